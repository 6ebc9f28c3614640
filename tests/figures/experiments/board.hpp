// The experiments' board: one processor, whichever the program was told to run on.
#pragma once

#include "kernel/machine/table/board.hpp"

namespace tappet::experiments {

inline constexpr Board one_processor{
    .name = "experiments",
    .world = "host",
    .memory_budget_bytes = 4 * 1024 * 1024,
    .heap_bytes = 0,
    .processors = 1,
    .highest_priority = 80,
    .default_processor = -1, // that of the program, which has a single one
    .only_warned = warn_only("realtime-kernel", "clock-source", "rt-throttling", "cpu-governor",
                             "heap-sealed", "cpu-dma-latency", "memory-locked", "memory-lockable", "swap",
                             "fifo-priority", "clock-resolution", "processors"),
};

} // namespace tappet::experiments
