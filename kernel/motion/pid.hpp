// The PID controller with the additions of practice: set point weights, a filtered derivative, limits without
// wind-up, feed-forward and bumpless transfer (Astrom and Hagglund, Advanced PID Control, 2006, chapters 3
// and 13).
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/motion/refused.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>

namespace tappet::motion {

/// Gains in units of the output per unit of the error.
struct PidGains {
    double proportional = 0.0;
    double integral = 0.0;   ///< per second
    double derivative = 0.0; ///< per unit per second
    /// Time constant of the filter on the derivative, s; zero: none.
    double derivative_filter_s = 0.0;
    /// Weight of the set point in the proportional part: below one it reduces overshoot.
    double set_point_weight = 1.0;
    /// Weight of the set point in the derivative: with zero a step of the set point gives no kick.
    double derivative_weight = 0.0;
    /// Time in which the integral follows an output cut by the limits, s. Zero: it stops in the meantime.
    double tracking_s = 0.0;
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    /// Smaller errors count as zero, in both directions.
    double dead_band = 0.0;
};

/// Returns the fault and its cure; empty: there is none.
constexpr std::string_view check(const PidGains& gains) noexcept TAPPET_REALTIME {
    for (const double value :
         {gains.proportional, gains.integral, gains.derivative, gains.derivative_filter_s,
          gains.set_point_weight, gains.derivative_weight, gains.tracking_s, gains.dead_band})
        if (!is_number(value)) return "a gain is not a finite number; write one";
    if (gains.derivative_filter_s < 0.0 || gains.tracking_s < 0.0)
        return "a time constant is negative; write 0 for none";
    if (!(gains.lowest < gains.highest))
        return "the output limits are an empty range; set lowest below highest";
    if (gains.dead_band < 0.0) return "the dead band is negative; write 0 for none";
    return {};
}

class Pid {
public:
    /// Contract: check(gains) is empty. For constants the compiler checks it.
    explicit constexpr Pid(const PidGains& gains) noexcept TAPPET_REALTIME { tune(gains); }

    /// Executes one step of the loop: returns the output including the feed-forward. An argument that is not
    /// finite, or a step that is not positive, changes nothing and is counted. Between two limits, one step
    /// changes the integral or the derivative by at most their distance. An integral beyond a limit, from
    /// track() or large parts of opposite sign, returns in the step whose output that limit cuts: as far as
    /// it caused the cut, and no further than the limit. Real-time.
    constexpr double operator()(double set_point, double measured, Duration step,
                                double feed_forward = 0.0) noexcept TAPPET_REALTIME {
        const double h = to_seconds(step);
        if (!is_number(set_point) || !is_number(measured) || !is_number(feed_forward) || !(h > 0.0)) {
            ++refused_;
            return output_;
        }
        const double error = beyond_dead_band(set_point - measured);
        derive(set_point, measured, h);
        double wanted = proportional(set_point, measured) + integral_ + derivative_ + feed_forward;
        if (!is_number(wanted)) { // the sum of finite numbers may overflow
            reset();
            return output_;
        }
        put_out(wanted);
        wanted = unwind(wanted);
        const double grows = within_span(gains_.integral * error * h);
        const double cut = within_span(output_ - wanted);
        const bool is_far = cut != output_ - wanted, winds_up = cut * grows < 0.0;
        step_s_ = h;
        if (gains_.tracking_s > 0.0)
            add(within_span((is_far && winds_up ? 0.0 : grows) + cut * share()));
        else if (!winds_up)
            add(grows);
        return output_;
    }
    /// Reports the actuator's value for the last output, when limits behind this controller cut it. Needs
    /// tracking_s. Real-time.
    constexpr void applied(double actual) noexcept TAPPET_REALTIME {
        if (!is_number(actual))
            ++refused_;
        else if (gains_.tracking_s > 0.0)
            add(within_span(actual - output_) * share());
    }
    /// Follows while another source drives with `actual`: the next step continues from there without a bump,
    /// however far the set point is. Once it is near, the integral is between the limits in one step.
    /// Real-time.
    constexpr void track(double set_point, double measured, double actual, double feed_forward = 0.0) noexcept
        TAPPET_REALTIME {
        if (!is_number(set_point) || !is_number(measured) || !is_number(actual) || !is_number(feed_forward)) {
            ++refused_;
            return;
        }
        derivative_ = 0.0;
        seen_ = gains_.derivative_weight * set_point - measured;
        has_seen_ = true;
        integral_ = actual - proportional(set_point, measured) - feed_forward;
        if (!is_number(integral_)) integral_ = 0.0;
        put_out(actual);
    }
    constexpr void reset() noexcept TAPPET_REALTIME {
        integral_ = derivative_ = 0.0;
        put_out(0.0);
        has_seen_ = false;
    }
    /// Changes the gains; only the proportional part of the output may jump. Contract: as above. Real-time.
    constexpr void tune(const PidGains& gains) noexcept TAPPET_REALTIME {
        TAPPET_CONTRACT(check(gains).empty(), Contract::refused_settings);
        gains_ = gains;
        put_out(output_);
    }

    [[nodiscard]] constexpr double output() const noexcept TAPPET_REALTIME { return output_; }
    [[nodiscard]] constexpr double integral() const noexcept TAPPET_REALTIME { return integral_; }
    /// Returns how many calls were refused since the beginning.
    [[nodiscard]] constexpr std::uint32_t refused() const noexcept TAPPET_REALTIME { return refused_; }

private:
    constexpr void put_out(double wanted) noexcept TAPPET_REALTIME {
        output_ = std::clamp(wanted, gains_.lowest, gains_.highest);
    }
    [[nodiscard]] constexpr double beyond_dead_band(double error) const noexcept TAPPET_REALTIME {
        const double band = gains_.dead_band;
        return error > band ? error - band : error < -band ? error + band : 0.0;
    }
    [[nodiscard]] constexpr double proportional(double set_point, double measured) const noexcept
        TAPPET_REALTIME {
        return gains_.proportional * beyond_dead_band(gains_.set_point_weight * set_point - measured);
    }
    /// Removes from the integral the excess beyond a limit; returns the sum without it.
    [[nodiscard]] constexpr double unwind(double wanted) noexcept TAPPET_REALTIME {
        const double before = integral_;
        if (wanted < gains_.lowest && integral_ < gains_.lowest)
            integral_ = std::min(gains_.lowest, integral_ + (gains_.lowest - wanted));
        else if (wanted > gains_.highest && integral_ > gains_.highest)
            integral_ = std::max(gains_.highest, integral_ + (gains_.highest - wanted));
        return wanted + (integral_ - before);
    }
    /// Returns 0 for a value that is not finite.
    [[nodiscard]] constexpr double within_span(double value) const noexcept TAPPET_REALTIME {
        const double span = gains_.highest - gains_.lowest;
        return value != value ? 0.0 : std::clamp(value, -span, span);
    }
    constexpr void add(double to_integral) noexcept TAPPET_REALTIME {
        if (const double sum = integral_ + to_integral; is_number(sum)) integral_ = sum;
    }
    [[nodiscard]] constexpr double share() const noexcept TAPPET_REALTIME {
        return std::min(1.0, step_s_ / gains_.tracking_s);
    }
    /// Backward difference, which is stable for any step.
    constexpr void derive(double set_point, double measured, double h) noexcept TAPPET_REALTIME {
        const double now = gains_.derivative_weight * set_point - measured;
        const double filter = gains_.derivative_filter_s;
        const double moved = has_seen_ ? now - seen_ : 0.0;
        derivative_ = within_span((filter * derivative_ + gains_.derivative * moved) / (filter + h));
        seen_ = now;
        has_seen_ = true;
    }

    PidGains gains_;
    double integral_ = 0.0;
    double derivative_ = 0.0;
    double seen_ = 0.0;
    double output_ = 0.0;
    double step_s_ = 0.0;
    bool has_seen_ = false;
    std::uint32_t refused_ = 0;
};

} // namespace tappet::motion
