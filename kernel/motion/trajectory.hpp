// Trajectories of axes in closed form: no loop, no search, the shortest time within the limits.
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

/// Returns the cube root of a positive number: a first guess from its exponent, good to five bits, whose
/// precision Halley's step triples three times. The library's result has other bits in constants than at run
/// time.
constexpr double cube_root(double x) noexcept TAPPET_REALTIME {
    if (!(x > 0.0)) return 0.0;
    double y = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + (std::uint64_t{715094163} << 32));
    for (int i = 0; i < 3; ++i) {
        const double cube = y * y * y;
        y *= (cube + 2.0 * x) / (2.0 * cube + x);
    }
    return y;
}

/// Ends the profile at rest. Finite numbers may be too far apart for finite results.
inline Planned whole(Profile profile, double position) noexcept TAPPET_REALTIME {
    if (!profile.rest_at(position)) return std::unexpected(Refused{Refusal::not_a_number});
    return profile;
}

constexpr bool is_limit(double value) noexcept TAPPET_REALTIME { return is_number(value) && value > 0.0; }

} // namespace detail

/// Plans from any position and velocity to rest at `target`, with bounded velocity and acceleration, which
/// jumps; at most three pieces. A start that is too fast brakes first; one that cannot stop in time turns
/// back. The acceleration of `from` is ignored. Real-time.
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
    const double reached = std::sqrt(std::max(0.0, a * way + 0.5 * v * v)); // without the velocity limit
    const double peak = std::max(std::min(reached, most), 0.0);
    // The time at constant speed, for the distance that both ramps leave.
    const double first = (v > peak ? v * v - peak * peak : peak * peak - v * v) / (2.0 * a);
    const double cruise = reached > most ? std::max(0.0, way - first - peak * peak / (2.0 * a)) / peak : 0.0;
    Profile profile{from};
    profile.add(std::fabs(peak - v) / a, side * (v > peak ? -a : a), 0.0);
    profile.add(cruise, 0.0, 0.0);
    profile.add(peak / a, -side * a, 0.0);
    return detail::whole(profile, target);
}

/// Plans from rest to rest with bounded velocity, acceleration and jerk, at most seven pieces (Biagiotti and
/// Melchiorri, Trajectory Planning for Automatic Machines and Robots, 3.4). Real-time.
inline Planned jerk_limited(double from, double target, const AxisLimits& limits) noexcept TAPPET_REALTIME {
    if (!is_number(from) || !is_number(target)) return std::unexpected(Refused{Refusal::not_a_number});
    const double a = limits.acceleration;
    const double j = limits.jerk;
    if (!detail::is_limit(limits.velocity) || !detail::is_limit(a) || !detail::is_limit(j))
        return std::unexpected(Refused{Refusal::limit_not_positive});
    const double way = std::fabs(target - from);
    const double side = detail::sign_of(target - from);
    // `bend` is the duration of the jerk, `ramp` of the speed's rise. Quotients: products overflow sooner.
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

/// Plans from any state to rest, at any position, in the shortest time within the limits of acceleration and
/// jerk; at most three pieces. An acceleration beyond its limit is reduced first. Real-time.
inline Planned stop(const AxisState& from, const AxisLimits& limits) noexcept TAPPET_REALTIME {
    if (!is_number(from.position) || !is_number(from.velocity) || !is_number(from.acceleration))
        return std::unexpected(Refused{Refusal::not_a_number});
    const double most = limits.acceleration;
    const double j = limits.jerk;
    if (!detail::is_limit(most) || !detail::is_limit(j))
        return std::unexpected(Refused{Refusal::limit_not_positive});
    // The speed when the acceleration has been reduced to zero: the profile brakes against it.
    const double left = from.velocity + from.acceleration * std::fabs(from.acceleration) / (2.0 * j);
    const double side = detail::sign_of(left);
    const double v = side * from.velocity;
    const double a = side * from.acceleration;
    const double reached = std::sqrt(std::max(0.0, j * v + 0.5 * a * a)); // without the acceleration limit
    const double brake = std::max(std::min(reached, most), 0.0);
    const double turn = -brake - a; // of the acceleration; negative unless it starts beyond its limit
    const double speed = v + 0.5 * (a - brake) * std::fabs(turn) / j;
    const double hold = reached > most ? std::max(0.0, speed - brake * brake / (2.0 * j)) / brake : 0.0;
    Profile profile{from};
    profile.add(std::fabs(turn) / j, from.acceleration, side * detail::sign_of(turn) * j);
    profile.add(hold, -side * brake, 0.0);
    profile.add(brake / j, -side * brake, side * j);
    return detail::whole(profile, profile.end().position);
}

} // namespace tappet::motion
