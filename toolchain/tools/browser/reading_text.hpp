// A reading as a line for people or for programs, with everything beside the value that must not be missed.
#pragma once

#include "toolchain/tools/browser/observer.hpp"
#include "toolchain/tools/browser/value.hpp"

namespace tappet::browser {

/// Returns "fresh", "stale" (older than its row allows), "never_written", or "unread" of an input that
/// was written and that its component has not read.
[[nodiscard]] std::string_view flow_of(const MapReader& map, const Reading& reading);
/// Returns "wire 13.5 deg" when the device of an input gave another value than its component last read.
[[nodiscard]] std::string wire_of(const MapReader& map, const Reading& reading);
/// Returns ", \"wire\": 13.5, \"wire_time_ns\": T" for an input that a device feeds; otherwise empty.
[[nodiscard]] std::string json_wire_of(const MapReader& map, const Reading& reading);
/// Returns "FORCED", "stale", "never written", "unread", "busy", "wire 13.5 deg", separated by ", ";
/// empty when there is nothing to report.
[[nodiscard]] std::string marks_of(const MapReader& map, const Reading& reading);
/// Returns the value in the given style; "?" while busy.
[[nodiscard]] std::string value_of(const MapReader& map, const Reading& reading, Style style);
/// Returns "12.5 deg"; a duration includes its own unit.
[[nodiscard]] std::string with_unit(const MapReader& map, const Reading& reading);
/// Returns {"name": "..", "value": .., "unit": "..", "flow": "..", "forced": false, "time_ns": T}; a busy one
/// has "busy": true and no value.
[[nodiscard]] std::string json_of(const MapReader& map, const Reading& reading);
/// Returns "shaft.angle_deg = 12.5 deg   FORCED, wire 13.5 deg, 4ms newer".
[[nodiscard]] std::string line_of(const MapReader& map, const Reading& reading);

} // namespace tappet::browser
