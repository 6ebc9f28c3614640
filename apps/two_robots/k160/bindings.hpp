// Where this robot's modules and lines stand on each board.
#pragma once

#include "kernel/machine/table/binding.hpp"

namespace two_robots::k160::bindings {

using namespace tappet;

constexpr BoundDevice lines_at(std::string_view chip) {
    return wired("robot-io", chip, line("start", 0), line("ready", 1), line("work", 2), line("stop", 3),
                 line("switch_1", 4), line("switch_2", 5), line("switch_3", 6), line("switch_4", 7),
                 line("switch_5", 8), line("switch_6", 9), line("enable", 10), line("release", 11));
}

// Both robots are in one box there.
inline constexpr Binding bench = binding(wired("robot-can", "can1"), lines_at("panel"));

inline constexpr Binding ipc_x86_64 = binding(wired("robot-can", "can0"), lines_at("io"), place("can", 3),
                                              place("loop", 3), place("io", 3), place("browser", 0));

// The processors are four there, too.
inline constexpr Binding ipc_aarch64 = ipc_x86_64;

} // namespace two_robots::k160::bindings
