// Response times of activities whose periods begin on one grid, with phases: activities that never begin
// together delay each other less than if they did (Tindell 1994; Palencia and Gonzalez Harbour 1998, with one
// transaction).
#pragma once

#include "kernel/machine/check/schedulability.hpp"

#include <numeric>

namespace tappet {

namespace analysis {

/// A busy period that begins with an arrival of `first`. Tasks on the grid then arrive as soon as their
/// phases and the common divisor of their periods allow; all other tasks arrive together with `first`.
struct BusyPeriod {
    std::span<const TaskTiming> tasks; ///< up to the analysed task, which is the last
    const TaskTiming& first;

    [[nodiscard]] constexpr std::int64_t offset_of(const TaskTiming& task) const noexcept {
        if (!task.is_on_grid()) return 0;
        const std::int64_t grid = std::gcd(task.period_ns, first.period_ns);
        return ((task.phase_ns - first.phase_ns) % grid + grid) % grid;
    }
    static constexpr std::int64_t arrivals_behind(Span window, std::int64_t offset,
                                                  std::int64_t period) noexcept {
        if (!window.exists() || window.ns <= offset) return 0;
        return arrivals(Span{window.ns - offset}, period);
    }
    [[nodiscard]] constexpr Span demand_above(Span window) const noexcept {
        Span sum{0};
        for (const TaskTiming& task : tasks.first(tasks.size() - 1))
            sum = sum + (task.is_on_grid() ? arrivals_behind(window, offset_of(task), task.period_ns)
                                           : arrivals(window + Span{task.jitter_ns}, task.period_ns)) *
                            Span{task.budget_ns};
        return sum;
    }
    /// Returns the worst response of the analysed task's jobs in it, the first of which arrives after
    /// `offset`; none: the busy period is unbounded.
    [[nodiscard]] constexpr Span worst(std::int64_t offset, std::int64_t& steps_left) const noexcept {
        const TaskTiming& own = tasks.back();
        const Span blocking{own.blocking_ns}, budget{own.budget_ns};
        Span worst{0};
        Span end{0};
        for (std::int64_t job = 0;; ++job) {
            const std::int64_t arrival = offset + job * own.period_ns;
            // Earlier demand must last until the job arrives: otherwise the job begins a busy period of its
            // own.
            const Span before =
                fixed_point(Span{std::max<std::int64_t>(1, end.ns)}, steps_left, [&](Span window) {
                    const Span demand = blocking + job * budget + demand_above(window);
                    return demand.exists() ? Span{std::max<std::int64_t>(1, demand.ns)} : demand;
                });
            if (!before.exists()) return before;
            if (before.ns < arrival) return worst;
            end = fixed_point(before, steps_left, [&](Span window) {
                return blocking + (job + 1) * budget + demand_above(window);
            });
            if (!end.exists()) return end;
            worst = Span{std::max(worst.ns, end.ns - arrival)};
            if (end.ns <= arrival + own.period_ns) return worst;
        }
    }
};

} // namespace analysis

/// Like response_time(), which is an upper bound, but uses the phases. Returns that bound when the task's
/// period has too many places against another task's.
constexpr Response response_time_on_grid(std::span<const TaskTiming> by_priority_highest_first,
                                         std::size_t index) noexcept {
    constexpr std::int64_t most_places = 64;
    const Response together = response_time(by_priority_highest_first, index);
    if (!together.bounded) return together;
    const auto tasks = by_priority_highest_first.first(index + 1);
    const TaskTiming& own = tasks.back();
    bool has_phase = false;
    for (const TaskTiming& task : tasks) has_phase |= task.phase_ns > 0;
    if (!has_phase || !own.is_on_grid()) return together;
    std::int64_t steps_left = analysis_max_steps;
    std::int64_t worst_ns = 0;
    for (const TaskTiming& first : tasks) {
        if (!first.is_on_grid()) continue;
        const std::int64_t grid = std::gcd(own.period_ns, first.period_ns);
        if (own.period_ns / grid > most_places) return together;
        const analysis::BusyPeriod busy{tasks, first};
        for (std::int64_t offset = busy.offset_of(own); offset < own.period_ns; offset += grid) {
            const analysis::Span worst = busy.worst(offset, steps_left);
            if (!worst.exists()) return together;
            worst_ns = std::max(worst_ns, worst.ns);
        }
    }
    return {true, std::min(worst_ns, together.worst_ns)};
}

} // namespace tappet
