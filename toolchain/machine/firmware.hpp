// The life of a firmware, the same for every machine: opens devices, arms, starts, supervises, stops, sums
// up. A machine's own parts are in its table, its components, and, rarely, in hooks.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/worlds/real_world.hpp"

#include <span>

namespace tappet {

/// How a firmware ends. When its guardian had to end it: 128 plus the number of the signal, as a shell
/// reports it.
enum class Ending : int { well = 0, wrong_set_up = 2, refused_to_arm = 3, stopped_by_fault = 4 };

/// The hooks of one machine. The supervisor's thread calls them, never between a fault and safe values.
struct FirmwareHooks {
    /// Parses words of the command line that the firmware does not know. The error is the refusal.
    Sentence (*take)(std::span<char* const> words) = nullptr;
    /// Called when the machine is configured and nothing moves.
    void (*configured)(MachineInstance& instance) = nullptr;
    /// Called when everything has stopped, before the summary is written.
    void (*ended)(MachineInstance& instance, const RealWorld& world) = nullptr;
};

/// Runs until a signal asks it to end or a fault ends it; returns the exit code. Uses two processes: the
/// machine's and its guardian's. `devices` and the machine's data must be in static memory. Each printed line
/// begins with the machine's name. Not real-time.
[[nodiscard]] int run_firmware(const AcceptedMachine& machine, GuardedDevices& devices, int count,
                               char** words, const FirmwareHooks& hooks = {});

} // namespace tappet
