// The PID controller with what practice adds to it: weights of the set point, a filtered derivative, limits
// without wind-up, feed-forward and a change of hands without a bump (Astrom and Hagglund, Advanced PID
// Control, 2006, chapters 3 and 13).
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

/// Gains in units of the output for one unit of the error.
struct PidGains {
    double proportional = 0.0;
    double integral = 0.0;   ///< for each second
    double derivative = 0.0; ///< for one unit a second
    /// Time constant of the filter on the derivative, s; nought: none.
    double derivative_filter_s = 0.0;
    /// The share of the set point in the proportional part: below one there is less overshoot.
    double set_point_weight = 1.0;
    /// The share in the derivative: with nought a step of the set point gives no kick.
    double derivative_weight = 0.0;
    /// In which time the integral lets go of what the limits cut off, s. Nought: it stands still meanwhile.
    double tracking_s = 0.0;
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    /// An error up to here, either way, is none.
    double dead_band = 0.0;
};

/// Empty, or what is wrong with them and the cure.
constexpr std::string_view check(const PidGains& gains) noexcept TAPPET_REALTIME {
    for (const double value :
         {gains.proportional, gains.integral, gains.derivative, gains.derivative_filter_s,
          gains.set_point_weight, gains.derivative_weight, gains.tracking_s, gains.dead_band})
        if (!is_number(value)) return "a gain is no number; write one";
    if (gains.derivative_filter_s < 0.0 || gains.tracking_s < 0.0)
        return "a time constant is negative; write nought for none";
    if (!(gains.lowest < gains.highest))
        return "the limits of the output hold nothing; let lowest be below highest";
    if (gains.dead_band < 0.0) return "the dead band is negative; write nought for none";
    return {};
}

class Pid {
public:
    /// Contract: check(gains) is empty. Of constants the compiler sees it.
    explicit constexpr Pid(const PidGains& gains) noexcept TAPPET_REALTIME { tune(gains); }

    /// One step of the loop: what to put out, with what is known beforehand added. What is no number leaves
    /// everything as it was and counts, as does a step that is not positive. Between two limits nothing moves
    /// the integral or the derivative by more than their distance in one step. An integral beyond a limit,
    /// from track() or large parts of opposite sign, returns in the step whose output that limit cuts: as far
    /// as it caused the cut, and no further than the limit. Real-time.
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
        if (!is_number(wanted)) { // of numbers that are no more when they are added
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
    /// What the actuator did with the last output, when limits behind this one cut it. Needs tracking_s.
    /// Real-time.
    constexpr void applied(double actual) noexcept TAPPET_REALTIME {
        if (!is_number(actual))
            ++refused_;
        else if (gains_.tracking_s > 0.0)
            add(within_span(actual - output_) * share());
    }
    /// Somebody else drives, with `actual`: the next step goes on from there without a bump, however far the
    /// set point is. Once it is near, the integral is between the limits in one step. Real-time.
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
    /// Other gains; the output does not jump but by the proportional part. Contract: as above. Real-time.
    constexpr void tune(const PidGains& gains) noexcept TAPPET_REALTIME {
        TAPPET_CONTRACT(check(gains).empty(), Contract::refused_settings);
        gains_ = gains;
        put_out(output_);
    }

    [[nodiscard]] constexpr double output() const noexcept TAPPET_REALTIME { return output_; }
    [[nodiscard]] constexpr double integral() const noexcept TAPPET_REALTIME { return integral_; }
    /// Calls that were refused since the beginning.
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
    /// Takes out of the integral what it asks for beyond a limit, and returns the sum without that.
    [[nodiscard]] constexpr double unwind(double wanted) noexcept TAPPET_REALTIME {
        const double before = integral_;
        if (wanted < gains_.lowest && integral_ < gains_.lowest)
            integral_ = std::min(gains_.lowest, integral_ + (gains_.lowest - wanted));
        else if (wanted > gains_.highest && integral_ > gains_.highest)
            integral_ = std::max(gains_.highest, integral_ + (gains_.highest - wanted));
        return wanted + (integral_ - before);
    }
    /// What is no number is nothing.
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
    /// By the backward difference, which is stable for any step.
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
