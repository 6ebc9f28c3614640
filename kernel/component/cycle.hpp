// What a component is told in each cycle.
#pragma once

#include "kernel/base/time.hpp"

namespace tappet {

struct Cycle {
    Time now{};        ///< when this cycle began to run
    Time release{};    ///< when it should have begun: the period's time, the timer's time, or the wake
    Duration period{}; ///< of a periodic activity; zero for the others
};

} // namespace tappet
