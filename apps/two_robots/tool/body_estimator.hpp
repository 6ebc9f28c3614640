// Estimators of the tool's loop: the present place and motion of the body, from past places of LEDs.
#pragma once

#include "apps/two_robots/tool/kalman_track.hpp"
#include "apps/two_robots/tool/leds.hpp"
#include "apps/two_robots/tool/values.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/motion/estimators.hpp"
#include "kernel/motion/positive.hpp"

#include <bit>

namespace two_robots {

/// Fits a frame through at least three LEDs by least squares (Gauss-Newton), starting from `guess`. Returns
/// false when the LEDs are too few, or on one line.
[[nodiscard]] inline bool fit_body(const Leds& leds, BodyFrame& guess) noexcept TAPPET_REALTIME {
    const int seen = std::popcount(leds.seen);
    if (seen < 3) return false;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero(), middle_on_body = Eigen::Vector3d::Zero();
    const auto vector = [](const std::array<double, 3>& place) noexcept
        TAPPET_REALTIME { return Eigen::Vector3d{place[0], place[1], place[2]}; };
    for (std::size_t i = 0; i < led_count; ++i) {
        if ((leds.seen >> i & 1U) == 0) continue;
        middle += vector(leds.at[i]) / seen;
        middle_on_body += vector(leds_on_body[i]) / seen;
    }
    Eigen::Matrix3d rotation = guess.rotation;
    for (int round = 0; round < 6; ++round) {
        Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
        Eigen::Matrix<double, 3, 1> turn = Eigen::Matrix<double, 3, 1>::Zero();
        for (std::size_t i = 0; i < led_count; ++i) {
            if ((leds.seen >> i & 1U) == 0) continue;
            const Eigen::Vector3d arm = rotation * (vector(leds_on_body[i]) - middle_on_body);
            const Eigen::Vector3d missing = vector(leds.at[i]) - middle - arm;
            square += arm.dot(arm) * Eigen::Matrix3d::Identity() - arm * arm.transpose();
            turn += arm.cross(missing);
        }
        if (!motion::solve_positive(square, turn)) return false;
        rotation = motion::rotation_about(turn) * rotation;
    }
    guess.rotation = rotation;
    guess.position = middle - rotation * middle_on_body;
    return true;
}

/// The common part: six tracks, each a filter of a value and its speed, for places and for angles from a
/// reference. It writes in each step while the body is known: from the second exposure until the last one is
/// too old. The output is extrapolated linearly from the measurements to now. An estimator that replaces
/// another one continues from its model. `Own` creates its filter. Real-time.
template <class Own, class Filter>
struct AnyBodyEstimator {
    Input<Leds> leds;
    Input<BodyModel> before;
    Output<BodyModel> model;
    Output<bool> good;
    Property<bool> predicts{true};

    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        lose();
        if (before.good() && leds.good()) go_on(before.get(), cycle.now);
        put(cycle.now);
        good.write(knows());
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        Leds seen;
        const Flow flow = leds.read(seen);
        if (flow == Flow::fresh) take(seen, leds.stamp());
        if (flow == Flow::stale) lose();
        put(cycle.now);
        if (good.last() != knows()) good.write(knows());
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { good.write(false); }

protected:
    template <class... Facets>
    static constexpr auto estimator_facets(const Facets&... more) {
        return facets(
            input<&Own::leds>("leds", "m", "at the time of their exposure"),
            input<&Own::before>("before", "", "the model of the estimator that it replaces", optional),
            output<&Own::model>("model", "", "where the body is now, and its twist; while it is known"),
            output<&Own::good>("good", "", "the body is known"),
            property<&Own::predicts>("predicts", "",
                                     "false: uses the last exposure without prediction, for comparison"),
            more...);
    }

private:
    [[nodiscard]] bool knows() const noexcept TAPPET_REALTIME { return tracks_[0].good(); }
    void put(Time now) noexcept TAPPET_REALTIME {
        if (knows()) model.write(predicts.get() ? at(now) : BodyModel{measured_, {}});
    }
    void take(const Leds& seen, Time at) noexcept TAPPET_REALTIME {
        if (!fit_body(seen, measured_)) return;
        if (!knows()) reference_ = measured_.rotation;
        track(measured_, at);
    }
    void track(const BodyFrame& body, Time at) noexcept TAPPET_REALTIME {
        const Eigen::Vector3d turn = motion::rotation_vector(body.rotation * reference_.transpose());
        for (int i = 0; i < 3; ++i) {
            tracks_[static_cast<std::size_t>(i)].sample(body.position[i], at);
            tracks_[static_cast<std::size_t>(3 + i)].sample(turn[i], at);
        }
    }
    /// Feeds the tracks with two exposures computed from the model: the last one and one before it.
    void go_on(const BodyModel& from, Time now) noexcept TAPPET_REALTIME {
        constexpr Duration between = 20ms;
        reference_ = from.frame.rotation;
        for (const Time at : {leds.stamp() - between, leds.stamp()}) {
            const double ago = to_seconds(now - at);
            measured_.position = from.frame.position - from.twist.linear * ago;
            measured_.rotation = motion::rotation_about(-ago * from.twist.angular) * reference_;
            track(measured_, at);
        }
    }
    [[nodiscard]] BodyModel at(Time now) const noexcept TAPPET_REALTIME {
        BodyModel body;
        Eigen::Vector3d turn;
        for (int i = 0; i < 3; ++i) {
            const Filter& way = tracks_[static_cast<std::size_t>(i)];
            const Filter& angle = tracks_[static_cast<std::size_t>(3 + i)];
            body.frame.position[i] = way.at(now);
            body.twist.linear[i] = way.velocity();
            turn[i] = angle.at(now);
            body.twist.angular[i] = angle.velocity();
        }
        body.frame.rotation = motion::rotation_about(turn) * reference_;
        return body;
    }
    void lose() noexcept TAPPET_REALTIME {
        for (Filter& each : tracks_) each = static_cast<const Own&>(*this).filter();
    }

    std::array<Filter, 6> tracks_{Own::usual, Own::usual, Own::usual, Own::usual, Own::usual, Own::usual};
    BodyFrame measured_{};
    Eigen::Matrix3d reference_ = Eigen::Matrix3d::Identity();
};

/// Estimates with alpha-beta filters.
struct BodyEstimator : AnyBodyEstimator<BodyEstimator, motion::AlphaBeta> {
    static constexpr motion::AlphaBeta usual{motion::AlphaBetaGains{0.5, 0.17}};
    Property<double> alpha{0.5}, beta{0.17};

    [[nodiscard]] motion::AlphaBeta filter() const noexcept TAPPET_REALTIME {
        return motion::AlphaBeta{{alpha.get(), beta.get()}};
    }
    static constexpr auto interface() {
        return estimator_facets(
            property<&BodyEstimator::alpha>("alpha", "", "of the filters, on places", range(0.05, 1.0)),
            property<&BodyEstimator::beta>("beta", "", "of the filters, on speeds", range(0.01, 1.0)));
    }
};

/// Estimates with Kalman filters, whose gains follow from the noise properties.
struct KalmanBodyEstimator : AnyBodyEstimator<KalmanBodyEstimator, KalmanTrack> {
    static constexpr KalmanTrack usual{{.acceleration = 0.02, .noise = 0.02e-3}};
    Property<double> acceleration{0.02}, noise{0.02e-3};

    [[nodiscard]] KalmanTrack filter() const noexcept TAPPET_REALTIME {
        return KalmanTrack{{acceleration.get(), noise.get()}};
    }
    static constexpr auto interface() {
        return estimator_facets(
            property<&KalmanBodyEstimator::acceleration>(
                "acceleration", "m/s^2", "deviation, from exposure to exposure", range(1e-3, 10.0)),
            property<&KalmanBodyEstimator::noise>("noise", "m", "deviation of a place that was measured",
                                                  range(1e-6, 1e-2)));
    }
};

} // namespace two_robots
