// Numbers that are zero at compile time. Compilers cannot remove a * 0.0 or a + 0.0 (a may be NaN or -0), so
// zero is a type here, and computations with it vanish.
#pragma once

#include "kernel/base/realtime.hpp"

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

namespace tappet::motion::sparse {

struct Zero {};

template <class T>
concept Number = std::same_as<T, Zero> || std::same_as<T, double>;

// clang-format off
constexpr double value(double a) noexcept TAPPET_REALTIME { return a; }
constexpr double value(Zero) noexcept TAPPET_REALTIME { return 0.0; }
constexpr Zero operator-(Zero) noexcept TAPPET_REALTIME { return {}; }
constexpr Zero operator*(Zero, Zero) noexcept TAPPET_REALTIME { return {}; }
constexpr Zero operator*(Zero, double) noexcept TAPPET_REALTIME { return {}; }
constexpr Zero operator*(double, Zero) noexcept TAPPET_REALTIME { return {}; }
constexpr Zero operator+(Zero, Zero) noexcept TAPPET_REALTIME { return {}; }
constexpr double operator+(Zero, double b) noexcept TAPPET_REALTIME { return b; }
constexpr double operator+(double a, Zero) noexcept TAPPET_REALTIME { return a; }
constexpr Zero operator-(Zero, Zero) noexcept TAPPET_REALTIME { return {}; }
constexpr double operator-(Zero, double b) noexcept TAPPET_REALTIME { return -b; }
constexpr double operator-(double a, Zero) noexcept TAPPET_REALTIME { return a; }
// clang-format on

/// Selects one of two, at compile time or at run time.
template <Number A, Number B>
constexpr A select(std::true_type, A a, B) noexcept TAPPET_REALTIME {
    return a;
}
template <Number A, Number B>
constexpr B select(std::false_type, A, B b) noexcept TAPPET_REALTIME {
    return b;
}
template <Number A, Number B>
constexpr double select(bool is_first, A a, B b) noexcept TAPPET_REALTIME {
    return is_first ? value(a) : value(b);
}

template <Number X, Number Y, Number Z>
struct Triple {
    X x;
    Y y;
    Z z;
    [[nodiscard]] Eigen::Vector3d dense() const noexcept TAPPET_REALTIME {
        return {value(x), value(y), value(z)};
    }
};

template <Number... A, Number... B>
constexpr auto operator+(const Triple<A...>& a, const Triple<B...>& b) noexcept TAPPET_REALTIME {
    return Triple{a.x + b.x, a.y + b.y, a.z + b.z};
}
template <Number... A, Number... B>
constexpr auto operator-(const Triple<A...>& a, const Triple<B...>& b) noexcept TAPPET_REALTIME {
    return Triple{a.x - b.x, a.y - b.y, a.z - b.z};
}
template <Number S, Number... A>
constexpr auto operator*(S s, const Triple<A...>& a) noexcept TAPPET_REALTIME {
    return Triple{s * a.x, s * a.y, s * a.z};
}
template <Number... A, Number... B>
constexpr auto cross(const Triple<A...>& a, const Triple<B...>& b) noexcept TAPPET_REALTIME {
    return Triple{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Cosine and sine of an angle.
template <Number C, Number S>
struct Turn {
    C c;
    S s;
};

/// Converts components along the axes after a turn about z to those before it, and back.
template <Number... T, Number... A>
constexpr auto about_z(const Turn<T...>& t, const Triple<A...>& a) noexcept TAPPET_REALTIME {
    return Triple{t.c * a.x - t.s * a.y, t.s * a.x + t.c * a.y, a.z};
}
template <Number... T, Number... A>
constexpr auto back_about_z(const Turn<T...>& t, const Triple<A...>& a) noexcept TAPPET_REALTIME {
    return Triple{t.c * a.x + t.s * a.y, t.c * a.y - t.s * a.x, a.z};
}
/// The same about x.
template <Number... T, Number... A>
constexpr auto about_x(const Turn<T...>& t, const Triple<A...>& a) noexcept TAPPET_REALTIME {
    return Triple{a.x, t.c * a.y - t.s * a.z, t.s * a.y + t.c * a.z};
}
template <Number... T, Number... A>
constexpr auto back_about_x(const Turn<T...>& t, const Triple<A...>& a) noexcept TAPPET_REALTIME {
    return Triple{a.x, t.c * a.y + t.s * a.z, t.c * a.z - t.s * a.y};
}

} // namespace tappet::motion::sparse
