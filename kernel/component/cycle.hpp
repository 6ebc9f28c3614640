// The times of a cycle, as its components get them.
#pragma once

#include "kernel/base/time.hpp"

namespace tappet {

struct Cycle {
    Time now{};        ///< when this cycle began to run
    Time release{};    ///< when it should have begun: the period's time, the timer's time, or the wake
    Duration period{}; ///< of a periodic activity; zero for the others

    /// Returns the time for which a repeating timer is armed next: `time` after it was due, which keeps its
    /// grid. If that is past, it returns `time` from now: missed turns are not made up for all at once.
    [[nodiscard]] constexpr Time after(Duration time) const noexcept {
        const Time on_grid = release + time;
        return on_grid > now ? on_grid : now + time;
    }
};

} // namespace tappet
