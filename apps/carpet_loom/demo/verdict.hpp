// What a viewer reads at the end: the run in a few lines, and what of it must not be.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::demo {

/// The farthest a stop may be from the stop angle.
inline constexpr double most_stop_error_deg = 10.0;

struct Verdict {
    std::string table;               // lines of plain text
    std::vector<std::string> faults; // sentences; empty when all is well
};

/// `merged` is what merge() made.
[[nodiscard]] Verdict judge(std::string_view merged, std::int64_t picks_wanted);

} // namespace tappet::demo
