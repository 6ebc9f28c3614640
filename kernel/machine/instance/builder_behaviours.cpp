// Places the behaviours that drive components, and the slots for later ones, and passes them to their
// engines.
#include "kernel/machine/check/controls.hpp"
#include "kernel/machine/instance/builder.hpp"
#include "kernel/machine/instance/controlled.hpp"

#include <new>

namespace tappet {

namespace {

void note_transition(void* engine, StateIndex from, StateIndex to, TransitionIndex transition,
                     Time now) noexcept TAPPET_REALTIME {
    const std::uint64_t what = (std::uint64_t{from} << 32) | (std::uint64_t{to} << 16) | transition;
    static_cast<Engine*>(engine)->note(what, now);
}

BehaviourUnit& unit_at(void* self) noexcept TAPPET_REALTIME { return *static_cast<BehaviourUnit*>(self); }
BehaviourSlot& slot_at(void* self) noexcept TAPPET_REALTIME { return *static_cast<BehaviourSlot*>(self); }

} // namespace

Sentence MachineBuilder::place_behaviours() {
    std::size_t placed[max_activities] = {};
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b) {
        const BehaviourRow& row = machine_.table.behaviours[b];
        const std::size_t c = find_component(machine_.table, row.component);
        const std::size_t activity = machine_.index.activity[c];
        Behaviour behaviour;
        if (row.is_slot())
            place_slot(b, behaviour);
        else if (const Sentence fault = place_unit(b, behaviour); !fault.empty())
            return Sentence{"behaviour of \"", row.component, "\": ", fault};
        behaviour.part = machine_.plan.part_of[c];
        new (&instance_.at(machine_.plan.activities[activity].behaviours)[placed[activity]++])
            Behaviour{behaviour};
    }
    return {};
}

Sentence MachineBuilder::connect_controls() {
    for (std::size_t c = 0; c < machine_.table.components.size(); ++c) {
        const ComponentRow& row = machine_.table.components[c];
        if (row.type->control == nullptr) continue;
        Controlled controlled;
        controlled.life = &instance_.life();
        controlled.name = row.name;
        controlled.component = find_component(machine_.table, row.controlled);
        if (row.type->controls == ComponentType::Controls::behaviour) {
            const std::size_t b = checks::controlled_behaviour(machine_.table, row);
            controlled.engine = &instance_.engines()[machine_.index.activity[c]];
            controlled.slot = instance_.slot_of_row(b);
            controlled.unit = instance_.unit_of_row(b);
            if (controlled.slot == nullptr)
                controlled.part = checks::controlled_instance(machine_.table.behaviours[b].unit(), row);
        }
        row.type->control(instance_.component(c), controlled);
    }
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b) {
        if (BehaviourUnit* const unit = instance_.unit_of_row(b); unit != nullptr) unit->connect_links();
        if (BehaviourSlot* const slot = instance_.slot_of_row(b); slot != nullptr)
            if (const Sentence fault = slot->begin(); !fault.empty())
                return Sentence{"slot of \"", machine_.table.behaviours[b].component, "\": ", fault};
    }
    return {};
}

Sentence MachineBuilder::place_unit(std::size_t b, Behaviour& behaviour) {
    const BehaviourRow& row = machine_.table.behaviours[b];
    const BehaviourPlan& plan = machine_.plan.behaviours[b];
    const ScriptUnit script = row.unit();
    const std::span events = instance_.at(plan.events);
    std::size_t event = 0;
    for (const std::string_view name : events_of(script).all()) new (&events[event++]) std::string_view{name};
    const std::size_t c = find_component(machine_.table, row.component);
    auto* unit = new (instance_.at<void>(plan.unit_at)) BehaviourUnit;
    if (Sentence fault =
            unit->place(script, row.code, row.options, instance_.at(plan.memory), events, instance_, c);
        !fault.empty())
        return fault;
    unit->trace(&note_transition, &instance_.engines()[machine_.index.activity[c]]);
    behaviour.self = unit;
    behaviour.start = [](void* self, Time now) noexcept TAPPET_REALTIME { unit_at(self).start(now); };
    if (unit->has_programs())
        behaviour.programs = [](void* self, Time now) noexcept
            TAPPET_REALTIME { return unit_at(self).step_programs(now); };
    behaviour.step = [](void* self, Time now) noexcept TAPPET_REALTIME {
        const bool worked = unit_at(self).step(now);
        unit_at(self).report_errors();
        return worked;
    };
    behaviour.stop = [](void* self, Time now) noexcept
        TAPPET_REALTIME { unit_at(self).finish(now, "its component stops"); };
    behaviour.has_ended = [](const void* self) noexcept
        TAPPET_REALTIME { return static_cast<const BehaviourUnit*>(self)->is_finished(); };
    behaviour.next = [](const void* self) noexcept
        TAPPET_REALTIME { return static_cast<const BehaviourUnit*>(self)->next(); };
    return {};
}

void MachineBuilder::place_slot(std::size_t b, Behaviour& behaviour) {
    const BehaviourRow& row = machine_.table.behaviours[b];
    const BehaviourPlan& plan = machine_.plan.behaviours[b];
    const std::size_t c = find_component(machine_.table, row.component);
    const std::span events = instance_.at(plan.events);
    std::size_t event = 0;
    const auto name = [&](End end) {
        const std::string_view facet = facet_at(machine_.table, end).name;
        std::string_view path = facet;
        for (const std::string_view each : row.slot.events)
            if (end.component != c && is_named(each, machine_.table.components[end.component].name, facet))
                path = each;
        new (&events[event++]) std::string_view{path};
    };
    for_each_slot_event(machine_.table, row, name);
    const std::span<std::byte> memory = instance_.at(plan.memory);
    BehaviourSlot::Place place;
    place.row = &row;
    place.machine = &instance_;
    place.component = c;
    place.banks[0] = memory.first(memory.size() / 2);
    place.banks[1] = memory.last(memory.size() / 2);
    place.text = instance_.at(plan.text);
    place.events = events;
    place.handles = {instance_.at<EventHandle>(plan.handles_at), events.size()};
    place.trace = &note_transition;
    place.engine = &instance_.engines()[machine_.index.activity[c]];
    place.part = machine_.plan.part_of[c];
    End angle;
    if (!row.slot.angle.empty() && resolve(machine_.table, row.slot.angle, FacetKind::output, angle).empty())
        place.angle = static_cast<const Output<double>*>(instance_.facet(angle));
    auto* slot = new (instance_.at<void>(plan.slot_at)) BehaviourSlot;
    slot->place(place);
    behaviour.self = slot;
    behaviour.start = [](void* self, Time now) noexcept TAPPET_REALTIME { slot_at(self).start(now); };
    behaviour.programs = [](void* self, Time now) noexcept
        TAPPET_REALTIME { return slot_at(self).step_programs(now); };
    behaviour.step = [](void* self, Time now) noexcept TAPPET_REALTIME { return slot_at(self).step(now); };
    behaviour.stop = [](void* self, Time now) noexcept TAPPET_REALTIME { slot_at(self).stop(now); };
    behaviour.has_ended = [](const void* self) noexcept TAPPET_REALTIME {
        const BehaviourUnit* unit = static_cast<const BehaviourSlot*>(self)->active();
        return unit == nullptr || unit->is_finished();
    };
    behaviour.next = [](const void* self) noexcept
        TAPPET_REALTIME { return static_cast<const BehaviourSlot*>(self)->next(); };
}

} // namespace tappet
