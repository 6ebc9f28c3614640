// What a viewer reads at the end: the run in a few lines, and what of it must not be.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::demo {

/// The farthest a stop may be from the stop angle.
inline constexpr double most_stop_error_deg = 10.0;

/// A run of so many picks shows how its weave is changed; the script that is woven then, and the first of the
/// patterns that it lifts.
inline constexpr std::int64_t least_picks_for_weaves = 60;
inline constexpr const char* new_weave = "twill.osd";
inline constexpr std::uint64_t pattern_of_new_weave = 4369;

struct Verdict {
    std::string table;               // lines of plain text
    std::vector<std::string> faults; // sentences; empty when all is well
};

/// `merged` is what merge() made.
[[nodiscard]] Verdict judge(std::string_view merged, std::int64_t picks_wanted);

} // namespace tappet::demo
