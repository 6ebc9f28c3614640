// What only one machine's host program does, as its HOST_HOOKS header gives it to tappet_machine() of CMake.
#pragma once

#include "drivers/plant/plant.hpp"
#include "kernel/machine/instance/instance.hpp"

namespace tappet {

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
