// What the demo runs on the bench: its options, and what goes wrong on the way.
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

/// Views of the words. The error says which word is wrong and how to put it right.
[[nodiscard]] std::expected<CommandLine, std::string> read_options(std::span<const std::string_view> words);
[[nodiscard]] std::string usage();

/// Words of the plant's command line. Some of it goes wrong by chance, and one of each kind for sure, so that
/// a viewer sees them all whatever the chance brings.
[[nodiscard]] std::vector<std::string> troubles(std::uint64_t picks);
[[nodiscard]] bench::Scenario scenario_of(const CommandLine& options);

} // namespace tappet::demo
