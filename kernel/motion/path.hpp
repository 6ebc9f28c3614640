// Paths of a frame through space, straight or along an arc, as functions of the share travelled; a trajectory
// from 0 to 1 gives the share over time.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/frame.hpp"
#include "kernel/motion/profile.hpp"
#include "kernel/motion/refused.hpp"
#include "kernel/motion/sine.hpp"
#include "kernel/motion/twist.hpp"

#include <algorithm>
#include <cmath>
#include <expected>
#include <limits>
#include <numbers>

namespace tappet::motion {

/// The pose of B in A, its twist at its own origin along the axes of A, and the derivative of that.
template <class A, class B>
struct PathState {
    Frame<A, B> frame;
    Twist<B, A, B, A> velocity;
    Twist<B, A, B, A> acceleration;
};

/// Limits along a path: m and rad, and seconds.
struct PathLimits {
    AxisLimits linear;
    AxisLimits angular;
};

/// The orientation turns about one axis, in proportion to the distance.
template <class A, class B>
class Path {
public:
    /// Creates a straight path. Refused: values that are not finite. Real-time.
    static std::expected<Path, Refused> line(const Frame<A, B>& from, const Frame<A, B>& to) noexcept
        TAPPET_REALTIME {
        Path path{from, to};
        path.along_ = to.position - from.position;
        path.length_ = length_of(path.along_);
        if (!is_number(path.length_) || !is_number(path.angle_))
            return std::unexpected(Refused{Refusal::not_a_number});
        return path;
    }
    /// Creates a path along the circle through three points, less than one turn. Refused: points that
    /// coincide or lie on one line, which define no circle; values that are not finite. Real-time.
    static std::expected<Path, Refused> arc(const Frame<A, B>& from, const Point<A>& via,
                                            const Frame<A, B>& to) noexcept TAPPET_REALTIME {
        Path path{from, to};
        const Eigen::Vector3d a = via.at - from.position;
        const Eigen::Vector3d b = to.position - from.position;
        const Eigen::Vector3d normal = a.cross(b);
        const double area = normal.dot(normal);
        if (!is_number(area) || !is_number(path.angle_))
            return std::unexpected(Refused{Refusal::not_a_number});
        if (!(area > 1e-16 * a.dot(a) * b.dot(b))) return std::unexpected(Refused{Refusal::no_direction});
        const Eigen::Vector3d to_centre = (a.dot(a) * b - b.dot(b) * a).cross(normal) / (2.0 * area);
        path.radius_ = length_of(to_centre);
        path.along_ = -to_centre;
        path.across_ = normal.cross(path.along_) / std::sqrt(area);
        const Eigen::Vector3d last = b - to_centre;
        const double turned = std::atan2(last.dot(path.across_), last.dot(path.along_));
        path.sweep_ = turned > 0.0 ? turned : turned + 2.0 * std::numbers::pi;
        path.length_ = path.radius_ * path.sweep_;
        if (!is_number(path.length_)) return std::unexpected(Refused{Refusal::not_a_number});
        return path;
    }

    [[nodiscard]] double length_m() const noexcept TAPPET_REALTIME { return length_; }
    [[nodiscard]] double angle_rad() const noexcept TAPPET_REALTIME { return angle_; } ///< of its turn
    [[nodiscard]] double radius_m() const noexcept TAPPET_REALTIME { return radius_; } ///< zero: a line

    /// Returns the state at `share` in [0, 1] with its derivatives; continues beyond its ends. Real-time.
    [[nodiscard]] PathState<A, B> at(const AxisState& share) const noexcept TAPPET_REALTIME {
        PathState<A, B> state;
        const auto& [s, rate, change] = share;
        state.frame.rotation = rotation_about(s * turn_) * from_.rotation;
        state.velocity.angular = rate * turn_;
        state.acceleration.angular = change * turn_;
        if (radius_ == 0.0) {
            state.frame.position = from_.position + s * along_;
            state.velocity.linear = rate * along_;
            state.acceleration.linear = change * along_;
            return state;
        }
        const auto [sine, cosine] = sine_cosine(s * sweep_);
        const Eigen::Vector3d out = cosine * along_ + sine * across_;
        const Eigen::Vector3d on = sweep_ * (cosine * across_ - sine * along_);
        state.frame.position = from_.position - along_ + out;
        state.velocity.linear = rate * on;
        state.acceleration.linear = change * on - (rate * sweep_) * (rate * sweep_) * out;
        return state;
    }

    /// Returns the limits of the share, for a trajectory from 0 to 1. On an arc, half of the squared
    /// acceleration is reserved for the curvature. Refused: a limit that is not positive (0: linear, 1:
    /// angular), a path of no length, limits that give none for the share. Real-time.
    [[nodiscard]] std::expected<AxisLimits, Refused> limits(const PathLimits& most) const noexcept
        TAPPET_REALTIME {
        AxisLimits linear = most.linear;
        if (radius_ > 0.0) {
            linear.acceleration *= std::sqrt(0.5);
            linear.velocity = std::min(linear.velocity, std::sqrt(linear.acceleration * radius_));
        }
        constexpr double none = std::numeric_limits<double>::infinity();
        AxisLimits found{none, none, none};
        for (const auto& [limit, size, element] : {Part{linear, length_, 0}, Part{most.angular, angle_, 1}}) {
            if (!(limit.velocity > 0.0 && limit.acceleration > 0.0 && limit.jerk > 0.0))
                return std::unexpected(Refused{Refusal::limit_not_positive, element});
            if (!(size > nowhere)) continue;
            found.velocity = std::min(found.velocity, limit.velocity / size);
            found.acceleration = std::min(found.acceleration, limit.acceleration / size);
            found.jerk = std::min(found.jerk, limit.jerk / size);
        }
        if (!(std::max(length_, angle_) > nowhere)) return std::unexpected(Refused{Refusal::no_direction});
        for (const double limit : {found.velocity, found.acceleration, found.jerk})
            if (!is_number(limit) || limit == 0.0) return std::unexpected(Refused{Refusal::not_a_number});
        return found;
    }

private:
    static constexpr double nowhere = 1e-12; ///< m or rad: rounding error of a zero distance
    struct Part {
        AxisLimits limit;
        double size;
        int element;
    };
    Path(const Frame<A, B>& from, const Frame<A, B>& to) noexcept TAPPET_REALTIME
        : from_(from),
          turn_(rotation_vector(to.rotation* from.rotation.transpose())),
          angle_(length_of(turn_)) {}
    static double length_of(const Eigen::Vector3d& v) noexcept TAPPET_REALTIME { return std::sqrt(v.dot(v)); }

    Frame<A, B> from_;
    Eigen::Vector3d turn_; ///< from the first orientation to the last, along the axes of A
    Eigen::Vector3d along_ = Eigen::Vector3d::Zero();  ///< the distance; of an arc: centre to start
    Eigen::Vector3d across_ = Eigen::Vector3d::Zero(); ///< from the centre to a quarter turn further
    double length_ = 0.0;
    double angle_ = 0.0;
    double radius_ = 0.0;
    double sweep_ = 0.0;
};

} // namespace tappet::motion
