// A set point that follows its target at a limited rate.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>

namespace tappet {

/// Rates in units per second; a rate that is not positive, or NaN, allows no motion in that direction; an
/// infinite rate jumps. Real-time.
class Ramp {
public:
    constexpr Ramp(double up_per_s, double down_per_s, double begins_at = 0.0) noexcept
        : up_{up_per_s}, down_{down_per_s} {
        reset(begins_at);
    }
    constexpr explicit Ramp(double per_s) noexcept : Ramp{per_s, per_s} {}

    /// Makes one step towards the target without overshoot. A target that is not finite and a negative step
    /// are ignored.
    constexpr double operator()(double target, Duration step) noexcept TAPPET_REALTIME {
        if (!is_number(target)) return value_;
        const double s = std::max(to_seconds(step), 0.0);
        if (target > value_ && up_ > 0)
            value_ = target - value_ > up_ * s ? value_ + up_ * s : target;
        else if (target < value_ && down_ > 0)
            value_ = value_ - target > down_ * s ? value_ - down_ * s : target;
        return value_;
    }
    /// Ignores a value that is not finite.
    constexpr void reset(double value) noexcept TAPPET_REALTIME {
        if (is_number(value)) value_ = value;
    }
    [[nodiscard]] constexpr double value() const noexcept TAPPET_REALTIME { return value_; }

private:
    double up_, down_;
    double value_ = 0.0;
};

} // namespace tappet
