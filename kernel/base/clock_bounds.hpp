// Certain bounds, not an estimate, of how far another clock is ahead of this machine's clock.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>

namespace tappet {

/// Two bounds, which widen as time passes by as much as the two clocks may drift. Real-time.
class ClockBounds {
public:
    /// Returns how far two clocks may drift apart in that time, rounded upwards. `drift`: seconds per second.
    [[nodiscard]] static Duration parted(Duration time, double drift) noexcept TAPPET_REALTIME {
        return time > Duration::zero()
                   ? Duration{static_cast<std::int64_t>(static_cast<double>(time.count()) * drift) + 1}
                   : Duration::zero();
    }
    /// Widens the bounds. `now`: of this machine's clock.
    void age(Time now, double drift) noexcept TAPPET_REALTIME {
        const Duration wider = parted(now - at_, drift);
        if (known_) least_ -= wider, most_ += wider;
        at_ = now;
    }
    /// Adds two bounds, which both hold at the time of the last age(). If they exclude the known range it is
    /// another clock, and they replace it. If they exclude each other they have no effect.
    void narrow(Duration least, Duration most) noexcept TAPPET_REALTIME {
        if (!known_ || least > most || excludes(least, most)) return replace(least, most);
        least_ = std::max(least_, least);
        most_ = std::min(most_, most);
    }
    /// Replaces the bounds: it is unknown whether it is the same clock.
    void replace(Duration least, Duration most) noexcept TAPPET_REALTIME {
        if (least > most) return;
        jumps_ += known_ && excludes(least, most) ? 1 : 0;
        least_ = least, most_ = most;
        known_ = true;
    }
    [[nodiscard]] bool known() const noexcept TAPPET_REALTIME { return known_; }
    /// Returns how far the other clock is ahead of this machine's clock, within error().
    [[nodiscard]] Duration ahead() const noexcept TAPPET_REALTIME { return least_ + error(); }
    [[nodiscard]] Duration error() const noexcept TAPPET_REALTIME { return (most_ - least_ + 1ns) / 2; }
    /// Returns how many times it cannot have been the clock known before.
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
