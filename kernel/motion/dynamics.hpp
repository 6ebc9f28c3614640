// Inverse dynamics of a chain: the torques for a motion, by the recursive Newton-Euler algorithm (Luh, Walker
// and Paul 1980): outward along the links for their motion, and back for their loads.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/chain.hpp"
#include "kernel/motion/twist.hpp"

#include <Eigen/Core>

#include <concepts>

namespace tappet::motion {

namespace detail {

/// Inputs and results of a computation.
template <int joints>
struct Motion {
    const Joints<joints>& q;
    const Turns<joints>& turns;
    const Joints<joints>& rates;
    const Joints<joints>& accelerations;
    const Eigen::Vector3d& tip_force; ///< that the end exerts, along the axes of the end
    const Eigen::Vector3d& tip_torque;
    Joints<joints>& torques;
};

template <sparse::Number F, sparse::Number B>
constexpr auto friction(double rate, F forward, B backward) noexcept TAPPET_REALTIME {
    if constexpr (std::same_as<F, sparse::Zero> && std::same_as<B, sparse::Zero>)
        return sparse::Zero{};
    else
        return rate > 0.0 ? sparse::value(forward) : rate < 0.0 ? -sparse::value(backward) : 0.0;
}

struct Loads {
    sparse::Triple<double, double, double> force, torque;
};

/// `w`, `e` and `g` are the angular velocity, the angular acceleration and the acceleration of the origin of
/// frame i, along its axes. Returns the load that link i and those beyond it exert on frame i, along its
/// axes.
template <int i, class Robot, class W, class E, class G>
[[gnu::always_inline]] inline Loads loads(const Robot& robot, const Motion<Robot::joints>& motion, W w, E e,
                                          G g) noexcept TAPPET_REALTIME {
    using namespace sparse;
    if constexpr (i == Robot::joints) {
        const auto& f = motion.tip_force;
        const auto& t = motion.tip_torque;
        return {Triple{f.x(), f.y(), f.z()}, Triple{t.x(), t.y(), t.z()}};
    } else {
        const auto number = [&]<Of which>() { return robot.template number<i, which>(); };
        const auto place = place_of<i>(robot, motion.turns[static_cast<std::size_t>(i)], motion.q[i]);
        const Turn tilt{robot.template number<i, Of::ca>(), robot.template number<i, Of::sa>()};
        const double sense = number.template operator()<Of::sense>();
        const double rate = sense * motion.rates[i];
        const double acceleration = sense * motion.accelerations[i];
        const auto kind = place.is_revolute;
        const auto spin = select(kind, rate, Zero{});
        const auto spin_up = select(kind, acceleration, Zero{});
        const auto slide = select(kind, Zero{}, rate);
        const auto slide_up = select(kind, Zero{}, acceleration);
        const auto into = [&](const auto& v) { return back_about_x(tilt, back_about_z(place.turn, v)); };

        const Triple aside{w.y, -w.x, Zero{}}; // w x z
        const auto wi = into(w + Triple{Zero{}, Zero{}, spin});
        const auto ei = into(e + Triple{Zero{}, Zero{}, spin_up} + spin * aside);
        const auto gi = into(g + Triple{Zero{}, Zero{}, slide_up} + (2.0 * slide) * aside);

        // The acceleration of a point r of the link is that of its origin and U r, U = [e x] + [w x][w x].
        const auto xx = wi.x * wi.x;
        const auto yy = wi.y * wi.y;
        const auto zz = wi.z * wi.z;
        const auto xy = wi.x * wi.y;
        const auto yz = wi.y * wi.z;
        const auto xz = wi.x * wi.z;
        const Triple ux{-(yy + zz), xy - ei.z, xz + ei.y};
        const Triple uy{xy + ei.z, -(xx + zz), yz - ei.x};
        const Triple uz{xz - ei.y, yz + ei.x, -(xx + yy)};
        const auto along = [&](const auto& r) {
            return Triple{ux.x * r.x + ux.y * r.y + ux.z * r.z, uy.x * r.x + uy.y * r.y + uy.z * r.z,
                          uz.x * r.x + uz.y * r.y + uz.z * r.z};
        };
        const Triple p{number.template operator()<Of::a>(), place.way * tilt.s, place.way * tilt.c};
        const auto here = gi + along(p);
        const Loads beyond = loads<i + 1>(robot, motion, wi, ei, here);

        const auto m = number.template operator()<Of::mass>();
        const Triple h{number.template operator()<Of::hx>(), number.template operator()<Of::hy>(),
                       number.template operator()<Of::hz>()};
        // Second moments P: the moment of mass in this motion is the sum over r x (U r).
        const auto pxy = number.template operator()<Of::pxy>();
        const auto pyz = number.template operator()<Of::pyz>();
        const auto pxz = number.template operator()<Of::pxz>();
        const Triple px{number.template operator()<Of::pxx>(), pxy, pxz};
        const Triple py{pxy, number.template operator()<Of::pyy>(), pyz};
        const Triple pz{pxz, pyz, number.template operator()<Of::pzz>()};
        const auto dot = [](const auto& a, const auto& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
        const Triple moment{dot(uz, py) - dot(uy, pz), dot(ux, pz) - dot(uz, px), dot(uy, px) - dot(ux, py)};
        const auto force = m * here + along(h) + beyond.force;
        const auto torque = moment + cross(h, here) + cross(p, force) + beyond.torque;

        const auto out = [&](const auto& v) { return about_z(place.turn, about_x(tilt, v)); };
        const auto f = out(force);
        const auto t = out(torque);
        const auto by_drive = number.template operator()<Of::rotor>() * acceleration +
                              number.template operator()<Of::viscous>() * rate +
                              friction(rate, number.template operator()<Of::forward>(),
                                       number.template operator()<Of::backward>());
        motion.torques[i] = sense * (value(select(kind, t.z, f.z)) + by_drive);
        return {Triple{value(f.x), value(f.y), value(f.z)}, Triple{value(t.x), value(t.y), value(t.z)}};
    }
}

} // namespace detail

/// Returns the torques (Nm; of prismatic joints forces, N) for a motion of a chain, against its gravity,
/// inertia, drives and friction, while its end exerts `on_surroundings`. `robot`: folded<chain>, or a Loaded
/// one. Contract: q, rates (rad/s, m/s) and accelerations (rad/s2, m/s2) are finite. Real-time.
template <class Robot>
Joints<Robot::joints>
inverse_dynamics(const Robot& robot, const Joints<Robot::joints>& q, const Joints<Robot::joints>& rates,
                 const Joints<Robot::joints>& accelerations,
                 const Wrench<struct Surroundings, typename Robot::End, typename Robot::End>&
                     on_surroundings = {}) noexcept TAPPET_REALTIME {
    using sparse::Triple, sparse::Zero;
    const auto turns = detail::turns_of(robot, q);
    require_numbers<Robot::joints>(rates);
    require_numbers<Robot::joints>(accelerations);
    Joints<Robot::joints> torques;
    // An upward acceleration of the base has the effect of gravity.
    detail::loads<0>(
        robot,
        detail::Motion<Robot::joints>{q, turns, rates, accelerations, on_surroundings.force,
                                      on_surroundings.torque, torques},
        Triple{Zero{}, Zero{}, Zero{}}, Triple{Zero{}, Zero{}, Zero{}},
        Triple{-robot.template gravity<0>(), -robot.template gravity<1>(), -robot.template gravity<2>()});
    return torques;
}

} // namespace tappet::motion
