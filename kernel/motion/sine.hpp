// Sine and cosine together, inlined: the same bits with every compiler, library and processor, in constants
// too, and half the time of two calls. Joints of a chain are turned by nothing else.
#pragma once

#include "kernel/base/realtime.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace tappet::motion {

struct SineCosine {
    double sine;
    double cosine;
};

namespace detail {

/// Of r in [-pi/4, pi/4], turned by quarters: within one unit of the last place. The polynomials are those of
/// fdlibm (Sun Microsystems 1993). No branch: quadrants cannot be foretold.
constexpr SineCosine of_quarter(double r, std::int64_t quarters) noexcept TAPPET_REALTIME {
    const double z = r * r;
    const double w = z * z;
    const double ps = 8.33333333332248946124e-03 +
                      z * (-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
                      z * w * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
    const double pc = z * (4.16666666666666019037e-02 +
                           z * (-1.38888888888741095749e-03 + z * 2.48015872894767294178e-05)) +
                      w * w *
                          (-2.75573143513906633035e-07 +
                           z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11));
    const double half = 0.5 * z;
    const double rest = 1.0 - half;
    const auto sine = std::bit_cast<std::uint64_t>(r + z * r * (-1.66666666666666324348e-01 + z * ps));
    const auto cosine = std::bit_cast<std::uint64_t>(rest + (((1.0 - rest) - half) + z * pc));
    const auto q = static_cast<std::uint64_t>(quarters);
    const std::uint64_t exchanged = (sine ^ cosine) & (0 - (q & 1));
    return {std::bit_cast<double>(sine ^ exchanged ^ ((q & 2) << 62)),
            std::bit_cast<double>(cosine ^ exchanged ^ (((q + 1) & 2) << 62))};
}

} // namespace detail

/// Of an angle in rad, within 2e-16 up to 1e5 rad; beyond that by the library. Real-time.
constexpr SineCosine sine_cosine(double angle) noexcept TAPPET_REALTIME {
    if (!(angle < 1e5 && angle > -1e5)) [[unlikely]]
        return {std::sin(angle), std::cos(angle)};
    // Added to this, a number keeps its whole part in its last bits.
    constexpr double whole = 0x1.8p52;
    const double shifted = angle * 6.36619772367581382433e-01 + whole;
    const double n = shifted - whole;
    // A quarter turn in two parts, of which the first has so few bits that its product with n is exact.
    const double r = (angle - n * 1.57079632673412561417e+00) - n * 6.07710050650619224932e-11;
    return detail::of_quarter(r, std::bit_cast<std::int64_t>(shifted));
}

/// Of an angle in degrees, at most 1e9 either way: exact where it is a whole number of quarter turns.
/// Real-time.
constexpr SineCosine sine_cosine_of_degrees(double degrees) noexcept TAPPET_REALTIME {
    const double turned = degrees / 90.0;
    const auto quarters = static_cast<std::int64_t>(turned + (turned < 0.0 ? -0.5 : 0.5));
    const double rest = degrees - 90.0 * static_cast<double>(quarters);
    return detail::of_quarter(rest * (3.14159265358979323846 / 180.0), quarters);
}

} // namespace tappet::motion
