// Writes HTML for people and JSON for clients.
#include "toolchain/tools/gateway/page.hpp"

#include "toolchain/tools/browser/reading_text.hpp"
#include "toolchain/tools/gateway/encoding.hpp"

namespace tappet::network {

namespace {

using browser::in_quotes;

std::string page(std::string_view title, std::string_view body, bool refreshes) {
    return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + in_html(title) +
           "</title>" + (refreshes ? "<meta http-equiv=\"refresh\" content=\"2\">" : "") +
           "<meta name=\"viewport\" content=\"width=device-width\"><link rel=\"stylesheet\" "
           "href=\"/page.css\"></head>\n<body>\n" +
           std::string{body} + "</body></html>\n";
}

void add_rows(std::string& body, const Station& station) {
    const browser::MapReader& map = station.place()->map;
    std::size_t rows = 0;
    for (const browser::Reading& each : station.read(station.with_values())) {
        if (++rows > bounds.page_rows || body.size() > bounds.page_bytes) {
            body += "<tr><td>and more: watch them by name</td><td></td><td></td></tr>\n";
            return;
        }
        const std::string marks = browser::marks_of(map, each);
        const std::string value = as_utf8(browser::with_unit(map, each));
        body += "<tr><td>" + in_html(map.full_name(each.facet)) + "</td><td>" + in_html(cut(value, 200)) +
                "</td><td>" + in_html(marks) + "</td></tr>\n";
    }
}

std::string utf8_quoted(std::string_view text) { return in_quotes(as_utf8(text)); }

std::string facet_json(const browser::MapReader& map, std::uint32_t index) {
    const map::Facet& facet = map.facets()[index];
    const std::string type = facet.type == map::none ? std::string{} : browser::type_name(map, facet.type);
    std::string text = "{\"name\": " + utf8_quoted(map.text(facet.name)) +
                       ", \"kind\": " + utf8_quoted(map.text(facet.kind)) +
                       ", \"type\": " + utf8_quoted(type) +
                       ", \"unit\": " + utf8_quoted(map.text(facet.unit)) +
                       ", \"has_value\": " + (facet.value_at != 0 ? "true" : "false") + ", \"role\": ";
    text += facet.role.length == 0 ? std::string{"null"} : utf8_quoted(map.text(facet.role));
    const auto has = [&](std::uint32_t flag) { return (facet.flags & flag) != 0 ? "true" : "false"; };
    text += std::string{", \"for_people\": "} + has(map::facet_for_people) +
            ", \"moves\": " + has(map::facet_moves | map::facet_moves_while_held);
    return text + ", \"help\": " + utf8_quoted(map.text(facet.doc)) + "}";
}

} // namespace

std::string_view page_style() {
    return "body{font:14px sans-serif;background:#fff;color:#222}td{padding:0 1em 0 "
           "0}label{display:block;margin:.5em 0}\n";
}

std::string login_page(std::string_view fault) {
    return page("Tappet: log in",
                "<h1>Log in</h1>\n" +
                    (fault.empty() ? std::string{} : "<p><b>" + in_html(fault) + "</b></p>\n") +
                    "<form method=\"post\" action=\"/login\"><label>User <input name=\"user\" "
                    "autocomplete=\"username\"></label>"
                    "<label>Password <input name=\"password\" type=\"password\" "
                    "autocomplete=\"current-password\"></label>"
                    "<button>Log in</button></form>\n",
                false);
}

std::string values_page(std::span<const Station* const> stations, const LoggedIn& who, bool can_leave) {
    std::string body = "<p>" + in_html(who.user) + ", " + std::string{tappet::to_text(who.role)} + "</p>\n";
    if (can_leave) body += "<form method=\"post\" action=\"/logout\"><button>Log out</button></form>\n";
    if (stations.empty()) body += "<p>No machine is running here.</p>\n";
    for (const Station* each : stations) {
        body += "<h1>" + in_html(each->name()) + "</h1>\n";
        if (each->place() == nullptr) {
            body += "<p>It does not answer: " + in_html(each->reason()) + "</p>\n";
            continue;
        }
        body += "<p>board " + in_html(each->place()->board) + ", build " + in_html(each->place()->build_id) +
                "</p>\n";
        if (const std::string why = each->standstill(monotonic_ns()); !why.empty())
            body += "<p>These values are old: " + in_html(why) + ".</p>\n";
        body += "<table>\n";
        add_rows(body, *each);
        body += "</table>\n";
    }
    return page("Tappet", body, true);
}

std::string machine_json(const Station& station) {
    std::string text = "{\"name\": " + utf8_quoted(station.name()) + ", \"answers\": ";
    if (station.place() == nullptr) return text + "false, \"reason\": " + utf8_quoted(station.reason()) + "}";
    const Place& place = *station.place();
    return text + "true, \"board\": " + utf8_quoted(place.board) +
           ", \"build_id\": " + utf8_quoted(place.build_id) +
           ", \"framework\": " + utf8_quoted(place.framework) + ", \"world\": " + utf8_quoted(place.world) +
           ", \"life\": " + std::to_string(station.life()) + "}";
}

std::string facets_json(const Station& station) {
    const browser::MapReader& map = station.place()->map;
    std::string text = "[";
    for (const map::Component& component : map.components()) {
        if (text.size() > 1) text += ", ";
        text += "{\"component\": " + utf8_quoted(map.text(component.name)) +
                ", \"type\": " + utf8_quoted(browser::user_name(map.text(component.type))) +
                ", \"facets\": [";
        for (std::uint32_t i = 0; i < component.facet_count; ++i)
            text += (i == 0 ? "" : ", ") + facet_json(map, component.first_facet + i);
        text += "]}";
    }
    return text + "]";
}

} // namespace tappet::network
