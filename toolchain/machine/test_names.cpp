// Looks names up as the table's check does.
#include "toolchain/machine/test_names.hpp"

#include "drivers/hardware/devices.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/statechart/execution.hpp"

#include <algorithm>

namespace tappet {

Sentence check_component(const MachineInstance& machine, std::string_view component) {
    const auto components = machine.machine().table.components;
    if (std::ranges::find(components, component, &ComponentRow::name) != components.end()) return {};
    Nearest nearest{component};
    for (const ComponentRow& each : components) nearest.consider(each.name);
    Sentence fault{"the machine has no component \"", component, "\""};
    detail::add_suggestion(fault, nearest, "its table lists them");
    return fault;
}

Sentence check_state(const MachineInstance& machine, std::string_view component, std::string_view state) {
    if (Sentence fault = check_component(machine, component); !fault.empty()) return fault;
    const StateMachineExecution* states = machine.state_machine_of(component);
    const auto rows = machine.machine().table.behaviours;
    if (states == nullptr) {
        const bool has_slot = std::ranges::any_of(
            rows, [&](const BehaviourRow& row) { return row.component == component && row.is_slot(); });
        return has_slot ? Sentence{} : Sentence{"no state machine drives component \"", component, "\""};
    }
    Nearest nearest{state};
    for (const StateRow& each : states->machine().table.states) {
        if (each.name == state) return {};
        nearest.consider(each.name);
    }
    Sentence fault{"the state machine of \"", component, "\" has no state \"", state, "\""};
    detail::add_suggestion(fault, nearest, "its rows state(...) list them");
    return fault;
}

Sentence check_device(const MachineInstance& machine, std::string_view device, std::string_view kind) {
    Nearest nearest{device};
    for (const ComponentRow& each : machine.machine().table.components) {
        if (!drives(each, kind)) continue;
        if (each.device == device) return {};
        nearest.consider(each.device);
    }
    Sentence fault{"the machine drives no ", kind, " device \"", device, "\""};
    detail::add_suggestion(fault, nearest, "its table lists them, device(\"..\")");
    return fault;
}

bool is_in_state(const MachineInstance& machine, std::string_view component, std::string_view state) {
    const StateMachineExecution* states = machine.state_machine_of(component);
    if (states == nullptr) return false;
    const auto path = states->path();
    return std::ranges::find(path, state) != path.end();
}

} // namespace tappet
