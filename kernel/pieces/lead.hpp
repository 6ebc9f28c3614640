// Dead time compensation: predicts where something that moves will be when an actuator acts, and when to
// drive the actuator so that it acts at a position. For angles of a shaft use kernel/cam.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>

namespace tappet {

/// Extrapolates linearly from the last two samples, at most `farthest` from the last one. Samples much closer
/// together than those before count as one: over so short a time, noise gives no usable speed. Real-time.
class Lead {
public:
    constexpr explicit Lead(Duration farthest) noexcept : farthest_{farthest} {}

    /// Takes a value measured at `at`. A value that is not finite, or older than the last one, restarts.
    constexpr void sample(double value, Time at) noexcept TAPPET_REALTIME {
        if (!is_number(value)) return reset();
        if (samples_ > 0 && at > at_) {
            const Duration apart = at - at_;
            if (apart >= usual_ - apart) from_ = value_, from_at_ = at_;
            usual_ = std::max(apart, usual_ / 2);
            per_s_ = (value - from_) / to_seconds(at - from_at_);
            samples_ = 2;
            if (!is_number(per_s_)) begin();
        } else if (samples_ == 0 || at < at_) {
            begin();
        }
        value_ = value;
        at_ = at;
    }
    constexpr void reset() noexcept TAPPET_REALTIME {
        begin();
        samples_ = 0;
    }
    /// Returns whether there are two samples that are not too old.
    [[nodiscard]] constexpr bool good(Time when) const noexcept TAPPET_REALTIME {
        return samples_ == 2 && when - at_ <= farthest_;
    }
    /// Returns the predicted or past value. Beyond `farthest` it stays constant; if the result is not finite,
    /// the last value.
    [[nodiscard]] constexpr double at(Time when) const noexcept TAPPET_REALTIME {
        const Duration ahead = when - at_;
        const double there = value_ + per_s_ * to_seconds(ahead < farthest_ ? ahead : farthest_);
        return is_number(there) ? there : value_;
    }
    /// Returns when to drive an actuator with that dead time so that it acts at `place`; it may be in the
    /// past. never: the value does not reach it, or not within `farthest`.
    [[nodiscard]] constexpr Time drive_at(double place, Duration dead_time) const noexcept TAPPET_REALTIME {
        if (samples_ != 2 || per_s_ == 0.0) return never;
        const double s = (place - value_) / per_s_;
        const double limit = std::min(to_seconds(farthest_), 9.2e9); // of a Duration
        if (!(s >= 0.0 && s <= limit)) return never;
        return at_ + Duration{static_cast<std::int64_t>(s * 1e9 + 0.5)} - dead_time;
    }
    [[nodiscard]] constexpr double per_s() const noexcept TAPPET_REALTIME { return per_s_; }

private:
    /// Restarts with the current sample.
    constexpr void begin() noexcept TAPPET_REALTIME {
        samples_ = 1;
        per_s_ = 0.0;
        usual_ = {};
    }

    Duration farthest_;
    double value_ = 0.0, per_s_ = 0.0;
    Time at_{};
    double from_ = 0.0; ///< value and time of the start of the line
    Time from_at_{};
    Duration usual_{}; ///< interval between samples
    int samples_ = 0;
};

} // namespace tappet
