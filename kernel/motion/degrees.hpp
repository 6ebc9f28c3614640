// Sine and cosine of constants: exact where an angle is a whole number of quarter turns, and computed by the
// compiler, which clang does not do with the library's.
#pragma once

#include "kernel/base/realtime.hpp"

namespace tappet::motion {

struct SineCosine {
    double sine;
    double cosine;
};

/// Of an angle in degrees, at most 1e9 either way; within 2e-16. Real-time, though meant for tables.
constexpr SineCosine sine_cosine_of_degrees(double degrees) noexcept TAPPET_REALTIME {
    const double quarters_real = degrees / 90.0;
    const auto quarters = static_cast<long long>(quarters_real + (quarters_real < 0.0 ? -0.5 : 0.5));
    // In [-45, 45] degrees the series is at its last bit after ten terms.
    const double x = (degrees - 90.0 * static_cast<double>(quarters)) * (3.14159265358979323846 / 180.0);
    double sine = 0.0;
    double cosine = 0.0;
    for (int n = 20; n > 0; n -= 2) {
        cosine = (1.0 + cosine) * -x * x / (n * (n - 1));
        sine = (1.0 + sine) * -x * x / (n * (n + 1));
    }
    sine = x + x * sine;
    cosine = 1.0 + cosine;
    switch (((quarters % 4) + 4) % 4) {
    case 0: return {sine, cosine};
    case 1: return {cosine, -sine};
    case 2: return {-sine, -cosine};
    default: return {-cosine, sine};
    }
}

} // namespace tappet::motion
