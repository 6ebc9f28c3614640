// Estimator of the tool's loop: where the body is now and how it moves, from places of LEDs that are past.
#pragma once

#include "apps/two_robots/tool/leds.hpp"
#include "apps/two_robots/tool/values.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/motion/estimators.hpp"
#include "kernel/motion/positive.hpp"

#include <atomic>
#include <bit>

namespace two_robots {

/// The frame of least squares through at least three LEDs, by Gauss and Newton from `guess`. False: they are
/// too few, or on one line.
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

/// Writes in each step while it knows the body: from two exposures on, until the last one is too old. What
/// is written is said of now, straight on from what was measured. Real-time.
struct BodyEstimator {
    Input<Leds> leds;
    Output<BodyModel> model;
    Output<bool> good;
    Property<bool> predicts{true};
    Property<double> alpha{0.5}, beta{0.17};

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        lose();
        good.write(false);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        Leds seen;
        const Flow flow = leds.read(seen);
        if (flow == Flow::fresh) take(seen, leds.stamp());
        const bool knows = (flow == Flow::fresh || flow == Flow::old) && filters_[0].good();
        if (knows) model.write(predicts.get() ? at(cycle.now) : BodyModel{measured_, {}});
        if (flow == Flow::stale) lose();
        if (good.last() != knows) good.write(knows);
        is_seen_.store(knows, std::memory_order_relaxed);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        good.write(false);
        is_seen_.store(false, std::memory_order_relaxed);
    }
    bool is_seen() const noexcept TAPPET_REALTIME { return is_seen_.load(std::memory_order_relaxed); }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            input<&BodyEstimator::leds>("leds", "m", "at the time of their exposure"),
            output<&BodyEstimator::model>("model", "", "where the body is now, and its twist; while it is known"),
            output<&BodyEstimator::good>("good", "", "the body is known"),
            method<&BodyEstimator::is_seen>("is_seen", "the body is known", any_thread),
            property<&BodyEstimator::predicts>("predicts", "", "false: the last exposure as it is, to see what that costs"),
            property<&BodyEstimator::alpha>("alpha", "", "of the alpha-beta estimators, on places", range(0.05, 1.0)),
            property<&BodyEstimator::beta>("beta", "", "of the alpha-beta estimators, on speeds", range(0.01, 1.0)));
    }
    // clang-format on

private:
    void take(const Leds& seen, Time at) noexcept TAPPET_REALTIME {
        if (!fit_body(seen, measured_)) return;
        if (!filters_[0].good()) reference_ = measured_.rotation;
        const Eigen::Vector3d turn = motion::rotation_vector(measured_.rotation * reference_.transpose());
        for (int i = 0; i < 3; ++i) {
            filters_[static_cast<std::size_t>(i)].sample(measured_.position[i], at);
            filters_[static_cast<std::size_t>(3 + i)].sample(turn[i], at);
        }
    }
    [[nodiscard]] BodyModel at(Time now) const noexcept TAPPET_REALTIME {
        BodyModel body;
        Eigen::Vector3d turn;
        for (int i = 0; i < 3; ++i) {
            const motion::AlphaBeta& way = filters_[static_cast<std::size_t>(i)];
            const motion::AlphaBeta& angle = filters_[static_cast<std::size_t>(3 + i)];
            body.frame.position[i] = way.at(now);
            body.twist.linear[i] = way.velocity();
            turn[i] = angle.at(now);
            body.twist.angular[i] = angle.velocity();
        }
        body.frame.rotation = motion::rotation_about(turn) * reference_;
        return body;
    }
    void lose() noexcept TAPPET_REALTIME {
        for (motion::AlphaBeta& each : filters_) each = motion::AlphaBeta{{alpha.get(), beta.get()}};
    }

    static constexpr motion::AlphaBetaGains gains{0.5, 0.17};
    std::array<motion::AlphaBeta, 6> filters_{motion::AlphaBeta{gains}, motion::AlphaBeta{gains},
                                              motion::AlphaBeta{gains}, motion::AlphaBeta{gains},
                                              motion::AlphaBeta{gains}, motion::AlphaBeta{gains}};
    BodyFrame measured_{};
    Eigen::Matrix3d reference_ = Eigen::Matrix3d::Identity();
    std::atomic<bool> is_seen_{false};
};

} // namespace two_robots
