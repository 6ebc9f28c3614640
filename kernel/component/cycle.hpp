// What a component is told in each cycle.
#pragma once

#include "kernel/base/time.hpp"

namespace tappet {

struct Cycle {
    Time now{};        ///< when this cycle began to run
    Time release{};    ///< when it should have begun: the period's time, the timer's time, or the wake
    Duration period{}; ///< of a periodic activity; zero for the others

    /// When a timer is to fire that goes on after this one: so long from when it was due, which keeps its
    /// grid. When that is past, so long from now: turns that were missed are not made up for, all at one
    /// instant.
    [[nodiscard]] constexpr Time after(Duration time) const noexcept {
        const Time on_grid = release + time;
        return on_grid > now ? on_grid : now + time;
    }
};

} // namespace tappet
