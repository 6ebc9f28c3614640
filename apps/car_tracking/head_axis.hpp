// One axis of the camera's head: converts its counts to angles, and computes the speed with which it reaches
// an angle and stops there.
#pragma once

#include "apps/car_tracking/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace tappet::car_tracking {

/// One axis of the head, as its encoder reports it.
struct AxisReading {
    static constexpr double counts_per_degree = 200.0;
    std::int64_t counts = 0;
    bool is_index_seen = false; ///< since power-on
    std::int64_t index_counts = 0;
};

/// The angles at which the index marks are mounted, in degrees.
inline constexpr Aim index_marks{0.0, -30.0};

/// All real-time; angles in degrees.
class HeadAxis {
public:
    /// Stores the device's reading; call it once per step.
    void read(const AxisReading& reading) noexcept TAPPET_REALTIME {
        steps_standing_ = reading.counts == reading_.counts ? steps_standing_ + 1 : 0;
        reading_ = reading;
    }
    /// Defines the position of the last reading as `angle`.
    void call_it(double angle) noexcept TAPPET_REALTIME { offset_ = angle - degrees_of(reading_.counts); }
    /// Defines the position of the index mark as `angle`. Returns false when the mark was not passed yet.
    bool take_index(double angle) noexcept TAPPET_REALTIME {
        if (reading_.is_index_seen) offset_ = angle - degrees_of(reading_.index_counts);
        return reading_.is_index_seen;
    }
    void go_to(double angle) noexcept TAPPET_REALTIME { target_ = angle; }

    [[nodiscard]] double angle() const noexcept TAPPET_REALTIME {
        return degrees_of(reading_.counts) + offset_;
    }
    [[nodiscard]] bool is_index_seen() const noexcept TAPPET_REALTIME { return reading_.is_index_seen; }
    [[nodiscard]] bool arrived() const noexcept TAPPET_REALTIME {
        return std::abs(target_ - angle()) < 2.0 * close_enough && steps_standing_ >= 3;
    }
    /// Returns the speed at which to turn, in deg/s, low enough to brake before the target.
    [[nodiscard]] double speed() const noexcept TAPPET_REALTIME {
        const double way = target_ - angle();
        const double far = std::abs(way);
        if (far < close_enough) return 0.0;
        const double size = std::min({most_speed, std::sqrt(2.0 * braking * far), near_gain * far});
        return way > 0.0 ? size : -size;
    }

private:
    static constexpr double close_enough = 0.02;
    static constexpr double most_speed = 120.0; // deg/s
    static constexpr double braking = 300.0;    // deg/s^2
    static constexpr double near_gain = 30.0;   // 1/s

    static double degrees_of(std::int64_t counts) noexcept TAPPET_REALTIME {
        return static_cast<double>(counts) / AxisReading::counts_per_degree;
    }

    AxisReading reading_{};
    double offset_ = 0.0;
    double target_ = 0.0;
    int steps_standing_ = 0;
};

} // namespace tappet::car_tracking
