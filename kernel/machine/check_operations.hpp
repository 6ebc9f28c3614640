// Checks of who reaches what from outside the reactions: the components that see the machine.
#pragma once

#include "kernel/machine/check_components.hpp"

namespace tappet::checks {

/// The components that see the machine share one mailbox into each engine, which has one sending thread; and
/// what they do for somebody outside must not delay a deadline.
constexpr Sentence check_observers(const MachineView& m, const TableIndexView& r) {
    std::size_t first = nowhere;
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        if (!m.components[c].type->sees_machine) continue;
        const ActivityRow& activity = m.activities[r.activity[c]];
        if (activity.real_time)
            return of_component(m.components[c].name, " sees the machine, but its activity \"", activity.name,
                                "\" is real-time; run it in an activity that is not_real_time");
        if (first == nowhere) first = c;
        if (r.activity[c] != r.activity[first])
            return of_component(m.components[c].name, " sees the machine from activity \"", activity.name,
                                "\", but \"", m.components[first].name, "\" does so from activity \"",
                                m.activities[r.activity[first]].name, "\"; run both in one activity");
    }
    return {};
}

} // namespace tappet::checks
