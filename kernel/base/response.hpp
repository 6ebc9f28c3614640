// Worst cases of time in whole nanoseconds: what an analysis answers, spans that never overflow, and the
// fixed points by which it finds them. All of it runs in constant expressions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace tappet {

/// The worst time from a release's arrival to its end, own jitter included. `bounded` is false when there is
/// none: too much load, a timing without sense (a period or bit rate of 0, a negative time), or no answer
/// within `analysis_max_steps`; worst_ns then means nothing.
struct Response {
    bool bounded = false;
    std::int64_t worst_ns = 0;
    [[nodiscard]] constexpr bool within(std::int64_t deadline_ns) const noexcept {
        return bounded && worst_ns <= deadline_ns;
    }
    constexpr bool operator==(const Response&) const = default;
};

/// Fixed-point steps one answer may take. Sets loaded to 99 % take some hundreds; without a limit one loaded
/// to 100 % with jitter would never end.
inline constexpr std::int64_t analysis_max_steps = 20'000;
/// No interval of the analysis may grow beyond this: 104 days.
inline constexpr std::int64_t analysis_max_ns = std::int64_t{1} << 53;
static_assert(analysis_max_ns <= std::numeric_limits<std::int64_t>::max() / 4,
              "the sum of three times within the limit must not overflow");

namespace analysis {

// A time within [0, analysis_max_ns], or none: nothing computed from none is a time.
struct Span {
    std::int64_t ns = -1;
    constexpr explicit Span(std::int64_t value = -1) noexcept
        : ns{value >= 0 && value <= analysis_max_ns ? value : -1} {}
    [[nodiscard]] constexpr bool exists() const noexcept { return ns >= 0; }
    friend constexpr Span operator+(Span a, Span b) noexcept {
        return a.exists() && b.exists() ? Span{a.ns + b.ns} : Span{};
    }
    friend constexpr Span operator*(std::int64_t times, Span a) noexcept {
        std::int64_t product = 0;
        if (!a.exists() || times < 0 || __builtin_mul_overflow(times, a.ns, &product)) return Span{};
        return Span{product};
    }
};

// How many arrivals of that period fall into a window; 0 periods do not exist here.
constexpr std::int64_t arrivals(Span window, std::int64_t period_ns) noexcept {
    return window.exists() ? (window.ns + period_ns - 1) / period_ns : -1;
}

// The least fixed point of next() at or above start, or none; takes its steps from the given ones.
template <class Next> constexpr Span fixed_point(Span start, std::int64_t& steps_left, Next next) noexcept {
    Span now = start;
    while (now.exists() && steps_left > 0) {
        --steps_left;
        const Span then = next(now);
        if (then.ns == now.ns) return now;
        now = then;
    }
    return Span{};
}

} // namespace analysis

} // namespace tappet
