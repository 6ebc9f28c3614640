// Commands that only read: the browser sends no request, except for counters, which the machine sums up on
// request.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/reading_text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>

namespace tappet::browser {

namespace {

using map::none;

std::string activity_name(const MapReader& map, std::uint32_t activity) {
    return activity == none ? "-" : map.named(map.activities()[activity].name);
}

/// Returns "double", or "(double) -> bool" for a callable facet.
std::string type_of(const MapReader& map, const map::Facet& facet) {
    if (facet.type == none) return "";
    std::string text = type_name(map, facet.type);
    if (facet.result != none) text += " -> " + type_name(map, facet.result);
    return text;
}

std::string json_text(std::string_view key, std::string_view text) {
    return ", " + in_quotes(key) + ": " + in_quotes(text);
}

/// Returns "12.5 deg FORCED, wire 13.5 deg"; only the unit when the facet has no value.
std::string value_with_unit(Work& work, std::uint32_t index) {
    const MapReader& map = work.session.map();
    if (map.facets()[index].value_at == 0) return std::string{map.text(map.facets()[index].unit)};
    const Reading reading = work.session.observer().read(index);
    const std::string wire = wire_of(map, reading);
    return with_unit(map, reading) + (reading.forced ? " FORCED" : "") + (wire.empty() ? "" : ", ") + wire;
}

std::string_view motion_of(const map::Facet& facet) {
    if ((facet.flags & map::facet_moves_while_held) != 0) return "moves_while_held";
    return (facet.flags & map::facet_moves) != 0 ? "moves" : "";
}

/// Returns the role that may set, call or send it, and whether that moves something; empty: none.
std::string role_of(const MapReader& map, const map::Facet& facet, std::string_view before,
                    std::string_view after) {
    const std::string role{map.text(facet.role)};
    if (role.empty()) return {};
    const std::string motion{motion_of(facet)};
    return std::string{before} + role + (motion.empty() ? "" : ", ") + motion + std::string{after};
}

/// The same for programs, and whether its interface offers it to people.
std::string json_rights(const MapReader& map, const map::Facet& facet) {
    const std::string role{map.text(facet.role)};
    if (role.empty()) return {};
    const bool for_people = (facet.flags & map::facet_for_people) != 0;
    return json_text("role", role) + R"(, "for_people": )" + (for_people ? "true" : "false") +
           json_text("motion", motion_of(facet).empty() ? "none" : motion_of(facet));
}

void list_component(Work& work, std::uint32_t index) {
    const MapReader& map = work.session.map();
    const map::Component& component = map.components()[index];
    for (std::uint32_t i = component.first_facet; i < component.first_facet + component.facet_count; ++i) {
        const map::Facet& facet = map.facets()[i];
        if (work.line.json) {
            work.out << "{\"name\": " << in_quotes(map.full_name(i))
                     << json_text("kind", map.text(facet.kind)) << json_text("type", type_of(map, facet))
                     << json_text("unit", map.text(facet.unit)) << json_text("doc", map.text(facet.doc))
                     << json_rights(map, facet);
            if (facet.value_at != 0) {
                const Reading reading = work.session.observer().read(i);
                work.out << ", \"value\": " << value_of(map, reading, Style::json)
                         << json_wire_of(map, reading);
            }
            work.out << "}\n";
            continue;
        }
        std::string line = padded(map.full_name(i), 30) + " " +
                           padded(std::string{map.text(facet.kind)}, 10) + " " +
                           padded(type_of(map, facet), 14) + " " + padded(value_with_unit(work, i), 16) +
                           " " + std::string{map.text(facet.doc)};
        // All properties need the same role.
        if (map.text(facet.kind) != "property") line += role_of(map, facet, " [", "]");
        line.erase(line.find_last_not_of(' ') + 1);
        work.out << line << "\n";
    }
}

Result<std::uint32_t> component_named(const MapReader& map, const std::string& name) {
    if (const auto found = map.find_component(name)) return *found;
    const std::string nearest = MapReader::nearest_of(name, names_for(map, Takes::component));
    return wrong("the machine has no component '" + name + "'" +
                 (nearest.empty() ? "; list shows its components" : nearest));
}

void tell_connections(Work& work, std::uint32_t facet, const std::string& indent) {
    const MapReader& map = work.session.map();
    for (const map::Connection& each : map.connections()) {
        if (each.from == facet && each.to != none)
            work.out << indent << "-> " << map.full_name(each.to) << "\n";
        if (each.to != facet || each.from == none) continue;
        work.out << indent << "<- " << map.full_name(each.from);
        if (each.max_age_ns > 0)
            work.out << " (stale after " << duration_text(each.max_age_ns) << ": "
                     << map.text(each.when_stale) << ")";
        if ((each.flags & map::connection_buffered) != 0) work.out << " (buffer of " << each.capacity << ")";
        const std::string wire =
            map.facets()[facet].value_at == 0 ? "" : wire_of(map, work.session.observer().read(facet));
        work.out << (wire.empty() ? "" : ", ") << wire << "\n";
    }
    for (const map::Reaction& each : map.reactions()) {
        if (each.from == facet && each.to != none)
            work.out << indent << "-> " << map.text(each.how) << " " << map.full_name(each.to) << "\n";
        if (each.from == facet && each.to == none) work.out << indent << "-> " << map.text(each.how) << "\n";
        if (each.to == facet && each.from != none)
            work.out << indent << "<- " << map.text(each.how) << " of " << map.full_name(each.from) << "\n";
    }
}

void tell_figures(Work& work, map::Owner owner, std::uint32_t index, const std::string& indent) {
    const MapReader& map = work.session.map();
    for (std::uint32_t i = 0; i < map.figures().size(); ++i) {
        const map::Figure& figure = map.figures()[i];
        if (figure.owner != owner || (owner != map::Owner::machine && figure.index != index)) continue;
        const FigureReading reading = work.session.observer().read_figure(i);
        const std::string unit{map.text(figure.unit)};
        const bool none_there = reading.busy || reading.value.empty();
        if (work.line.json) {
            work.out << (indent.empty() ? "" : ", ") << in_quotes(map.text(figure.name)) << ": "
                     << (none_there ? "null" : to_text(map, figure.type, reading.value, Style::json));
            continue;
        }
        work.out << indent << map.text(figure.name) << " = "
                 << (none_there ? "busy" : to_text(map, figure.type, reading.value, Style::brief))
                 << (unit.empty() ? "" : " ") << unit << "\n";
    }
}

void tell_activity(Work& work, std::uint32_t index) {
    const MapReader& map = work.session.map();
    const map::Activity& each = map.activities()[index];
    if (work.line.json) {
        work.out << "{\"activity\": " << in_quotes(map.named(each.name))
                 << json_text("trigger", map.text(each.trigger)) << ", \"period_ns\": " << each.period_ns
                 << ", \"deadline_ns\": " << each.deadline_ns << ", \"budget_ns\": " << each.budget_ns
                 << ", \"real_time\": " << (each.real_time != 0 ? "true" : "false")
                 << ", \"priority\": " << each.priority << ", \"processor\": " << each.processor;
        tell_figures(work, map::Owner::activity, index, " ");
        work.out << "}\n";
        return;
    }
    work.out << "activity " << map.named(each.name) << ": " << map.text(each.trigger);
    if (each.period_ns > 0) work.out << " " << duration_text(each.period_ns);
    if (each.at_most_n > 0 && each.period_ns == 0)
        work.out << ", at most " << each.at_most_n << " in " << duration_text(each.at_most_per_ns);
    if (each.real_time != 0)
        work.out << ", deadline " << duration_text(each.deadline_ns) << ", budget "
                 << duration_text(each.budget_ns) << ", priority " << each.priority;
    else
        work.out << ", not real-time";
    work.out << "\n";
    tell_figures(work, map::Owner::activity, index, "    ");
}

void tell_component(Work& work, std::uint32_t index) {
    const MapReader& map = work.session.map();
    const map::Component& each = map.components()[index];
    if (work.line.json) {
        work.out << "{\"component\": " << in_quotes(map.named(each.name))
                 << json_text("type", user_name(map.text(each.type)))
                 << json_text("activity", activity_name(map, each.activity))
                 << ", \"facets\": " << each.facet_count;
        tell_figures(work, map::Owner::component, index, " ");
        work.out << "}\n";
        return;
    }
    work.out << padded(map.named(each.name), 16) << " " << padded(user_name(map.text(each.type)), 28) << " "
             << padded(activity_name(map, each.activity), 12) << " " << each.facet_count << " facets";
    if (each.device.length > 0) work.out << ", device " << map.text(each.device);
    work.out << "\n";
}

void tell_machine(Work& work) {
    const MapReader& map = work.session.map();
    const map::Header& header = map.header();
    std::string_view build{header.build_id.data(), header.build_id.size()};
    build = build.substr(0, build.find('\0'));
    if (work.line.json) {
        work.out << "{\"machine\": " << in_quotes(map.text(header.machine))
                 << json_text("board", map.text(header.board)) << json_text("world", map.text(header.world))
                 << json_text("build_id", build) << json_text("framework", header.framework.data())
                 << json_text("role", work.session.role()) << ", \"process\": " << header.process
                 << ", \"forced\": " << work.session.observer().forced()
                 << ", \"components\": " << map.components().size()
                 << ", \"facets\": " << map.facets().size();
        tell_figures(work, map::Owner::machine, 0, " ");
        work.out << "}\n";
    } else {
        work.out << "machine " << map.text(header.machine) << " on board " << map.text(header.board)
                 << ", process " << header.process << ", build " << (build.empty() ? "without an id" : build)
                 << ", Tappet " << header.framework.data() << "\n"
                 << map.components().size() << " components, " << map.facets().size() << " facets, "
                 << map.connections().size() << " connections, " << map.reactions().size() << " reactions; "
                 << work.session.observer().forced() << " forced\n"
                 << "you are its " << work.session.role() << "\n";
        tell_figures(work, map::Owner::machine, 0, "");
    }
    for (std::uint32_t i = 0; i < map.activities().size(); ++i) tell_activity(work, i);
}

/// Prints the counters that the machine sums up only on request.
Result<void> tell_counters(Work& work) {
    const auto counters = work.session.link().request("counters");
    if (!counters) return std::unexpected(counters.error());
    const auto rows = [&](const char* key) { return counters->value(key, nlohmann::ordered_json::array()); };
    for (const auto& stack : rows("stacks")) {
        if (work.line.json) {
            work.out << "{\"stack_of\": " << stack["activity"] << ", \"bytes\": " << stack["bytes"]
                     << ", \"used_bytes\": " << stack["used_bytes"] << "}\n";
            continue;
        }
        // A world without threads knows no stack usage.
        if (stack["used_bytes"] == 0) continue;
        work.out << "stack of " << stack["activity"].get<std::string>() << ": " << stack["used_bytes"]
                 << " of " << stack["bytes"] << " bytes used at most\n";
    }
    for (const auto& row : rows("held_back"))
        if (work.line.json)
            work.out << "{\"limits\": " << row["row"] << ", \"held_back\": " << row["times"] << "}\n";
        else
            work.out << "limits held back " << row["row"].get<std::string>() << " " << row["times"]
                     << (row["times"] == 1 ? " time\n" : " times\n");
    for (const auto& row : rows("unsent"))
        if (work.line.json)
            work.out << row << "\n";
        else if (row.contains("output"))
            work.out << row["output"].get<std::string>() << ": " << row["no_number"]
                     << " times received and not a number, not passed on\n";
        else
            work.out << row["input"].get<std::string>() << ": " << row["clamped"]
                     << " times outside its range, sent as its nearest bound; " << row["no_number"]
                     << " times not a number, not sent\n";
    if (const auto all = counters->value("unsent_rows", std::size_t{0});
        !work.line.json && all > rows("unsent").size())
        work.out << all - rows("unsent").size() << " more rows: the summary of the run lists them\n";
    return {};
}

std::string range_of(const map::Facet& facet) {
    if ((facet.flags & map::facet_has_range) == 0) return {};
    std::string low = std::to_string(facet.low);
    std::string high = std::to_string(facet.high);
    for (std::string* each : {&low, &high}) {
        each->erase(each->find_last_not_of('0') + 1);
        if (each->ends_with('.')) each->pop_back();
    }
    return low + " to " + high;
}

void tell_facet(Work& work, const FoundFacet& found) {
    const MapReader& map = work.session.map();
    const map::Facet& facet = found.record;
    const bool has_value = facet.value_at != 0;
    if (work.line.json) {
        work.out << "{\"name\": " << in_quotes(map.full_name(found.index))
                 << json_text("kind", map.text(facet.kind)) << json_text("type", type_of(map, facet))
                 << json_text("unit", map.text(facet.unit)) << json_text("doc", map.text(facet.doc))
                 << json_text("activity", activity_name(map, map.activity_of(facet)))
                 << json_rights(map, facet);
        if ((facet.flags & map::facet_has_range) != 0)
            work.out << ", \"low\": " << facet.low << ", \"high\": " << facet.high;
        work.out << "}\n";
        return;
    }
    work.out << map.full_name(found.index) << ": " << map.text(facet.kind) << " " << type_of(map, facet)
             << " " << map.text(facet.unit) << "\n    " << map.text(facet.doc) << "\n    in activity "
             << activity_name(map, map.activity_of(facet)) << role_of(map, facet, ", for the ", "") << "\n";
    if (const std::string range = range_of(facet); !range.empty()) work.out << "    from " << range << "\n";
    if (has_value) work.out << "    " << line_of(map, work.session.observer().read(found.index)) << "\n";
    tell_connections(work, found.index, "    ");
}

} // namespace

Result<void> run_list(Work& work) {
    const MapReader& map = work.session.map();
    if (work.arguments().empty()) {
        for (std::uint32_t i = 0; i < map.components().size(); ++i) tell_component(work, i);
        return {};
    }
    const auto component = component_named(map, work.arguments()[0]);
    if (!component) return std::unexpected(component.error());
    list_component(work, *component);
    return {};
}

Result<void> run_get(Work& work) {
    std::string busy;
    const auto all = find_seen(work);
    if (!all) return std::unexpected(all.error());
    for (const Seen& seen : *all) {
        const MapReader& map = seen.session->map();
        for (const Reading& reading : seen.session->observer().read(seen.facets)) {
            work.out << (work.line.json ? json_of(map, reading) : line_of(map, reading)) << "\n";
            if (reading.busy && busy.empty()) busy = map.full_name(reading.facet);
        }
    }
    if (busy.empty()) return {};
    return failure(Fault::too_late, "the activity of '" + busy + "' was in its cycle at each of " +
                                        std::to_string(Observer::attempts) + " looks; try again");
}

Result<void> run_tree(Work& work) {
    const MapReader& map = work.session.map();
    std::uint32_t only = none;
    if (!work.arguments().empty()) {
        const auto component = component_named(map, work.arguments()[0]);
        if (!component) return std::unexpected(component.error());
        only = *component;
    }
    for (std::uint32_t c = 0; c < map.components().size(); ++c) {
        if (only != none && only != c) continue;
        if (work.line.json) {
            list_component(work, c);
            continue;
        }
        const map::Component& component = map.components()[c];
        work.out << map.named(component.name) << " (" << user_name(map.text(component.type)) << ", activity "
                 << activity_name(map, component.activity) << ")\n";
        for (std::uint32_t i = component.first_facet; i < component.first_facet + component.facet_count;
             ++i) {
            const map::Facet& facet = map.facets()[i];
            work.out << "    " << map.text(facet.kind) << " " << map.text(facet.name) << " "
                     << type_of(map, facet) << "\n";
            tell_connections(work, i, "        ");
        }
    }
    return {};
}

Result<void> run_info(Work& work) {
    const MapReader& map = work.session.map();
    if (work.arguments().empty()) {
        tell_machine(work);
        return tell_counters(work);
    }
    const std::string& name = work.arguments()[0];
    bool told = false;
    if (const auto component = map.find_component(name)) {
        tell_component(work, *component);
        if (!work.line.json) tell_figures(work, map::Owner::component, *component, "    ");
        told = true;
    }
    for (std::uint32_t i = 0; i < map.activities().size(); ++i) {
        if (map.named(map.activities()[i].name) != name) continue;
        tell_activity(work, i);
        told = true;
    }
    if (told) return {};
    const auto facet = find_facet(map, Takes::anything, name);
    if (!facet) return std::unexpected(facet.error());
    tell_facet(work, *facet);
    return {};
}

Result<void> run_forced(Work& work) {
    const MapReader& map = work.session.map();
    for (std::uint32_t i = 0; i < map.facets().size(); ++i) {
        if (map.facets()[i].forced_at == 0) continue;
        const Reading reading = work.session.observer().read(i);
        if (reading.forced)
            work.out << (work.line.json ? json_of(map, reading) : line_of(map, reading)) << "\n";
    }
    return {};
}

} // namespace tappet::browser
