// What a viewer reads at the end: the run in a few lines, and what of it must not be.
#pragma once

#include <cstdint>
#include <expected>
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
    std::string summary;             // of both, as one JSON object
    std::string table;               // lines of plain text
    std::vector<std::string> faults; // sentences; empty when all is well
};

/// Of the firmware's summary and the plant's report. In their summary all keys of the machine stay where they
/// are; of the plant those that judge the machine (stops, cam errors, picks, injected breaks, damage) stand
/// beside them, and the rest of its bookkeeping lies under "plant". The error: what is no JSON, or lacks a
/// key, or has one of another type.
[[nodiscard]] std::expected<Verdict, std::string> judge(std::string_view machine, std::string_view plant,
                                                        std::int64_t picks_wanted);

} // namespace tappet::demo
