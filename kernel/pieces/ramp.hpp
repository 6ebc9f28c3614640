// A set point that follows its target no faster than it may.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

namespace tappet {

/// In units a second; a rate that is not positive, or no number, moves nothing that way. Real-time.
class Ramp {
public:
    constexpr Ramp(double up_per_s, double down_per_s, double begins_at = 0.0) noexcept
        : up_{up_per_s}, down_{down_per_s}, value_{begins_at} {}
    constexpr explicit Ramp(double per_s) noexcept : Ramp{per_s, per_s} {}

    /// One step towards the target, which it reaches and does not pass. What is no number is no target.
    constexpr double operator()(double target, Duration step) noexcept TAPPET_REALTIME {
        if (!is_number(target)) return value_;
        const double s = to_seconds(step);
        if (target > value_ && up_ > 0)
            value_ = target - value_ <= up_ * s ? target : value_ + up_ * s;
        else if (target < value_ && down_ > 0)
            value_ = value_ - target <= down_ * s ? target : value_ - down_ * s;
        return value_;
    }
    constexpr void reset(double value) noexcept TAPPET_REALTIME { value_ = value; }
    [[nodiscard]] constexpr double value() const noexcept TAPPET_REALTIME { return value_; }

private:
    double up_, down_;
    double value_;
};

} // namespace tappet
