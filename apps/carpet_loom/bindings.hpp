// Maps the carpet loom's devices and lines to each board, and its activities to processors.
#pragma once

#include "drivers/gpio/kind.hpp"
#include "drivers/modbus/kind.hpp"
#include "kernel/machine/table/binding.hpp"

namespace tappet::carpet::bindings {

namespace detail {

constexpr auto loom_io(std::string_view at) {
    return wired("loom-io", at, line("emergency_stop", 0), line("drop_wire", 1), line("weft_detector", 2),
                 line("button_start", 3), line("button_stop", 4), line("button_acknowledge", 5),
                 line("weft_release", 8), line("brake", 9), line("lamp_run", 10), line("lamp_stop", 11),
                 line("lamp_fault", 12), line("yarn_cutter", 13));
}

} // namespace detail

// clang-format off
inline constexpr Binding bench = binding(
    wired("loom-can", "can0"),
    detail::loom_io("io"),
    wired("loom-utility", "127.0.0.1:1502", unit(1)),
    proven_by("weft.picks_woven", 20));

inline constexpr Binding ipc_x86_64 = binding(
    wired("loom-can", "can0"),
    detail::loom_io("io"),
    wired("loom-utility", "192.168.7.2:502", unit(1)),
    // The device activities have a processor of their own: neither an interrupt nor a background activity
    // evicts their caches.
    place("can", 3), place("io", 3),
    place("utility", 0), place("console", 0), place("restarter", 0), place("scope", 0), place("browser", 0),
    proven_by("weft.picks_woven", 100));

// This board also has four processors.
inline constexpr Binding ipc_aarch64 = ipc_x86_64;
// clang-format on

} // namespace tappet::carpet::bindings
