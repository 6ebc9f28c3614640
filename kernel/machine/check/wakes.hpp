// Checks the wakes of sporadic activities: a row must lead to each step() and work() that one runs, since its
// timers and its behaviours' waits run nothing but themselves.
#pragma once

#include "kernel/machine/check/behaviours.hpp"

namespace tappet::checks {

/// Whether a row causes cycles of the activity in which its components are stepped.
constexpr bool is_woken(const MachineView& m, const TableIndexView& r, std::size_t activity) noexcept {
    for (std::size_t x = 0; x < m.connections.size(); ++x)
        if (m.connections[x].wakes_reader && r.activity[r.connections[x].to.component] == activity)
            return true;
    for (std::size_t i = 0; i < m.reactions.size(); ++i) {
        const Link& link = r.reactions[i];
        const bool is_command =
            m.reactions[i].kind == ReactionKind::uses && facet_at(m, link.to).kind == FacetKind::command;
        const bool is_told = m.reactions[i].kind == ReactionKind::when && !m.reactions[i].target.synchronous;
        if ((is_told || is_command) && r.activity[link.to.component] == activity) return true;
        // A finished command wakes its sender.
        if (is_command && r.activity[link.from.component] == activity) return true;
    }
    for (const BehaviourRow& row : m.behaviours)
        if (r.activity[find_component(m, r.by_name, row.component)] == activity &&
            (row.is_slot() ? row.slot.events.size() : events_of(row.unit()).all().size()) != 0)
            return true;
    return false;
}

constexpr Sentence check_wakes(const MachineView& m, const TableIndexView& r) {
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        const ActivityRow& row = m.activities[a];
        if (row.trigger != Trigger::on_work || is_woken(m, r, a)) continue;
        std::size_t stepped = nowhere;
        bool has_driver = false; // a driver listens to its device itself
        for (const auto& name : row.runs) {
            const std::size_t c = find_component(m, r.by_name, name);
            const ComponentType& type = *m.components[c].type;
            has_driver |= type.device_kind != nullptr;
            if (stepped == nowhere && (type.step != nullptr || type.work != nullptr)) stepped = c;
        }
        if (stepped == nowhere || has_driver) continue;
        const ComponentRow& component = m.components[stepped];
        return of_activity(row.name, " runs on_work() but no row wakes it, so the ",
                           component.type->step != nullptr ? "step()" : "work()", " of component \"",
                           component.name,
                           "\" would never run; add wakes to a connection into it, or "
                           "when(\"...\", tell(\"",
                           component.name, ".operation\")), or run it every(...)");
    }
    return {};
}

} // namespace tappet::checks
