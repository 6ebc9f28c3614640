// The room that the camera sees, in numbers: field, tunnel, calibration mark, and things that look similar to
// the car.
#pragma once

#include "apps/car_tracking/image.hpp"

namespace tappet::car_tracking::room {

inline constexpr double width = 4.0; ///< of the play field, m; from 0 along x
inline constexpr double depth = 3.0; ///< along y

/// Returns the position of the camera.
inline Eigen::Vector3d eye() { return {2.0, -0.6, 2.0}; }

struct Rectangle {
    double left, near, right, far;
    [[nodiscard]] constexpr bool holds(double x, double y, double margin = 0.0) const {
        return x >= left - margin && x <= right + margin && y >= near - margin && y <= far + margin;
    }
};

/// The tunnel hides the car. Its roof is at tunnel_height.
inline constexpr Rectangle tunnel{2.55, 1.75, 3.45, 2.55};
inline constexpr double tunnel_height = 0.12;

inline constexpr double car_length = 0.30;
inline constexpr double car_width = 0.15;
inline constexpr double car_height = 0.05; ///< of its roof

struct Disc {
    double x, y, radius;
    Colour colour;
    [[nodiscard]] constexpr bool holds(double at_x, double at_y) const {
        return (at_x - x) * (at_x - x) + (at_y - y) * (at_y - y) <= radius * radius;
    }
};

/// The mark on the floor behind the field by which the camera is calibrated.
inline constexpr Disc mark{2.04, 3.38, 0.12, {250, 250, 250}};
/// A red ball, smaller than a car; a blue ball.
inline constexpr std::array<Disc, 2> balls{
    {{0.75, 1.9, 0.05, {205, 45, 40}}, {2.2, 0.9, 0.06, {40, 60, 190}}}};

inline constexpr Colour wall{70, 74, 82};
inline constexpr Colour floor_light{158, 156, 150};
inline constexpr Colour floor_dark{128, 126, 122};
inline constexpr Colour tunnel_roof{96, 84, 66};
inline constexpr Colour car_body{200, 42, 36};

} // namespace tappet::car_tracking::room
