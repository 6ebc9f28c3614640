// Who reacts to which event: the reaction rows, and the triggers of the behaviours, in one list.
#pragma once

#include "kernel/machine/check.hpp"
#include "kernel/statechart/execution.hpp"

namespace tappet {

/// One reaction row, or one trigger of a state machine.
struct Subscription {
    End event;
    End operation;                   ///< of a reaction row
    std::size_t behaviour = nowhere; ///< of a trigger
    std::size_t trigger = 0;
    bool synchronous = false;
    std::uint32_t quota = 0;
    std::size_t sender = 0;   ///< activity
    std::size_t receiver = 0; ///< activity
};

/// So many unserved emissions a state machine's trigger holds.
inline constexpr std::uint32_t trigger_quota = 8;

/// How many subscriptions a checked table has.
constexpr std::size_t count_subscriptions(const MachineView& m) {
    std::size_t count = 0;
    for (const auto& row : m.reactions) count += row.kind == ReactionKind::when;
    for (const auto& row : m.behaviours)
        if (!row.is_slot()) count += measure(row.machine).triggers;
    return count;
}

/// Writes the subscriptions of a checked table into `into`, which has room for all.
constexpr void list_subscriptions(const MachineView& m, const TableIndexView& r,
                                  std::span<Subscription> into) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < m.reactions.size(); ++i) {
        if (m.reactions[i].kind != ReactionKind::when) continue;
        Subscription& s = into[n++];
        s.event = r.reactions[i].from;
        s.operation = r.reactions[i].to;
        s.synchronous = m.reactions[i].target.synchronous;
        s.quota = m.reactions[i].target.quota;
        s.sender = r.activity[s.event.component];
        s.receiver = r.activity[s.operation.component];
    }
    for (std::size_t b = 0; b < m.behaviours.size(); ++b) {
        const BehaviourRow& row = m.behaviours[b];
        if (row.is_slot()) continue;
        const StateHierarchy names{row.machine};
        for (std::size_t t = 0; t < names.triggers; ++t) {
            Subscription& s = into[n++];
            static_cast<void>(checks::resolve_trigger(m, row, names.trigger_name(t), s.event));
            s.behaviour = b;
            s.trigger = t;
            s.quota = trigger_quota;
            s.sender = r.activity[s.event.component];
            s.receiver = r.activity[find_component(m, row.component)];
        }
    }
}

} // namespace tappet
