// Checks of the section reactions: events and operations exist and fit; a synchronous call stays inside its
// activity or is declared safe.
#pragma once

#include "kernel/machine/check/events.hpp"

namespace tappet::checks {

/// A limit that keeps the mailbox of all rows from one activity to another within 32 bits.
inline constexpr std::uint32_t most_waiting = 1 << 16;

/// Checks a row; fills its ends.
constexpr Sentence check_reaction(const MachineView& m, TableIndexView r, std::size_t i) {
    const ReactionRow& row = m.reactions[i];
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
        return of_reaction(row,
                           ": queue(0) has no room for an emission; write queue(n) with n of at least 1");
    if (row.target.quota > most_waiting)
        return of_reaction(row, ": queue(", row.target.quota, ") is larger than the limit of ", most_waiting,
                           "; write a smaller queue(n)");
    for (std::size_t j = r.reactions_into.first[link.to.component]; j != nowhere;
         j = r.reactions_into.next[j])
        if (r.reactions[j].from == link.from && r.reactions[j].to == link.to)
            return of_reaction(row, " appears twice in reactions(...), rows ", j + 1, " and ", i + 1,
                               "; remove one");
    r.reactions_into.add(i, link.to.component);
    return {};
}

constexpr Sentence check_required_operations(const MachineView& m, const TableIndexView& r) {
    const auto must_be_named = [](const Facet& facet) {
        return facet.required && facet.kind == FacetKind::operation;
    };
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        if (!has_facet(m.components[c].type, must_be_named)) continue;
        for (std::size_t f = 0; f < m.components[c].type->facets.size(); ++f) {
            const Facet& facet = m.components[c].type->facets[f];
            if (!must_be_named(facet)) continue;
            bool named = false;
            for (std::size_t i = r.reactions_into.first[c]; i != nowhere && !named;
                 i = r.reactions_into.next[i])
                named = r.reactions[i].to.facet == f;
            if (!named)
                return of_component(m.components[c].name, ": no reaction names its required operation \"",
                                    facet.name, "\"; add when(\"...\", tell(\"", m.components[c].name, ".",
                                    facet.name, "\"))");
        }
    }
    return {};
}

constexpr Sentence check_reactions(const MachineView& m, TableIndexView r) {
    r.reactions_into.clear();
    for (std::size_t i = 0; i < m.reactions.size(); ++i)
        if (m.reactions[i].kind == ReactionKind::when)
            if (Sentence fault = check_reaction(m, r, i); !fault.empty()) return fault;
    if (Sentence fault = check_required_operations(m, r); !fault.empty()) return fault;
    if (Sentence fault = check_heard_events(m, r); !fault.empty()) return fault;
    return check_handles_and_waits(m, r);
}

} // namespace tappet::checks
