// Inverse kinematics in closed form, for arms of six turning joints whose last three axes meet in one point
// (Pieper 1968), upper arm and forearm in one plane: most industrial robots.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/motion/joint_range.hpp"
#include "kernel/motion/kinematics.hpp"

#include <cmath>
#include <cstddef>

namespace tappet::motion {

/// Whether closed_form can be asked for this chain: axis 1 across axis 2, axes 2 and 3 along each other, and
/// a wrist whose axes 4, 5 and 6 meet at right angles.
template <class Base, class End, int joints>
constexpr bool has_closed_form(const Chain<Base, End, joints>& chain) noexcept {
    if constexpr (joints != 6) {
        return false;
    } else {
        const auto across = [&](std::size_t i) {
            return sine_cosine_of_degrees(chain.links[i].alpha_deg).cosine == 0.0;
        };
        const auto& [shoulder, upper, fore, roll, bend, last] = chain.links;
        for (const Link& link : chain.links)
            if (link.joint != Joint::revolute) return false;
        return across(0) && sine_cosine_of_degrees(upper.alpha_deg).sine == 0.0 && across(2) && across(3) &&
               across(4) && upper.a_m != 0.0 && (fore.a_m != 0.0 || roll.d_m != 0.0) && roll.a_m == 0.0 &&
               bend.a_m == 0.0 && bend.d_m == 0.0;
    }
}

/// All joints that lead the end of a chain to `target`: shoulder in front or behind, elbow up or down, wrist
/// turned over or not; none when it is out of reach. Where a turn is free, with the wrist stretched or above
/// the first axis, it is that of `near`. Angles as they come; nearest(..) brings them to where the arm is.
/// The target's rotation is a rotation. Contract: its numbers and `near` are numbers. Real-time: eight times
/// the same.
template <const auto& chain>
Bounded<Joints<6>, 8> closed_form(const Folded<chain>&, const FrameOf<Folded<chain>>& target,
                                  const Joints<6>& near) noexcept TAPPET_REALTIME {
    static_assert(has_closed_form(chain),
                  "the wrist of this chain allows no closed form: use least_squares(..)");
    using detail::Of;
    constexpr const auto& table = detail::table_of<chain>;
    constexpr double s1 = table[0][Of::sa];
    constexpr double c2 = table[1][Of::ca];
    constexpr double s3 = table[2][Of::sa];
    constexpr double a1 = table[0][Of::a], d1 = table[0][Of::d], a2 = table[1][Of::a];
    constexpr double a3 = table[2][Of::a], d4 = table[3][Of::d];
    constexpr double offset = table[1][Of::d] + c2 * table[2][Of::d]; // of the arm's plane from axis 1
    require_numbers<6>(near);
    require_numbers<3>(target.position);
    require_numbers<9>(target.rotation.reshaped());

    // What follows the last turn is taken off, so that the position is that of the wrist.
    Frame<typename Folded<chain>::End, typename Folded<chain>::End> last;
    last.rotation << 1, 0, 0, 0, table[5][Of::ca], -table[5][Of::sa], 0, table[5][Of::sa], table[5][Of::ca];
    last.position = {table[5][Of::a], 0.0, table[5][Of::d]};
    const auto wrist = target * inverse(last);
    const Eigen::Vector3d& w = wrist.position;

    const auto angle_of = [&](int i, double q) { // theta, from the joint's own angle
        const auto& numbers = table[static_cast<std::size_t>(i)];
        return numbers[Of::sense] * q + std::atan2(numbers[Of::s0], numbers[Of::c0]);
    };
    const auto joint_of = [&](int i, double theta) {
        const auto& numbers = table[static_cast<std::size_t>(i)];
        return numbers[Of::sense] * (theta - std::atan2(numbers[Of::s0], numbers[Of::c0]));
    };
    const auto turn_by = [](double theta, double sine, double cosine) { // Rz(theta) Rx(alpha)
        const auto [s, c] = sine_cosine(theta);
        Eigen::Matrix3d m;
        m << c, -s * cosine, s * sine, s, c * cosine, -c * sine, 0.0, sine, cosine;
        return m;
    };

    Bounded<Joints<6>, 8> found;
    const double out = w.x() * w.x() + w.y() * w.y() - offset * offset;
    const double scale = a2 * a2 + a3 * a3 + d4 * d4;
    if (out < -1e-12 * scale) return found;
    const double reach = std::sqrt(out > 0.0 ? out : 0.0);
    const double forearm = std::sqrt(a3 * a3 + d4 * d4);
    const bool is_above = w.x() * w.x() + w.y() * w.y() < 1e-20 * scale;
    for (const double shoulder : {1.0, -1.0}) {
        const double across = shoulder * reach;
        const double theta1 =
            is_above ? angle_of(0, near[0]) : std::atan2(w.y(), w.x()) - std::atan2(-s1 * offset, across);
        const double x = across - a1;
        const double y = s1 * (w.z() - d1);
        double cosine = (x * x + y * y - a2 * a2 - forearm * forearm) / (2.0 * a2 * forearm);
        if (!(std::fabs(cosine) <= 1.0 + 1e-12)) continue;
        cosine = cosine > 1.0 ? 1.0 : cosine < -1.0 ? -1.0 : cosine;
        for (const double elbow : {1.0, -1.0}) {
            const double sine = elbow * std::sqrt(1.0 - cosine * cosine);
            const double theta3 = std::atan2(s3 * d4, a3) + std::atan2(sine, cosine);
            const double theta2 = std::atan2(y, x) - std::atan2(c2 * forearm * sine, a2 + forearm * cosine);
            const Eigen::Matrix3d arm =
                turn_by(theta1, s1, 0.0) * turn_by(theta2, 0.0, c2) * turn_by(theta3, s3, 0.0);
            const Eigen::Matrix3d m = arm.transpose() * wrist.rotation;
            constexpr double s4 = table[3][Of::sa];
            constexpr double s5 = table[4][Of::sa];
            const double bent = std::sqrt(m(0, 2) * m(0, 2) + m(1, 2) * m(1, 2));
            for (const double over : {1.0, -1.0}) {
                const double theta4 = bent < 1e-10 ? angle_of(3, near[3])
                                                   : std::atan2(s5 * over * m(1, 2), s5 * over * m(0, 2));
                const double theta5 = std::atan2(over * bent, -s4 * s5 * m(2, 2));
                // The last turn is what is left: it makes good what is unsure about the fourth near a
                // stretched wrist.
                const Eigen::Matrix3d rest =
                    (turn_by(theta4, s4, 0.0) * turn_by(theta5, s5, 0.0)).transpose() * m;
                Joints<6> q;
                q << joint_of(0, theta1), joint_of(1, theta2), joint_of(2, theta3), joint_of(3, theta4),
                    joint_of(4, theta5), joint_of(5, std::atan2(rest(1, 0), rest(0, 0)));
                static_cast<void>(found.push(q));
            }
        }
    }
    return found;
}

} // namespace tappet::motion
