// The integral over time of a sampled value: litres from litres per second.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <limits>

namespace tappet {

/// Trapezoidal rule between samples, clamped to its limits. Real-time.
class Integrator {
public:
    constexpr Integrator() noexcept = default;
    constexpr Integrator(double low, double high) noexcept : low_{low}, high_{high} { reset(); }

    /// Adds a value per second that was measured at `at`. The first value, one that is not finite and one
    /// older than the last restart the integral and add nothing; a value that would make the sum infinite
    /// adds nothing either.
    constexpr double operator()(double per_s, Time at) noexcept TAPPET_REALTIME {
        const bool is_good = is_number(per_s);
        if (known_ && is_good && at > at_)
            hold(value_ + (0.5 * per_s + 0.5 * before_) * to_seconds(at - at_));
        known_ = is_good;
        before_ = per_s;
        at_ = at;
        return value_;
    }
    /// Omits the time until the next sample: call it when the value was not good.
    constexpr void pause() noexcept TAPPET_REALTIME { known_ = false; }
    /// Ignores a value that is not finite.
    constexpr void reset(double value = 0.0) noexcept TAPPET_REALTIME {
        hold(value);
        known_ = false;
    }
    [[nodiscard]] constexpr double value() const noexcept TAPPET_REALTIME { return value_; }

private:
    constexpr void hold(double sum) noexcept TAPPET_REALTIME {
        if (is_number(sum)) value_ = sum < low_ ? low_ : sum > high_ ? high_ : sum;
    }

    double low_ = -std::numeric_limits<double>::infinity();
    double high_ = std::numeric_limits<double>::infinity();
    double value_ = 0.0, before_ = 0.0;
    Time at_{};
    bool known_ = false;
};

} // namespace tappet
