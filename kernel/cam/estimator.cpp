// The Kalman filter of ShaftEstimator, with Eigen's fixed-size matrices.
#include "kernel/cam/estimator.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace tappet {

namespace {

using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;

// White noise jerk of density 1 over dt, on position, velocity and acceleration.
Matrix jerk_noise(double dt) noexcept TAPPET_REALTIME {
    const double t2 = dt * dt;
    const double t3 = t2 * dt;
    Matrix noise;
    noise(0, 0) = t3 * t2 / 20.0;
    noise(0, 1) = noise(1, 0) = t2 * t2 / 8.0;
    noise(0, 2) = noise(2, 0) = t3 / 6.0;
    noise(1, 1) = t3 / 3.0;
    noise(1, 2) = noise(2, 1) = t2 / 2.0;
    noise(2, 2) = dt;
    return noise;
}

double clamp(double value, double limit) noexcept TAPPET_REALTIME {
    return std::max(-limit, std::min(limit, value));
}

// Deviations from which a sample shows that the shaft accelerates, and from which it is an outlier.
constexpr double manoeuvre_deviations = 3.5;
constexpr double outlier_deviations = 6.0;
static_assert(
    manoeuvre_deviations * manoeuvre_deviations > 12.0,
    "at a beat of speed and samples the rounding jumps by a whole code, sqrt(12) of its deviations");
static_assert(outlier_deviations > manoeuvre_deviations,
              "a manoeuvre is followed before a sample is refused");

} // namespace

ShaftEstimator::ShaftEstimator(const ShaftProperties& properties) noexcept TAPPET_REALTIME
    : properties_(properties),
      step_deg_(360.0 / properties.codes_per_turn),
      step_variance_(step_deg_* step_deg_ / 12.0),
      jitter_s_(to_seconds(properties.stamp_jitter)) {
    motion_.horizon_s = to_seconds(properties.acceleration_horizon);
}

double ShaftEstimator::deviation_deg() const noexcept TAPPET_REALTIME { return std::sqrt(covariance_[0]); }

void ShaftEstimator::sample(std::uint32_t code, Time stamp) noexcept TAPPET_REALTIME {
    if (code >= properties_.codes_per_turn) {
        ++counters_.bad_code;
        return;
    }
    Reading now;
    now.code = code;
    now.centre = properties_.zero + Rotation::units(static_cast<std::int64_t>(
                                        ((std::uint64_t{code} * 2 + 1) << 31) / properties_.codes_per_turn));
    now.stamp = stamp - properties_.stamp_latency;
    if (settled_ == 0) {
        motion_.state.position = ShaftPosition{0, now.centre};
        start(now);
        return;
    }
    if (now.stamp <= last_.stamp || (suspected_in_a_row_ != 0 && now.stamp <= suspected_.stamp)) {
        ++counters_.out_of_order;
        return;
    }
    const bool same_rest = standing_ && at_rest_codes(code);
    if (!same_rest && now.stamp - last_.stamp > properties_.lost_after) {
        ++counters_.gaps;
        reset(now);
        return;
    }
    if (!reachable(last_, now)) {
        suspect(now);
        return;
    }
    suspected_in_a_row_ = 0;
    if (same_rest) {
        ++counters_.accepted;
        last_ = now;
        motion_.stamp = now.stamp;
        return;
    }
    filter(now);
}

bool ShaftEstimator::reachable(const Reading& from, const Reading& to) const noexcept TAPPET_REALTIME {
    const double dt = to_seconds(to.stamp - from.stamp) + 4.0 * jitter_s_;
    const double way = std::fabs((to.centre - from.centre).in_degrees());
    return way <= properties_.max_speed.in_deg_s() * dt + 1.5 * step_deg_;
}

void ShaftEstimator::start(const Reading& now) noexcept TAPPET_REALTIME {
    rest_deg_ = 0.0;
    motion_.stamp = now.stamp;
    motion_.state.velocity_deg_s = 0.0;
    motion_.state.acceleration_deg_s2 = 0.0;
    open(0.5 * properties_.max_speed.in_deg_s());
    last_ = now;
    rest_codes_ = {now.code, now.code};
    rest_since_ = now.stamp;
    standing_ = false;
    suspected_in_a_row_ = outliers_in_a_row_ = 0;
    settled_ = 1;
    ++counters_.accepted;
}

void ShaftEstimator::reset(const Reading& now) noexcept TAPPET_REALTIME {
    // Selects the turn nearest to the predicted position.
    const ShaftPosition expected = motion_.at(now.stamp).position;
    motion_.state.position = expected + (now.centre - expected.angle());
    ++counters_.resets;
    ++epoch_;
    start(now);
}

void ShaftEstimator::suspect(const Reading& now) noexcept TAPPET_REALTIME {
    ++counters_.implausible;
    fault_ = true;
    suspected_in_a_row_ =
        suspected_in_a_row_ != 0 && reachable(suspected_, now) ? suspected_in_a_row_ + 1 : 1;
    suspected_ = now;
    if (suspected_in_a_row_ == agreeing_jumps) reset(now);
}

void ShaftEstimator::open(double velocity_deviation) noexcept TAPPET_REALTIME {
    Eigen::Map<Matrix> covariance{covariance_.data()};
    const double acceleration_deviation = properties_.max_acceleration_deg_s2 / 3.0;
    covariance.setZero();
    covariance(0, 0) = step_variance_;
    covariance(1, 1) = velocity_deviation * velocity_deviation;
    covariance(2, 2) = acceleration_deviation * acceleration_deviation;
}

void ShaftEstimator::filter(const Reading& now) noexcept TAPPET_REALTIME {
    Eigen::Map<Matrix> covariance{covariance_.data()};
    const double dt = to_seconds(now.stamp - last_.stamp);
    if (standing_) { // off again: as fast as one sample's acceleration and a creep below standing_'s
                     // threshold
        standing_ = false;
        open(properties_.max_acceleration_deg_s2 * dt + step_deg_ / to_seconds(properties_.standstill_after));
    }
    Matrix step = Matrix::Identity();
    step(0, 1) = step(1, 2) = dt;
    step(0, 2) = 0.5 * dt * dt;
    Vector state{rest_deg_, motion_.state.velocity_deg_s, motion_.state.acceleration_deg_s2};
    const Vector predicted = step * state;
    const Matrix noise = jerk_noise(dt) * properties_.jerk_density;
    const Matrix stepped = step * covariance;
    Matrix spread = stepped * step.transpose() + noise;

    const double blur = predicted(1) * jitter_s_;
    const double measure_variance = step_variance_ + blur * blur;
    const ShaftPosition from = motion_.state.position;
    const Angle expected = (from + Rotation::degrees(predicted(0))).angle();
    const double surprise = (now.centre - expected).in_degrees();
    double total = spread(0, 0) + measure_variance;
    if (surprise * surprise > manoeuvre_deviations * manoeuvre_deviations * total) {
        spread += noise * (properties_.manoeuvre_gain - 1.0);
        total = spread(0, 0) + measure_variance;
        const double pushed = properties_.max_acceleration_deg_s2 * dt * dt;
        const bool outlier = std::fabs(surprise) > outlier_deviations * std::sqrt(total) + pushed;
        if (outlier && outliers_in_a_row_ == 0) {
            ++counters_.outliers;
            outliers_in_a_row_ = 1;
            return;
        }
        if (outlier) { // it persists: the shaft does what was ruled out, so the estimate is void
            open(0.5 * properties_.max_speed.in_deg_s());
            spread = covariance;
            spread(0, 0) += surprise * surprise;
            total = spread(0, 0) + measure_variance;
        }
    }
    outliers_in_a_row_ = 0;
    const Vector gain = spread.col(0) / total;
    state = predicted + gain * surprise;
    covariance = spread - total * (gain * gain.transpose());

    // A code is a bound, not only a measurement: the shaft was within it, apart from the stamp's jitter.
    const double centre = predicted(0) + surprise;
    const double bound = 0.5 * step_deg_ + 2.0 * std::fabs(state(1)) * jitter_s_;
    state(0) = centre + clamp(state(0) - centre, bound);
    const double limit = properties_.max_speed.in_deg_s();
    motion_.state.velocity_deg_s = clamp(state(1), limit);
    motion_.state.acceleration_deg_s2 = clamp(state(2), properties_.max_acceleration_deg_s2);
    motion_.stamp = now.stamp;
    fold(state(0));
    settle(now);
}

void ShaftEstimator::fold(double moved_deg) noexcept TAPPET_REALTIME {
    const Rotation whole = Rotation::degrees(moved_deg);
    motion_.state.position = motion_.state.position + whole;
    rest_deg_ = moved_deg - whole.in_degrees();
}

void ShaftEstimator::settle(const Reading& now) noexcept TAPPET_REALTIME {
    ++counters_.accepted;
    if (settled_ < settle_samples) ++settled_;
    if (!at_rest_codes(now.code)) {
        rest_codes_ = {last_.code, now.code};
        rest_since_ = now.stamp;
    }
    last_ = now;
    const Duration still = now.stamp - rest_since_;
    if (still >= properties_.standstill_after) {
        stand(now);
        return;
    }
    if (still <= Duration::zero()) return;
    // Within one code for so long: at most twice its width over that time, even when just setting off.
    const double fastest = 2.0 * step_deg_ / to_seconds(still);
    double& velocity = motion_.state.velocity_deg_s;
    if (std::fabs(velocity) > fastest) {
        velocity = clamp(velocity, fastest);
        if (velocity * motion_.state.acceleration_deg_s2 > 0.0) motion_.state.acceleration_deg_s2 = 0.0;
    }
}

void ShaftEstimator::stand(const Reading& now) noexcept TAPPET_REALTIME {
    standing_ = true;
    motion_.state.velocity_deg_s = motion_.state.acceleration_deg_s2 = 0.0;
    const double beside = (now.centre - motion_.state.position.angle()).in_degrees();
    fold(rest_deg_ + beside - clamp(beside, 0.5 * step_deg_));
    rest_deg_ = 0.0;
}

} // namespace tappet
