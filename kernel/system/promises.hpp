// Promises of the whole system, proven hop by hop: each machine's own check proves the deadlines of its
// activities, the wire's analysis bounds each frame, and a chain takes no longer than all of them together
// (Tindell and Clark 1994; for sampled values Davare et al. 2007).
#pragma once

#include "kernel/system/plan.hpp"

namespace tappet {

/// The worst time of a chain, and its largest part.
struct ChainTime {
    Sentence fault{}; ///< set when there is no such chain
    Duration worst{};
    Sentence largest{};
    Duration largest_part{};

    constexpr void add(Duration part, const Sentence& what) {
        worst += part;
        if (part <= largest_part) return;
        largest_part = part;
        largest = what;
    }
};

namespace systems {

constexpr Sentence at_node(const SystemView& s, std::string_view what, std::size_t node) {
    return Sentence{what, " at node \"", s.nodes[node].name, "\""};
}

/// Adds the activity at the far end of a hop, and how long the chain may wait for it.
constexpr void add_reader(const SystemView& s, const NodeEnd& end, ChainTime& time) {
    const MachineView& table = s.nodes[end.node].table;
    const std::size_t a = activity_of(table, table.components[end.at.component].name);
    if (a == nowhere) return; // the machine's own check reports it
    const ActivityRow& row = table.activities[a];
    if (row.periodic()) // nothing wakes it in between: a message, too, waits for its next period
        time.add(row.period,
                 at_node(s, Sentence{"the period of activity \"", row.name, "\""}.view(), end.node));
    time.add(row.deadline(),
             at_node(s, Sentence{"the deadline of activity \"", row.name, "\""}.view(), end.node));
}

template <class Plan>
constexpr void add_crossing(const SystemView& s, const Plan& plan, std::size_t x, ChainTime& time) {
    const Crossing& row = s.crossings[x];
    const WireFrame& frame = plan.frames[plan.place[x].frame];
    if (row.kind == CrossingKind::data) time.add(row.every, of_crossing(row, ": its every(...)"));
    time.add(frame.worst, of_crossing(row, ": its frame on the wire"));
    time.add(s.wire.service.deadline,
             at_node(s, "the deadline by which the wire is served", plan.index[x].to.node));
    add_reader(s, plan.index[x].to, time);
}

/// Adds one hop, over the wire or inside a node. False: no row leads from the one end to the other.
template <class Plan>
constexpr bool add_hop(const SystemView& s, const Plan& plan, std::string_view from, std::string_view to,
                       ChainTime& time) {
    for (std::size_t x = 0; x < s.crossings.size(); ++x)
        if (s.crossings[x].kind != CrossingKind::presence && s.crossings[x].from() == from &&
            s.crossings[x].to() == to)
            return add_crossing(s, plan, x, time), true;
    std::size_t node = nowhere, other = nowhere;
    if (!resolve_node(s, from, node).empty() || !resolve_node(s, to, other).empty() || node != other)
        return false;
    const MachineView& table = s.nodes[node].table;
    NodeEnd end{.node = node};
    for (const ReactionRow& row : table.reactions) {
        if (row.event != in_node(from) || row.target.operation != in_node(to)) continue;
        if (row.target.synchronous) return true; // in the emitter's own time
        static_cast<void>(resolve_end(s, to, FacetKind::operation, end));
        return add_reader(s, end, time), true;
    }
    for (const ConnectionRow& row : table.connections) {
        if (row.from != in_node(from) || row.to != in_node(to)) continue;
        static_cast<void>(resolve_end(s, to, FacetKind::input, end));
        return add_reader(s, end, time), true;
    }
    return false;
}

/// Adds the time between an input of a component and its reaction: an event follows in the same cycle, an
/// output in the next one, since operations are served after its step.
constexpr Sentence pass_through(const SystemView& s, std::string_view in, std::string_view out,
                                ChainTime& time) {
    NodeEnd from, to;
    const auto facet_of = [&](std::string_view path, NodeEnd& end) {
        if (!resolve_node(s, path, end.node).empty()) return false;
        for (const FacetKind kind :
             {FacetKind::input, FacetKind::operation, FacetKind::event, FacetKind::output})
            if (resolve_end(s, path, kind, end).empty()) return true;
        return false;
    };
    if (!facet_of(in, from) || !facet_of(out, to) || from.node != to.node ||
        from.at.component != to.at.component)
        return Sentence{"via(\"", in, "\", \"", out,
                        "\") does not name two facets of one component of one node"};
    const MachineView& table = s.nodes[to.node].table;
    const std::size_t a = activity_of(table, table.components[to.at.component].name);
    if (a != nowhere && from.facet->kind == FacetKind::operation && to.facet->kind == FacetKind::output)
        time.add(table.activities[a].shortest_period() + table.activities[a].deadline(),
                 at_node(s, Sentence{"the next cycle of activity \"", table.activities[a].name, "\""}.view(),
                         to.node));
    return {};
}

template <class Plan>
constexpr ChainTime prove_reaction(const SystemView& s, const Plan& plan, const PromiseRow& row) {
    ChainTime time;
    std::string_view at = row.from;
    for (std::size_t i = 0; i <= row.via.size(); i += 2) {
        const std::string_view next = i < row.via.size() ? row.via[i] : row.to;
        if (!add_hop(s, plan, at, next, time)) {
            time.fault = Sentence{"no row leads from \"", at, "\" to \"", next,
                                  "\"; add it, or name what lies between with via(\"in\", \"out\")"};
            return time;
        }
        if (i >= row.via.size()) break;
        if (Sentence fault = pass_through(s, row.via[i], row.via[i + 1], time); !fault.empty()) {
            time.fault = fault;
            return time;
        }
        at = row.via[i + 1];
    }
    return time;
}

/// Proves a stop: from the last sign of life of a node until an input elsewhere shows that it is gone.
template <class Plan>
constexpr ChainTime prove_stop(const SystemView& s, const Plan& plan, const PromiseRow& row) {
    ChainTime time;
    const std::size_t node = find_node(s, row.node);
    for (std::size_t x = 0; x < s.crossings.size(); ++x) {
        const Crossing& crossing = s.crossings[x];
        if (crossing.to() != row.to || plan.index[x].from.node != node || node == nowhere) continue;
        Duration on_wire{};
        for (const WireFrame& frame : plan.frames)
            if (frame.node == node &&
                (crossing.kind == CrossingKind::presence ? frame.kind == WireFrameKind::beat
                                                         : &frame == &plan.frames[plan.place[x].frame]))
                on_wire = frame.worst;
        const bool is_presence = crossing.kind == CrossingKind::presence;
        if (!is_presence && crossing.data.max_age == Duration::zero()) {
            time.fault = of_crossing(crossing, " has no maximum age; add stale_after(...)");
            return time;
        }
        time.add(on_wire, of_crossing(crossing, ": the last frame on the wire"));
        time.add(is_presence ? s.wire.silent_after : crossing.data.max_age,
                 is_presence ? Sentence{"the wire's silent_after(...)"}
                             : of_crossing(crossing, ": its stale_after(...)"));
        // The wire's end at that node detects silence; the reader itself sees that a value is old.
        if (is_presence)
            time.add(s.wire.service.deadline,
                     at_node(s, "the deadline by which the wire is served", plan.index[x].to.node));
        add_reader(s, plan.index[x].to, time);
        return time;
    }
    time.fault = Sentence{"nothing of node \"",
                          row.node,
                          "\" reaches \"",
                          row.to,
                          "\"; add presence(\"",
                          row.node,
                          "\", \"",
                          row.to,
                          "\")"};
    return time;
}

/// Returns the fault of the first promise that does not hold; `proven` has a place for each.
template <class Plan>
constexpr Sentence check_promises(const SystemView& s, const Plan& plan, std::span<Duration> proven) {
    for (std::size_t p = 0; p < s.promises.size(); ++p) {
        const PromiseRow& row = s.promises[p];
        const Sentence who = row.stops ? Sentence{"stops \"", row.node, "\" -> \"", row.to, "\""}
                                       : Sentence{"reaction \"", row.from, "\" -> \"", row.to, "\""};
        if (row.too_many) return Sentence{who, " has more than 4 via(...); name two reactions"};
        if (row.within <= Duration::zero()) return Sentence{who, " does not say by when; add within(...)"};
        const ChainTime time = row.stops ? prove_stop(s, plan, row) : prove_reaction(s, plan, row);
        if (!time.fault.empty()) return Sentence{who, ": ", time.fault};
        proven[p] = time.worst;
        if (time.worst > row.within)
            return Sentence{who,
                            " may take ",
                            time.worst.count() / 1000,
                            " us, but is promised within ",
                            row.within.count() / 1000,
                            " us; the largest part, ",
                            time.largest_part.count() / 1000,
                            " us, is ",
                            time.largest,
                            "; shorten that, or promise less"};
    }
    return {};
}

} // namespace systems

} // namespace tappet
