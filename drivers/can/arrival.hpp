// When a frame arrived, in the machine's time: the kernel stamps frames by the wall clock, which people and
// daemons set.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>

namespace tappet::can {

/// Of one socket. A wall clock that was set since the last frame shows in its distance from the machine's:
/// the frame then counts as arrived now, and what was stamped before it cannot have arrived earlier than
/// that.
class Arrivals {
public:
    /// What a wall clock that is only steered does not differ by between two frames.
    static constexpr Duration most_drift = 1ms;

    /// `wall` and `now` are the two clocks at one time, before the first frame.
    constexpr void begin(Time wall, Time now) noexcept {
        distance_ = wall - now;
        last_ = Time::min();
    }
    /// `stamp` is the frame's by the wall clock; the answer is never before the last one, nor after `now`.
    constexpr Time of(Time stamp, Time wall, Time now) noexcept TAPPET_REALTIME {
        const Duration change = (wall - now) - distance_;
        distance_ += change;
        was_set_ = change > most_drift || change < -most_drift;
        last_ = std::max(last_, was_set_ ? now : std::min(now, now - (wall - stamp)));
        return last_;
    }
    /// The last answer is when it was read, for want of a better one.
    [[nodiscard]] constexpr bool was_set() const noexcept TAPPET_REALTIME { return was_set_; }

private:
    Duration distance_{};
    Time last_ = Time::min();
    bool was_set_ = false;
};

} // namespace tappet::can
