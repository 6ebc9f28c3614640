// Wires the gate of a held output, and reports what it held back.
#include "kernel/limits/held_in.hpp"

#include <algorithm>
#include <new>

namespace tappet {

namespace {

/// Returns how long an order may stand that the states do not allow: a writer sees a change of the state some
/// cycles later.
Duration grace_of(const AcceptedMachine& of, const HeldIn& row, std::size_t driver, std::size_t machine) {
    Duration slowest{};
    const auto consider = [&](std::size_t component) {
        slowest = std::max(slowest, of.table.activities[of.index.activity[component]].period);
    };
    consider(driver);
    consider(machine);
    for (std::size_t x = 0; x < of.table.connections.size(); ++x)
        if (same_text(of.table.connections[x].to, row.output))
            consider(of.index.connections[x].from.component);
    return std::max<Duration>(100ms, 4 * slowest);
}

} // namespace

void HeldIn::connect(MachineInstance& instance, std::size_t, std::span<std::byte> memory) const {
    const AcceptedMachine& of = instance.machine();
    const std::size_t dot = output.find('.');
    const std::size_t driver = find_component(of.table, output.substr(0, dot));
    const BehaviourRow* const row = held_detail::behaviour_of(of.table, machine);
    BehaviourUnit& unit = *instance.unit_of_row(static_cast<std::size_t>(row - of.table.behaviours.data()));
    const Duration grace = grace_of(of, *this, driver, find_component(of.table, machine));
    auto* const placed = new (memory.data()) held_detail::Placed{
        .clock = &instance.clock(),
        .held = StateGate{.gate = OutputGate{grace}, .driver = instance.waker_of(of.index.activity[driver])}};
    const std::span<const UnitPart> parts = unit.parts();
    for (std::size_t i = 0; i < parts.size(); ++i)
        for (std::size_t s = 0; parts[i].machine != nullptr && s < parts[i].type->machine.states.size(); ++s)
            if (std::ranges::find(states, parts[i].type->machine.states[s].name) != states.end())
                static_cast<void>(
                    placed->held.open_in.push({static_cast<InstanceIndex>(i), static_cast<StateIndex>(s)}));
    unit.add_gate(placed->held);
    const ComponentType& type = *of.table.components[driver].type;
    type.gate_output(instance.component(driver), held_detail::output_of(type, output.substr(dot + 1)),
                     placed->held.gate);
}

SectionCount HeldIn::counted(std::span<const std::byte> memory, std::size_t row) const noexcept {
    if (row != 0) return {};
    const auto& placed = *reinterpret_cast<const held_detail::Placed*>(memory.data());
    return {output, placed.held.gate.times(placed.clock->now()),
            "was asked on outside the states of its held_in(..) and kept at its safe value"};
}

} // namespace tappet
