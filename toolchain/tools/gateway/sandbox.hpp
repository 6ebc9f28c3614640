// Takes from the gateway's process what it does not need: files, calls of the kernel, capabilities, memory.
#pragma once

#include <expected>
#include <string>
#include <vector>

namespace tappet::network {

struct Sandbox {
    std::vector<std::string> readable{}; ///< folders
    std::vector<std::string> writable{}; ///< folders
    std::vector<unsigned> processors{};  ///< empty: any
};

/// Applies it to this process, for ever; call it before threads start and after the sockets listen. Returns
/// what the kernel could not do, which the gateway then runs without: Landlock came with Linux 5.13. The
/// error: it is not safe to go on.
[[nodiscard]] std::expected<std::vector<std::string>, std::string> apply(const Sandbox& sandbox);

/// Reads "0,2-3". Nothing: it is no list of processors.
[[nodiscard]] std::expected<std::vector<unsigned>, std::string> processors_from(std::string_view text);

} // namespace tappet::network
