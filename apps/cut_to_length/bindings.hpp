// Maps the cutter's devices and lines to each board.
#pragma once

#include "drivers/gpio/kind.hpp"
#include "kernel/machine/table/binding.hpp"

namespace cut_to_length::bindings {

using namespace tappet;

inline constexpr auto buttons_and_knife = wired("line-io", "io", line("start", 0), line("stop", 1),
                                                line("emergency_stop", 2), line("knife", 4), line("lamp", 5));

inline constexpr Binding bench = binding(wired("feed-can", "can0"), buttons_and_knife);

inline constexpr Binding ipc_x86_64 = binding(wired("feed-can", "can0"), buttons_and_knife, place("can", 3),
                                              place("io", 3), place("browser", 0));

// This board also has four processors.
inline constexpr Binding ipc_aarch64 = ipc_x86_64;

} // namespace cut_to_length::bindings
