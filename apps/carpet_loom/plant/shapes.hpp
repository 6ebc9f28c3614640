// Functions and rounding that the physics uses instead of libm, for the same bits with every compiler.
#pragma once

#include "kernel/base/realtime.hpp"

#include <cstdint>

namespace tappet::loom {

/// Returns the nearest integer, halves away from zero; |x| below 2^62.
constexpr std::int64_t round_to_int(double x) noexcept TAPPET_REALTIME {
    return static_cast<std::int64_t>(x < 0.0 ? x - 0.5 : x + 0.5);
}

/// Returns the largest integer not above x; |x| below 2^62.
constexpr std::int64_t floor_to_int(double x) noexcept TAPPET_REALTIME {
    const auto whole = static_cast<std::int64_t>(x);
    return static_cast<double>(whole) > x ? whole - 1 : whole;
}

/// sin(2 pi turns), error below 4e-6: Taylor's polynomial of degree 9 on the folded quarter.
constexpr double sine_of_turns(double turns) noexcept TAPPET_REALTIME {
    double x = turns - static_cast<double>(round_to_int(turns));
    if (x > 0.25) x = 0.5 - x;
    if (x < -0.25) x = -0.5 - x;
    const double y = x * 6.283185307179586;
    const double s = y * y;
    return y * (1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0))));
}

/// Returns the angle wrapped into (-180, 180].
constexpr double wrapped_deg(double deg) noexcept TAPPET_REALTIME {
    const double turns = static_cast<double>(floor_to_int((deg + 180.0) / 360.0));
    const double rest = deg - 360.0 * turns;
    return rest == -180.0 ? 180.0 : rest;
}

/// Returns the angle wrapped into [0, 360).
constexpr double angle_of_position(double position_deg) noexcept TAPPET_REALTIME {
    return position_deg - 360.0 * static_cast<double>(floor_to_int(position_deg / 360.0));
}

constexpr double clamp_to(double x, double limit) noexcept TAPPET_REALTIME {
    return x > limit ? limit : x < -limit ? -limit : x;
}

inline constexpr double deg_per_rad = 57.29577951308232;
inline constexpr double rad_s_per_rpm = 0.10471975511965977;

} // namespace tappet::loom
