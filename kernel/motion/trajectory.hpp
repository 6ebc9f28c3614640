// Trajectories of axes in closed form: no loop, no search, the shortest time that the limits leave.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/profile.hpp"
#include "kernel/motion/refused.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <expected>

namespace tappet::motion {

using Planned = std::expected<Profile, Refused>;

namespace detail {

constexpr double sign_of(double value) noexcept TAPPET_REALTIME { return value < 0.0 ? -1.0 : 1.0; }

/// Of a positive number: a first guess from its exponent, good to five bits, which Halley's step triples
/// three times. The library's has other bits in constants than at run time.
constexpr double cube_root(double x) noexcept TAPPET_REALTIME {
    if (!(x > 0.0)) return 0.0;
    double y = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + (std::uint64_t{715094163} << 32));
    for (int i = 0; i < 3; ++i) {
        const double cube = y * y * y;
        y *= (cube + 2.0 * x) / (2.0 * cube + x);
    }
    return y;
}

/// At rest there. Numbers that are good by themselves may be too far apart for what is computed of them.
inline Planned whole(Profile profile, double position) noexcept TAPPET_REALTIME {
    if (!profile.rest_at(position)) return std::unexpected(Refused{Refusal::not_a_number});
    return profile;
}

constexpr bool is_limit(double value) noexcept TAPPET_REALTIME { return is_number(value) && value > 0.0; }

} // namespace detail

/// From any position and velocity to rest at `target`, with bounded velocity and acceleration, which jumps;
/// at most three pieces. One that is too fast brakes first, one that cannot stop in time turns back. The
/// acceleration of `from` counts for nothing. Real-time.
inline Planned trapezoid(const AxisState& from, double target, const AxisLimits& limits) noexcept
    TAPPET_REALTIME {
    if (!is_number(from.position) || !is_number(from.velocity) || !is_number(target))
        return std::unexpected(Refused{Refusal::not_a_number});
    const double most = limits.velocity;
    const double a = limits.acceleration;
    if (!detail::is_limit(most) || !detail::is_limit(a))
        return std::unexpected(Refused{Refusal::limit_not_positive});
    const double stops_at = from.position + from.velocity * std::fabs(from.velocity) / (2.0 * a);
    const double side = detail::sign_of(target - stops_at);
    const double v = side * from.velocity;
    const double way = side * (target - from.position);
    const double reached = std::sqrt(std::max(0.0, a * way + 0.5 * v * v)); // were there no limit
    const double peak = std::max(std::min(reached, most), 0.0);
    // What is left for the constant speed, of what both ramps leave over.
    const double first = (v > peak ? v * v - peak * peak : peak * peak - v * v) / (2.0 * a);
    const double cruise = reached > most ? std::max(0.0, way - first - peak * peak / (2.0 * a)) / peak : 0.0;
    Profile profile{from};
    profile.add(std::fabs(peak - v) / a, side * (v > peak ? -a : a), 0.0);
    profile.add(cruise, 0.0, 0.0);
    profile.add(peak / a, -side * a, 0.0);
    return detail::whole(profile, target);
}

/// From rest to rest with bounded velocity, acceleration and jerk, at most seven pieces (Biagiotti and
/// Melchiorri, Trajectory Planning for Automatic Machines and Robots, 3.4). Real-time.
inline Planned jerk_limited(double from, double target, const AxisLimits& limits) noexcept TAPPET_REALTIME {
    if (!is_number(from) || !is_number(target)) return std::unexpected(Refused{Refusal::not_a_number});
    const double a = limits.acceleration;
    const double j = limits.jerk;
    if (!detail::is_limit(limits.velocity) || !detail::is_limit(a) || !detail::is_limit(j))
        return std::unexpected(Refused{Refusal::limit_not_positive});
    const double way = std::fabs(target - from);
    const double side = detail::sign_of(target - from);
    // `bend` is how long the jerk lasts, `ramp` how long the speed rises.
    // Quotients: products have no number sooner.
    const bool has_plateau = limits.velocity / a > a / j;
    double bend = has_plateau ? a / j : std::sqrt(limits.velocity / j);
    double ramp = has_plateau ? bend + limits.velocity / a : 2.0 * bend;
    double cruise = way / limits.velocity - ramp;
    if (cruise < 0.0) { // the speed is not reached
        cruise = 0.0;
        bend = a / j;
        ramp = 0.5 * bend + std::sqrt(0.25 * bend * bend + way / a);
        if (ramp < 2.0 * bend) { // nor is the acceleration
            bend = detail::cube_root(0.5 * way / j);
            ramp = 2.0 * bend;
        }
    }
    const double flat = ramp - 2.0 * bend;
    const double reached = side * j * bend;
    Profile profile{AxisState{from}};
    profile.add(bend, 0.0, side * j);
    profile.add(flat, reached, 0.0);
    profile.add(bend, reached, -side * j);
    profile.add(cruise, 0.0, 0.0);
    profile.add(bend, 0.0, -side * j);
    profile.add(flat, -reached, 0.0);
    profile.add(bend, -reached, side * j);
    return detail::whole(profile, target);
}

/// From any state to rest, wherever that is, in the shortest time that acceleration and jerk leave; at most
/// three pieces. An acceleration beyond its limit is first taken back. Real-time.
inline Planned stop(const AxisState& from, const AxisLimits& limits) noexcept TAPPET_REALTIME {
    if (!is_number(from.position) || !is_number(from.velocity) || !is_number(from.acceleration))
        return std::unexpected(Refused{Refusal::not_a_number});
    const double most = limits.acceleration;
    const double j = limits.jerk;
    if (!detail::is_limit(most) || !detail::is_limit(j))
        return std::unexpected(Refused{Refusal::limit_not_positive});
    // What speed is left when the acceleration has gone: against that it brakes.
    const double left = from.velocity + from.acceleration * std::fabs(from.acceleration) / (2.0 * j);
    const double side = detail::sign_of(left);
    const double v = side * from.velocity;
    const double a = side * from.acceleration;
    const double reached = std::sqrt(std::max(0.0, j * v + 0.5 * a * a)); // were there no limit
    const double brake = std::max(std::min(reached, most), 0.0);
    const double turn = -brake - a; // of the acceleration; below nought but for one beyond its limit
    const double speed = v + 0.5 * (a - brake) * std::fabs(turn) / j;
    const double hold = reached > most ? std::max(0.0, speed - brake * brake / (2.0 * j)) / brake : 0.0;
    Profile profile{from};
    profile.add(std::fabs(turn) / j, from.acceleration, side * detail::sign_of(turn) * j);
    profile.add(hold, -side * brake, 0.0);
    profile.add(brake / j, -side * brake, side * j);
    return detail::whole(profile, profile.end().position);
}

} // namespace tappet::motion
