// The arms as tables, and the process component that answers the data flow's kinematic questions (thesis fig.
// 3.10 a).
#pragma once

#include "apps/two_robots/values.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/motion/closed_form.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

namespace two_robots {

// clang-format off
/// Rz(q1) Tz(l1) Rx(-q2) Tz(l2) Rx(-q3) Tz(l3) Rz(q4) Rx(-q5) Rz(q6) Tz(l6): the structure of KUKA's 160 and,
/// with the wrist below, of its 361; lengths in m.
constexpr motion::Chain<Base, Flange, 6> kuka_arm(double l1, double l2, double l3, double l6) noexcept TAPPET_REALTIME {
    return {{{
        {.alpha_deg = 90, .d_m = l1, .theta_deg = 90},
        {.a_m = l2, .theta_deg = 90, .reversed = true},
        {.alpha_deg = -90, .theta_deg = -90, .reversed = true},
        {.alpha_deg = 90, .d_m = l3},
        {.alpha_deg = -90, .reversed = true},
        {.d_m = l6, .theta_deg = -90},
    }}};
}
inline constexpr auto k361_arm = kuka_arm(1.020, 0.480, 0.645, 0.120);
inline constexpr auto k160_arm = kuka_arm(0.900, 0.970, 1.080, 0.180);
// clang-format on

/// A wrist whose three axes meet at right angles: its table angles equal its joint angles.
struct PlainWrist {
    static Joints angles(const Joints& q) noexcept TAPPET_REALTIME { return q; }
    static Joints joints(const Joints& angles) noexcept TAPPET_REALTIME { return angles; }
    static void columns(const Joints&, Eigen::Matrix<double, 6, 6>&) noexcept TAPPET_REALTIME {}
};

/// The wrist of the K361: joint 5 turns two cones of 30 degrees against each other. It is equivalent to a
/// plain wrist bent by `th`, which joints 4 and 6 see turned by `al`.
struct ConeWrist {
    static Joints angles(const Joints& q) noexcept TAPPET_REALTIME {
        const auto [sine, cosine] = motion::sine_cosine(0.5 * q[4]);
        const double al = 0.5 * std::numbers::pi - std::atan2(std::numbers::sqrt3 * sine, 2.0 * cosine);
        Joints angles = q;
        angles[3] += al;
        angles[4] = 4.0 * std::asin(0.5 * sine);
        angles[5] -= al;
        return angles;
    }
    /// Limits the bend to the possible 120 degrees.
    static Joints joints(const Joints& angles) noexcept TAPPET_REALTIME {
        const double sine = std::min(std::max(2.0 * motion::sine_cosine(0.25 * angles[4]).sine, -1.0), 1.0);
        const double cosine = std::sqrt(1.0 - sine * sine);
        const double al = 0.5 * std::numbers::pi - std::atan2(std::numbers::sqrt3 * sine, 2.0 * cosine);
        Joints q = angles;
        q[3] -= al;
        q[4] = 2.0 * std::asin(sine);
        q[5] += al;
        return q;
    }
    /// Converts the flange's motion per angle to its motion per joint.
    static void columns(const Joints& q, Eigen::Matrix<double, 6, 6>& jacobian) noexcept TAPPET_REALTIME {
        const double cosine = motion::sine_cosine(q[4]).cosine;
        const double half = motion::sine_cosine(0.5 * q[4]).cosine;
        const double of_al = -2.0 * std::numbers::sqrt3 / (7.0 + cosine);
        const double of_th = 2.0 * std::numbers::sqrt2 * half / std::sqrt(7.0 + cosine);
        jacobian.col(4) = of_th * jacobian.col(4) + of_al * (jacobian.col(3) - jacobian.col(5));
    }
};

struct JointSolution {
    bool found = false;
    SixNumbers joints{};
};

/// Returns the flange's posture for some joints. `robot`: folded, or Loaded. Real-time.
template <class Wrist, class Robot>
Posture posture_of(const Robot& robot, const SixNumbers& joints) noexcept TAPPET_REALTIME {
    const Joints q = joints.joints();
    auto pose = motion::forward_with_jacobian(robot, Wrist::angles(q));
    Wrist::columns(q, pose.jacobian.matrix);
    Posture posture{.flange = FrameNumbers{pose.frame}};
    Eigen::Map<Eigen::Matrix<double, 6, 6>>{posture.jacobian_numbers.data()} = pose.jacobian.matrix;
    return posture;
}

/// Process component of an arm: the flange's posture for joints, the joints for a posture. Real-time.
template <const auto& arm, class Wrist>
struct Kinematics {
    Posture posture(const SixNumbers& joints) noexcept TAPPET_REALTIME {
        return posture_of<Wrist>(motion::folded<arm>, joints);
    }
    /// Returns the solution nearest to `near`; does not check the joints' limits.
    JointSolution solve(const FrameNumbers& flange, const SixNumbers& near) noexcept TAPPET_REALTIME {
        const Joints from = Wrist::angles(near.joints());
        const auto all = motion::closed_form(motion::folded<arm>, flange.frame(), from);
        const auto best = motion::nearest<6>(all, from);
        if (!best) return {};
        return {true, SixNumbers{Wrist::joints(*best)}};
    }
    static constexpr auto interface() {
        return facets(method<&Kinematics::posture>("posture", "of the flange for these joints", any_thread),
                      method<&Kinematics::solve>("solve", "the joints for a place of the flange, near others",
                                                 any_thread));
    }
};

/// The same for an arm with measured lengths, called in place of the drawn one. Its callers run in any
/// activity, and its lengths are set in its own: each length is written atomically. Real-time.
template <class Wrist>
struct MeasuredKinematics {
    Property<double> l1{1.0}, l2{0.5}, l3{0.5}, l6{0.1};

    void changed() noexcept TAPPET_REALTIME {
        const std::array<double, 4> set{l1.get(), l2.get(), l3.get(), l6.get()};
        for (std::size_t i = 0; i < set.size(); ++i) lengths_[i].store(set[i], std::memory_order_relaxed);
    }
    Posture posture(const SixNumbers& joints) noexcept TAPPET_REALTIME {
        const auto length = [this](std::size_t i) noexcept
            TAPPET_REALTIME { return lengths_[i].load(std::memory_order_relaxed); };
        return posture_of<Wrist>(motion::Loaded{kuka_arm(length(0), length(1), length(2), length(3))},
                                 joints);
    }
    static constexpr auto interface() {
        return facets(
            method<&MeasuredKinematics::posture>("posture", "of the flange for these joints", any_thread),
            property<&MeasuredKinematics::l1>("l1", "m", "from the floor to joint 2", range(0.1, 2.0)),
            property<&MeasuredKinematics::l2>("l2", "m", "of the upper arm", range(0.1, 2.0)),
            property<&MeasuredKinematics::l3>("l3", "m", "of the forearm", range(0.1, 2.0)),
            property<&MeasuredKinematics::l6>("l6", "m", "from the wrist to the flange", range(0.01, 1.0)));
    }

private:
    std::array<std::atomic<double>, 4> lengths_{1.0, 0.5, 0.5, 0.1};
};

using K361Kinematics = Kinematics<k361_arm, ConeWrist>;
using K160Kinematics = Kinematics<k160_arm, PlainWrist>;

} // namespace two_robots
