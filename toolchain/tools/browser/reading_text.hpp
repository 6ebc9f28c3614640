// A reading as a line for people or for programs, with everything that must not be overlooked beside the
// value.
#pragma once

#include "toolchain/tools/browser/observer.hpp"
#include "toolchain/tools/browser/value.hpp"

namespace tappet::browser {

/// "fresh", "stale" (older than its row allows) or "never_written".
[[nodiscard]] std::string_view flow_of(const MapReader& map, const Reading& reading);
/// "FORCED", "stale", "never written", "busy", parted by ", "; empty when there is nothing to say.
[[nodiscard]] std::string marks_of(const MapReader& map, const Reading& reading);
/// The value in the given style; "?" while busy.
[[nodiscard]] std::string value_of(const MapReader& map, const Reading& reading, Style style);
/// {"name": "..", "value": .., "unit": "..", "flow": "..", "forced": false, "time_ns": T}; a busy one has
/// "busy": true and no value.
[[nodiscard]] std::string json_of(const MapReader& map, const Reading& reading);
/// "shaft.angle_deg = 12.5 deg   FORCED".
[[nodiscard]] std::string line_of(const MapReader& map, const Reading& reading);

} // namespace tappet::browser
