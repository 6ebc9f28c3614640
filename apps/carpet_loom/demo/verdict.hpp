// The result shown at the end: the run in a few lines, and its faults.
#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::demo {

/// The largest distance of a stop from the stop angle.
inline constexpr double most_stop_error_deg = 10.0;

/// In a run of at least this many picks, the demo changes the weave. The next two constants: the script that
/// it loads, and the first pattern that this script lifts.
inline constexpr std::int64_t least_picks_for_weaves = 60;
inline constexpr const char* new_weave = "twill.osd";
inline constexpr std::uint64_t pattern_of_new_weave = 4369;

struct Verdict {
    std::string summary;             // of both, as one JSON object
    std::string table;               // lines of plain text
    std::vector<std::string> faults; // sentences; empty when all is well
};

/// Judges the firmware's summary and the plant's report. The merged summary keeps all keys of the machine in
/// place. The plant's keys that judge the machine (stops, cam errors, picks, injected breaks, damage) stand
/// beside them; its other keys are under "plant". The error names invalid JSON, or a key that is missing or
/// has the wrong type.
[[nodiscard]] std::expected<Verdict, std::string> judge(std::string_view machine, std::string_view plant,
                                                        std::int64_t picks_wanted);

} // namespace tappet::demo
