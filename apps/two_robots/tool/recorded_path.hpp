// A movement of the tip that was recorded and is replayed: places at even times, between them a curve.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/sine.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>

namespace two_robots {

/// Round the middle at 20 mm and 10 mm/s, one sample each fifth of a second; m, beside the hole's axis.
inline constexpr std::size_t recorded_samples = 63;
inline constexpr double recorded_step_s = 0.2;
inline constexpr double recorded_s = recorded_samples * recorded_step_s;
inline constexpr double recorded_radius = 0.020;

inline constexpr auto recorded = [] {
    std::array<std::array<double, 2>, recorded_samples> samples{};
    for (std::size_t i = 0; i < recorded_samples; ++i) {
        const auto [sine, cosine] =
            tappet::motion::sine_cosine_of_degrees(360.0 * static_cast<double>(i) / recorded_samples);
        samples[i] = {recorded_radius * cosine, recorded_radius * sine};
    }
    return samples;
}();

/// The curve of Catmull and Rom through the samples, round and round. Real-time.
inline Eigen::Vector3d recorded_at(double seconds) noexcept TAPPET_REALTIME {
    const double place = seconds / recorded_step_s;
    const double whole = std::floor(place);
    const double t = place - whole;
    const auto at = static_cast<std::size_t>(whole) + recorded_samples;
    const auto sample = [&](std::size_t i) noexcept TAPPET_REALTIME {
        const auto& [x, y] = recorded[(at + i - 1) % recorded_samples];
        return Eigen::Vector3d{x, y, 0.0};
    };
    const Eigen::Vector3d a = sample(0), b = sample(1), c = sample(2), d = sample(3);
    return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

} // namespace two_robots
