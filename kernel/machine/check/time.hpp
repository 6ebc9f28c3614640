// Urgency and time: priorities follow from deadlines (deadline monotonic; Leung and Whitehead 1982). For each
// processor, response-time analysis decides whether every deadline holds with the declared budgets.
#pragma once

#include "kernel/machine/check/components.hpp"
#include "kernel/machine/check/on_grid.hpp"
#include "kernel/machine/table/binding.hpp"
#include "kernel/machine/table/board.hpp"

#include <limits>

namespace tappet::checks {

static_assert(max_activities < Inbox::max_senders);

constexpr int processor_of(const Board& board, const Binding& binding, std::string_view activity) noexcept {
    for (const auto& each : binding.placement)
        if (each.activity == activity) return each.processor;
    return board.default_processor;
}

/// Formats nanoseconds in us, as engineers read them.
constexpr Sentence in_us(std::int64_t ns) { return Sentence{ns / 1000, " us"}; }

/// Fills the ranks and their order: real-time activities by shortest deadline, then by the order of the
/// table; activities that are not real-time come last.
constexpr void rank_activities(const MachineView& m, TableIndexView r) {
    const auto more_urgent = [&m](std::size_t a, std::size_t b) {
        const ActivityRow& x = m.activities[a];
        const ActivityRow& y = m.activities[b];
        if (x.real_time != y.real_time) return x.real_time;
        if (x.real_time && x.deadline() != y.deadline()) return x.deadline() < y.deadline();
        return a < b;
    };
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        r.rank[a] = 0;
        for (std::size_t b = 0; b < m.activities.size(); ++b)
            if (a != b && more_urgent(b, a)) ++r.rank[a];
        r.by_rank[r.rank[a]] = a;
    }
}

/// Returns, for each activity, whether it runs by its period alone: no timer of a component, and no time-out
/// of a behaviour, wakes it off the grid. `activity_of`: of each component.
constexpr std::array<bool, max_activities> find_on_grid(const MachineView& m,
                                                        std::span<const std::size_t> activity_of) {
    std::array<bool, max_activities> on_grid{};
    for (std::size_t a = 0; a < m.activities.size(); ++a)
        on_grid[a] = m.activities[a].trigger == Trigger::every;
    const auto leaves_it = [&](std::size_t c) {
        if (c != nowhere && activity_of[c] != nowhere) on_grid[activity_of[c]] = false;
    };
    for (std::size_t c = 0; c < m.components.size(); ++c)
        if (has_facet(m.components[c].type,
                      [](const Facet& facet) { return facet.kind == FacetKind::timer; }))
            leaves_it(c);
    for (const BehaviourRow& each : m.behaviours) leaves_it(find_component(m, each.component));
    return on_grid;
}

/// Returns the worst response of one real-time activity, given the ranks and the processors of all. Ignores
/// deadlines.
constexpr Response worst_response(const MachineView& m, std::span<const std::size_t> rank,
                                  std::span<const int> processors, std::span<const bool> on_grid,
                                  std::size_t a) {
    std::array<TaskTiming, max_activities> tasks{};
    std::size_t count = 0;
    for (std::size_t urgency = 0; urgency <= rank[a]; ++urgency)
        for (std::size_t b = 0; b < rank.size(); ++b) {
            if (rank[b] != urgency || processors[b] != processors[a]) continue;
            // n wakes in a window may come together: they count as one job of n budgets.
            const ActivityRow& other = m.activities[b];
            const std::int64_t wakes_together = other.trigger == Trigger::every ? 1 : other.at_most_n;
            tasks[count++] = {other.shortest_period().count(), other.budget_each.count() * wakes_together,
                              other.deadline().count()};
            if (on_grid[b]) tasks[count - 1].phase_ns = other.phase.count();
        }
    return response_time_on_grid(std::span{tasks}.first(count), count - 1);
}

/// Returns the worst response of each activity of an accepted table; 0: it is not real-time.
constexpr std::array<std::int64_t, max_activities> worst_responses_ns(const MachineView& m,
                                                                      const Board& board,
                                                                      const Binding& binding,
                                                                      const TableIndexView& r) {
    std::array<std::int64_t, max_activities> worst{};
    std::array<int, max_activities> processors{};
    for (std::size_t a = 0; a < m.activities.size(); ++a)
        processors[a] = processor_of(board, binding, m.activities[a].name);
    const auto on_grid = find_on_grid(m, r.activity);
    for (std::size_t a = 0; a < m.activities.size(); ++a)
        if (m.activities[a].real_time) worst[a] = worst_response(m, r.rank, processors, on_grid, a).worst_ns;
    return worst;
}

/// Checks every deadline; fills the worst response times.
constexpr Sentence check_schedulability(const MachineView& m, const Board& board, const Binding& binding,
                                        TableIndexView r) {
    if (m.activities.size() > max_activities)
        return Sentence{"the table has more than ", max_activities,
                        " activities; merge those of equal period"};
    for (const Placement& place : binding.placement) {
        if (find_activity(m, place.activity) == nowhere) {
            Nearest nearest{place.activity};
            for (const auto& row : m.activities) nearest.consider(row.name);
            Sentence text{"binding to board \"", board.name, "\", place(\"", place.activity,
                          "\"): the table has no such activity"};
            detail::add_suggestion(text, nearest, "remove the placement");
            return text;
        }
        for (const Placement& other : binding.placement)
            if (&other != &place && other.activity == place.activity)
                return Sentence{"binding to board \"", board.name, "\": place(\"", place.activity,
                                "\") appears twice; remove one"};
        if (place.processor < 0 || place.processor >= board.processors)
            return of_activity(place.activity, ": its binding to board \"", board.name,
                               "\" places it on processor ", place.processor,
                               " but the board has processors 0 to ", board.processors - 1,
                               "; correct place(\"", place.activity, "\")");
    }
    for (const ActivityRow& row : m.activities) {
        const std::int64_t wakes_together = row.trigger == Trigger::every ? 1 : row.at_most_n;
        std::int64_t needs = 0;
        if (__builtin_mul_overflow(row.budget_each.count(), wakes_together, &needs))
            needs = std::numeric_limits<std::int64_t>::max();
        if (row.real_time && needs > row.deadline().count())
            return of_activity(row.name, ": its budget",
                               wakes_together > 1 ? ", for all wakes that may come together," : "", " is ",
                               in_us(needs), " but its deadline ", in_us(row.deadline().count()),
                               "; lower the budget or lengthen the deadline or the period");
    }
    rank_activities(m, r);
    std::array<int, max_activities> processors{};
    for (std::size_t a = 0; a < m.activities.size(); ++a)
        processors[a] = processor_of(board, binding, m.activities[a].name);
    const auto on_grid = find_on_grid(m, r.activity);
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        r.worst_response_ns[a] = 0;
        const ActivityRow& row = m.activities[a];
        if (!row.real_time) continue;
        const Response response = worst_response(m, r.rank, processors, on_grid, a);
        if (!response.bounded)
            return of_activity(row.name, " is not schedulable on processor ", processors[a], " of board \"",
                               board.name,
                               "\": the activities there need more than all of its time; lower budgets, "
                               "lengthen periods, or place it elsewhere");
        if (!response.within(row.deadline().count()))
            return of_activity(row.name, " is not schedulable on processor ", processors[a], " of board \"",
                               board.name, "\": its worst response is ", in_us(response.worst_ns),
                               ", its deadline ", in_us(row.deadline().count()),
                               "; lower the budget of it or of a more urgent activity, lengthen its "
                               "deadline, or place it elsewhere");
        r.worst_response_ns[a] = response.worst_ns;
    }
    return {};
}

} // namespace tappet::checks
