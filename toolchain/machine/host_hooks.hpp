// A machine's own parts of its host program: its HOST_HOOKS header passes them to tappet_machine() of CMake.
#pragma once

#include "drivers/plant/plant.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/statechart/execution.hpp"

namespace tappet {

/// Returns the outermost state of the state machine that drives the component; empty: none.
[[nodiscard]] inline std::string_view state_of(const MachineInstance& machine, std::string_view component) {
    const StateMachineExecution* states = machine.state_machine_of(component);
    return states == nullptr || states->path().empty() ? std::string_view{} : states->path()[0];
}

/// The hooks read machine and plant, which wait meanwhile: under virtual time only. Not real-time.
struct HostHooks {
    bool in_real_time = false; ///< the program also supports real time, without looks
    Duration look_every{};
    /// Called between two moments of the machine, and once after everything has stopped.
    void (*look)(MachineInstance& machine, Plant& plant, Time now) = nullptr;
    /// Called at the end. The error names the output that could not be written.
    Sentence (*ended)(const Plant& plant) = nullptr;
};

} // namespace tappet
