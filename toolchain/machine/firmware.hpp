// The life of a firmware, the same for every machine: devices opened, armed, started, supervised, stopped,
// summed up. What only one machine says stands in its table, its components, and, rarely, in hooks.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/worlds/real_world.hpp"

#include <span>

namespace tappet {

/// How a firmware ends. Where its guardian had to end it: 128 and the number of the signal, as a shell tells
/// it.
enum class Ending : int { well = 0, wrong_set_up = 2, refused_to_arm = 3, stopped_by_fault = 4 };

/// What only one machine says. The supervisor's thread calls them: never between a fault and safe values.
struct FirmwareHooks {
    /// Words of the command line that the firmware does not know. The error is the refusal.
    Sentence (*take)(std::span<char* const> words) = nullptr;
    /// The machine is configured, nothing moves.
    void (*configured)(MachineInstance& instance) = nullptr;
    /// Everything stands, the summary is not written yet.
    void (*ended)(MachineInstance& instance, const RealWorld& world) = nullptr;
};

/// Runs until it is told to end by a signal, or a fault ends it; returns its exit code, in two processes: the
/// machine's and its guardian's. `devices` and what the machine needs are in static memory; what it prints
/// begins with the machine's name. Not real-time.
[[nodiscard]] int run_firmware(const AcceptedMachine& machine, GuardedDevices& devices, int count,
                               char** words, const FirmwareHooks& hooks = {});

} // namespace tappet
