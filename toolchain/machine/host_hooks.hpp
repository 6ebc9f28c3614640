// What only one machine's host program does, as its HOOKS header gives it to tappet_machine() of CMake.
#pragma once

#include "drivers/plant/plant.hpp"
#include "kernel/machine/instance/instance.hpp"

namespace tappet {

/// It looks into machine and plant; then it has virtual time only. Not real-time.
struct HostHooks {
    Duration look_every{};
    /// Between two moments of the machine, and once when everything stands.
    void (*look)(MachineInstance& machine, Plant& plant, Time now) = nullptr;
    /// At the end. The error is what it could not leave behind.
    Sentence (*ended)(const Plant& plant) = nullptr;
};

} // namespace tappet
