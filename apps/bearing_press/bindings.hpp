// Maps the press's devices and lines to each board.
#pragma once

#include "drivers/gpio/kind.hpp"
#include "kernel/machine/table/binding.hpp"

namespace bearing_press::bindings {

using namespace tappet;

inline constexpr auto panel =
    wired("panel-io", "io", line("start", 0), line("stop", 1), line("up", 2), line("down", 3),
          line("home", 4), line("upper_end", 5), line("lower_end", 6), line("lamp", 7));

inline constexpr Binding bench = binding(wired("axis-can", "can0"), panel);

inline constexpr Binding ipc_x86_64 = binding(wired("axis-can", "can0"), panel, place("can", 3),
                                              place("loops", 3), place("io", 3), place("browser", 0));

// This board also has four processors.
inline constexpr Binding ipc_aarch64 = ipc_x86_64;

} // namespace bearing_press::bindings
