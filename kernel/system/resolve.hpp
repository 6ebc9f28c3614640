// Resolves the ends of crossings: finds them by name and checks their kind, type and unit, or returns a
// sentence that states the fault and its cure.
#pragma once

#include "kernel/machine/check/flow.hpp"
#include "kernel/system/encoding.hpp"

namespace tappet {

constexpr std::size_t find_node(const SystemView& s, std::string_view name) noexcept {
    for (std::size_t n = 0; n < s.nodes.size(); ++n)
        if (s.nodes[n].name == name) return n;
    return nowhere;
}

/// One end of a row: its node, and its place in the node's table.
struct NodeEnd {
    std::size_t node = nowhere;
    End at{};
    const Facet* facet = nullptr;
};

/// The compiler's data of a crossing.
struct CrossingIndex {
    NodeEnd from{}, to{}; ///< of presence: `from` is only the node
    NodeEnd if_lost{};
    WireValue value{};        ///< of data: the value; of the others: their arguments
    WireValue result{};       ///< of commands
    std::uint16_t name = 0;   ///< the number of the row for both ends
    std::uint16_t layout = 0; ///< digest of its layout on the wire: another version's may differ
};

namespace systems {

/// Returns "node.component.facet" without its node.
constexpr std::string_view in_node(std::string_view path) noexcept {
    return path.substr(std::min(path.size(), find_character(path, '.') + 1));
}

constexpr Sentence resolve_node(const SystemView& s, std::string_view path, std::size_t& node) {
    const std::size_t dot = find_character(path, '.');
    const std::string_view name = path.substr(0, dot);
    node = find_node(s, name);
    if (node != nowhere && dot != std::string_view::npos) return {};
    if (node != nowhere)
        return Sentence{"\"", path, "\" is not of the form \"node.component.facet\"; name all three"};
    Nearest nearest{name};
    for (const SystemNode& row : s.nodes) nearest.consider(row.name);
    Sentence text{"there is no node \"", name, "\""};
    tappet::detail::add_suggestion(text, nearest, "add it to nodes(...)");
    return text;
}

constexpr Sentence resolve_end(const SystemView& s, std::string_view path, FacetKind wanted, NodeEnd& end) {
    if (Sentence fault = resolve_node(s, path, end.node); !fault.empty()) return fault;
    const MachineView& table = s.nodes[end.node].table;
    if (Sentence fault = tappet::resolve(table, in_node(path), wanted, end.at); !fault.empty())
        return Sentence{"in node \"", s.nodes[end.node].name, "\" ", fault};
    end.facet = &facet_at(table, end.at);
    return {};
}

template <class... Pieces>
constexpr Sentence of_crossing(const Crossing& row, const Pieces&... fault) {
    if (row.kind == CrossingKind::presence)
        return Sentence{"presence of \"", row.node, "\" -> \"", row.to(), "\"", fault...};
    return Sentence{"crossing \"", row.from(), "\" -> \"", row.to(), "\"", fault...};
}

constexpr Sentence resolve_data(const SystemView& s, const Crossing& row, CrossingIndex& found) {
    if (row.data.buffered)
        return Sentence{": a buffer does not cross a wire: emit an event for each value, which crosses with "
                        "when(\"...\", tell(\"...\")), or send the last one by data(...)"};
    if (Sentence fault = resolve_end(s, row.data.from, FacetKind::output, found.from); !fault.empty())
        return Sentence{": ", fault};
    if (Sentence fault = resolve_end(s, row.data.to, FacetKind::input, found.to); !fault.empty())
        return Sentence{": ", fault};
    if (Sentence fault = checks::check_direction(row.data, *found.from.facet, *found.to.facet);
        !fault.empty())
        return Sentence{": ", fault};
    if (row.every <= Duration::zero()) return Sentence{" does not say how often it is sent; add every(10ms)"};
    if (row.at_most_per != Duration::zero())
        return Sentence{" is sent every(...); at_most(...) is for events and commands, remove it"};
    if (row.with_time) {
        if (!s.wire.has_clock())
            return Sentence{" is sent with_time, but wire \"", s.wire.name,
                            "\" has no common time; add common_clock(\"node\", every(100ms), within(200us))"};
        const Duration oldest = oldest_told - row.every - longest_under_way;
        if (row.data.max_age <= Duration::zero() || row.data.max_age > oldest)
            return Sentence{" is sent with_time, which holds for ", oldest.count() / 1'000'000,
                            " ms; write stale_after(...) of at most that"};
    }
    Sentence fault;
    found.value = wire_value(found.from.facet->type, row.encoding, fault);
    found.value.has_time = row.with_time;
    return fault.empty() ? fault : Sentence{": ", fault};
}

constexpr Sentence check_pace(const Crossing& row) {
    if (row.with_time) return Sentence{" is sent when it happens; with_time is for data, remove it"};
    if (row.every > Duration::zero())
        return Sentence{" is sent when it happens; every(...) is for data, remove it"};
    if (row.at_most_per <= Duration::zero())
        return Sentence{" does not say how often it may happen; add at_most(1, 100ms)"};
    if (row.at_most_n != 1)
        return Sentence{" says at_most(", row.at_most_n,
                        ", ...): one is under way at a time; write at_most(1, ...) with the least time "
                        "between two"};
    if (row.within <= Duration::zero())
        return Sentence{" does not say by when it must be served; add within(20ms)"};
    if (row.at_most_per < row.within)
        return Sentence{" may follow after ", row.at_most_per.count() / 1000,
                        " us, while the one before it may "
                        "still be under way for ",
                        row.within.count() / 1000, " us; write within(...) no longer than at_most(1, ...)"};
    return {};
}

constexpr Sentence resolve_event(const SystemView& s, const Crossing& row, CrossingIndex& found) {
    if (row.reaction.target.synchronous)
        return Sentence{": call(...) runs in the emitter, which is another machine's; write tell(...)"};
    if (!row.reaction.handle.empty() || !row.reaction.is_connected)
        return Sentence{
            ": handles do not cross a wire; disconnect it behind the wire, or ask in the operation"};
    if (Sentence fault = resolve_end(s, row.from(), FacetKind::event, found.from); !fault.empty())
        return Sentence{": ", fault};
    if (Sentence fault = resolve_end(s, row.to(), FacetKind::operation, found.to); !fault.empty())
        return Sentence{": ", fault};
    if (found.from.facet->kind != FacetKind::event)
        return Sentence{": \"", row.from(), "\" is ", to_text(found.from.facet->kind), ", not an event"};
    if (found.to.facet->kind != FacetKind::operation)
        return Sentence{": \"", row.to(), "\" is ", to_text(found.to.facet->kind), ", not an operation"};
    if (found.from.facet->type != found.to.facet->type)
        return Sentence{": the event has the arguments (", found.from.facet->type->name, "), the operation (",
                        found.to.facet->type->name, "); give both the same"};
    if (row.if_lost.empty()) return {};
    if (Sentence fault = resolve_end(s, row.if_lost, FacetKind::operation, found.if_lost); !fault.empty())
        return Sentence{": ", fault};
    if (found.if_lost.node != found.from.node || found.if_lost.facet->kind != FacetKind::operation ||
        found.if_lost.facet->type != type_id<Arguments<>>)
        return Sentence{": if_lost(\"", row.if_lost,
                        "\") names no operation without arguments of the emitter's node; name one"};
    return {};
}

constexpr Sentence resolve_command(const SystemView& s, const Crossing& row, CrossingIndex& found) {
    if (Sentence fault = resolve_end(s, row.from(), FacetKind::command_call, found.from); !fault.empty())
        return Sentence{": ", fault};
    if (found.from.facet->kind == FacetKind::method_call)
        return Sentence{": a method would block its caller until the wire has answered; make it a command"};
    if (Sentence fault = resolve_end(s, row.to(), FacetKind::command, found.to); !fault.empty())
        return Sentence{": ", fault};
    if (found.from.facet->kind != FacetKind::command_call)
        return Sentence{": \"", row.from(), "\" is ", to_text(found.from.facet->kind),
                        ", not a command call"};
    if (found.to.facet->kind != FacetKind::command)
        return Sentence{": \"", row.to(), "\" is ", to_text(found.to.facet->kind), ", not a command"};
    if (found.from.facet->type != found.to.facet->type)
        return Sentence{": the call is of the signature (", found.from.facet->type->name, "), the command (",
                        found.to.facet->type->name, "); give both the same"};
    return {};
}

constexpr Sentence resolve_presence(const SystemView& s, const Crossing& row, CrossingIndex& found) {
    found.from.node = find_node(s, row.node);
    if (found.from.node == nowhere)
        return Sentence{": there is no node \"", row.node, "\"; add it to nodes(...)"};
    if (Sentence fault = resolve_end(s, row.to(), FacetKind::input, found.to); !fault.empty())
        return Sentence{": ", fault};
    if (found.to.facet->kind != FacetKind::input || found.to.facet->type != type_id<bool>)
        return Sentence{": \"", row.to(), "\" is not an input of type bool; name one"};
    if (row.data.max_age != Duration::zero())
        return Sentence{" has stale_after(...), but it becomes false instead of stale; remove that"};
    return {};
}

/// Encodes arguments and results.
constexpr Sentence wire_values(const Crossing& row, CrossingIndex& found) {
    Sentence fault;
    if (row.kind == CrossingKind::event) {
        found.value = wire_value(found.from.facet->type, row.encoding, fault);
        return fault;
    }
    const CommandOperations& command = *found.to.facet->command;
    found.value = wire_value(command.arguments, row.encoding, fault);
    const bool is_number = command.results->elements.size() == 1 && command.results->elements[0]->arithmetic;
    if (fault.empty())
        found.result = wire_value(command.results, is_number ? row.encoding : Encoding{}, fault);
    return fault;
}

constexpr Sentence resolve_crossing(const SystemView& s, const Crossing& row, CrossingIndex& found) {
    Sentence fault;
    switch (row.kind) {
    case CrossingKind::data: fault = resolve_data(s, row, found); break;
    case CrossingKind::presence: fault = resolve_presence(s, row, found); break;
    case CrossingKind::event:
    case CrossingKind::command:
        fault =
            row.kind == CrossingKind::event ? resolve_event(s, row, found) : resolve_command(s, row, found);
        if (fault.empty()) fault = check_pace(row);
        if (fault.empty()) {
            fault = wire_values(row, found);
            if (!fault.empty()) fault = Sentence{": ", fault};
        }
        break;
    }
    if (fault.empty() && found.from.node == found.to.node)
        fault = Sentence{" has both ends in node \"", s.nodes[found.to.node].name,
                         "\"; write it into that machine's own table"};
    return fault.empty() ? fault : of_crossing(row, fault);
}

constexpr Sentence check_nodes(const SystemView& s) {
    if (s.nodes.size() < 2) return Sentence{"a system has two nodes at least; add node<table>(\"name\")"};
    for (std::size_t n = 0; n < s.nodes.size(); ++n) {
        const std::string_view name = s.nodes[n].name;
        if (name.empty() || find_character(name, '.') != std::string_view::npos)
            return Sentence{"node \"", name, "\": a node's name is not empty and has no dot; rename it"};
        if (find_node(s, name) != n) return Sentence{"node \"", name, "\" appears twice; rename one of them"};
    }
    if (s.wire.name.empty()) return Sentence{"the wire has no name; write wire(\"name\", ...)"};
    for (const SystemNode& row : s.nodes)
        if (find_component(row.table, s.wire.name) != nowhere)
            return Sentence{"node \"", row.name, "\" has a component \"", s.wire.name,
                            "\", which is the wire's name; rename one of them"};
    if (!s.wire.foreign.empty())
        return Sentence{"wire \"", s.wire.name, "\": ", s.wire.foreign,
                        "(...) does not apply to a wire; remove it"};
    if (s.wire.rate.bits_per_second == 0)
        return Sentence{"wire \"", s.wire.name, "\" has no bit rate; add bit_rate(500'000)"};
    if (s.wire.is_fd() && s.wire.rate.in_data_phase < s.wire.rate.bits_per_second)
        return Sentence{"wire \"",
                        s.wire.name,
                        "\" has ",
                        s.wire.rate.in_data_phase,
                        " bit/s in the data phase, less than its ",
                        s.wire.rate.bits_per_second,
                        "; write the faster one behind the other"};
    if (s.wire.fixed_identifiers && s.wire.states_first)
        return Sentence{"wire \"", s.wire.name,
                        "\" has both identifiers_from(...) and fixed_identifiers; remove one of them"};
    if (const CommonClock& clock = s.wire.clock; s.wire.has_clock()) {
        if (clock.told > 1)
            return Sentence{"wire \"", s.wire.name, "\" has ", clock.told,
                            " common_clock(...); one node sends the time, remove the others"};
        if (find_node(s, clock.node) == nowhere)
            return Sentence{"common_clock(\"", clock.node,
                            "\"): there is no such node; name one of nodes(...)"};
        if (clock.every < 10ms || clock.every > 10s)
            return Sentence{"common_clock(\"", clock.node, "\") is sent every ",
                            clock.every.count() / 1'000'000, " ms; write every(...) from 10 ms to 10 s"};
        if (const Duration least = 8 * (s.wire.service.deadline + 1ms); clock.every < least)
            return Sentence{"common_clock(\"",
                            clock.node,
                            "\") is sent every ",
                            clock.every.count() / 1'000'000,
                            " ms, of which a quarter must do for a frame and served_within(...) twice; write "
                            "every(...) of ",
                            least.count() / 1'000'000,
                            " ms at least, or serve the wire sooner"};
        if (clock.stamps_late <= Duration::zero() || !(clock.drift >= 0 && clock.drift <= 1e-2))
            return Sentence{
                "common_clock(\"", clock.node,
                "\"): stamps_late(...) must be above 0 and drift(...) from 0 to 1e-2; correct them"};
        if (clock.within <= Duration::zero())
            return Sentence{"common_clock(\"", clock.node, "\") has no permitted error; add within(200us)"};
    }
    if (s.wire.beats <= Duration::zero() || s.wire.silent_after < 2 * s.wire.beats)
        return Sentence{"wire \"",
                        s.wire.name,
                        "\": a node is silent after ",
                        s.wire.silent_after.count() / 1000,
                        " us, but must survive one lost beat, and beats come every ",
                        s.wire.beats.count() / 1000,
                        " us; write silent_after(...) of more than twice that"};
    return {};
}

} // namespace systems

} // namespace tappet
