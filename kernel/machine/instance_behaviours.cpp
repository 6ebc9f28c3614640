// Places the state machines that drive components.
#include "kernel/machine/instance.hpp"

#include <new>

namespace tappet {

namespace {

void note_transition(void* engine, StateIndex from, StateIndex to, TransitionIndex transition,
                     Time now) noexcept TAPPET_REALTIME {
    const std::uint64_t what = (std::uint64_t{from} << 32) | (std::uint64_t{to} << 16) | transition;
    static_cast<Engine*>(engine)->note(what, now);
}

StateMachineExecution& execution_of(void* self) noexcept TAPPET_REALTIME {
    return *static_cast<StateMachineExecution*>(self);
}

// The stop of a component leaves its machine in the final state; the next start leads from there.
void start_again(StateMachineExecution& execution, Time now) noexcept TAPPET_REALTIME {
    if (execution.start(now) == StateOutcome::ignored) static_cast<void>(execution.request_initial(now));
}

} // namespace

void MachineInstance::place_behaviours() {
    std::size_t placed[checks::max_activities] = {};
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b) {
        const BehaviourRow& row = machine_.table.behaviours[b];
        if (row.is_slot()) continue;
        const BehaviourPlan& plan = machine_.plan.behaviours[b];
        const ResolvedSizes& sizes = plan.sizes;
        const ResolvedRoom room{{at<StatePlan>(plan.plans_at), sizes.states},
                                {at<std::string_view>(plan.triggers_at), sizes.triggers},
                                {at<ArcIndex>(plan.cells_at), sizes.states * sizes.triggers},
                                {at<StateArc>(plan.arcs_at), sizes.arcs},
                                {at<StateProgram>(plan.programs_at), sizes.programs}};
        static_cast<void>(resolve_into(row.machine, room));
        const std::size_t c = find_component(machine_.table, row.component);
        const std::size_t activity = machine_.index.activity[c];
        auto* execution = new (at<void>(plan.execution_at)) StateMachineExecution;
        execution->bind({row.machine, room.triggers, room.plans.data(), room.cells.data(), room.arcs.data(),
                         room.programs.data()},
                        component(c));
        execution->trace(&note_transition, &engines()[activity]);
        Behaviour behaviour;
        behaviour.self = execution;
        behaviour.part = machine_.plan.part_of[c];
        behaviour.start = [](void* self, Time now) noexcept
            TAPPET_REALTIME { start_again(execution_of(self), now); };
        behaviour.step = [](void* self, Time now) noexcept TAPPET_REALTIME { execution_of(self).step(now); };
        behaviour.stop = [](void* self, Time now) noexcept TAPPET_REALTIME {
            static_cast<void>(execution_of(self).request_final(now, "its component stops"));
        };
        behaviour.next = [](const void* self) noexcept
            TAPPET_REALTIME { return static_cast<const StateMachineExecution*>(self)->next_timeout(); };
        new (at<Behaviour>(machine_.plan.activities[activity].behaviours_at) + placed[activity]++)
            Behaviour{behaviour};
    }
}

} // namespace tappet
