// Frames, points and vectors with the frame of reference in their type: mismatches do not compile. A
// reference is any type, a declared one is enough: struct World; struct Flange;
#pragma once

#include "kernel/base/fixed_matrix.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/motion/rotation.hpp"

#include <Eigen/Core>

namespace tappet::motion {

/// A position, by its coordinates in A, m.
template <class A>
struct Point {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
};

/// A direction with a length, along the axes of A: a displacement in m, a velocity in m/s, a force in N.
template <class A>
struct Vector {
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
};

/// The pose of the frame B in the frame A: its axes are the columns of `rotation`, its origin is `position`
/// (m). The default coincides with A. `rotation` must be a rotation matrix; this is not checked.
template <class A, class B>
struct Frame {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d position = Eigen::Vector3d::Zero();

    /// Returns C in A from B in A and C in B. Real-time.
    template <class C>
    friend Frame<A, C> operator*(const Frame& ab, const Frame<B, C>& bc) noexcept TAPPET_REALTIME {
        Frame<A, C> ac;
        ac.rotation.noalias() = ab.rotation * bc.rotation;
        ac.position = ab.rotation * bc.position + ab.position;
        return ac;
    }
    /// Returns the same position, seen from A. Real-time.
    friend Point<A> operator*(const Frame& ab, const Point<B>& b) noexcept TAPPET_REALTIME {
        return {ab.rotation * b.at + ab.position};
    }
    /// Returns the same direction, along the axes of A. Real-time.
    friend Vector<A> operator*(const Frame& ab, const Vector<B>& b) noexcept TAPPET_REALTIME {
        return {ab.rotation * b.along};
    }
    /// Returns A in B. Real-time.
    friend Frame<B, A> inverse(const Frame& ab) noexcept TAPPET_REALTIME {
        Frame<B, A> ba;
        ba.rotation = ab.rotation.transpose();
        ba.position = -(ba.rotation * ab.position);
        return ba;
    }
};

template <class A>
Vector<A> operator-(const Point<A>& to, const Point<A>& from) noexcept TAPPET_REALTIME {
    return {to.at - from.at};
}
template <class A>
Point<A> operator+(const Point<A>& from, const Vector<A>& by) noexcept TAPPET_REALTIME {
    return {from.at + by.along};
}

} // namespace tappet::motion

// Ports can carry them, observers see their numbers; each reference is a different type to a connection.
namespace tappet {

template <class A>
inline constexpr bool copied_as_bytes<motion::Point<A>> = true;
template <class A>
inline constexpr bool copied_as_bytes<motion::Vector<A>> = true;
template <class A, class B>
inline constexpr bool copied_as_bytes<motion::Frame<A, B>> = true;

template <class A>
inline constexpr auto fields_of<motion::Point<A>> = fields(field<&motion::Point<A>::at>("at", "m"));
template <class A>
inline constexpr auto fields_of<motion::Vector<A>> = fields(field<&motion::Vector<A>::along>("along"));
template <class A, class B>
inline constexpr auto fields_of<motion::Frame<A, B>> =
    fields(field<&motion::Frame<A, B>::rotation>("rotation"),
           field<&motion::Frame<A, B>::position>("position", "m"));

} // namespace tappet
