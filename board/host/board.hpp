// The host: a developer's machine. Devices are in-process twins; it must not control a real machine.
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
    .simulated = true,
    // A developer's kernel is rarely a real-time one, and other programs run on it.
    .only_warned = warn_only("realtime-kernel", "clock-source", "rt-throttling", "cpu-governor",
                             "heap-sealed", "cpu-dma-latency", "memory-locked", "memory-lockable", "swap",
                             "fifo-priority", "clock-resolution"),
    .kernel_command_line = "",
};

} // namespace tappet::board
