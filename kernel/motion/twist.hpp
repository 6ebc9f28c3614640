// Twists and wrenches with body, point and axes in their type (after De Laet et al., Geometric relations
// between rigid bodies, IEEE Robotics & Automation Magazine 20(1), 2013).
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/frame.hpp"

#include <Eigen/Core>

namespace tappet::motion {

/// The velocity of Body relative to Reference. `linear` (m/s) is that of the point of Body at the origin of
/// At, `angular` rad/s; both along the axes of In.
template <class Body, class Reference, class At, class In>
struct Twist {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();

    /// Returns the twist of Next relative to Reference, by way of Body. Real-time.
    template <class Next>
    friend Twist<Next, Reference, At, In> operator+(const Twist& body,
                                                    const Twist<Next, Body, At, In>& next) noexcept
        TAPPET_REALTIME {
        return {body.linear + next.linear, body.angular + next.angular};
    }
    /// Returns the twist of Reference relative to Body. Real-time.
    friend Twist<Reference, Body, At, In> operator-(const Twist& twist) noexcept TAPPET_REALTIME {
        return {-twist.linear, -twist.angular};
    }
};

/// The load on Body: `force` N, `torque` Nm about the origin of At; both along the axes of In.
template <class Body, class At, class In>
struct Wrench {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();

    friend Wrench operator+(const Wrench& a, const Wrench& b) noexcept TAPPET_REALTIME {
        return {a.force + b.force, a.torque + b.torque};
    }
    friend Wrench operator-(const Wrench& wrench) noexcept TAPPET_REALTIME {
        return {-wrench.force, -wrench.torque};
    }
};

/// Returns the power of a wrench on a moving body, W. Both at one point, along the same axes. Real-time.
template <class B, class R, class At, class In>
double power(const Wrench<B, At, In>& wrench, const Twist<B, R, At, In>& twist) noexcept TAPPET_REALTIME {
    return wrench.force.dot(twist.linear) + wrench.torque.dot(twist.angular);
}

/// Returns the same motion at the body's point at the origin of To; `way` leads there from the origin of At.
/// Real-time.
template <class To, class B, class R, class At, class In>
Twist<B, R, To, In> moved(const Twist<B, R, At, In>& twist, const Vector<In>& way) noexcept TAPPET_REALTIME {
    return {twist.linear + twist.angular.cross(way.along), twist.angular};
}
/// Returns the same load, torque about the origin of To; `way` leads there from that of At. Real-time.
template <class To, class B, class At, class In>
Wrench<B, To, In> moved(const Wrench<B, At, In>& wrench, const Vector<In>& way) noexcept TAPPET_REALTIME {
    return {wrench.force, wrench.torque + wrench.force.cross(way.along)};
}

/// Returns the same motion at the same point, along the axes of X. Real-time.
template <class X, class In, class B, class R, class At>
Twist<B, R, At, X> turned(const Frame<X, In>& frame, const Twist<B, R, At, In>& twist) noexcept
    TAPPET_REALTIME {
    return {frame.rotation * twist.linear, frame.rotation * twist.angular};
}
/// Returns the same load about the same point, along the axes of X. Real-time.
template <class X, class In, class B, class At>
Wrench<B, At, X> turned(const Frame<X, In>& frame, const Wrench<B, At, In>& wrench) noexcept TAPPET_REALTIME {
    return {frame.rotation * wrench.force, frame.rotation * wrench.torque};
}

/// Converts point and axes at once, for values given wholly in one frame (the adjoint). Real-time.
template <class X, class Y, class B, class R>
Twist<B, R, X, X> operator*(const Frame<X, Y>& frame, const Twist<B, R, Y, Y>& twist) noexcept
    TAPPET_REALTIME {
    return moved<X>(turned(frame, twist), Vector<X>{-frame.position});
}
template <class X, class Y, class B>
Wrench<B, X, X> operator*(const Frame<X, Y>& frame, const Wrench<B, Y, Y>& wrench) noexcept TAPPET_REALTIME {
    return moved<X>(turned(frame, wrench), Vector<X>{-frame.position});
}

/// Returns the twist that moves B from one pose to another within a second: straight, and about one axis. At
/// the origin of B, along the axes of A. Real-time.
template <class A, class B>
Twist<B, A, B, A> difference(const Frame<A, B>& from, const Frame<A, B>& to) noexcept TAPPET_REALTIME {
    return {to.position - from.position, rotation_vector(to.rotation * from.rotation.transpose())};
}

} // namespace tappet::motion

namespace tappet {

template <class... References>
inline constexpr bool copied_as_bytes<motion::Twist<References...>> = true;
template <class... References>
inline constexpr bool copied_as_bytes<motion::Wrench<References...>> = true;

template <class... References>
inline constexpr auto fields_of<motion::Twist<References...>> =
    fields(field<&motion::Twist<References...>::linear>("linear", "m/s"),
           field<&motion::Twist<References...>::angular>("angular", "rad/s"));
template <class... References>
inline constexpr auto fields_of<motion::Wrench<References...>> =
    fields(field<&motion::Wrench<References...>::force>("force", "N"),
           field<&motion::Wrench<References...>::torque>("torque", "Nm"));

} // namespace tappet
