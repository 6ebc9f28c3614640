// What only one machine's host program does, as its HOST_HOOKS header gives it to tappet_machine() of CMake.
#pragma once

#include "drivers/plant/plant.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/statechart/execution.hpp"

namespace tappet {

/// Of the state machine that drives the component, the outermost one; empty: none.
[[nodiscard]] inline std::string_view state_of(const MachineInstance& machine, std::string_view component) {
    const StateMachineExecution* states = machine.state_machine_of(component);
    return states == nullptr || states->path().empty() ? std::string_view{} : states->path()[0];
}

/// It looks into machine and plant, which has to wait meanwhile: under virtual time. Not real-time.
struct HostHooks {
    bool in_real_time = false; ///< the program has real time too, in which nobody looks
    Duration look_every{};
    /// Between two moments of the machine, and once when everything stands.
    void (*look)(MachineInstance& machine, Plant& plant, Time now) = nullptr;
    /// At the end. The error is what it could not leave behind.
    Sentence (*ended)(const Plant& plant) = nullptr;
};

} // namespace tappet
