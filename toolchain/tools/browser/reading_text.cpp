// Age and origin of a value, from its row in the map.
#include "toolchain/tools/browser/reading_text.hpp"

namespace tappet::browser {

namespace {

/// How old a value at this facet may be; 0: it never becomes stale.
std::int64_t max_age_of(const MapReader& map, std::uint32_t facet) {
    for (const map::Connection& each : map.connections())
        if (each.to == facet) return each.max_age_ns;
    return 0;
}

} // namespace

std::string_view flow_of(const MapReader& map, const Reading& reading) {
    if (reading.never_written()) return "never_written";
    if (reading.forced || reading.stamp_ns < 0 || reading.now_ns < 0) return "fresh";
    const std::int64_t limit = max_age_of(map, reading.facet);
    return limit > 0 && reading.now_ns - reading.stamp_ns > limit ? "stale" : "fresh";
}

std::string marks_of(const MapReader& map, const Reading& reading) {
    if (reading.busy) return "busy";
    const std::string_view flow = flow_of(map, reading);
    std::string marks = reading.forced ? "FORCED" : "";
    if (flow == "fresh" || reading.forced) return marks;
    return marks + (flow == "stale" ? "stale" : "never written");
}

std::string value_of(const MapReader& map, const Reading& reading, Style style) {
    if (reading.busy || reading.value.empty()) return style == Style::json ? "null" : "?";
    return to_text(map, map.facets()[reading.facet].type, reading.value, style);
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
    return all + "}";
}

std::string line_of(const MapReader& map, const Reading& reading) {
    const std::string_view unit = map.text(map.facets()[reading.facet].unit);
    std::string line = map.full_name(reading.facet) + " = " + value_of(map, reading, Style::brief);
    const bool bears_it = map.types()[map.facets()[reading.facet].type].shape == map::Shape::duration;
    if (!unit.empty() && !bears_it) line += " " + std::string{unit};
    const std::string marks = marks_of(map, reading);
    return marks.empty() ? line : line + "   " + marks;
}

} // namespace tappet::browser
