// Worst-case times in whole nanoseconds: the result of an analysis, time spans that never overflow, and the
// fixed-point iterations of the analysis. All of it runs in constant expressions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace tappet {

/// The worst time from a release's arrival to its end, own jitter included. `bounded` is false when there is
/// none: too much load, invalid times (a period or bit rate of 0, a negative time), or no result within
/// `analysis_max_steps`. Then worst_ns means nothing.
struct Response {
    bool bounded = false;
    std::int64_t worst_ns = 0;
    [[nodiscard]] constexpr bool within(std::int64_t deadline_ns) const noexcept {
        return bounded && worst_ns <= deadline_ns;
    }
    constexpr bool operator==(const Response&) const = default;
};

/// Most fixed-point steps of one result. Sets loaded to 99 % take some hundreds; without a limit a set loaded
/// to 100 % with jitter would never end.
inline constexpr std::int64_t analysis_max_steps = 20'000;
/// Longest interval of the analysis: 104 days.
inline constexpr std::int64_t analysis_max_ns = std::int64_t{1} << 53;
static_assert(analysis_max_ns <= std::numeric_limits<std::int64_t>::max() / 4,
              "the sum of three times within the limit must not overflow");

namespace analysis {

// A time within [0, analysis_max_ns], or none: a result computed from none is none.
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

// Returns how many arrivals of that period are in a window; periods of 0 do not occur here.
constexpr std::int64_t arrivals(Span window, std::int64_t period_ns) noexcept {
    return window.exists() ? (window.ns + period_ns - 1) / period_ns : -1;
}

// Returns the least fixed point of next() at or above start, or none; subtracts its steps from steps_left.
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
