// Conversions of rotations: matrix, rotation vector (axis times angle), and the angle by its parts.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/sine.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace tappet::motion {

/// Returns the matrix of the rotation by |v| rad about v (right hand), by Rodrigues' formula; the identity
/// when v is zero. Real-time.
inline Eigen::Matrix3d rotation_about(const Eigen::Vector3d& v) noexcept TAPPET_REALTIME {
    const double angle = std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
    // sin(x)/x and (1 - cos x)/x2 by their series where the quotients lose precision.
    const bool is_small = angle < 1e-4;
    const auto [half, half_cosine] = sine_cosine(0.5 * angle);
    const double s = is_small ? 1.0 - angle * angle / 6.0 : 2.0 * half * half_cosine / angle;
    const double k = is_small ? 0.5 - angle * angle / 24.0 : 2.0 * half * half / (angle * angle);
    const double c = 1.0 - 2.0 * half * half;
    Eigen::Matrix3d m;
    m << c + k * v.x() * v.x(), k * v.x() * v.y() - s * v.z(), k * v.x() * v.z() + s * v.y(),
        k * v.x() * v.y() + s * v.z(), c + k * v.y() * v.y(), k * v.y() * v.z() - s * v.x(),
        k * v.x() * v.z() - s * v.y(), k * v.y() * v.z() + s * v.x(), c + k * v.z() * v.z();
    return m;
}

/// Returns the rotation vector of a rotation matrix, |v| in [0, pi] rad: the inverse of rotation_about, by
/// the quaternion, so that it stays precise near no turn and near half a turn. Real-time.
inline Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& m) noexcept TAPPET_REALTIME {
    const Eigen::Quaterniond q{m};
    const double sign = q.w() < 0.0 ? -1.0 : 1.0;
    const double sine = std::sqrt(q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
    const double scale = sine < 1e-12 ? 2.0 : 2.0 * std::atan2(sine, sign * q.w()) / sine;
    return {sign * scale * q.x(), sign * scale * q.y(), sign * scale * q.z()};
}

} // namespace tappet::motion
