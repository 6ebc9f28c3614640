// A reading as a line for people or for programs, with everything that must not be overlooked beside the
// value.
#pragma once

#include "toolchain/tools/browser/observer.hpp"
#include "toolchain/tools/browser/value.hpp"

namespace tappet::browser {

/// "fresh", "stale" (older than its row allows) or "never_written".
[[nodiscard]] std::string_view flow_of(const MapReader& map, const Reading& reading);
/// "wire 13.5 deg", where the device that feeds an input gave another value than its component read last.
[[nodiscard]] std::string wire_of(const MapReader& map, const Reading& reading);
/// ", \"wire\": 13.5, \"wire_time_ns\": T" of each input that a device feeds; else empty.
[[nodiscard]] std::string json_wire_of(const MapReader& map, const Reading& reading);
/// "FORCED", "stale", "never written", "busy", "wire 13.5 deg", parted by ", "; empty when there is nothing
/// to say.
[[nodiscard]] std::string marks_of(const MapReader& map, const Reading& reading);
/// The value in the given style; "?" while busy.
[[nodiscard]] std::string value_of(const MapReader& map, const Reading& reading, Style style);
/// "12.5 deg"; a duration bears its own unit.
[[nodiscard]] std::string with_unit(const MapReader& map, const Reading& reading);
/// {"name": "..", "value": .., "unit": "..", "flow": "..", "forced": false, "time_ns": T}; a busy one has
/// "busy": true and no value.
[[nodiscard]] std::string json_of(const MapReader& map, const Reading& reading);
/// "shaft.angle_deg = 12.5 deg   FORCED, wire 13.5 deg, 4ms newer".
[[nodiscard]] std::string line_of(const MapReader& map, const Reading& reading);

} // namespace tappet::browser
