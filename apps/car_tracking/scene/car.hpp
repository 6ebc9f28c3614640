// The toy car: it laps the field on a wobbly track at varying speed, through the tunnel. Now and then
// somebody lifts it and puts it down elsewhere.
#pragma once

#include "apps/car_tracking/scene/room.hpp"
#include "kernel/base/random.hpp"
#include "kernel/base/time.hpp"

namespace tappet::car_tracking {

struct CarPose {
    double x = 0.0;
    double y = 0.0;
    double heading = 0.0; ///< radians, from x towards y
    bool lifted = false;  ///< in somebody's hand, out of sight
};

class Car {
public:
    explicit Car(Random& random) {
        phase_ = 2.0 * std::numbers::pi * random.unit();
        wobble_a_ = 2.0 * std::numbers::pi * random.unit();
        wobble_b_ = 2.0 * std::numbers::pi * random.unit();
        speed_wave_ = 2.0 * std::numbers::pi * random.unit();
        lift_at_ = 20.0 + 6.0 * random.unit();
    }

    void advance(double seconds) {
        time_ += seconds;
        if (is_lifted()) return;
        if (!put_down_ && time_ >= lift_at_ + lift_time) {
            put_down_ = true;
            phase_ += std::numbers::pi;
        }
        const double speed = 0.30 + 0.10 * std::sin(0.9 * time_ + speed_wave_);
        phase_ += speed * seconds / mean_radius;
    }

    [[nodiscard]] CarPose pose() const {
        const auto [x, y] = place(phase_);
        const auto [ahead_x, ahead_y] = place(phase_ + 1e-4);
        return {x, y, std::atan2(ahead_y - y, ahead_x - x), is_lifted()};
    }
    /// Returns true while the car cannot be seen: in the tunnel or in a hand.
    [[nodiscard]] bool hidden() const {
        const CarPose now = pose();
        return now.lifted || room::tunnel.holds(now.x, now.y);
    }
    [[nodiscard]] double lifted_at_s() const { return lift_at_; }

    static constexpr double lift_time = 1.5; // s

private:
    static constexpr double mean_radius = 1.15;

    [[nodiscard]] bool is_lifted() const { return time_ >= lift_at_ && time_ < lift_at_ + lift_time; }
    [[nodiscard]] std::pair<double, double> place(double phase) const {
        const double wobble =
            1.0 + 0.06 * std::sin(3.0 * phase + wobble_a_) + 0.04 * std::sin(2.0 * phase + wobble_b_);
        return {2.0 + 1.35 * wobble * std::cos(phase), 1.45 + 0.95 * wobble * std::sin(phase)};
    }

    double time_ = 0.0;
    double phase_ = 0.0;
    double wobble_a_ = 0.0;
    double wobble_b_ = 0.0;
    double speed_wave_ = 0.0;
    double lift_at_ = 0.0;
    bool put_down_ = false;
};

} // namespace tappet::car_tracking
