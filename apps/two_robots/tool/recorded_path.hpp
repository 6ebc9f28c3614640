// A recorded movement of the tip for replay: places at even times, connected by a curve.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/sine.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>

namespace two_robots {

/// A circle of 20 mm radius around the hole's axis at 10 mm/s, a sample each fifth of a second; in m.
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

/// Returns the place on the Catmull-Rom curve through the samples, cyclically. Real-time.
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
