// Checks of events beyond their two ends: required listeners exist, and every handle and every wait is used
// by a row.
#pragma once

#include "kernel/component/event.hpp"
#include "kernel/machine/check/components.hpp"

namespace tappet::checks {

template <class... Pieces>
constexpr Sentence of_reaction(const ReactionRow& row, const Pieces&... fault) {
    return Sentence{"reaction \"", row.event, "\" -> \"", row.target.operation, "\"", fault...};
}

/// Checks that each event that must be heard has enough rows that nobody can disconnect.
constexpr Sentence check_heard_events(const MachineView& m, const TableIndexView& r) {
    const auto must_be_heard = [](const Facet& facet) { return facet.least_reactions != 0; };
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        if (!has_facet(m.components[c].type, must_be_heard)) continue;
        for (std::size_t f = 0; f < m.components[c].type->facets.size(); ++f) {
            const Facet& facet = m.components[c].type->facets[f];
            if (facet.least_reactions == 0) continue;
            std::size_t heard = 0;
            for (std::size_t i = 0; i < m.reactions.size(); ++i)
                heard += r.reactions[i].from == End{c, f} && m.reactions[i].handle.empty() ? 1u : 0u;
            if (heard < facet.least_reactions)
                return of_component(m.components[c].name, ": its event \"", facet.name, "\" has ", heard,
                                    " reactions but needs at least ", std::size_t{facet.least_reactions},
                                    "; add when(\"", m.components[c].name, ".", facet.name,
                                    "\", ...) to reactions(...)");
        }
    }
    return {};
}

/// Checks the handle of row `i`, if it names one.
constexpr Sentence check_handle(const MachineView& m, const TableIndexView& r, std::size_t i) {
    const ReactionRow& row = m.reactions[i];
    if (row.handle.empty())
        return row.is_connected ? Sentence{}
                                : of_reaction(row, " starts disconnected and nothing can connect it; add "
                                                   "handled_by(\"component.handle\")");
    End handle;
    if (Sentence fault = resolve(m, r.by_name, row.handle, FacetKind::handle, handle); !fault.empty())
        return of_reaction(row, ": ", fault);
    if (facet_at(m, handle).kind != FacetKind::handle)
        return of_reaction(row, ": \"", row.handle, "\" is ", to_text(facet_at(m, handle).kind),
                           "; name a handle in handled_by(...)");
    for (std::size_t j = 0; j < i; ++j)
        if (m.reactions[j].handle == row.handle)
            return of_reaction(row, ": its handle \"", row.handle, "\" is already used by reaction \"",
                               m.reactions[j].event, "\" -> \"", m.reactions[j].target.operation,
                               "\"; give each row its own handle");
    return {};
}

/// Checks that no other row tells the EventWait that is the target of row `i`.
constexpr Sentence check_wait(const MachineView& m, const TableIndexView& r, std::size_t i) {
    const ReactionRow& row = m.reactions[i];
    if (row.target.synchronous)
        return of_reaction(row, ": \"", row.target.operation, "\" waits for an event; use tell(...)");
    for (std::size_t j = 0; j < i; ++j)
        if (m.reactions[j].kind == ReactionKind::when && r.reactions[j].to == r.reactions[i].to)
            return of_reaction(row, ": reaction \"", m.reactions[j].event, "\" tells \"",
                               row.target.operation, "\" too; give each row a wait of its own");
    return {};
}

/// Checks that a row names every handle and every wait that is not optional.
constexpr Sentence check_handles_and_waits(const MachineView& m, const TableIndexView& r) {
    const auto must_be_named = [](const Facet& facet) {
        return facet.required && (facet.kind == FacetKind::handle || facet.kind == FacetKind::wait);
    };
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        if (!has_facet(m.components[c].type, must_be_named)) continue;
        for (std::size_t f = 0; f < m.components[c].type->facets.size(); ++f) {
            const Facet& facet = m.components[c].type->facets[f];
            if (!must_be_named(facet)) continue;
            const std::string_view component = m.components[c].name;
            bool named = false;
            for (std::size_t i = 0; i < m.reactions.size() && !named; ++i)
                named = facet.kind == FacetKind::wait
                            ? r.reactions[i].to == End{c, f}
                            : is_named(m.reactions[i].handle, component, facet.name);
            if (named) continue;
            if (facet.kind == FacetKind::wait)
                return of_component(component, ": no reaction tells its wait \"", facet.name,
                                    "\"; add when(\"...\", tell(\"", component, ".", facet.name, "\"))");
            return of_component(component, ": no reaction is handled by its \"", facet.name,
                                "\"; add handled_by(\"", component, ".", facet.name, "\") to a when(...)");
        }
    }
    return {};
}

} // namespace tappet::checks
