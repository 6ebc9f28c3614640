// Inverse kinematics of any chain by damped least squares: rates for a twist, and joints for a frame in a
// bounded number of bounded steps.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/joint_range.hpp"
#include "kernel/motion/kinematics.hpp"
#include "kernel/motion/positive.hpp"
#include "kernel/motion/refused.hpp"

#include <algorithm>
#include <cmath>
#include <expected>

namespace tappet::motion {

/// Returns the joint rates for a twist, as exactly as `damping` (m/rad, positive) permits (Nakamura and
/// Hanafusa 1986): J' (J J' + damping2 I)^-1 v. Near a singular posture the twist becomes inexact and the
/// rates stay bounded: no rate is above |v| / (2 damping). All are scaled down together until each is within
/// `most` (rad/s, m/s), so that the direction is kept. Refused: a twist or damping that is not finite or not
/// positive. Real-time.
template <class B, class R, class At, class In, int joints>
std::expected<Joints<joints>, Refused> damped_rates(const Jacobian<B, R, At, In, joints>& jacobian,
                                                    const Twist<B, R, At, In>& twist, double damping,
                                                    const Joints<joints>& most) noexcept TAPPET_REALTIME {
    if (!(damping > 0.0) || !is_number(damping)) return std::unexpected(Refused{Refusal::limit_not_positive});
    const auto& j = jacobian.matrix;
    Eigen::Matrix<double, 6, 6> square = j * j.transpose();
    square.diagonal().array() += damping * damping;
    Eigen::Matrix<double, 6, 1> v;
    v << twist.linear, twist.angular;
    for (int i = 0; i < 6; ++i)
        if (!is_number(v[i])) return std::unexpected(Refused{Refusal::not_a_number, i});
    if (!solve_positive(square, v)) return std::unexpected(Refused{Refusal::not_a_number});
    Joints<joints> rates = j.transpose() * v;
    double over = 1.0;
    for (int i = 0; i < joints; ++i) {
        if (!is_number(rates[i])) return std::unexpected(Refused{Refusal::not_a_number, i});
        if (!(most[i] > 0.0)) return std::unexpected(Refused{Refusal::limit_not_positive, i});
        over = std::max(over, std::fabs(rates[i]) / most[i]);
    }
    rates /= over;
    return rates;
}

struct LeastSquaresOptions {
    int most_steps = 60;
    double most_step = 0.4;   ///< of any joint, rad or m
    double position_m = 1e-9; ///< reached when within both
    double angle_rad = 1e-9;
};

template <int joints>
struct LeastSquares {
    Joints<joints> q;
    int steps = 0;
};

/// Returns joints that bring a chain's end to `target`, starting at `from`: Levenberg and Marquardt with the
/// damping given by the error itself (Sugihara 2011). Refused: not reached after the last step; the target is
/// out of reach or on the other side of a limit. Contract: `from` and the target are finite. Real-time:
/// options.most_steps times one Jacobian and one system of equations with as many unknowns as there are
/// joints.
template <class Robot>
std::expected<LeastSquares<Robot::joints>, Refused>
least_squares(const Robot& robot, const FrameOf<Robot>& target, const Joints<Robot::joints>& from,
              const JointRanges<Robot::joints>& ranges = {}, const LeastSquaresOptions& options = {}) noexcept
    TAPPET_REALTIME {
    constexpr int joints = Robot::joints;
    require_numbers<3>(target.position);
    require_numbers<9>(target.rotation.reshaped());
    Joints<joints> q = from;
    for (int step = 0; step <= options.most_steps; ++step) {
        const auto pose = forward_with_jacobian(robot, q);
        const auto way = difference(pose.frame, target);
        const double apart = way.linear.squaredNorm();
        const double turned = way.angular.squaredNorm();
        if (apart <= options.position_m * options.position_m &&
            turned <= options.angle_rad * options.angle_rad && is_within(q, ranges))
            return LeastSquares<joints>{q, step};
        Eigen::Matrix<double, 6, 1> error;
        error << way.linear, way.angular;
        const auto& j = pose.jacobian.matrix;
        Eigen::Matrix<double, joints, joints> square = j.transpose() * j;
        // The constant gives a chain with idle joints a unique solution.
        square.diagonal().array() += 0.5 * (apart + turned) + 1e-12;
        Joints<joints> moves = j.transpose() * error;
        if (!solve_positive(square, moves)) return std::unexpected(Refused{Refusal::not_converged});
        double over = 1.0;
        for (int i = 0; i < joints; ++i) over = std::max(over, std::fabs(moves[i]) / options.most_step);
        for (int i = 0; i < joints; ++i) {
            const auto [lowest, highest] = ranges[static_cast<std::size_t>(i)];
            q[i] = std::min(std::max(q[i] + moves[i] / over, lowest), highest);
        }
        if (!q.allFinite()) return std::unexpected(Refused{Refusal::not_converged});
    }
    return std::unexpected(Refused{Refusal::not_converged});
}

} // namespace tappet::motion
