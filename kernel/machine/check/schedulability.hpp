// Will every deadline be met? Response-time analysis of threads under fixed priorities on one core, and of
// the frames on a CAN bus: integer nanoseconds, so that the compiler can answer before the machine exists.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

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

/// One periodic or sporadic load on one core. period_ns: the least time between two arrivals. jitter_ns: the
/// longest from arrival to release. blocking_ns: the longest that something of lower priority holds it up.
struct TaskTiming {
    std::int64_t period_ns = 0;
    std::int64_t budget_ns = 0;
    std::int64_t deadline_ns = 0;
    std::int64_t jitter_ns = 0;
    std::int64_t blocking_ns = 0;
    std::int64_t phase_ns = -1; ///< of its arrivals on the grid that all periods have; below nought: on none

    [[nodiscard]] constexpr bool is_on_grid() const noexcept { return phase_ns >= 0 && jitter_ns == 0; }
};

/// A data frame of classical CAN, sent once a period at most. CAN FD, with its two bit rates, is another
/// formula.
struct CanMessageTiming {
    bool extended = false; ///< a 29-bit identifier
    unsigned data_bytes = 0;
    std::int64_t period_ns = 0;
    std::int64_t deadline_ns = 0;
    std::int64_t jitter_ns = 0;
};

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

/// Of the task at `index`, of tasks on one core, highest priority first. Deadlines may exceed periods: every
/// job of the level's busy period is looked at (Joseph and Pandya 1986; Audsley 1993; Lehoczky 1990).
constexpr Response response_time(std::span<const TaskTiming> by_priority_highest_first,
                                 std::size_t index) noexcept {
    using analysis::Span;
    if (index >= by_priority_highest_first.size()) return {};
    const auto higher = by_priority_highest_first.first(index);
    const TaskTiming& own = by_priority_highest_first[index];
    for (const TaskTiming& task : by_priority_highest_first.first(index + 1)) {
        const bool sensible = task.period_ns > 0 && task.period_ns <= analysis_max_ns &&
                              Span{task.budget_ns}.exists() && Span{task.jitter_ns}.exists();
        if (!sensible) return {};
    }
    const Span blocking{own.blocking_ns};
    const Span budget{own.budget_ns};
    const Span jitter{own.jitter_ns};

    std::int64_t steps_left = analysis_max_steps;
    const auto interference = [&](Span window) {
        Span sum{0};
        for (const TaskTiming& task : higher) {
            sum = sum +
                  analysis::arrivals(window + Span{task.jitter_ns}, task.period_ns) * Span{task.budget_ns};
        }
        return sum;
    };
    // At least 1 ns: an empty window holds no arrival, and a job of no length waits all the same.
    const auto not_empty = [](Span start) {
        return start.exists() ? Span{std::max<std::int64_t>(1, start.ns)} : start;
    };
    const Span busy = analysis::fixed_point(not_empty(blocking + budget), steps_left, [&](Span window) {
        return blocking + interference(window) +
               std::max<std::int64_t>(1, analysis::arrivals(window + jitter, own.period_ns)) * budget;
    });
    if (!busy.exists()) return {};

    const std::int64_t jobs = std::max<std::int64_t>(1, analysis::arrivals(busy + jitter, own.period_ns));
    std::int64_t worst_ns = 0;
    Span end{};
    for (std::int64_t job = 0; job < jobs; ++job) {
        const Span demand = blocking + (job + 1) * budget;
        // A job ends no earlier than the one before it and its own budget: a start nearer to the fixed point.
        const Span start = not_empty(job == 0 ? demand : end + budget);
        end = analysis::fixed_point(start, steps_left,
                                    [&](Span window) { return demand + interference(window); });
        if (!end.exists()) return {};
        worst_ns = std::max(worst_ns, jitter.ns + end.ns - job * own.period_ns);
    }
    return {true, worst_ns};
}

/// The longest a frame can take on the wire, stuff bits and the gap after it included; rounded up. -1: no
/// such frame.
constexpr std::int64_t can_frame_time_ns(const CanMessageTiming& message, std::int64_t bitrate) noexcept {
    if (message.data_bytes > 8 || bitrate <= 0) return -1;
    // Bits open to stuffing besides the data, and the 13 that are not: delimiters, acknowledge, end, gap.
    const std::int64_t stuffed =
        (message.extended ? 54 : 34) + 8 * static_cast<std::int64_t>(message.data_bytes);
    const std::int64_t bits = stuffed + 13 + (stuffed - 1) / 4;
    return (bits * 1'000'000'000 + bitrate - 1) / bitrate;
}

/// Of the frame at `index`, of all frames on the bus in the order in which they win it: by identifier, a base
/// frame before an extended one with the same first 11 bits (Davis, Burns, Bril and Lukkien 2007, which
/// corrects Tindell 1994). Holds while every node sends its own frames in that order too, and without
/// retransmissions.
constexpr Response can_response_time(std::span<const CanMessageTiming> by_priority_highest_first,
                                     std::size_t index, std::int64_t bitrate) noexcept {
    using analysis::Span;
    if (index >= by_priority_highest_first.size()) return {};
    for (const CanMessageTiming& message : by_priority_highest_first) {
        const bool sensible = message.period_ns > 0 && message.period_ns <= analysis_max_ns &&
                              Span{message.jitter_ns}.exists() && can_frame_time_ns(message, bitrate) > 0;
        if (!sensible) return {};
    }
    const auto higher = by_priority_highest_first.first(index);
    const CanMessageTiming& own = by_priority_highest_first[index];
    const Span bit{(1'000'000'000 + bitrate - 1) / bitrate};
    const Span frame{can_frame_time_ns(own, bitrate)};
    const Span jitter{own.jitter_ns};
    // A frame on the wire is not interrupted, so one of lower priority may just have begun.
    Span blocking{0};
    for (const CanMessageTiming& lower : by_priority_highest_first.subspan(index + 1)) {
        blocking = Span{std::max(blocking.ns, can_frame_time_ns(lower, bitrate))};
    }

    std::int64_t steps_left = analysis_max_steps;
    const auto interference = [&](Span window, Span margin) {
        Span sum{0};
        for (const CanMessageTiming& message : higher) {
            sum = sum + analysis::arrivals(window + Span{message.jitter_ns} + margin, message.period_ns) *
                            Span{can_frame_time_ns(message, bitrate)};
        }
        return sum;
    };
    const Span busy = analysis::fixed_point(frame, steps_left, [&](Span window) {
        return blocking + interference(window, Span{0}) +
               analysis::arrivals(window + jitter, own.period_ns) * frame;
    });
    if (!busy.exists()) return {};

    const std::int64_t frames = analysis::arrivals(busy + jitter, own.period_ns);
    std::int64_t worst_ns = 0;
    for (std::int64_t nth = 0; nth < frames; ++nth) {
        const Span before = blocking + nth * frame;
        // The wire is lost to whoever is ready up to one bit after this frame would begin.
        const Span wait = analysis::fixed_point(
            before, steps_left, [&](Span window) { return before + interference(window, bit); });
        if (!wait.exists()) return {};
        worst_ns = std::max(worst_ns, jitter.ns + wait.ns - nth * own.period_ns + frame.ns);
    }
    return {true, worst_ns};
}

} // namespace tappet
