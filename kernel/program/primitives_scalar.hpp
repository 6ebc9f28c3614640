// Primitives on bools, numbers and times. An integer overflow and an integer division by zero fail the
// action; reals follow IEEE 754.
#pragma once

#include "kernel/program/value_access.hpp"

#include <cmath>
#include <limits>

namespace tappet::primitive {

/// `F` is bool(A, B, R&); false: no result.
template <class A, class B, class R, bool (*F)(A, B, R&) noexcept TAPPET_REALTIME>
constexpr ActionResult binary(ProgramContext&, const Instruction&, std::byte* to, const std::byte* a,
                              const std::byte* b) noexcept TAPPET_REALTIME {
    R result{};
    if (!F(load_value<A>(a), load_value<B>(b), result)) return ActionResult::failed;
    store_value(to, result);
    return ActionResult::done;
}
template <class A, class R, bool (*F)(A, R&) noexcept TAPPET_REALTIME>
constexpr ActionResult unary(ProgramContext&, const Instruction&, std::byte* to, const std::byte* a,
                             const std::byte*) noexcept TAPPET_REALTIME {
    R result{};
    if (!F(load_value<A>(a), result)) return ActionResult::failed;
    store_value(to, result);
    return ActionResult::done;
}

// ---- integers, and times, which are integers of nanoseconds

constexpr ScriptInt integer_of(ScriptInt value) noexcept TAPPET_REALTIME { return value; }
constexpr ScriptInt integer_of(Duration value) noexcept TAPPET_REALTIME { return value.count(); }

template <class A, class B, class R>
constexpr bool add_integer(A a, B b, R& to) noexcept TAPPET_REALTIME {
    ScriptInt sum = 0;
    if (__builtin_add_overflow(integer_of(a), integer_of(b), &sum)) return false;
    to = R{sum};
    return true;
}
template <class A, class B, class R>
constexpr bool subtract_integer(A a, B b, R& to) noexcept TAPPET_REALTIME {
    ScriptInt difference = 0;
    if (__builtin_sub_overflow(integer_of(a), integer_of(b), &difference)) return false;
    to = R{difference};
    return true;
}
template <class A, class B, class R>
constexpr bool multiply_integer(A a, B b, R& to) noexcept TAPPET_REALTIME {
    ScriptInt product = 0;
    if (__builtin_mul_overflow(integer_of(a), integer_of(b), &product)) return false;
    to = R{product};
    return true;
}
constexpr bool divisible(ScriptInt a, ScriptInt b) noexcept TAPPET_REALTIME {
    return b != 0 && !(b == -1 && a == std::numeric_limits<ScriptInt>::min());
}
/// Rounds towards zero.
template <class A, class B, class R>
constexpr bool divide_integer(A a, B b, R& to) noexcept TAPPET_REALTIME {
    if (!divisible(integer_of(a), integer_of(b))) return false;
    to = R{integer_of(a) / integer_of(b)};
    return true;
}
/// Has the sign of `a`.
template <class A, class B, class R>
constexpr bool remainder_integer(A a, B b, R& to) noexcept TAPPET_REALTIME {
    if (!divisible(integer_of(a), integer_of(b))) return false;
    to = R{integer_of(a) % integer_of(b)};
    return true;
}
template <class A>
constexpr bool negate_integer(A a, A& to) noexcept TAPPET_REALTIME {
    return subtract_integer(ScriptInt{0}, a, to);
}
template <class A>
constexpr bool absolute_integer(A a, A& to) noexcept TAPPET_REALTIME {
    if (integer_of(a) < 0) return negate_integer(a, to);
    to = a;
    return true;
}

/// Returns whether a rounded real fits into an integer.
constexpr bool fits_integer(double value) noexcept TAPPET_REALTIME {
    return value >= -0x1p63 && value < 0x1p63;
}
inline bool scale_time(Duration a, double b, Duration& to) noexcept TAPPET_REALTIME {
    const double product = std::nearbyint(static_cast<double>(a.count()) * b);
    if (!fits_integer(product)) return false;
    to = Duration{static_cast<ScriptInt>(product)};
    return true;
}
inline bool scale_by_time(double a, Duration b, Duration& to) noexcept TAPPET_REALTIME {
    return scale_time(b, a, to);
}
inline bool shrink_time(Duration a, double b, Duration& to) noexcept TAPPET_REALTIME {
    const double quotient = std::nearbyint(static_cast<double>(a.count()) / b);
    if (!fits_integer(quotient)) return false;
    to = Duration{static_cast<ScriptInt>(quotient)};
    return true;
}
constexpr bool ratio_of_times(Duration a, Duration b, double& to) noexcept TAPPET_REALTIME {
    to = static_cast<double>(a.count()) / static_cast<double>(b.count());
    return true;
}

// ---- reals

constexpr bool add_real(double a, double b, double& to) noexcept TAPPET_REALTIME {
    to = a + b;
    return true;
}
constexpr bool subtract_real(double a, double b, double& to) noexcept TAPPET_REALTIME {
    to = a - b;
    return true;
}
constexpr bool multiply_real(double a, double b, double& to) noexcept TAPPET_REALTIME {
    to = a * b;
    return true;
}
inline bool divide_real(double a, double b, double& to) noexcept TAPPET_REALTIME {
    to = a / b;
    return true;
}
constexpr bool negate_real(double a, double& to) noexcept TAPPET_REALTIME {
    to = -a;
    return true;
}

/// A function of <cmath> of one or two reals.
template <double (*F)(double)>
bool real_function(double a, double& to) noexcept TAPPET_REALTIME {
    TAPPET_ESCAPE("a function of the mathematics library computes, and does nothing else", to = F(a));
    return true;
}
template <double (*F)(double, double)>
bool real_function2(double a, double b, double& to) noexcept TAPPET_REALTIME {
    TAPPET_ESCAPE("a function of the mathematics library computes, and does nothing else", to = F(a, b));
    return true;
}

// ---- comparison of numbers and times

template <class T>
constexpr bool equal(T a, T b, bool& to) noexcept TAPPET_REALTIME {
    to = a == b;
    return true;
}
template <class T>
constexpr bool unequal(T a, T b, bool& to) noexcept TAPPET_REALTIME {
    to = !(a == b);
    return true;
}
template <class T>
constexpr bool less(T a, T b, bool& to) noexcept TAPPET_REALTIME {
    to = a < b;
    return true;
}
template <class T>
constexpr bool at_most(T a, T b, bool& to) noexcept TAPPET_REALTIME {
    to = a <= b;
    return true;
}
template <class T>
constexpr bool greater(T a, T b, bool& to) noexcept TAPPET_REALTIME {
    to = a > b;
    return true;
}
template <class T>
constexpr bool at_least(T a, T b, bool& to) noexcept TAPPET_REALTIME {
    to = a >= b;
    return true;
}
template <class T>
constexpr bool lesser_of(T a, T b, T& to) noexcept TAPPET_REALTIME {
    to = b < a ? b : a;
    return true;
}
template <class T>
constexpr bool greater_of(T a, T b, T& to) noexcept TAPPET_REALTIME {
    to = a < b ? b : a;
    return true;
}

// ---- bools

constexpr bool both(bool a, bool b, bool& to) noexcept TAPPET_REALTIME {
    to = a && b;
    return true;
}
constexpr bool either(bool a, bool b, bool& to) noexcept TAPPET_REALTIME {
    to = a || b;
    return true;
}
constexpr bool invert(bool a, bool& to) noexcept TAPPET_REALTIME {
    to = !a;
    return true;
}

// ---- conversions between the script's types

constexpr bool integer_to_real(ScriptInt a, double& to) noexcept TAPPET_REALTIME {
    to = static_cast<double>(a);
    return true;
}
/// Rounds towards zero; fails when no integer holds it, or for NaN.
constexpr bool real_to_integer(double a, ScriptInt& to) noexcept TAPPET_REALTIME {
    if (!fits_integer(a)) return false;
    to = static_cast<ScriptInt>(a);
    return true;
}
constexpr bool boolean_to_integer(bool a, ScriptInt& to) noexcept TAPPET_REALTIME {
    to = a ? 1 : 0;
    return true;
}
constexpr bool time_to_seconds(Duration a, double& to) noexcept TAPPET_REALTIME {
    to = to_seconds(a);
    return true;
}
inline bool seconds_to_time(double a, Duration& to) noexcept TAPPET_REALTIME {
    return scale_time(Duration{1'000'000'000}, a, to);
}

// ---- C++ numbers and script numbers: read from any width, written where they fit

template <class Stored>
constexpr bool widen(Stored a, ScriptInt& to) noexcept TAPPET_REALTIME {
    if constexpr (std::is_unsigned_v<Stored> && sizeof(Stored) == sizeof(ScriptInt))
        if (a > static_cast<Stored>(std::numeric_limits<ScriptInt>::max())) return false;
    to = static_cast<ScriptInt>(a);
    return true;
}
template <class Stored>
constexpr bool narrow(ScriptInt a, Stored& to) noexcept TAPPET_REALTIME {
    if constexpr (std::is_unsigned_v<Stored>) {
        if (a < 0) return false;
        if constexpr (sizeof(Stored) < sizeof(ScriptInt))
            if (a > static_cast<ScriptInt>(std::numeric_limits<Stored>::max())) return false;
    } else {
        if (a < std::numeric_limits<Stored>::min() || a > std::numeric_limits<Stored>::max()) return false;
    }
    to = static_cast<Stored>(a);
    return true;
}
constexpr bool widen_real(float a, double& to) noexcept TAPPET_REALTIME {
    to = static_cast<double>(a);
    return true;
}
/// Fails when a finite value would become infinite.
constexpr bool narrow_real(double a, float& to) noexcept TAPPET_REALTIME {
    constexpr double most = static_cast<double>(std::numeric_limits<float>::max());
    if (a - a == 0 && (a > most || a < -most)) return false;
    to = static_cast<float>(a);
    return true;
}

} // namespace tappet::primitive
