// Maps the lines of either robot to the chip to which they are wired.
#pragma once

#include "drivers/gpio/kind.hpp"
#include "kernel/machine/table/binding.hpp"

namespace two_robots {

using namespace tappet;

constexpr auto lines_at(std::string_view chip) {
    return wired("robot-io", chip, line("start", 0), line("ready", 1), line("work", 2), line("stop", 3),
                 line("switch_1", 4), line("switch_2", 5), line("switch_3", 6), line("switch_4", 7),
                 line("switch_5", 8), line("switch_6", 9), line("enable", 10), line("release", 11));
}

} // namespace two_robots
