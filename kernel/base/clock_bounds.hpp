// How far another clock is ahead of the own one: what is certain, not what is likely.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>

namespace tappet {

/// Between two bounds, which widen as time passes by as much as the two clocks may drift. Real-time.
class ClockBounds {
public:
    /// What two clocks may part in that time, rounded upwards. `drift`: seconds in a second.
    [[nodiscard]] static Duration parted(Duration time, double drift) noexcept TAPPET_REALTIME {
        return time > Duration::zero()
                   ? Duration{static_cast<std::int64_t>(static_cast<double>(time.count()) * drift) + 1}
                   : Duration::zero();
    }
    /// `now`: of the own clock.
    void age(Time now, double drift) noexcept TAPPET_REALTIME {
        const Duration wider = parted(now - at_, drift);
        if (known_) least_ -= wider, most_ += wider;
        at_ = now;
    }
    /// Both hold at the time of the last age(). Where they exclude what is known it is another clock; where
    /// they exclude each other they tell of none.
    void narrow(Duration least, Duration most) noexcept TAPPET_REALTIME {
        if (!known_ || least > most || excludes(least, most)) return replace(least, most);
        least_ = std::max(least_, least);
        most_ = std::min(most_, most);
    }
    /// Only the new ones hold: nobody knows whether it is the same clock.
    void replace(Duration least, Duration most) noexcept TAPPET_REALTIME {
        if (least > most) return;
        jumps_ += known_ && excludes(least, most) ? 1 : 0;
        least_ = least, most_ = most;
        known_ = true;
    }
    [[nodiscard]] bool known() const noexcept TAPPET_REALTIME { return known_; }
    /// Of the other clock against the own one, give or take error().
    [[nodiscard]] Duration ahead() const noexcept TAPPET_REALTIME { return least_ + error(); }
    [[nodiscard]] Duration error() const noexcept TAPPET_REALTIME { return (most_ - least_ + 1ns) / 2; }
    /// Times that it cannot have been the clock that was known before.
    [[nodiscard]] std::int64_t jumps() const noexcept TAPPET_REALTIME { return jumps_; }

private:
    [[nodiscard]] bool excludes(Duration least, Duration most) const noexcept TAPPET_REALTIME {
        return most < least_ || least > most_;
    }

    bool known_ = false;
    Duration least_{}, most_{};
    Time at_{};
    std::int64_t jumps_ = 0;
};

} // namespace tappet
