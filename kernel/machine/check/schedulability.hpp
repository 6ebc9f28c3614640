// Schedulability: response-time analysis of threads under fixed priorities on one core. It uses integer
// nanoseconds, so that the compiler can decide whether every deadline is met before the machine exists.
#pragma once

#include "kernel/base/response.hpp"

#include <algorithm>
#include <span>

namespace tappet {

/// One periodic or sporadic load on one core. period_ns: the shortest time between two arrivals. jitter_ns:
/// the longest time from arrival to release. blocking_ns: the longest delay by anything of lower priority.
struct TaskTiming {
    std::int64_t period_ns = 0;
    std::int64_t budget_ns = 0;
    std::int64_t deadline_ns = 0;
    std::int64_t jitter_ns = 0;
    std::int64_t blocking_ns = 0;
    std::int64_t phase_ns = -1; ///< of its arrivals on the grid of all periods; negative: not on the grid

    [[nodiscard]] constexpr bool is_on_grid() const noexcept { return phase_ns >= 0 && jitter_ns == 0; }
};

/// The job of a task with the worst response. It is the last of `jobs` of its own jobs; with all
/// higher-priority load they fill a window that begins with the first one's release.
struct WorstJob {
    Response response{};
    std::int64_t window_ns = 0;
    std::int64_t jobs = 1;
};

/// Returns the worst job of the task at `index`; the tasks run on one core, highest priority first. Deadlines
/// may exceed periods: examines every job of the level's busy period (Joseph and Pandya 1986; Audsley 1993;
/// Lehoczky 1990).
constexpr WorstJob worst_job(std::span<const TaskTiming> by_priority_highest_first,
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
    // At least 1 ns: an empty window holds no arrival, yet a job of zero length waits too.
    const auto not_empty = [](Span start) {
        return start.exists() ? Span{std::max<std::int64_t>(1, start.ns)} : start;
    };
    const Span busy = analysis::fixed_point(not_empty(blocking + budget), steps_left, [&](Span window) {
        return blocking + interference(window) +
               std::max<std::int64_t>(1, analysis::arrivals(window + jitter, own.period_ns)) * budget;
    });
    if (!busy.exists()) return {};

    const std::int64_t jobs = std::max<std::int64_t>(1, analysis::arrivals(busy + jitter, own.period_ns));
    WorstJob worst;
    Span end{};
    for (std::int64_t job = 0; job < jobs; ++job) {
        const Span demand = blocking + (job + 1) * budget;
        // A job ends no earlier than the previous one plus its own budget: a start nearer to the fixed point.
        const Span start = not_empty(job == 0 ? demand : end + budget);
        end = analysis::fixed_point(start, steps_left,
                                    [&](Span window) { return demand + interference(window); });
        if (!end.exists()) return {};
        const std::int64_t ns = jitter.ns + end.ns - job * own.period_ns;
        if (job == 0 || ns > worst.response.worst_ns) worst = {{true, ns}, end.ns, job + 1};
    }
    return worst;
}

constexpr Response response_time(std::span<const TaskTiming> by_priority_highest_first,
                                 std::size_t index) noexcept {
    return worst_job(by_priority_highest_first, index).response;
}

} // namespace tappet
