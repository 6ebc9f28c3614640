// Writes values, figures and counters as families of metrics.
#include "toolchain/tools/gateway/metrics.hpp"

#include "toolchain/tools/browser/reading_text.hpp"
#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/frame.hpp"

#include <charconv>
#include <cmath>
#include <cstring>

namespace tappet::network {

namespace {

/// Returns the value as a number; nothing: it is none.
std::optional<std::string> number_of(const browser::MapReader& map, std::uint32_t type,
                                     std::span<const std::byte> bytes) {
    if (type == map::none || bytes.empty()) return std::nullopt;
    const FrameKind kind = frame_kind(map, type);
    if (kind == FrameKind::text || kind == FrameKind::none) return std::nullopt;
    if (kind == FrameKind::boolean) return bytes[0] != std::byte{0} ? "1" : "0";
    std::string text = browser::to_text(
        map, type, bytes, kind == FrameKind::duration ? browser::Style::plain : browser::Style::json);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
    return whole ? std::optional{std::move(text)} : std::nullopt;
}

void family(std::string& text, std::string_view name, std::string_view type, std::string_view help) {
    text += "# HELP " + std::string{name} + " " + std::string{help} + "\n# TYPE " + std::string{name} + " " +
            std::string{type} + "\n";
}

std::string unit_label(std::string_view unit) {
    return unit.empty() ? std::string{} : ",unit=\"" + label_text(unit) + "\"";
}

void add_values(std::string& text, const Station& station) {
    const browser::MapReader& map = station.place()->map;
    for (const browser::Reading& each : station.read(station.with_values())) {
        if (text.size() > bounds.page_bytes) return;
        const std::string_view flow = browser::flow_of(map, each);
        if (each.busy || flow == "never_written" || flow == "stale") continue;
        const map::Facet& facet = map.facets()[each.facet];
        if (const auto number = number_of(map, facet.type, each.value))
            text += "tappet_value{machine=\"" + label_text(station.name()) + "\",name=\"" +
                    label_text(map.own_name(map.full_name(each.facet))) + "\"" +
                    unit_label(map.text(facet.unit)) + "} " + *number + "\n";
    }
}

void add_figures(std::string& text, const Station& station) {
    const browser::MapReader& map = station.place()->map;
    const browser::Observer observer = station.observer();
    const auto owner_of = [&](const map::Figure& figure) {
        const auto own = [&](map::Text name) { return std::string{map.text(name)}; };
        switch (figure.owner) {
        case map::Owner::component:
            return "component=\"" + label_text(own(map.components().at(figure.index).name)) + "\"";
        case map::Owner::activity:
            return "activity=\"" + label_text(own(map.activities().at(figure.index).name)) + "\"";
        case map::Owner::connection: return "connection=\"" + std::to_string(figure.index) + "\"";
        case map::Owner::reaction: return "reaction=\"" + std::to_string(figure.index) + "\"";
        case map::Owner::machine: break;
        }
        return std::string{"owner=\"machine\""};
    };
    for (std::uint32_t i = 0; i < map.figures().size() && text.size() <= bounds.page_bytes; ++i) {
        const map::Figure& figure = map.figures()[i];
        const bool owned =
            (figure.owner != map::Owner::component || figure.index < map.components().size()) &&
            (figure.owner != map::Owner::activity || figure.index < map.activities().size());
        const browser::FigureReading reading = observer.read_figure(i);
        if (!owned || reading.busy) continue;
        if (const auto number = number_of(map, figure.type, reading.value))
            text += "tappet_figure{machine=\"" + label_text(station.name()) + "\"," + owner_of(figure) +
                    ",name=\"" + label_text(map.text(figure.name)) + "\"" +
                    unit_label(map.text(figure.unit)) + "} " + *number + "\n";
    }
}

} // namespace

std::string label_text(std::string_view text) {
    std::string all;
    for (const char character : as_utf8(text)) {
        if (character == '"' || character == '\\') all += '\\';
        if (character == '\n')
            all += "\\n";
        else
            all += character;
    }
    return all;
}

std::string metrics_text(std::span<const Station* const> stations, const Counters& counters,
                         MetricsForm form) {
    std::string text;
    const std::int64_t now_ns = monotonic_ns();
    const auto lives = [&](const Station* each) {
        return each->place() != nullptr && each->standstill(now_ns).empty();
    };
    family(text, "tappet_up", "gauge", "Whether the machine answers and makes cycles.");
    for (const Station* each : stations)
        text += "tappet_up{machine=\"" + label_text(each->name()) + "\"} " + (lives(each) ? "1" : "0") + "\n";
    family(text, "tappet_value", "gauge", "A value of the machine, by its name; durations in seconds.");
    for (const Station* each : stations)
        if (lives(each)) add_values(text, *each);
    family(text, "tappet_figure", "gauge",
           "What the framework counts for a part of the machine; durations in seconds.");
    for (const Station* each : stations)
        if (each->place() != nullptr) add_figures(text, *each);
    const auto own = [&](const char* name, bool counts, std::uint64_t value, const char* help) {
        const std::string sample = std::string{name} + (counts ? "_total" : "");
        family(text, form == MetricsForm::open ? name : sample, counts ? "counter" : "gauge", help);
        text += sample + " " + std::to_string(value) + "\n";
    };
    own("tappet_gateway_connections", false, counters.connections, "Connections that are open.");
    own("tappet_gateway_accepted", true, counters.accepted, "Connections accepted.");
    own("tappet_gateway_turned_away", true, counters.turned_away, "Connections beyond the bounds.");
    own("tappet_gateway_frames", true, counters.frames_sent, "Frames of watches sent.");
    own("tappet_gateway_frames_lost", true, counters.frames_lost, "Frames that slow clients lost.");
    own("tappet_gateway_requests", true, counters.requests, "Requests relayed to machines.");
    own("tappet_gateway_logins_failed", true, counters.logins_failed, "Logins that failed.");
    return form == MetricsForm::open ? text + "# EOF\n" : text;
}

} // namespace tappet::network
