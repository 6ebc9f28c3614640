// Checks of the section connections: both ends exist, point the right way, carry the same type; every input has one
// writer; and inside an activity an order exists in which every component sees this cycle's values.
#pragma once

#include "kernel/machine/check_components.hpp"

namespace tappet::checks {

template <class... Pieces>
constexpr Sentence of_connection(const ConnectionRow& row, const Pieces&... fault) {
    return Sentence{"connection \"", row.from, "\" -> \"", row.to, "\": ", fault...};
}

constexpr Sentence check_direction(const ConnectionRow& row, const Facet& from, const Facet& to) {
    const bool from_is_input = from.kind == FacetKind::input || from.kind == FacetKind::buffer_input;
    const bool to_is_output = to.kind == FacetKind::output || to.kind == FacetKind::buffer_output;
    if (from_is_input && to_is_output) return of_connection(row, "runs from an input to an output; exchange the two");
    const FacetKind wanted_from = row.buffered ? FacetKind::buffer_output : FacetKind::output;
    const FacetKind wanted_to = row.buffered ? FacetKind::buffer_input : FacetKind::input;
    if (from.kind != wanted_from)
        return of_connection(row, "\"", row.from, "\" is ", to_text(from.kind), ", not ", to_text(wanted_from), from.kind == FacetKind::buffer_output ? "; write buffer<n>(...)" : from.kind == FacetKind::output ? "; write data(...)" : "; name an output first");
    if (to.kind != wanted_to)
        return of_connection(row, "\"", row.to, "\" is ", to_text(to.kind), ", not ", to_text(wanted_to), to.kind == FacetKind::buffer_input ? "; write buffer<n>(...)" : to.kind == FacetKind::input ? "; write data(...)" : "; name an input second");
    if (from.type != to.type) return of_connection(row, "\"", row.from, "\" is of type ", from.type->name, " but \"", row.to, "\" is of type ", to.type->name, "; connect ports of one type");
    return {};
}

constexpr Sentence check_policies(const MachineView& m, const ConnectionRow& row, const Facet& to, std::size_t writer, std::size_t reader) {
    if (row.buffered && row.capacity == 0) return of_connection(row, "holds no value; write buffer<n> with n of at least 1");
    if (row.has_substitute && !to.type->arithmetic) return of_connection(row, "a value of type ", to.type->name, " has no substitute number; use hold or stop_machine");
    if (row.when_stale != WhenStale::hold && row.max_age == Duration::zero() && !row.has_substitute) return of_connection(row, "says what a stale value means but not when it is stale; add stale_after(...)");
    if (row.buffered && (row.max_age != Duration::zero() || row.has_substitute)) return of_connection(row, "values in a buffer have no age; remove stale_after and substitute");
    if (row.wakes_reader && m.activities[reader].periodic()) return of_connection(row, "wakes activity \"", m.activities[reader].name, "\", which is periodic; remove wakes");
    if (row.wakes_reader && writer == reader) return of_connection(row, "wakes its own activity \"", m.activities[reader].name, "\"; remove wakes");
    if (row.delayed_step && writer != reader) return of_connection(row, "delayed means one cycle of one activity, but this row crosses from \"", m.activities[writer].name, "\" to \"", m.activities[reader].name, "\"; remove delayed");
    return {};
}

/// Fills the ends of each connection.
constexpr Sentence check_connections(const MachineView& m, TableIndexView r) {
    for (std::size_t x = 0; x < m.connections.size(); ++x) {
        const ConnectionRow& row = m.connections[x];
        Link& link = r.connections[x];
        if (Sentence fault = resolve(m, row.from, row.buffered ? FacetKind::buffer_output : FacetKind::output, link.from); !fault.empty()) return of_connection(row, fault);
        if (Sentence fault = resolve(m, row.to, row.buffered ? FacetKind::buffer_input : FacetKind::input, link.to); !fault.empty()) return of_connection(row, fault);
        const Facet& to = facet_at(m, link.to);
        if (Sentence fault = check_direction(row, facet_at(m, link.from), to); !fault.empty()) return fault;
        if (Sentence fault = check_policies(m, row, to, r.activity[link.from.component], r.activity[link.to.component]); !fault.empty()) return fault;
        std::size_t rows_here = 0;
        std::size_t rows_there = 0;
        for (std::size_t j = 0; j < x; ++j) {
            if (r.connections[j].to == link.to) {
                if (r.connections[j].from == link.from) return of_connection(row, "stands in connections(...) twice; remove one");
                if (!row.buffered) return of_connection(row, "\"", row.to, "\" is written by \"", m.connections[j].from, "\" already; an input has one writer: remove one row, or use a buffer");
                ++rows_there;
            }
            if (row.buffered && r.connections[j].from == link.from) ++rows_here;
        }
        if (rows_here >= max_buffer_rows || rows_there >= max_buffer_rows) return of_connection(row, "is one more than the ", max_buffer_rows, " buffer rows a port may have; merge some");
    }
    for (std::size_t c = 0; c < m.components.size(); ++c)
        for (std::size_t f = 0; f < m.components[c].type->facets.size(); ++f) {
            const Facet& facet = m.components[c].type->facets[f];
            if (!facet.required || (facet.kind != FacetKind::input && facet.kind != FacetKind::buffer_input)) continue;
            bool connected = false;
            for (const auto& link : r.connections) connected |= link.to == End{c, f};
            if (!connected)
                return of_component(m.components[c].name, "its required input \"", facet.name, "\" is not connected; add ", facet.kind == FacetKind::input ? "data" : "buffer<n>", "(\"...\", \"", m.components[c].name, ".", facet.name, "\")");
        }
    return {};
}

/// Orders the components of each activity by data flow (thesis 3.2: the kernel's data-flow order). A delayed row turns
/// round: its reader runs before its writer, so that it sees the last cycle's value, always.
constexpr Sentence order_components(const MachineView& m, TableIndexView r) {
    for (auto& each : r.position) each = nowhere;
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        const auto& names = m.activities[a].runs;
        Bounded<std::size_t, ActivityRow::max_runs> members;
        Bounded<std::size_t, ActivityRow::max_runs> waits_for; // how many members must run before this one
        for (const auto& name : names) static_cast<void>(members.push(find_component(m, name))), static_cast<void>(waits_for.push(0));
        const auto place_of = [&members](std::size_t component) {
            for (std::size_t i = 0; i < members.size(); ++i)
                if (members[i] == component) return i;
            return nowhere;
        };
        const auto edge = [&m, &r, &place_of](std::size_t x, std::size_t& before, std::size_t& after) {
            before = place_of(m.connections[x].delayed_step ? r.connections[x].to.component : r.connections[x].from.component);
            after = place_of(m.connections[x].delayed_step ? r.connections[x].from.component : r.connections[x].to.component);
            return before != after && !m.connections[x].buffered;
        };
        const auto inside = [&r, a](std::size_t x) { return r.activity[r.connections[x].from.component] == a && r.activity[r.connections[x].to.component] == a; };
        std::size_t before = 0;
        std::size_t after = 0;
        for (std::size_t x = 0; x < m.connections.size(); ++x) {
            if (!inside(x)) continue;
            if (r.connections[x].from.component == r.connections[x].to.component && !m.connections[x].delayed_step && !m.connections[x].buffered)
                return of_connection(m.connections[x], "is a component's own output; add delayed, or keep the value in the component");
            if (edge(x, before, after)) ++waits_for[after];
        }
        for (std::size_t placed = 0; placed < members.size(); ++placed) {
            std::size_t next = nowhere;
            for (std::size_t i = 0; i < members.size() && next == nowhere; ++i)
                if (r.position[members[i]] == nowhere && waits_for[i] == 0) next = i;
            if (next == nowhere) {
                for (std::size_t x = 0; x < m.connections.size(); ++x)
                    if (inside(x) && edge(x, before, after) && r.position[members[before]] == nowhere && r.position[members[after]] == nowhere)
                        return of_connection(m.connections[x], "closes a data-flow cycle inside activity \"", m.activities[a].name, "\"; add delayed to the row whose reader shall see the last cycle's value");
            }
            r.position[members[next]] = placed;
            for (std::size_t x = 0; x < m.connections.size(); ++x)
                if (inside(x) && edge(x, before, after) && before == next) --waits_for[after];
        }
    }
    return {};
}

} // namespace tappet::checks
