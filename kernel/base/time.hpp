// The machine's time: nanoseconds since the world began, real (CLOCK_MONOTONIC) or virtual. Never wall-clock
// time.
#pragma once

#include <chrono>
#include <concepts>
#include <cstdint>
#include <limits>

namespace tappet {

using Duration = std::chrono::nanoseconds;

/// The clock of a machine. It has no now(): kernel/os reads the time, real or virtual.
struct MachineClock {
    using duration = Duration;
    using rep = duration::rep;
    using period = duration::period;
    using time_point = std::chrono::time_point<MachineClock, Duration>;
    static constexpr bool is_steady = true;
};

using Time = MachineClock::time_point;

/// A time that is never reached: an activity that waits until it waits for work only.
inline constexpr Time never = Time::max();

namespace detail {
/// Returns the nearest representable number to a sum or difference that may overflow.
constexpr std::int64_t saturated(std::int64_t sum, bool is_beyond, bool is_low) noexcept {
    if (!is_beyond) return sum;
    return is_low ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
}
} // namespace detail

/// These three compute every sum and difference with a Time, because they are more specialized than those of
/// std::chrono. They saturate: a result beyond the earliest or the latest time is that time, and so with
/// durations. `never` plus a duration that is not negative is `never`.
template <class Rep, class Period>
    requires std::convertible_to<std::chrono::duration<Rep, Period>, Duration>
constexpr Time operator+(const Time& at, const std::chrono::duration<Rep, Period>& by) noexcept {
    const std::int64_t a = at.time_since_epoch().count(), b = Duration{by}.count();
    std::int64_t sum = 0;
    const bool is_beyond = __builtin_add_overflow(a, b, &sum);
    return Time{Duration{detail::saturated(sum, is_beyond, b < 0)}};
}
template <class Rep, class Period>
    requires std::convertible_to<std::chrono::duration<Rep, Period>, Duration>
constexpr Time operator+(const std::chrono::duration<Rep, Period>& by, const Time& at) noexcept {
    return at + by;
}
template <class Rep, class Period>
    requires std::convertible_to<std::chrono::duration<Rep, Period>, Duration>
constexpr Time operator-(const Time& at, const std::chrono::duration<Rep, Period>& by) noexcept {
    const std::int64_t a = at.time_since_epoch().count(), b = Duration{by}.count();
    std::int64_t rest = 0;
    const bool is_beyond = __builtin_sub_overflow(a, b, &rest);
    return Time{Duration{detail::saturated(rest, is_beyond, b > 0)}};
}
constexpr Duration operator-(const Time& later, const Time& earlier) noexcept {
    const std::int64_t a = later.time_since_epoch().count(), b = earlier.time_since_epoch().count();
    std::int64_t rest = 0;
    const bool is_beyond = __builtin_sub_overflow(a, b, &rest);
    return Duration{detail::saturated(rest, is_beyond, b > 0)};
}

constexpr Time at_ns(std::int64_t ns) noexcept { return Time{Duration{ns}}; }
constexpr std::int64_t to_ns(Time t) noexcept { return t.time_since_epoch().count(); }
constexpr double to_seconds(Duration d) noexcept { return static_cast<double>(d.count()) * 1e-9; }

using namespace std::chrono_literals;

} // namespace tappet
