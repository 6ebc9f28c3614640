// Serial chains of joints as constants: a Denavit-Hartenberg table with masses, gravity and drives.
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/motion/refused.hpp"
#include "kernel/motion/sine.hpp"
#include "kernel/motion/sparse.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace tappet::motion {

enum class Joint : std::uint8_t { revolute, prismatic };

/// Inertia tensor of a link about its centre of mass, along the axes of its frame, kg m2.
struct Inertia {
    double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, xz = 0;
};

/// The drive of a joint. `coulomb_*` holds at any speed in that direction of the joint, Nm at the motor.
struct Drive {
    double gear = 0;            ///< turns of the motor per turn of the joint; of a prismatic joint rad/m
    double inertia_kg_m2 = 0;   ///< of the motor's rotor
    double viscous_nm_s = 0;    ///< at the motor, Nm per rad/s
    double coulomb_forward = 0; ///< not negative
    double coulomb_backward = 0;
};

/// One row. Frame i is placed in frame i-1 at Rz(theta) Tz(d) Tx(a) Rx(alpha), standard parameters (Denavit
/// and Hartenberg 1955; Corke, Robotics, Vision and Control, 7.2). A revolute joint adds its angle to theta,
/// a prismatic one its travel to d; a reversed one subtracts it.
struct Link {
    double a_m = 0;
    double alpha_deg = 0; ///< 90 and its multiples are exact
    double d_m = 0;
    double theta_deg = 0;
    Joint joint = Joint::revolute;
    bool reversed = false;
    double mass_kg = 0;
    std::array<double, 3> centre_m{}; ///< of mass, in this link's frame
    Inertia inertia{};
    Drive drive{};
};

/// A chain from the frame Base to the frame End of the last link. One value per joint: rad or m.
template <class Base_, class End_, int joints_>
struct Chain {
    static_assert(joints_ > 0, "a chain has a joint");
    using Base = Base_;
    using End = End_;
    static constexpr int joints = joints_;
    std::array<Link, static_cast<std::size_t>(joints_)> links;
    std::array<double, 3> gravity_m_s2{0, 0, -9.81}; ///< along the axes of Base
};

/// Positions, rates, accelerations or torques of joints, in rad or m and s, Nm or N.
template <int joints>
using Joints = Eigen::Matrix<double, joints, 1>;

namespace detail {

/// Parameters of a link for the algorithms. `pxx`.. are the second moments of its mass about its frame's
/// origin (kg m2), `hx`.. the first ones (kg m); those of the drive refer to the joint.
enum Of : std::uint8_t { // clang-format off
    ca, sa, c0, s0, a, d, sense, mass, hx, hy, hz, pxx, pyy, pzz, pxy, pyz, pxz, rotor, viscous, forward, backward, numbers
}; // clang-format on
using Numbers = std::array<double, numbers>;

constexpr Numbers numbers_of(const Link& link) noexcept TAPPET_REALTIME {
    const auto [sin_alpha, cos_alpha] = sine_cosine_of_degrees(link.alpha_deg);
    const auto [sin_theta, cos_theta] = sine_cosine_of_degrees(link.theta_deg);
    const double m = link.mass_kg;
    const auto [x, y, z] = link.centre_m;
    const Inertia& i = link.inertia;
    const double half = 0.5 * (i.xx + i.yy + i.zz);
    const double gear = link.drive.gear < 0 ? -link.drive.gear : link.drive.gear;
    return {cos_alpha,
            sin_alpha,
            cos_theta,
            sin_theta,
            link.a_m,
            link.d_m,
            link.reversed ? -1.0 : 1.0,
            m,
            m * x,
            m * y,
            m * z,
            half - i.xx + m * x * x,
            half - i.yy + m * y * y,
            half - i.zz + m * z * z,
            -i.xy + m * x * y,
            -i.yz + m * y * z,
            -i.xz + m * x * z,
            gear * gear * link.drive.inertia_kg_m2,
            gear * gear * link.drive.viscous_nm_s,
            gear * link.drive.coulomb_forward,
            gear * link.drive.coulomb_backward};
}

template <const auto& chain>
inline constexpr auto table_of = [] {
    std::array<Numbers, static_cast<std::size_t>(chain.joints)> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = numbers_of(chain.links[i]);
    return table;
}();

} // namespace detail

/// A chain that the compiler folds into the code: zeros vanish, quarter turns become exchanges of axes.
///     inline constexpr Chain<World, Flange, 6> arm{...};
///     const auto pose = forward(folded<arm>, q);
template <const auto& chain>
struct Folded {
    using Type = std::remove_cvref_t<decltype(chain)>;
    using Base = Type::Base;
    using End = Type::End;
    static constexpr int joints = Type::joints;

    template <int i, detail::Of which>
    static constexpr auto number() noexcept TAPPET_REALTIME {
        return folded_number<detail::table_of<chain>[static_cast<std::size_t>(i)][which]>();
    }
    template <int i>
    static constexpr auto is_revolute() noexcept TAPPET_REALTIME {
        return std::bool_constant<chain.links[static_cast<std::size_t>(i)].joint == Joint::revolute>{};
    }
    template <int axis>
    static constexpr auto gravity() noexcept TAPPET_REALTIME {
        return folded_number<chain.gravity_m_s2[static_cast<std::size_t>(axis)]>();
    }

private:
    template <double value>
    static constexpr auto folded_number() noexcept TAPPET_REALTIME {
        if constexpr (value == 0.0)
            return sparse::Zero{};
        else
            return value;
    }
};
template <const auto& chain>
inline constexpr Folded<chain> folded{};

/// A chain with parameters of run time: calibrated, or from properties. Same algorithms, about half as fast.
template <class Base_, class End_, int joints_>
class Loaded {
public:
    using Base = Base_;
    using End = End_;
    static constexpr int joints = joints_;

    /// Copies the chain's parameters. Real-time.
    constexpr explicit Loaded(const Chain<Base_, End_, joints_>& chain) noexcept TAPPET_REALTIME
        : gravity_(chain.gravity_m_s2) {
        for (std::size_t i = 0; i < table_.size(); ++i) {
            table_[i] = detail::numbers_of(chain.links[i]);
            revolute_[i] = chain.links[i].joint == Joint::revolute;
        }
    }
    template <int i, detail::Of which>
    [[nodiscard]] constexpr double number() const noexcept TAPPET_REALTIME {
        return table_[static_cast<std::size_t>(i)][which];
    }
    template <int i>
    [[nodiscard]] constexpr bool is_revolute() const noexcept TAPPET_REALTIME {
        return revolute_[static_cast<std::size_t>(i)];
    }
    template <int axis>
    [[nodiscard]] constexpr double gravity() const noexcept TAPPET_REALTIME {
        return gravity_[static_cast<std::size_t>(axis)];
    }

private:
    std::array<detail::Numbers, static_cast<std::size_t>(joints_)> table_{};
    std::array<bool, static_cast<std::size_t>(joints_)> revolute_{};
    std::array<double, 3> gravity_;
};

/// Contract: all values are finite. Check sensor values where they enter the program.
template <int joints>
void require_numbers(const Joints<joints>& values) noexcept TAPPET_REALTIME {
    double sum = 0.0;
    for (int i = 0; i < joints; ++i) sum += values[i];
    if (is_number(sum)) [[likely]]
        return;
    for (int i = 0; i < joints; ++i) TAPPET_CONTRACT(is_number(values[i]), Contract::not_a_number, i);
}

namespace detail {

/// Position of a joint: the turn about z, the travel along z, and which of the two it moves.
template <class Kind, sparse::Number C, sparse::Number S, sparse::Number D>
struct Place {
    Kind is_revolute;
    sparse::Turn<C, S> turn;
    D way;
};

template <int joints>
using Turns = std::array<SineCosine, static_cast<std::size_t>(joints)>;

/// Joints 2k and 2k + 1: revolute ones are computed in pairs.
template <int k, class Robot>
[[gnu::always_inline]] inline void turn_two(const Robot& robot, const Joints<Robot::joints>& q,
                                            Turns<Robot::joints>& turns) noexcept TAPPET_REALTIME {
    constexpr int first = 2 * k;
    constexpr int second = first + 1 < Robot::joints ? first + 1 : first;
    const double a = robot.template number<first, Of::sense>() * q[first];
    const double b = robot.template number<second, Of::sense>() * q[second];
    auto& of_a = turns[static_cast<std::size_t>(first)];
    auto& of_b = turns[static_cast<std::size_t>(second)];
    if (is_usual_angle(a) && is_usual_angle(b)) [[likely]] {
        sine_cosine_of_two(a, b, of_a, of_b);
        return;
    }
    TAPPET_CONTRACT(is_number(a), Contract::not_a_number, first);
    TAPPET_CONTRACT(is_number(b), Contract::not_a_number, second);
    of_a = sine_cosine(a);
    of_b = sine_cosine(b);
}

/// Sines and cosines of all joints. Contract: q is finite.
template <class Robot>
[[gnu::always_inline]] inline Turns<Robot::joints> turns_of(const Robot& robot,
                                                            const Joints<Robot::joints>& q) noexcept
    TAPPET_REALTIME {
    Turns<Robot::joints> turns;
    [&]<int... k>(std::integer_sequence<int, k...>) {
        (turn_two<k>(robot, q, turns), ...);
    }(std::make_integer_sequence<int, (Robot::joints + 1) / 2>{});
    return turns;
}

template <int i, class Robot>
[[gnu::always_inline]] inline auto place_of(const Robot& robot, const SineCosine& turn, double q) noexcept
    TAPPET_REALTIME {
    using namespace sparse;
    const auto kind = robot.template is_revolute<i>();
    const auto c0 = robot.template number<i, Of::c0>();
    const auto s0 = robot.template number<i, Of::s0>();
    const auto d = robot.template number<i, Of::d>();
    const auto c = select(kind, turn.cosine * c0 - turn.sine * s0, c0);
    const auto s = select(kind, turn.cosine * s0 + turn.sine * c0, s0);
    const auto way = select(kind, d, robot.template number<i, Of::sense>() * q + d);
    return Place{kind, Turn{c, s}, way};
}

} // namespace detail

} // namespace tappet::motion
