// Estimators for noisy measurements: the alpha-beta estimator of one value and its speed, and the Kalman
// filter of fixed size.
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/motion/positive.hpp"
#include "kernel/motion/refused.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <expected>
#include <limits>
#include <string_view>

namespace tappet::motion {

/// Gains on position and velocity.
struct AlphaBetaGains {
    double alpha = 1.0;
    double beta = 1.0;
    /// Both poles at `memory` in [0, 1): the larger, the smoother and the slower.
    static constexpr AlphaBetaGains critically_damped(double memory) noexcept TAPPET_REALTIME {
        return {1.0 - memory * memory, (1.0 - memory) * (1.0 - memory)};
    }
    /// Gains of the stationary Kalman filter (Kalata 1984): `index` = deviation of the acceleration from
    /// sample to sample * period2 / deviation of the measurement.
    static AlphaBetaGains for_tracking_index(double index) noexcept TAPPET_REALTIME {
        const double r = (4.0 + index - std::sqrt(8.0 * index + index * index)) / 4.0;
        return {1.0 - r * r, 2.0 * (1.0 + r * r) - 4.0 * r};
    }
};

/// Returns the fault and its cure; empty: there is none.
constexpr std::string_view check(const AlphaBetaGains& gains) noexcept TAPPET_REALTIME {
    if (gains.alpha > 0.0 && gains.beta > 0.0 && 2.0 * gains.alpha + gains.beta < 4.0) return {};
    return "these gains are not stable; set alpha and beta positive and 2 alpha + beta below 4";
}

class AlphaBeta {
public:
    /// Contract: the gains are stable.
    explicit constexpr AlphaBeta(AlphaBetaGains gains) noexcept TAPPET_REALTIME : gains_{gains} {
        TAPPET_CONTRACT(check(gains).empty(), Contract::refused_settings);
    }

    static constexpr int most_before = 8;

    /// Takes a value that was measured at `at`. A value that is not finite, or not later than the last one,
    /// is ignored and counted; more than `most_before` in a row that are not later show that the last time
    /// stamp was wrong, and the estimator restarts. Real-time.
    constexpr void sample(double value, Time at) noexcept TAPPET_REALTIME {
        const bool is_before = samples_ > 0 && at <= at_;
        before_ = is_number(value) && is_before ? before_ + 1 : 0;
        if (before_ > most_before) reset();
        if (!is_number(value) || (is_before && before_ <= most_before)) {
            ++refused_;
            return;
        }
        before_ = 0;
        const double h = to_seconds(at - at_);
        // Not by h alone: shortly after the last value, noise gives no usable speed.
        usual_s_ = samples_ < 2 ? h : std::max(h, usual_s_ / 2.0);
        if (samples_ == 0) {
            value_ = value;
        } else if (samples_ == 1) { // two values give no more information
            velocity_ = (value - value_) / h;
            value_ = value;
        } else {
            const double expected = value_ + velocity_ * h;
            value_ = expected + gains_.alpha * (value - expected);
            velocity_ += gains_.beta * (value - expected) / usual_s_;
        }
        at_ = at;
        if (samples_ < 2) ++samples_;
        if (is_number(value_) && is_number(velocity_)) return;
        velocity_ = 0.0; // restarts
        value_ = value;
        samples_ = 1;
    }
    /// Returns whether position and velocity are known: after the second sample.
    [[nodiscard]] constexpr bool good() const noexcept TAPPET_REALTIME { return samples_ == 2; }
    /// Returns the past or future value, linearly extrapolated; if not finite, the last one. Real-time.
    [[nodiscard]] constexpr double at(Time when) const noexcept TAPPET_REALTIME {
        const double there = value_ + velocity_ * to_seconds(when - at_);
        return is_number(there) ? there : value_;
    }
    [[nodiscard]] constexpr double velocity() const noexcept TAPPET_REALTIME { return velocity_; }
    [[nodiscard]] constexpr std::uint32_t refused() const noexcept TAPPET_REALTIME { return refused_; }
    constexpr void reset() noexcept TAPPET_REALTIME {
        samples_ = 0;
        velocity_ = 0.0;
    }

private:
    AlphaBetaGains gains_;
    double value_ = 0.0;
    double velocity_ = 0.0;
    double usual_s_ = 0.0; ///< interval between samples
    Time at_{};
    int samples_ = 0, before_ = 0;
    std::uint32_t refused_ = 0;
};

/// The Kalman filter of `states` numbers, with the covariance in Joseph's form, which stays symmetric and
/// positive. When a number overflows, it restarts from its initial state. Units are the owner's.
template <int states>
class Kalman {
public:
    using State = Eigen::Matrix<double, states, 1>;
    using Covariance = Eigen::Matrix<double, states, states>;

    Kalman(const State& state, const Covariance& covariance) noexcept
        : first_state_(state), first_covariance_(covariance) {}

    /// Predicts one step of time: x = F x + u, with noise of covariance Q. A step with arguments that are not
    /// finite is ignored. Real-time.
    void predict(const Covariance& f, const Covariance& q, const State& u = State::Zero()) noexcept
        TAPPET_REALTIME {
        if (!f.allFinite() || !q.allFinite() || !u.allFinite()) return;
        const Covariance moved = f * covariance_;
        static_cast<void>(take(f * state_ + u, moved * f.transpose() + q));
    }
    /// Updates with a measurement z = H x with noise of covariance R. Returns the squared distance from the
    /// expected value, in deviations; a distance beyond `gate` and a value that is not finite are refused and
    /// change nothing. Real-time.
    template <int values>
    std::expected<double, Refused> update(const Eigen::Matrix<double, values, 1>& z,
                                          const Eigen::Matrix<double, values, states>& h,
                                          const Eigen::Matrix<double, values, values>& r,
                                          double gate = std::numeric_limits<double>::infinity()) noexcept
        TAPPET_REALTIME {
        for (int i = 0; i < values; ++i)
            if (!is_number(z[i])) return std::unexpected(Refused{Refusal::not_a_number, i});
        const Eigen::Matrix<double, values, 1> surprise = z - h * state_;
        const Eigen::Matrix<double, values, states> spread = h * covariance_;
        const Eigen::Matrix<double, values, values> total = spread * h.transpose() + r;
        Eigen::Matrix<double, values, states + 1> solved;
        solved.template leftCols<states>() = spread;
        solved.template rightCols<1>() = surprise;
        if (!solve_positive(total, solved)) return std::unexpected(Refused{Refusal::not_positive});
        double distance = surprise.dot(solved.template rightCols<1>());
        if (!is_number(distance)) distance = std::numeric_limits<double>::max(); // its square overflows
        if (!(distance <= gate)) return std::unexpected(Refused{Refusal::outlier});
        const Eigen::Matrix<double, states, values> gain = solved.template leftCols<states>().transpose();
        const Covariance rest = Covariance::Identity() - gain * h;
        const Covariance kept = rest * covariance_ * rest.transpose();
        const Covariance added = gain * r * gain.transpose();
        const Covariance sum = kept + added;
        if (!take(state_ + gain * surprise, 0.5 * (sum + sum.transpose())))
            return std::unexpected(Refused{Refusal::not_a_number});
        return distance;
    }
    [[nodiscard]] const State& state() const noexcept TAPPET_REALTIME { return state_; }
    [[nodiscard]] const Covariance& covariance() const noexcept TAPPET_REALTIME { return covariance_; }

private:
    bool take(const State& state, const Covariance& covariance) noexcept TAPPET_REALTIME {
        const bool is_good = state.allFinite() && covariance.allFinite();
        state_ = is_good ? state : first_state_;
        covariance_ = is_good ? covariance : first_covariance_;
        return is_good;
    }

    State first_state_, state_ = first_state_;
    Covariance first_covariance_, covariance_ = first_covariance_;
};

} // namespace tappet::motion
