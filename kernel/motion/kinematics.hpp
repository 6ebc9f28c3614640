// Forward kinematics and Jacobians of a chain, one pass over its links.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/chain.hpp"
#include "kernel/motion/frame.hpp"
#include "kernel/motion/twist.hpp"

#include <Eigen/Core>

namespace tappet::motion {

/// Maps rates of joints to the twist of Body in Reference, at the origin of At, along the axes of In: the
/// upper three rows m/s (linear), the lower three rad/s.
template <class Body, class Reference, class At, class In, int joints>
struct Jacobian {
    Eigen::Matrix<double, 6, joints> matrix;

    friend Twist<Body, Reference, At, In> operator*(const Jacobian& jacobian,
                                                    const Joints<joints>& rates) noexcept TAPPET_REALTIME {
        return {jacobian.matrix.template topRows<3>() * rates,
                jacobian.matrix.template bottomRows<3>() * rates};
    }
    /// Returns the joint torques against this load, Nm or N: the transpose. Real-time.
    [[nodiscard]] Joints<joints> torques(const Wrench<Body, At, In>& wrench) const noexcept TAPPET_REALTIME {
        return matrix.template topRows<3>().transpose() * wrench.force +
               matrix.template bottomRows<3>().transpose() * wrench.torque;
    }
};

template <class Robot>
using FrameOf = Frame<typename Robot::Base, typename Robot::End>;
template <class Robot>
using TwistOf = Twist<typename Robot::End, typename Robot::Base, typename Robot::End, typename Robot::Base>;
template <class Robot>
using JacobianOf = Jacobian<typename Robot::End, typename Robot::Base, typename Robot::End,
                            typename Robot::Base, Robot::joints>;

/// The pose of a chain's end, and how it moves with the joints.
template <class Robot>
struct Pose {
    FrameOf<Robot> frame;
    JacobianOf<Robot> jacobian;
};

namespace detail {

/// `x`, `y`, `z` and `origin` are those of frame i, along the axes of Base. The columns are written on the
/// way back, when the end is known.
template <int i, class Robot, class X, class Y, class Z, class P>
[[gnu::always_inline]] inline void follow(const Robot& robot, const Joints<Robot::joints>& q,
                                          const Turns<Robot::joints>& turns, X x, Y y, Z z, P origin,
                                          FrameOf<Robot>& end, JacobianOf<Robot>* jacobian) noexcept
    TAPPET_REALTIME {
    if constexpr (i == Robot::joints) {
        end.rotation.col(0) = x.dense();
        end.rotation.col(1) = y.dense();
        end.rotation.col(2) = z.dense();
        end.position = origin.dense();
    } else {
        const auto place = place_of<i>(robot, turns[static_cast<std::size_t>(i)], q[i]);
        const auto [c, s] = place.turn;
        const auto ca = robot.template number<i, Of::ca>();
        const auto sa = robot.template number<i, Of::sa>();
        const auto x1 = c * x + s * y;
        const auto y1 = c * y - s * x;
        follow<i + 1>(robot, q, turns, x1, ca * y1 + sa * z, ca * z - sa * y1,
                      origin + place.way * z + robot.template number<i, Of::a>() * x1, end, jacobian);
        if (jacobian == nullptr) return;
        const double sense = robot.template number<i, Of::sense>();
        const sparse::Triple tip{end.position.x(), end.position.y(), end.position.z()};
        const auto by_turning = cross(z, tip - origin);
        const auto kind = place.is_revolute;
        using sparse::select, sparse::Zero, sparse::value;
        jacobian->matrix.col(i) << value(sense * select(kind, by_turning.x, z.x)),
            value(sense * select(kind, by_turning.y, z.y)), value(sense * select(kind, by_turning.z, z.z)),
            value(sense * select(kind, z.x, Zero{})), value(sense * select(kind, z.y, Zero{})),
            value(sense * select(kind, z.z, Zero{}));
    }
}

template <class Robot>
[[gnu::always_inline]] inline void follow(const Robot& robot, const Joints<Robot::joints>& q,
                                          FrameOf<Robot>& end, JacobianOf<Robot>* jacobian) noexcept
    TAPPET_REALTIME {
    using sparse::Triple, sparse::Zero;
    follow<0>(robot, q, turns_of(robot, q), Triple{1.0, Zero{}, Zero{}}, Triple{Zero{}, 1.0, Zero{}},
              Triple{Zero{}, Zero{}, 1.0}, Triple{Zero{}, Zero{}, Zero{}}, end, jacobian);
}

} // namespace detail

/// Returns the pose of the end of a chain. `robot`: folded<chain>, or a Loaded one. Contract: q is finite.
/// Real-time.
template <class Robot>
FrameOf<Robot> forward(const Robot& robot, const Joints<Robot::joints>& q) noexcept TAPPET_REALTIME {
    FrameOf<Robot> end;
    detail::follow(robot, q, end, nullptr);
    return end;
}

/// Returns the pose and the Jacobian of the end in Base, at its origin, along the axes of Base. Real-time.
template <class Robot>
Pose<Robot> forward_with_jacobian(const Robot& robot, const Joints<Robot::joints>& q) noexcept
    TAPPET_REALTIME {
    Pose<Robot> pose;
    detail::follow(robot, q, pose.frame, &pose.jacobian);
    return pose;
}

} // namespace tappet::motion
