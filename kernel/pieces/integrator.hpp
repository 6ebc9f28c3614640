// The integral over time of a value that is sampled: litres from litres a second.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <limits>

namespace tappet {

/// By trapezia between samples, held between its limits. Real-time.
class Integrator {
public:
    constexpr Integrator() noexcept = default;
    constexpr Integrator(double low, double high) noexcept : low_{low}, high_{high} { reset(); }

    /// A value a second that was true at `at`. The first one, one that is no number and one that is older
    /// than the last one begin anew and add nothing; nor does what would make the sum no number.
    constexpr double operator()(double per_s, Time at) noexcept TAPPET_REALTIME {
        const bool is_good = is_number(per_s);
        if (known_ && is_good && at > at_)
            hold(value_ + (0.5 * per_s + 0.5 * before_) * to_seconds(at - at_));
        known_ = is_good;
        before_ = per_s;
        at_ = at;
        return value_;
    }
    /// What is missing between two samples is left out: call it when the value was not good.
    constexpr void pause() noexcept TAPPET_REALTIME { known_ = false; }
    /// Ignores a value that is no number.
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
