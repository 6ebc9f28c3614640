// Checks of the section behaviours: a behaviour drives a component of its own type, hears existing events,
// and uses only what is safe in another activity; a slot reserves existing names.
#pragma once

#include "kernel/machine/check/events.hpp"
#include "kernel/machine/check/operations.hpp"
#include "kernel/machine/table/unit_rows.hpp"
#include "kernel/statechart/check.hpp"

#include <algorithm>

namespace tappet::checks {

template <class... Pieces> constexpr Sentence of_behaviour(const BehaviourRow& row, const Pieces&... fault) {
    return Sentence{row.is_slot() ? "slot of \"" : "behaviour of \"", row.component, "\"", fault...};
}

/// "component.event", or "event" of the behaviour's own component.
constexpr Sentence resolve_trigger(const MachineView& m, const BehaviourRow& row, std::string_view name,
                                   End& found) {
    if (name.find('.') == std::string_view::npos) {
        const std::size_t own = find_component(m, row.component);
        const std::size_t facet = find_facet(m.components[own], name);
        if (facet != nowhere && m.components[own].type->facets[facet].kind == FacetKind::event) {
            found = {own, facet};
            return {};
        }
        Nearest nearest{name};
        for (const auto& each : m.components[own].type->facets)
            if (each.kind == FacetKind::event) nearest.consider(each.name);
        Sentence text{"component \"", row.component, "\" has no event \"", name, "\""};
        detail::add_suggestion(text, nearest, "name it, or another component's as component.event");
        return text;
    }
    if (Sentence fault = resolve(m, name, FacetKind::event, found); !fault.empty()) return fault;
    if (facet_at(m, found).kind != FacetKind::event)
        return Sentence{"\"", name, "\" is ", to_text(facet_at(m, found).kind),
                        ", not an event; name an event in on(...)"};
    return {};
}

/// A limit that keeps every sum over a slot within 32 bits.
inline constexpr std::uint32_t most_in_slot = 1 << 24;

constexpr Sentence check_slot(const MachineView& m, const TableIndexView& r, const BehaviourRow& row) {
    const Slot& slot = row.slot;
    if (slot.nodes == 0 || slot.data_bytes == 0 || slot.depth == 0)
        return of_behaviour(row, " does not reserve all of nodes, data and depth; state all three");
    if (std::max({slot.nodes, slot.data_bytes, slot.depth, slot.command_slots, slot.timers,
                  slot.text_bytes}) > most_in_slot)
        return of_behaviour(row, " reserves more than ", most_in_slot,
                            " of one resource; write smaller numbers");
    for (const auto& peer : slot.peers)
        if (find_component(m, peer) == nowhere)
            return of_behaviour(row, ": peers(...): ", unknown_component(m, peer));
    End found;
    for (const auto& name : slot.operations) {
        if (Sentence fault = resolve(m, name, FacetKind::operation, found); !fault.empty())
            return of_behaviour(row, ": operations(...): ", fault);
        const FacetKind kind = facet_at(m, found).kind;
        if (kind != FacetKind::operation && kind != FacetKind::method && kind != FacetKind::command)
            return of_behaviour(row, ": operations(...): \"", name, "\" is ", to_text(kind),
                                ", not an operation; name an operation");
    }
    for (const auto& name : slot.events) {
        if (Sentence fault = resolve(m, name, FacetKind::event, found); !fault.empty())
            return of_behaviour(row, ": events(...): ", fault);
        const Facet& event = facet_at(m, found);
        if (event.kind != FacetKind::event)
            return of_behaviour(row, ": events(...): \"", name, "\" is ", to_text(event.kind),
                                ", not an event; name an event");
        if (event.type->size > most_trigger_bytes)
            return of_behaviour(row, ": events(...): \"", name, "\" has ", event.type->size,
                                " bytes of arguments, more than the ", most_trigger_bytes,
                                " that a state machine keeps; read its component's ports instead");
    }
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        if (!m.components[c].type->sees_machine || r.activity[c] == nowhere) continue;
        const ActivityRow& activity = m.activities[r.activity[c]];
        if (activity.stack_bytes() < compiling_stack_bytes)
            return of_behaviour(row, ": scripts are compiled in activity \"", activity.name,
                                "\", whose stack of ", activity.stack_bytes(), " bytes is under ",
                                compiling_stack_bytes, "; enlarge its stack(...)");
    }
    if (slot.angle.empty()) return {};
    if (Sentence fault = resolve(m, r.by_name, slot.angle, FacetKind::output, found); !fault.empty())
        return of_behaviour(row, ": angle_of(...): ", fault);
    if (facet_at(m, found).kind != FacetKind::output || facet_at(m, found).type != type_id<double>)
        return of_behaviour(row, ": angle_of(\"", slot.angle, "\") is ", to_text(facet_at(m, found).kind),
                            " of ", facet_at(m, found).type->name, "; name an output of double, in degrees");
    if (r.activity[found.component] != r.activity[find_component(m, row.component)])
        return of_behaviour(row, ": angle_of(\"", slot.angle,
                            "\") is written in another activity; name an output of activity \"",
                            m.activities[r.activity[find_component(m, row.component)]].name, "\"");
    return {};
}

/// Checks that each peer has the type for which the script was compiled, and runs in its activity where the
/// script requires that.
constexpr Sentence check_unit_reach(const MachineView& m, const TableIndexView& r, const BehaviourRow& row) {
    const ScriptUnit unit = row.unit();
    const std::size_t driven = find_component(m, row.component);
    for (std::size_t i = 0; i < unit.reach.size(); ++i) {
        const Reachable& peer = unit.reach[i];
        const std::size_t c = component_of(m, row.component, unit, i);
        if (c == nowhere)
            return of_behaviour(row, ": script \"", unit.name,
                                "\": its reach: ", unknown_component(m, peer.name));
        if (peer.type->tag != m.components[c].type->tag)
            return of_behaviour(row, ": script \"", unit.name, "\" was compiled for ", peer.type->tag->name,
                                " but \"", m.components[c].name, "\" is a ", m.components[c].type->tag->name,
                                "; give its reach that type");
        if (peer.same_activity && r.activity[c] != r.activity[driven])
            return of_behaviour(row, ": script \"", unit.name, "\" uses \"", peer.name,
                                "\" as a component of its own activity, but activity \"",
                                m.activities[r.activity[c]].name,
                                "\" runs it; compile it with a reach that says so, or run both in one "
                                "activity");
    }
    return {};
}

/// Checks that everything a unit's programs use is safe in the activity that runs them.
constexpr Sentence check_unit_links(const MachineView& m, const TableIndexView& r, const BehaviourRow& row) {
    const ScriptUnit unit = row.unit();
    const std::size_t here = r.activity[find_component(m, row.component)];
    for (const BehaviourType& type : unit.types)
        for (const LinkRow& link : type.tables.links) {
            const std::size_t c = component_of(m, row.component, unit, link.peer);
            if (link.facet == LinkRow::component_itself) continue;
            if (link.facet >= m.components[c].type->facets.size())
                return of_behaviour(row, ": script \"", unit.name, "\" names facet ", link.facet, " of \"",
                                    m.components[c].name, "\", which has fewer; compile the script again");
            const Facet& facet = m.components[c].type->facets[link.facet];
            if (r.activity[c] == here || facet.any_thread) continue;
            if (facet.kind == FacetKind::command && link.needs_slot) continue;
            return of_behaviour(row, ": script \"", unit.name, "\" uses \"", m.components[c].name, ".",
                                facet.name, "\" (", to_text(facet.kind), ") of activity \"",
                                m.activities[r.activity[c]].name,
                                "\"; send it a command, or declare the operation any_thread if it is safe "
                                "there");
        }
    return {};
}

constexpr Sentence check_unit(const MachineView& m, const TableIndexView& r, const BehaviourRow& row) {
    const ScriptUnit unit = row.unit();
    const std::size_t driven = find_component(m, row.component);
    if (unit.instances.empty())
        return of_behaviour(row, ": script \"", unit.name,
                            "\" has nothing to run; add a RootStateMachine or a program");
    if (Sentence fault = check_unit_reach(m, r, row); !fault.empty()) return fault;
    if (Sentence fault = check_unit_links(m, r, row); !fault.empty()) return fault;
    for (const BehaviourType& type : unit.types) {
        const StateMachineTable& machine = type.machine;
        const bool is_program = type.is_program() && !type.tables.nodes.empty();
        if (machine.component != nullptr && machine.component != m.components[driven].type->tag)
            return of_behaviour(row, is_program ? ": program \"" : ": state machine \"", machine.name,
                                "\" is written for ", machine.component->name, " but \"", row.component,
                                "\" is a ", m.components[driven].type->tag->name,
                                "; name a component of its type");
        if (is_program) continue;
        if (Sentence fault = check(machine); !fault.empty()) return of_behaviour(row, ": ", fault);
        for (std::size_t t = 0; t < machine.transitions.size(); ++t) {
            const TransitionRow& transition = machine.transitions[t];
            if (!transition.on_event) continue;
            End found;
            Sentence fault = resolve_trigger(m, row, transition.event, found);
            if (fault.empty() && facet_at(m, found).type->size > most_trigger_bytes)
                fault = Sentence{"its ", facet_at(m, found).type->size, " bytes of arguments exceed the ",
                                 most_trigger_bytes, " that a state machine keeps; send them through a port"};
            if (!fault.empty())
                return of_behaviour(row, ": state machine \"", machine.name, "\": transition ", t + 1, " (\"",
                                    transition.from, "\" to \"", transition.to, "\" on \"", transition.event,
                                    "\"): ", fault);
        }
    }
    if (events_of(unit).too_many)
        return of_behaviour(row, ": script \"", unit.name, "\" hears more than ", max_state_events,
                            " events; split it");
    return {};
}

/// Checks that a slot's initial script reaches no more than the slot does, so that it can be loaded again.
constexpr Sentence check_slot_reach(const BehaviourRow& row) {
    const ScriptUnit unit = row.unit();
    const auto misses = [&](std::string_view peer, std::string_view name, const auto& allowed) {
        for (const std::string_view each : allowed)
            if (name.empty() ? each == peer : is_named(each, peer, name)) return false;
        return true;
    };
    const auto fault = [&](std::string_view what, std::string_view peer, std::string_view name) {
        return of_behaviour(row, ": its first script \"", unit.name, "\" reaches \"", peer,
                            name.empty() ? "" : ".", name, "\", but loaded scripts cannot; add it to ", what,
                            "(...) of the slot");
    };
    for (std::size_t i = 1; i < unit.reach.size(); ++i)
        if (misses(unit.reach[i].name, {}, row.slot.peers)) return fault("peers", unit.reach[i].name, {});
    for (const BehaviourType& type : unit.types) {
        for (const LinkRow& link : type.tables.links) {
            if (link.peer == 0 || link.facet == LinkRow::component_itself) continue;
            const Reachable& peer = unit.reach[link.peer];
            const Facet& facet = peer.type->facets[link.facet];
            const bool is_told = facet.kind == FacetKind::operation || facet.kind == FacetKind::method ||
                                 facet.kind == FacetKind::command;
            if (is_told && misses(peer.name, facet.name, row.slot.operations))
                return fault("operations", peer.name, facet.name);
        }
        for (const TransitionRow& transition : type.machine.transitions) {
            const std::size_t dot = transition.event.find('.');
            if (!transition.on_event || dot == std::string_view::npos) continue;
            const std::string_view peer = transition.event.substr(0, dot);
            const std::string_view event = transition.event.substr(dot + 1);
            if (peer != row.component && misses(peer, event, row.slot.events))
                return fault("events", peer, event);
        }
    }
    return {};
}

constexpr Sentence check_behaviours(const MachineView& m, const TableIndexView& r) {
    for (std::size_t b = 0; b < m.behaviours.size(); ++b) {
        const BehaviourRow& row = m.behaviours[b];
        if (find_component(m, row.component) == nowhere)
            return of_behaviour(row, ": ", unknown_component(m, row.component));
        for (std::size_t j = 0; j < b; ++j)
            if (m.behaviours[j].component == row.component && (m.behaviours[j].is_slot() == row.is_slot()))
                return of_behaviour(row, " appears twice in behaviours(...); a component has one ",
                                    row.is_slot() ? "slot" : "behaviour", ": remove one");
        if (row.is_slot())
            if (Sentence fault = check_slot(m, r, row); !fault.empty()) return fault;
        if (row.is_slot() && !row.is_driven()) continue;
        if (Sentence fault = check_unit(m, r, row); !fault.empty()) return fault;
        if (row.is_slot())
            if (Sentence fault = check_slot_reach(row); !fault.empty()) return fault;
    }
    for (const auto& row : m.components) {
        if (row.type->slot_required) {
            bool reserved = false;
            for (const auto& behaviour : m.behaviours)
                reserved |= behaviour.component == row.name && behaviour.is_slot();
            if (!reserved)
                return of_component(row.name, ": no slot is reserved for it; add behaviour(\"", row.name,
                                    "\", slot(...)) to behaviours(...)");
        }
        if (!row.type->behaviour_required) continue;
        bool driven = false;
        for (const auto& behaviour : m.behaviours)
            driven |= behaviour.component == row.name && behaviour.is_driven();
        if (!driven)
            return of_component(row.name, ": no behaviour drives it; add behaviour(\"", row.name,
                                "\", ...) to behaviours(...)");
    }
    return {};
}

} // namespace tappet::checks
