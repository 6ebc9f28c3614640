// The host: a developer's machine. Devices are in-process twins; nothing of it is fit for steel.
#pragma once

#include "kernel/machine/table/board.hpp"

namespace tappet::board {

inline constexpr Board host{
    .name = "host",
    .world = "host",
    .memory_budget_bytes = 4 * 1024 * 1024,
    .heap_bytes = 256 * 1024,
    .processors = 1,
    .highest_priority = 80,
    .devices =
        board_devices(board_device("loom-can", "can", "twin", bit_rate(500'000)),
                      board_device("loom-io", "gpio", "twin", line("emergency_stop", 0), line("drop_wire", 1),
                                   line("weft_detector", 2), line("button_start", 3), line("button_stop", 4),
                                   line("button_acknowledge", 5), line("weft_release", 8), line("brake", 9),
                                   line("lamp_run", 10), line("lamp_stop", 11), line("lamp_fault", 12),
                                   line("yarn_cutter", 13)),
                      board_device("loom-utility", "modbus", "twin"),
                      board_device("tracking-camera", "camera", "simulated")),
    // A developer's kernel is rarely a real-time one, and its other work goes on.
    .only_warned = warn_only("realtime-kernel", "clock-source", "rt-throttling", "cpu-governor",
                             "heap-sealed", "cpu-dma-latency", "memory-locked", "memory-lockable", "swap",
                             "fifo-priority", "clock-resolution"),
    .kernel_command_line = "",
};

} // namespace tappet::board
