// The demo's run on the bench: its options, and the faults that it injects.
#pragma once

#include "toolchain/command_line.hpp"
#include "toolchain/tools/bench/bench.hpp"

#include <expected>
#include <string>
#include <vector>

namespace tappet::demo {

inline constexpr std::uint64_t usual_picks = 200, usual_seed = 1;
inline constexpr const char* machine_report = "/tmp/machine.json"; ///< in the guest
inline constexpr const char* plant_report = "/tmp/plant.json";

/// Returns views of the words. The error names the wrong word and its cure.
[[nodiscard]] std::expected<CommandLine, std::string> read_options(std::span<const std::string_view> words);
[[nodiscard]] std::string usage();

/// Returns words of the plant's command line. Some faults happen by chance; one of each kind is scripted, so
/// that a viewer always sees all kinds.
[[nodiscard]] std::vector<std::string> troubles(std::uint64_t picks);
[[nodiscard]] bench::Scenario scenario_of(const CommandLine& options);

} // namespace tappet::demo
