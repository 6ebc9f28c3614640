// Checks of the sections reactions and behaviours: events and operations exist and fit, a synchronous call
// stays inside its activity or is declared safe, a behaviour drives a component of its own type and hears
// events that exist.
#pragma once

#include "kernel/machine/check_events.hpp"
#include "kernel/statechart/check.hpp"

namespace tappet::checks {

template <class... Pieces> constexpr Sentence of_behaviour(const BehaviourRow& row, const Pieces&... fault) {
    return Sentence{row.is_slot() ? "slot of \"" : "behaviour of \"", row.component, "\"", fault...};
}

/// Fills the ends of each reaction.
constexpr Sentence check_reactions(const MachineView& m, TableIndexView r) {
    r.reactions_into.clear();
    for (std::size_t i = 0; i < m.reactions.size(); ++i) {
        const ReactionRow& row = m.reactions[i];
        if (row.kind != ReactionKind::when) continue;
        Link& link = r.reactions[i];
        if (Sentence fault = resolve(m, r.by_name, row.event, FacetKind::event, link.from); !fault.empty())
            return of_reaction(row, ": ", fault);
        if (Sentence fault = resolve(m, r.by_name, row.target.operation, FacetKind::operation, link.to);
            !fault.empty())
            return of_reaction(row, ": ", fault);
        const Facet& event = facet_at(m, link.from);
        const Facet& operation = facet_at(m, link.to);
        const bool waits = operation.kind == FacetKind::wait;
        if (event.kind == FacetKind::operation && operation.kind == FacetKind::event)
            return of_reaction(row, " runs from an operation to an event; exchange the two");
        if (event.kind != FacetKind::event)
            return of_reaction(row, ": \"", row.event, "\" is ", to_text(event.kind),
                               ", not an event; name an event first");
        if (operation.kind != FacetKind::operation && !waits)
            return of_reaction(row, ": \"", row.target.operation, "\" is ", to_text(operation.kind),
                               ", not an operation; name an operation second");
        if (event.type != operation.type)
            return of_reaction(row, ": the event carries (", event.type->name, ") but the ",
                               waits ? "wait" : "operation", " takes (", operation.type->name,
                               "); give both the same arguments");
        if (Sentence fault = waits ? check_wait(m, r, i) : Sentence{}; !fault.empty()) return fault;
        if (Sentence fault = check_handle(m, r, i); !fault.empty()) return fault;
        const std::size_t emitter = r.activity[link.from.component];
        const std::size_t receiver = r.activity[link.to.component];
        if (row.target.synchronous && emitter != receiver && !operation.any_thread)
            return of_reaction(row, ": a synchronous call would run \"", row.target.operation,
                               "\" of activity \"", m.activities[receiver].name, "\" in activity \"",
                               m.activities[emitter].name,
                               "\"; use tell(...), or declare the operation any_thread if it is safe there");
        if (row.target.synchronous && m.activities[emitter].real_time &&
            (m.components[link.to.component].type->work != nullptr ||
             m.components[link.to.component].type->loop != nullptr))
            return of_reaction(row, ": component \"", m.components[link.to.component].name,
                               "\" may block; use tell(...)");
        if (!row.target.synchronous && row.target.quota == 0)
            return of_reaction(row, ": no emission may wait; write queue(n) with n of at least 1");
        if (event.type->size > sizeof(Message::arguments) && !row.target.synchronous)
            return of_reaction(row, ": its ", event.type->size, " bytes of arguments exceed the ",
                               sizeof(Message::arguments), " bytes of a message; send them through a port");
        for (std::size_t j = r.reactions_into.first[link.to.component]; j != nowhere;
             j = r.reactions_into.next[j])
            if (r.reactions[j].from == link.from && r.reactions[j].to == link.to)
                return of_reaction(row, " stands in reactions(...) twice (rows ", j + 1, " and ", i + 1,
                                   "); remove one");
        r.reactions_into.add(i, link.to.component);
    }
    for (std::size_t c = 0; c < m.components.size(); ++c)
        for (std::size_t f = 0; f < m.components[c].type->facets.size(); ++f) {
            const Facet& facet = m.components[c].type->facets[f];
            if (!facet.required || facet.kind != FacetKind::operation) continue;
            bool named = false;
            for (std::size_t i = r.reactions_into.first[c]; i != nowhere && !named;
                 i = r.reactions_into.next[i])
                named = r.reactions[i].to.facet == f;
            if (!named)
                return of_component(m.components[c].name, ": no reaction names its required operation \"",
                                    facet.name, "\"; add when(\"...\", tell(\"", m.components[c].name, ".",
                                    facet.name, "\"))");
        }
    if (Sentence fault = check_heard_events(m, r); !fault.empty()) return fault;
    return check_handles_and_waits(m, r);
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

constexpr Sentence check_slot(const MachineView& m, const BehaviourRow& row) {
    const Slot& slot = row.slot;
    if (slot.nodes == 0 || slot.data_bytes == 0 || slot.depth == 0)
        return of_behaviour(row, " reserves no nodes, data or depth; state all three");
    for (const auto& peer : slot.peers)
        if (find_component(m, peer) == nowhere)
            return of_behaviour(row, ": among its peers, ", unknown_component(m, peer));
    End found;
    for (const auto& name : slot.operations) {
        if (Sentence fault = resolve(m, name, FacetKind::operation, found); !fault.empty())
            return of_behaviour(row, ": among its operations, ", fault);
        if (facet_at(m, found).kind != FacetKind::operation)
            return of_behaviour(row, ": among its operations, \"", name, "\" is ",
                                to_text(facet_at(m, found).kind), ", not an operation; name an operation");
    }
    for (const auto& name : slot.events) {
        if (Sentence fault = resolve(m, name, FacetKind::event, found); !fault.empty())
            return of_behaviour(row, ": among its events, ", fault);
        if (facet_at(m, found).kind != FacetKind::event)
            return of_behaviour(row, ": among its events, \"", name, "\" is ",
                                to_text(facet_at(m, found).kind), ", not an event; name an event");
    }
    return {};
}

constexpr Sentence check_behaviours(const MachineView& m) {
    for (std::size_t b = 0; b < m.behaviours.size(); ++b) {
        const BehaviourRow& row = m.behaviours[b];
        const std::size_t component = find_component(m, row.component);
        if (component == nowhere) return of_behaviour(row, ": ", unknown_component(m, row.component));
        for (std::size_t j = 0; j < b; ++j)
            if (m.behaviours[j].component == row.component && (m.behaviours[j].is_slot() == row.is_slot()))
                return of_behaviour(row, " stands in behaviours(...) twice; a component has one ",
                                    row.is_slot() ? "slot" : "behaviour", ": remove one");
        if (row.is_slot()) {
            if (Sentence fault = check_slot(m, row); !fault.empty()) return fault;
            continue;
        }
        if (row.machine.component != m.components[component].type->tag)
            return of_behaviour(row, ": state machine \"", row.machine.name, "\" is written for ",
                                row.machine.component->name, " but \"", row.component, "\" is a ",
                                m.components[component].type->tag->name, "; name a component of its type");
        if (Sentence fault = check(row.machine); !fault.empty()) return of_behaviour(row, ": ", fault);
        for (std::size_t t = 0; t < row.machine.transitions.size(); ++t) {
            const TransitionRow& transition = row.machine.transitions[t];
            if (!transition.on_event) continue;
            End found;
            if (Sentence fault = resolve_trigger(m, row, transition.event, found); !fault.empty())
                return of_behaviour(row, ": state machine \"", row.machine.name, "\": transition ", t + 1,
                                    " (\"", transition.from, "\" to \"", transition.to, "\" on \"",
                                    transition.event, "\"): ", fault);
        }
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
            driven |= behaviour.component == row.name && !behaviour.is_slot();
        if (!driven)
            return of_component(row.name, ": no behaviour drives it; add behaviour(\"", row.name,
                                "\", ...) to behaviours(...)");
    }
    return {};
}

} // namespace tappet::checks
