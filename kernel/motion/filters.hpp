// Linear filters of one signal: low passes, a notch and lead-lag compensation.
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/motion/refused.hpp"
#include "kernel/motion/sine.hpp"

#include <algorithm>
#include <cstdint>
#include <expected>

namespace tappet::motion {

/// First order, 1 / (1 + T s), by the backward difference: stable for any step; a negative step is ignored.
/// The output starts at the first value; a value that is not finite is ignored. When the sum overflows, the
/// filter restarts with the value. T of zero or less does not filter. Real-time.
class LowPass {
public:
    explicit constexpr LowPass(Duration time_constant) noexcept : constant_s_{to_seconds(time_constant)} {}
    constexpr double operator()(double value, Duration step) noexcept TAPPET_REALTIME {
        if (!is_number(value)) return value_;
        const double h = std::max(to_seconds(step), 0.0);
        value_ = !known_ || !(constant_s_ > 0.0) ? value : value_ + (value - value_) * h / (constant_s_ + h);
        if (!is_number(value_)) value_ = value;
        known_ = true;
        return value_;
    }
    constexpr void reset() noexcept TAPPET_REALTIME { known_ = false; }

private:
    double constant_s_;
    double value_ = 0.0;
    bool known_ = false;
};

/// (1 + T1 s) / (1 + T2 s), by Tustin's rule: T1 above T2 leads, below it lags. Starts settled at the first
/// value; a value that is not finite is ignored, and a sum that overflows restarts the filter. A negative
/// step is ignored. Real-time.
class LeadLag {
public:
    /// Contract: `lag` is positive, `lead` is not negative.
    constexpr LeadLag(Duration lead, Duration lag) noexcept TAPPET_REALTIME : lead_s_{to_seconds(lead)},
                                                                              lag_s_{to_seconds(lag)} {
        TAPPET_CONTRACT(lag > Duration::zero(), Contract::precondition, lag);
        TAPPET_CONTRACT(lead >= Duration::zero(), Contract::precondition, lead);
    }
    constexpr double operator()(double value, Duration step) noexcept TAPPET_REALTIME {
        if (!is_number(value)) return value_;
        if (!known_) before_ = value_ = value;
        known_ = true;
        const double h = std::max(to_seconds(step), 0.0);
        value_ = ((2.0 * lead_s_ + h) * value + (h - 2.0 * lead_s_) * before_ - (h - 2.0 * lag_s_) * value_) /
                 (2.0 * lag_s_ + h);
        if (!is_number(value_)) value_ = value;
        before_ = value;
        return value_;
    }
    constexpr void reset() noexcept TAPPET_REALTIME { known_ = false; }

private:
    double lead_s_;
    double lag_s_;
    double before_ = 0.0;
    double value_ = 0.0;
    bool known_ = false;
};

/// Second order at a fixed sampling period, by Tustin's rule with exact corner frequency (transposed direct
/// form II). Starts settled at the first value; a value that is not finite is ignored, and after a sum that
/// overflows the next value restarts the filter.
class Biquad {
public:
    /// -3 dB at the corner with the usual damping of sqrt(1/2) (Butterworth).
    static constexpr std::expected<Biquad, Refused> low_pass(double corner_hz, Duration period,
                                                             double damping = 0.70710678118654752) noexcept
        TAPPET_REALTIME {
        const auto warped = warp(corner_hz, period);
        if (!warped) return std::unexpected(warped.error());
        const double k = *warped;
        const double a0 = 1.0 + 2.0 * damping * k + k * k;
        if (!(damping > 0.0) || !is_number(a0))
            return std::unexpected(Refused{Refusal::limit_not_positive, 2});
        return Biquad{k * k / a0, 2.0 * k * k / a0, k * k / a0, 2.0 * (k * k - 1.0) / a0,
                      (1.0 - 2.0 * damping * k + k * k) / a0};
    }
    /// Removes `centre_hz`; -3 dB over a band of about `width_hz`.
    static constexpr std::expected<Biquad, Refused> notch(double centre_hz, double width_hz,
                                                          Duration period) noexcept TAPPET_REALTIME {
        const auto warped = warp(centre_hz, period);
        if (!warped) return std::unexpected(warped.error());
        const double k = *warped;
        const double wide = k * width_hz / centre_hz;
        const double a0 = 1.0 + wide + k * k;
        if (!(width_hz > 0.0) || !is_number(a0))
            return std::unexpected(Refused{Refusal::limit_not_positive, 1});
        return Biquad{(1.0 + k * k) / a0, 2.0 * (k * k - 1.0) / a0, (1.0 + k * k) / a0,
                      2.0 * (k * k - 1.0) / a0, (1.0 - wide + k * k) / a0};
    }
    /// Filters one value each period. Real-time.
    constexpr double operator()(double value) noexcept TAPPET_REALTIME {
        if (!is_number(value)) return value_;
        if (!known_) { // both have a gain of 1 at standstill
            second_ = (b2_ - a2_) * value;
            first_ = (b1_ - a1_) * value + second_;
        }
        value_ = b0_ * value + first_;
        first_ = b1_ * value - a1_ * value_ + second_;
        second_ = b2_ * value - a2_ * value_;
        if (!is_number(value_)) value_ = value;
        known_ = is_number(first_) && is_number(second_);
        return value_;
    }
    constexpr void reset() noexcept TAPPET_REALTIME { known_ = false; }

private:
    constexpr Biquad(double b0, double b1, double b2, double a1, double a2) noexcept TAPPET_REALTIME
        : b0_{b0},
          b1_{b1},
          b2_{b2},
          a1_{a1},
          a2_{a2} {}
    static constexpr std::expected<double, Refused> warp(double hz, Duration period) noexcept
        TAPPET_REALTIME {
        const double turns = hz * to_seconds(period);
        if (!(hz > 0.0 && turns > 0.0 && turns < 0.5))
            return std::unexpected(Refused{Refusal::beyond_half_rate});
        const auto [sine, cosine] = sine_cosine_of_degrees(180.0 * turns);
        return sine / cosine;
    }

    double b0_, b1_, b2_, a1_, a2_;
    double first_ = 0.0, second_ = 0.0, value_ = 0.0;
    bool known_ = false;
};

} // namespace tappet::motion
