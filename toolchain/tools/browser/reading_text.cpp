// Age and origin of a value, from its row in the map.
#include "toolchain/tools/browser/reading_text.hpp"

namespace tappet::browser {

namespace {

/// Returns the maximum age of a value at this facet; 0: it never becomes stale.
std::int64_t max_age_of(const MapReader& map, std::uint32_t facet) {
    for (const map::Connection& each : map.connections())
        if (each.to == facet) return each.max_age_ns;
    return 0;
}

} // namespace

std::string_view flow_of(const MapReader& map, const Reading& reading) {
    if (reading.is_initial()) return reading.unread ? "unread" : "never_written";
    if (reading.forced || reading.stamp_ns < 0 || reading.now_ns < 0) return "fresh";
    const std::int64_t limit = max_age_of(map, reading.facet);
    return limit > 0 && reading.now_ns - reading.stamp_ns > limit ? "stale" : "fresh";
}

std::string marks_of(const MapReader& map, const Reading& reading) {
    if (reading.busy) return "busy";
    const std::string_view flow = flow_of(map, reading);
    std::string marks = reading.forced    ? "FORCED"
                        : flow == "fresh" ? ""
                        : reading.unread  ? "unread"
                        : flow == "stale" ? "stale"
                                          : "never written";
    const std::string wire = wire_of(map, reading);
    return marks + (marks.empty() || wire.empty() ? "" : ", ") + wire;
}

std::string value_of(const MapReader& map, const Reading& reading, Style style) {
    if (reading.busy || reading.value.empty()) return style == Style::json ? "null" : "?";
    return to_text(map, map.facets()[reading.facet].type, reading.value, style);
}

std::string with_unit(const MapReader& map, const Reading& reading) {
    const map::Facet& facet = map.facets()[reading.facet];
    const bool bears_it = facet.type != map::none && map.types()[facet.type].shape == map::Shape::duration;
    const std::string_view unit = bears_it ? std::string_view{} : map.text(facet.unit);
    return value_of(map, reading, Style::brief) + (unit.empty() ? "" : " ") + std::string{unit};
}

std::string wire_of(const MapReader& map, const Reading& reading) {
    if (reading.wire.empty() || reading.busy) return {};
    const Reading& wire = reading.wire.front();
    if (wire.busy || wire.forced || wire.is_initial()) return {};
    const bool scaled = (map.device_row_of(reading.facet)->flags & map::connection_scaled) != 0;
    const bool same =
        scaled ? wire.stamp_ns == reading.stamp_ns && !reading.forced : wire.value == reading.value;
    return same ? std::string{} : "wire " + with_unit(map, wire);
}

std::string json_wire_of(const MapReader& map, const Reading& reading) {
    if (reading.wire.empty() || reading.wire.front().busy || reading.wire.front().forced) return {};
    const Reading& wire = reading.wire.front();
    return ", \"wire\": " + (wire.is_initial() ? "null" : value_of(map, wire, Style::json)) +
           ", \"wire_time_ns\": " + std::to_string(wire.stamp_ns);
}

std::string json_of(const MapReader& map, const Reading& reading) {
    const map::Facet& facet = map.facets()[reading.facet];
    std::string all = "{\"name\": " + in_quotes(map.full_name(reading.facet));
    if (reading.busy) return all + ", \"busy\": true}";
    all += ", \"value\": " + value_of(map, reading, Style::json);
    all += ", \"unit\": " + in_quotes(map.text(facet.unit));
    all += ", \"flow\": " + in_quotes(flow_of(map, reading));
    all += std::string{", \"forced\": "} + (reading.forced ? "true" : "false");
    if (reading.stamp_ns >= 0) all += ", \"time_ns\": " + std::to_string(reading.stamp_ns);
    return all + json_wire_of(map, reading) + "}";
}

std::string line_of(const MapReader& map, const Reading& reading) {
    const std::string line = map.full_name(reading.facet) + " = " + with_unit(map, reading);
    std::string marks = marks_of(map, reading);
    if (!reading.is_initial() && !wire_of(map, reading).empty())
        if (const std::int64_t newer = reading.wire.front().stamp_ns - reading.stamp_ns; newer > 0)
            marks +=
                ", " + duration_text(newer - newer % (newer < 10'000'000 ? 1'000 : 1'000'000)) + " newer";
    return marks.empty() ? line : line + "   " + marks;
}

} // namespace tappet::browser
