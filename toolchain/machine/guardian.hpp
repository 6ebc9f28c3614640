// SPDX-License-Identifier: Apache-2.0
// The guardian of a firmware: it watches the machine's process and, however that ends or hangs, leaves the
// outputs safe.
#pragma once

#include "drivers/hardware/devices.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/os/guard.hpp"

#include <string_view>

namespace tappet {

/// In the guardian's process, from the split to its end, with the exit code of the machine's. The machine is
/// its copy, configured, with the engines in memory of both. It acts when the machine's process ends without
/// having said that all is safe, or says that it cannot make it so; when a thread of it crashes; when its
/// supervisor or a real-time activity shows no life for too long; and when a stop that was asked for has not
/// begun within a quarter of the board's stop_within, or not left all safe within all of it: it kills the
/// process, writes lines, awaits the end, writes lines again (another thread may have come in between), sends
/// frames until they are confirmed, writes registers, and keeps a black box in the directory `black_boxes`
/// (none when that is empty), as it does of a machine that a fault stopped in order. Not real-time.
[[noreturn]] void be_guardian(os::Guard& guard, GuardedDevices& devices, MachineInstance& instance,
                              std::string_view black_boxes);

} // namespace tappet
