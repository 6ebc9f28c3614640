// The bench: a PREEMPT_RT guest under QEMU with vcan, gpio-sim and a Modbus device on its own loopback. The
// real kernel interfaces, no real wires.
#pragma once

#include "kernel/machine/table/board.hpp"

namespace tappet::board {

inline constexpr Board bench{
    .name = "bench",
    .world = "bench",
    .memory_budget_bytes = 4 * 1024 * 1024,
    .heap_bytes = 160 * 1024,
    .processors = 1, // the emulator counts instructions for one processor only
    .highest_priority = 80,
    .devices =
        board_devices(board_device("loom-can", "can", "can0", bit_rate(500'000)),
                      board_device("loom-io", "gpio", "/dev/loom-io", line("emergency_stop", 0),
                                   line("drop_wire", 1), line("weft_detector", 2), line("button_start", 3),
                                   line("button_stop", 4), line("button_acknowledge", 5),
                                   line("weft_release", 8), line("brake", 9), line("lamp_run", 10),
                                   line("lamp_stop", 11), line("lamp_fault", 12), line("yarn_cutter", 13)),
                      board_device("loom-utility", "modbus", "127.0.0.1:1502")),
    // The emulator has neither a frequency governor nor a clock that Linux trusts.
    .only_warned = warn_only("clock-source", "cpu-governor"),
    .kernel_command_line = "console=ttyS0 quiet panic=-1",
    .properties_directory = "/run",
    // Everybody in the guest may look; two users of its tests may do more.
    .browsing = {.directory = "/run/tappet",
                 .mode = 0666,
                 .roles = roles(user(1001, Role::machine_operator), user(1002, Role::engineer))},
};

} // namespace tappet::board
