// Arrival time of a frame in the machine's time: the kernel stamps frames by the wall clock, which people and
// daemons set.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>

namespace tappet::can {

/// The arrivals of one socket. A wall clock set since the last frame shows as a change of its distance from
/// the machine's clock: the frame then counts as arrived now, and no later answer is before it.
class Arrivals {
public:
    /// Most drift between two frames of a wall clock that is only steered.
    static constexpr Duration most_drift = 1ms;

    /// Starts with the two clocks read at one time, before the first frame.
    constexpr void begin(Time wall, Time now) noexcept {
        distance_ = wall - now;
        last_ = Time::min();
    }
    /// Returns the arrival time of a frame with this wall clock stamp; never before the last answer, nor
    /// after `now`.
    constexpr Time of(Time stamp, Time wall, Time now) noexcept TAPPET_REALTIME {
        const Duration change = (wall - now) - distance_;
        distance_ += change;
        was_set_ = change > most_drift || change < -most_drift;
        last_ = std::max(last_, was_set_ ? now : std::min(now, now - (wall - stamp)));
        return last_;
    }
    /// Returns true when the last answer is only the time of reading, because the wall clock was set.
    [[nodiscard]] constexpr bool was_set() const noexcept TAPPET_REALTIME { return was_set_; }

private:
    Duration distance_{};
    Time last_ = Time::min();
    bool was_set_ = false;
};

} // namespace tappet::can
