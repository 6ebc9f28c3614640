// Places the behaviours that drive components and hands them to their engines.
#include "kernel/machine/instance.hpp"

#include <new>

namespace tappet {

namespace {

void note_transition(void* engine, StateIndex from, StateIndex to, TransitionIndex transition,
                     Time now) noexcept TAPPET_REALTIME {
    const std::uint64_t what = (std::uint64_t{from} << 32) | (std::uint64_t{to} << 16) | transition;
    static_cast<Engine*>(engine)->note(what, now);
}

BehaviourUnit& unit_of(void* self) noexcept TAPPET_REALTIME { return *static_cast<BehaviourUnit*>(self); }

} // namespace

Sentence MachineInstance::place_behaviours() {
    std::size_t placed[checks::max_activities] = {};
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b) {
        const BehaviourRow& row = machine_.table.behaviours[b];
        if (row.is_slot()) continue;
        const BehaviourPlan& plan = machine_.plan.behaviours[b];
        const ScriptUnit script = row.unit();
        const std::span events{at<std::string_view>(plan.events_at), plan.event_count};
        std::size_t event = 0;
        for (const std::string_view name : events_of(script).all())
            new (&events[event++]) std::string_view{name};
        const std::size_t c = find_component(machine_.table, row.component);
        const std::size_t activity = machine_.index.activity[c];
        auto* unit = new (at<void>(plan.unit_at)) BehaviourUnit;
        if (const Sentence fault =
                unit->place(script, row.code, row.options,
                            machine_.memory.subspan(plan.memory_at, plan.memory_bytes), events, *this, c);
            !fault.empty())
            return Sentence{"behaviour of \"", row.component, "\": ", fault};
        unit->trace(&note_transition, &engines()[activity]);
        Behaviour behaviour;
        behaviour.self = unit;
        behaviour.part = machine_.plan.part_of[c];
        behaviour.start = [](void* self, Time now) noexcept TAPPET_REALTIME { unit_of(self).start(now); };
        if (unit->has_programs())
            behaviour.programs = [](void* self, Time now) noexcept
                TAPPET_REALTIME { unit_of(self).step_programs(now); };
        behaviour.step = [](void* self, Time now) noexcept TAPPET_REALTIME { unit_of(self).step(now); };
        behaviour.stop = [](void* self, Time now) noexcept
            TAPPET_REALTIME { unit_of(self).finish(now, "its component stops"); };
        behaviour.next = [](const void* self) noexcept
            TAPPET_REALTIME { return static_cast<const BehaviourUnit*>(self)->next(); };
        new (at<Behaviour>(machine_.plan.activities[activity].behaviours_at) + placed[activity]++)
            Behaviour{behaviour};
    }
    return {};
}

} // namespace tappet
