// Leads six joints so that the flange follows a commanded frame. All Generators in Cartesian space use it.
#pragma once

#include "apps/two_robots/values.hpp"
#include "kernel/component/method.hpp"
#include "kernel/motion/least_squares.hpp"

#include <algorithm>

namespace two_robots {

/// Computes set points of the joints, starting from their positions. Follows the command's twist and corrects
/// the error of its frame with `gain` (1/s), within `rate` (rad/s) and `acceleration` (rad/s2) of each joint.
/// Real-time.
class FrameFollower {
public:
    struct Limits {
        double gain, rate, acceleration;
    };

    void start(const Joints& positions, const Joints& rates) noexcept TAPPET_REALTIME {
        target_ = positions;
        rate_ = rates;
    }
    void step(const MethodCall<Posture(const SixNumbers&)>& posture_of, const FlangeCommand& command,
              const Limits& limits, double h) noexcept TAPPET_REALTIME {
        const Answer<Posture> answer = posture_of(SixNumbers{target_});
        // The flange's posture is unknown: brakes to a standstill.
        if (!answer.given()) return go(Joints{Joints::Zero()}, limits.acceleration, h);
        const Posture posture = answer.value_or({});
        auto twist = motion::difference(posture.frame(), command.frame);
        twist.linear = bounded(limits.gain * twist.linear) + command.twist.linear;
        twist.angular = bounded(limits.gain * twist.angular) + command.twist.angular;
        const auto wanted =
            motion::damped_rates(posture.jacobian(), twist, damping, Joints{Joints::Constant(limits.rate)});
        go(wanted ? *wanted : Joints{Joints::Zero()}, limits.acceleration, h);
    }
    /// Accelerates towards these rates.
    void go(const Joints& wanted, double acceleration, double h) noexcept TAPPET_REALTIME {
        const double most = acceleration * h;
        double over = 1.0; // all joints are scaled together, so that the direction stays
        for (int i = 0; i < 6; ++i) over = std::max(over, std::abs(wanted[i] - rate_[i]) / most);
        const Joints before = rate_;
        rate_ += (wanted - rate_) / over;
        target_ += 0.5 * (before + rate_) * h;
    }
    [[nodiscard]] const Joints& target() const noexcept TAPPET_REALTIME { return target_; }
    [[nodiscard]] const Joints& rate() const noexcept TAPPET_REALTIME { return rate_; }

private:
    static constexpr double damping = 1e-3;
    static constexpr double most_of_error = 0.05; // m/s or rad/s

    static Eigen::Vector3d bounded(const Eigen::Vector3d& speed) noexcept TAPPET_REALTIME {
        const double size = std::sqrt(speed.dot(speed));
        return size > most_of_error ? Eigen::Vector3d{speed * (most_of_error / size)} : speed;
    }

    Joints target_ = Joints::Zero(), rate_ = Joints::Zero();
};

} // namespace two_robots
