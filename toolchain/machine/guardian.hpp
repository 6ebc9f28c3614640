// SPDX-License-Identifier: Apache-2.0
// The guardian of a firmware: watches the machine's process and leaves the outputs safe, however that process
// ends or hangs.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/os/guard.hpp"

#include <string_view>

namespace tappet {

/// Runs in the guardian's process, from the fork to its end, and exits with the machine's exit code.
/// `instance` is its copy of the configured machine, with the engines in shared memory. It acts when the
/// machine's process ends without having reported safe outputs, or reports that it cannot make them safe;
/// when one of its threads crashes; when its supervisor or a real-time activity shows no life for too long;
/// and when a requested stop has not begun within a quarter of the board's stop_within, or has not left
/// everything safe within all of it. It kills the process, writes lines, awaits the end, writes lines again
/// (another thread may have written in between), sends frames until they are confirmed, and writes registers.
/// It keeps a black box in the directory `black_boxes` (none when empty), also for a machine that a fault
/// stopped in order. Not real-time.
[[noreturn]] void be_guardian(os::Guard& guard, GuardedDevices& devices, MachineInstance& instance,
                              std::string_view black_boxes);

} // namespace tappet
