// The geometry of the camera: where a head aims, how a lens maps directions to pixels and back, and where a
// ray meets the floor.
//
// The room's origin is a corner of the play field: x to the right, y away from the camera, z upwards, in
// metres. A camera has the axes right, down and forward. Pixels count from the image's upper left corner.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/program/registered.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <optional>

namespace tappet::car_tracking {

/// The direction of the head, in degrees: pan 0 is along y, positive to the right; tilt 0 is level, positive
/// upwards. A difference of two aims is also an Aim.
struct Aim {
    double pan = 0.0;
    double tilt = 0.0;

    friend constexpr bool operator==(const Aim&, const Aim&) = default;
};

constexpr Aim operator+(const Aim& a, const Aim& b) noexcept TAPPET_REALTIME {
    return {a.pan + b.pan, a.tilt + b.tilt};
}
constexpr Aim operator-(const Aim& a, const Aim& b) noexcept TAPPET_REALTIME {
    return {a.pan - b.pan, a.tilt - b.tilt};
}
constexpr Aim sum_of_aims(const Aim& a, const Aim& b) noexcept TAPPET_REALTIME { return a + b; }
constexpr Aim difference_of_aims(const Aim& a, const Aim& b) noexcept TAPPET_REALTIME { return a - b; }

/// A lens and the sensor behind it: focal length in pixels, and the radial distortion that maps the distance
/// r from the optical axis (of the plane at distance 1) to r (1 + k1 r^2).
struct Lens {
    double focal_px = 0.0;
    double k1 = 0.0;
};

inline constexpr std::size_t image_columns = 160;
inline constexpr std::size_t image_rows = 120;

/// Returns the pixel at the optical axis.
inline Eigen::Vector2d image_centre() noexcept TAPPET_REALTIME {
    return {0.5 * (image_columns - 1), 0.5 * (image_rows - 1)};
}

constexpr double in_radians(double degrees) noexcept TAPPET_REALTIME {
    return degrees * (std::numbers::pi / 180.0);
}
constexpr double in_degrees(double radians) noexcept TAPPET_REALTIME {
    return radians * (180.0 / std::numbers::pi);
}

/// Returns the camera's axes right, down and forward as columns, in the room's frame.
inline Eigen::Matrix3d axes_at(const Aim& aim) noexcept TAPPET_REALTIME {
    const double pan = in_radians(aim.pan);
    const double tilt = in_radians(aim.tilt);
    const double sp = std::sin(pan);
    const double cp = std::cos(pan);
    const double st = std::sin(tilt);
    const double ct = std::cos(tilt);
    Eigen::Matrix3d axes;
    axes << cp, sp * st, sp * ct, //
        -sp, cp * st, cp * ct,    //
        0.0, -ct, st;
    return axes;
}

/// Returns the aim along a direction of the room; the direction's length does not matter.
inline Aim aim_along(const Eigen::Vector3d& direction) noexcept TAPPET_REALTIME {
    return {in_degrees(std::atan2(direction.x(), direction.y())),
            in_degrees(std::atan2(direction.z(), std::hypot(direction.x(), direction.y())))};
}

/// Returns the pixel of a direction in the camera's axes; nothing for a direction behind the camera.
inline std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& ray, const Lens& lens) noexcept
    TAPPET_REALTIME {
    if (ray.z() <= 1e-6) return std::nullopt;
    const Eigen::Vector2d flat{ray.x() / ray.z(), ray.y() / ray.z()};
    const double stretch = lens.focal_px * (1.0 + lens.k1 * flat.squaredNorm());
    return Eigen::Vector2d{image_centre() + stretch * flat};
}

/// Returns the direction that a pixel shows, in the camera's axes and with forward = 1. For |k1| r^2 < 0.2.
inline Eigen::Vector3d ray_of(const Eigen::Vector2d& pixel, const Lens& lens) noexcept TAPPET_REALTIME {
    const Eigen::Vector2d bent = (pixel - image_centre()) / lens.focal_px;
    Eigen::Vector2d flat = bent;
    for (int i = 0; i < 12; ++i) flat = bent / (1.0 + lens.k1 * flat.squaredNorm());
    return {flat.x(), flat.y(), 1.0};
}

/// Returns where a ray from `eye`, in the room, comes down to a height; nothing when it never does.
inline std::optional<Eigen::Vector3d> meet_height(const Eigen::Vector3d& eye,
                                                  const Eigen::Vector3d& direction, double height) noexcept
    TAPPET_REALTIME {
    if (direction.z() >= -1e-6) return std::nullopt;
    const double reach = (height - eye.z()) / direction.z();
    if (reach < 0.0) return std::nullopt;
    return Eigen::Vector3d{eye + reach * direction};
}

} // namespace tappet::car_tracking

template <>
inline constexpr auto tappet::fields_of<tappet::car_tracking::Aim> =
    tappet::fields(tappet::field<&tappet::car_tracking::Aim::pan>("pan", "deg"),
                   tappet::field<&tappet::car_tracking::Aim::tilt>("tilt", "deg"));
/// Scripts may add and subtract aims.
template <>
inline constexpr tappet::Registered<tappet::Op<"+", &tappet::car_tracking::sum_of_aims>,
                                    tappet::Op<"-", &tappet::car_tracking::difference_of_aims>>
    tappet::operators_of<tappet::car_tracking::Aim>{};
template <>
inline constexpr auto tappet::fields_of<tappet::car_tracking::Lens> =
    tappet::fields(tappet::field<&tappet::car_tracking::Lens::focal_px>("focal_px", "px"),
                   tappet::field<&tappet::car_tracking::Lens::k1>("k1"));
