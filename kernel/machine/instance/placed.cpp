// Returns the places of the parts of a machine.
#include "kernel/machine/instance/placed.hpp"

namespace tappet {

std::span<std::byte> PlacedMachine::stack_of(std::size_t activity) noexcept {
    return machine_.memory.subspan(machine_.plan.activities[activity].stack_at,
                                   machine_.plan.activities[activity].stack_bytes);
}

void* PlacedMachine::facet(End end) noexcept {
    const Facet& row = facet_at(machine_.table, end);
    return row.at(component(end.component), row.index);
}

std::span<std::byte> PlacedMachine::extra_memory(std::size_t section) const noexcept {
    std::size_t place = machine_.plan.extras_at;
    for (std::size_t before = 0; before < section; ++before)
        place += align_section(machine_.table.extras->at(before)->bytes(machine_.table));
    return machine_.memory.subspan(place, machine_.table.extras->at(section)->bytes(machine_.table));
}

GatedComponent* PlacedMachine::gate_of(std::size_t c) noexcept TAPPET_REALTIME {
    return &engines()[machine_.index.activity[c]].plan().parts[machine_.plan.part_of[c]];
}

Waker PlacedMachine::waker_of(std::size_t activity) noexcept TAPPET_REALTIME {
    Engine& engine = engines()[activity];
    // A periodic activity serves its messages in its next period: nothing wakes it in between.
    if (engine.plan().periodic) return {};
    return {&os::Waiter::wake_thunk, &engine.waiter()};
}

Waker PlacedMachine::post_waker_of(std::size_t activity) noexcept TAPPET_REALTIME {
    Waker waker = waker_of(activity);
    if (waker.wake != nullptr) waker.wake = &os::Waiter::wake_after_post_thunk;
    return waker;
}

const BehaviourUnit* PlacedMachine::behaviour_of(std::string_view component) const noexcept {
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b) {
        const BehaviourRow& row = machine_.table.behaviours[b];
        const BehaviourPlan& plan = machine_.plan.behaviours[b];
        if (row.component == component && row.is_driven())
            return row.is_slot() ? at<BehaviourSlot>(plan.slot_at)->active()
                                 : at<BehaviourUnit>(plan.unit_at);
    }
    return nullptr;
}

BehaviourSlot* PlacedMachine::slot_of(std::string_view component) noexcept {
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b)
        if (machine_.table.behaviours[b].component == component && machine_.table.behaviours[b].is_slot())
            return slot_of_row(b);
    return nullptr;
}

const StateMachineExecution* PlacedMachine::state_machine_of(std::string_view component) const noexcept {
    const BehaviourUnit* unit = behaviour_of(component);
    if (unit == nullptr) return nullptr;
    for (const UnitPart& part : unit->parts())
        if (part.machine != nullptr) return part.machine;
    return nullptr;
}

} // namespace tappet
