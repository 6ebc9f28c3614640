// tappet-browse ADDRESS:PORT COMMAND..: a line that a gateway runs, with this user's files and terminal.
#pragma once

#include "toolchain/tools/browser/far/wire.hpp"
#include "toolchain/tools/browser/program.hpp"

namespace tappet::browser {

/// A line for machines elsewhere.
struct FarCall {
    Address address{};
    std::string user{};               ///< of --user, or of USER
    std::string ca{};                 ///< of --ca
    std::vector<std::string> words{}; ///< of the line, without all these
};

/// Returns the call; nothing when the first word is no address, which is a line for this host. The error: an
/// option without its value.
[[nodiscard]] std::expected<std::optional<FarCall>, std::string>
parse_call(std::span<const std::string> words);

/// Runs the line at the gateway behind `open`, which is called once the line is known to be good. Returns its
/// exit code.
using OpenWire = std::function<Result<std::unique_ptr<FarWire>>(const FarCall& call)>;
[[nodiscard]] int run_far_line(const FarCall& call, Surroundings& surroundings, const OpenWire& open);

} // namespace tappet::browser
