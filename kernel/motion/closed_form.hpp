// Inverse kinematics in closed form, for arms of six revolute joints whose last three axes meet in one point
// (Pieper 1968), with upper arm and forearm in one plane: most industrial robots.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/motion/joint_range.hpp"
#include "kernel/motion/kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace tappet::motion {

/// Returns whether closed_form works for this chain: axis 1 perpendicular to axis 2, axes 2 and 3 parallel,
/// and a wrist whose axes 4, 5 and 6 meet at right angles.
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

namespace detail {

/// An angle by its cosine and sine; the angle itself is computed only at the end.
struct Bend {
    sparse::Turn<double, double> turn;
    explicit Bend(double angle) noexcept TAPPET_REALTIME {
        const auto [sine, cosine] = sine_cosine(angle);
        turn = {cosine, sine};
    }
    /// Normalises a cosine and a sine of any scale; both zero define no angle and give the angle zero.
    Bend(double cosine, double sine) noexcept TAPPET_REALTIME {
        const double length = std::sqrt(cosine * cosine + sine * sine);
        turn = length > 0.0 ? sparse::Turn{cosine / length, sine / length} : sparse::Turn{1.0, 0.0};
    }
    [[nodiscard]] double angle() const noexcept TAPPET_REALTIME { return std::atan2(turn.s, turn.c); }
};

} // namespace detail

namespace detail {

template <const auto& chain>
double joint_of(std::size_t i, double theta) noexcept TAPPET_REALTIME {
    return table_of<chain>[i][Of::sense] * (theta - chain.links[i].theta_deg * (std::numbers::pi / 180.0));
}
/// Returns the angle of joint `i` in `near`, unchanged.
template <const auto& chain>
Bend as_it_is(const Joints<6>& near, std::size_t i) noexcept TAPPET_REALTIME {
    const double q = near[static_cast<int>(i)];
    return Bend{table_of<chain>[i][Of::sense] * q + chain.links[i].theta_deg * (std::numbers::pi / 180.0)};
}

/// The two solutions of the wrist for the first three joints.
template <const auto& chain>
void add_wrists(Bounded<Joints<6>, 8>& found, const Joints<6>& near, const Eigen::Matrix3d& rotation,
                const std::array<Bend, 3>& arm) noexcept TAPPET_REALTIME {
    using sparse::Turn;
    constexpr const auto& table = table_of<chain>;
    constexpr double s1 = table[0][Of::sa], c2 = table[1][Of::ca], s3 = table[2][Of::sa];
    constexpr double s4 = table[3][Of::sa], s5 = table[4][Of::sa];
    // The wrist's rotation, by its first and its third column.
    const auto into_arm = [&](const auto& v) {
        const sparse::Triple column{v(0), v(1), v(2)};
        const auto upper = back_about_x(Turn{0.0, s1}, back_about_z(arm[0].turn, column));
        const auto fore = back_about_x(Turn{c2, 0.0}, back_about_z(arm[1].turn, upper));
        return back_about_x(Turn{0.0, s3}, back_about_z(arm[2].turn, fore));
    };
    const auto first = into_arm(rotation.col(0));
    const auto third = into_arm(rotation.col(2));
    const double bent = std::sqrt(third.x * third.x + third.y * third.y);
    const Bend four = bent < 1e-10 ? as_it_is<chain>(near, 3) : Bend{s5 * third.x, s5 * third.y};
    const Bend five{-s4 * s5 * third.z, bent};
    // The last joint takes the remaining rotation: it compensates the uncertainty of the fourth near a
    // stretched wrist.
    const auto left = back_about_x(
        Turn{0.0, s5}, back_about_z(five.turn, back_about_x(Turn{0.0, s4}, back_about_z(four.turn, first))));
    const Bend six{left.x, left.y};
    Joints<6> q;
    q << joint_of<chain>(0, arm[0].angle()), joint_of<chain>(1, arm[1].angle()),
        joint_of<chain>(2, arm[2].angle()), joint_of<chain>(3, four.angle()),
        joint_of<chain>(4, five.angle()), joint_of<chain>(5, six.angle());
    if (!q.allFinite()) return; // the target's rotation is not finite
    static_cast<void>(found.push(q));
    // The flipped wrist is equivalent: half a turn before and after its bend, which is reversed.
    q[3] += std::numbers::pi;
    q[4] = joint_of<chain>(4, -five.angle());
    q[5] += std::numbers::pi;
    static_cast<void>(found.push(q));
}

} // namespace detail

/// Returns all solutions that bring the end of a chain to `target`: shoulder in front or behind, elbow up or
/// down, wrist flipped or not; none when it is out of reach. Where a joint is free, with the wrist stretched
/// or above the first axis, it keeps its value of `near`. Angles are not normalised; nearest(..) moves them
/// near the arm's present ones. The target's rotation must be a rotation matrix. Contract: the target and
/// `near` are finite. Real-time: eight times the same computation.
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

    // Removes the offset after the last joint, so that the position is that of the wrist.
    Frame<typename Folded<chain>::End, typename Folded<chain>::End> last;
    last.rotation << 1, 0, 0, 0, table[5][Of::ca], -table[5][Of::sa], 0, table[5][Of::sa], table[5][Of::ca];
    last.position = {table[5][Of::a], 0.0, table[5][Of::d]};
    const auto wrist = target * inverse(last);
    const double wx = wrist.position.x();
    const double wy = wrist.position.y();

    using detail::Bend;

    Bounded<Joints<6>, 8> found;
    const double apart = wx * wx + wy * wy; // squared, from axis 1
    const double scale = a2 * a2 + a3 * a3 + d4 * d4;
    const double out = apart - offset * offset;
    if (out < -1e-12 * scale) return found;
    const double reach = std::sqrt(out > 0.0 ? out : 0.0);
    const double forearm = std::sqrt(a3 * a3 + d4 * d4);
    for (const double across : {reach, -reach}) {
        const Bend one = apart < 1e-20 * scale
                             ? detail::as_it_is<chain>(near, 0)
                             : Bend{wx * across - wy * s1 * offset, wy * across + wx * s1 * offset};
        const double x = across - a1;
        const double y = s1 * (wrist.position.z() - d1);
        const double bend = (x * x + y * y - a2 * a2 - forearm * forearm) / (2.0 * a2 * forearm);
        if (!(std::fabs(bend) <= 1.0 + 1e-12)) continue;
        const double cosine = std::min(std::max(bend, -1.0), 1.0);
        for (const double elbow : {1.0, -1.0}) {
            const double sine = elbow * std::sqrt(1.0 - cosine * cosine);
            const Bend three{a3 * cosine - s3 * d4 * sine, s3 * d4 * cosine + a3 * sine};
            const double ahead = a2 + forearm * cosine;
            const double aside = c2 * forearm * sine;
            const Bend two = x * x + y * y < 1e-20 * scale
                                 ? detail::as_it_is<chain>(near, 1)
                                 : Bend{x * ahead + y * aside, y * ahead - x * aside};
            detail::add_wrists<chain>(found, near, wrist.rotation, {one, two, three});
        }
    }
    return found;
}

} // namespace tappet::motion
