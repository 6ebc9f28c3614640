// Response-time analysis against worked examples and a simulation.
#include "kernel/machine/check/on_grid.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace {

using namespace tappet;

constexpr std::int64_t huge = std::numeric_limits<std::int64_t>::max();

constexpr TaskTiming task(std::int64_t budget, std::int64_t period) { return {period, budget, period}; }
constexpr Response worst(std::int64_t ns) { return {true, ns}; }

constexpr std::array rate_monotonic{task(3, 7), task(3, 12), task(5, 20)};
static_assert(response_time(rate_monotonic, 0) == worst(3));
static_assert(response_time(rate_monotonic, 1) == worst(6));
static_assert(response_time(rate_monotonic, 2) == worst(20));

constexpr std::array fully_loaded{task(5, 20), task(10, 40), task(40, 80)};
static_assert(response_time(fully_loaded, 0) == worst(5));
static_assert(response_time(fully_loaded, 1) == worst(15));
static_assert(response_time(fully_loaded, 2) == worst(80));

constexpr std::array three{task(3, 9), task(4, 12), task(2, 18)};
static_assert(response_time(three, 0) == worst(3));
static_assert(response_time(three, 1) == worst(7));
static_assert(response_time(three, 2) == worst(9));

// Lehoczky's example: the jobs of the busy period of 694 take 114 102 116 104 118 106 94.
constexpr std::array past_its_period{task(26, 70), task(62, 100)};
static_assert(response_time(past_its_period, 1) == worst(118), "the first job, 114, is not the worst");

TEST(ResponseTime, meets_a_deadline_to_the_nanosecond) {
    const Response response = response_time(rate_monotonic, 2);
    EXPECT_TRUE(response.within(20));
    EXPECT_FALSE(response.within(19));
    EXPECT_FALSE(Response{}.within(huge)) << "what has no bound meets no deadline";
}

TEST(ResponseTime, counts_blocking_once_in_each_busy_period) {
    std::array tasks = rate_monotonic;
    tasks[0].blocking_ns = 4;
    EXPECT_EQ(response_time(tasks, 0), worst(7));
    EXPECT_EQ(response_time(tasks, 1), worst(6)) << "the blocking of others is theirs";
}

TEST(ResponseTime, includes_its_own_jitter_from_the_arrival_on) {
    std::array tasks = rate_monotonic;
    tasks[1].jitter_ns = 2;
    EXPECT_EQ(response_time(tasks, 1), worst(8));
}

TEST(ResponseTime, includes_one_more_arrival_for_jitter_of_higher_priority) {
    std::array tasks{task(2, 10), task(5, 30)};
    EXPECT_EQ(response_time(tasks, 1), worst(7));
    tasks[0].jitter_ns = 4;
    EXPECT_EQ(response_time(tasks, 1), worst(9)) << "at 0 and, with the jitter of the first gone, at 6";
}

TEST(ResponseTime, is_unbounded_above_full_load) {
    const std::array tasks{task(6, 10), task(5, 10)};
    EXPECT_TRUE(response_time(tasks, 0).bounded);
    EXPECT_FALSE(response_time(tasks, 1).bounded);
}

TEST(ResponseTime, is_unbounded_at_full_load_with_blocking) {
    std::array tasks{task(5, 10), task(5, 10)};
    EXPECT_EQ(response_time(tasks, 1), worst(10));
    tasks[1].blocking_ns = 1;
    EXPECT_FALSE(response_time(tasks, 1).bounded);
}

TEST(ResponseTime, includes_interference_for_a_task_without_own_work) {
    const std::array tasks{task(6, 10), task(0, 10)};
    EXPECT_EQ(response_time(tasks, 1), worst(6));
    EXPECT_EQ(response_time(std::array{task(0, 10)}, 0), worst(0));
}

TEST(ResponseTime, refuses_impossible_timings) {
    EXPECT_FALSE(response_time({}, 0).bounded);
    EXPECT_FALSE(response_time(rate_monotonic, 3).bounded);
    EXPECT_FALSE(response_time(std::array{task(1, 0)}, 0).bounded);
    EXPECT_FALSE(response_time(std::array{task(1, -5)}, 0).bounded);
    EXPECT_FALSE(response_time(std::array{task(-1, 5)}, 0).bounded);
    EXPECT_FALSE(response_time(std::array{TaskTiming{5, 1, 5, -1, 0}}, 0).bounded);
    EXPECT_FALSE(response_time(std::array{TaskTiming{5, 1, 5, 0, -1}}, 0).bounded);
    EXPECT_FALSE(response_time(std::array{task(0, 0), task(1, 5)}, 1).bounded) << "above it, too";
}

TEST(ResponseTime, survives_the_largest_numbers) {
    for (const std::int64_t budget : {std::int64_t{1}, huge / 2, huge}) {
        for (const std::int64_t period : {std::int64_t{1}, huge / 2, huge}) {
            for (const std::int64_t jitter : {std::int64_t{0}, huge}) {
                const TaskTiming extreme{period, budget, huge, jitter, jitter};
                const Response response = response_time(std::array{extreme, extreme}, 1);
                EXPECT_FALSE(response.bounded);
            }
        }
    }
    const TaskTiming long_one{analysis_max_ns, analysis_max_ns / 4, huge, 0, 0};
    EXPECT_EQ(response_time(std::array{long_one, long_one}, 1), worst(analysis_max_ns / 2));
}

// The analysis is exact for tasks that arrive together without jitter: a simulation of every nanosecond
// agrees.
std::int64_t simulated_worst(std::span<const TaskTiming> tasks, std::size_t index, std::int64_t until) {
    struct State {
        std::int64_t jobs_done = 0;
        std::int64_t done_of_job = 0;
    };
    std::vector<State> states(tasks.size());
    std::int64_t longest = 0;
    for (std::int64_t now = 0; now < until; ++now) {
        for (std::size_t i = 0; i <= index; ++i) {
            const std::int64_t arrival =
                states[i].jobs_done * tasks[i].period_ns + std::max<std::int64_t>(0, tasks[i].phase_ns);
            if (arrival > now) continue;
            if (++states[i].done_of_job == tasks[i].budget_ns) {
                if (i == index) longest = std::max(longest, now + 1 - arrival);
                states[i].done_of_job = 0;
                ++states[i].jobs_done;
            }
            break;
        }
    }
    return longest;
}

TEST(ResponseTimeOnGrid, equals_that_of_a_lone_task_when_phases_separate_tasks) {
    std::array<TaskTiming, 2> tasks{task(400, 1000), task(300, 1000)};
    EXPECT_EQ(response_time(tasks, 1), worst(700));
    tasks[0].phase_ns = 0;
    tasks[1].phase_ns = 0;
    EXPECT_EQ(response_time_on_grid(tasks, 1), worst(700));
    tasks[1].phase_ns = 400;
    EXPECT_EQ(response_time_on_grid(tasks, 1), worst(300));
    tasks[1].phase_ns = 300;
    EXPECT_EQ(response_time_on_grid(tasks, 1), worst(400));
    tasks[0].phase_ns = -1; // it arrives at any time
    EXPECT_EQ(response_time_on_grid(tasks, 1), worst(700));
}

TEST(ResponseTimeOnGrid, bounds_a_simulation_and_never_exceeds_the_bound_without_phases) {
    Random random{11};
    constexpr std::array<std::int64_t, 5> periods{6, 12, 18, 24, 36};
    int shorter = 0, exact = 0, all = 0;
    for (int round = 0; round < 400; ++round) {
        std::vector<TaskTiming> tasks;
        double load = 0;
        for (int i = 0; i < 4; ++i) {
            const std::int64_t period = periods[random.below(periods.size())];
            const std::int64_t budget = random.between(1, period / 3);
            load += static_cast<double>(budget) / static_cast<double>(period);
            if (load > 0.95) break;
            tasks.push_back(task(budget, period));
            tasks.back().phase_ns = random.between(0, period - 1);
        }
        for (std::size_t i = 0; i < tasks.size(); ++i) {
            const std::int64_t seen = simulated_worst(tasks, i, 5'000);
            const Response on_grid = response_time_on_grid(tasks, i);
            ASSERT_TRUE(on_grid.bounded);
            ASSERT_GE(on_grid.worst_ns, seen) << "round " << round << " task " << i;
            ASSERT_LE(on_grid.worst_ns, response_time(tasks, i).worst_ns);
            shorter += on_grid.worst_ns < response_time(tasks, i).worst_ns ? 1 : 0;
            exact += on_grid.worst_ns == seen ? 1 : 0;
            ++all;
        }
    }
    EXPECT_GT(shorter, all / 10) << "phases help";
    EXPECT_GT(exact, all / 2) << "and the bound is near";
}

TEST(ResponseTime, agrees_with_a_simulation_of_random_task_sets) {
    Random random{7};
    int late = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<TaskTiming> tasks;
        double load = 0;
        for (int i = 0; i < 4; ++i) {
            const std::int64_t period = random.between(4, 40);
            const std::int64_t budget = random.between(1, period / 3 + 1);
            load += static_cast<double>(budget) / static_cast<double>(period);
            if (load > 0.999) break;
            tasks.push_back(task(budget, period));
        }
        for (std::size_t i = 0; i < tasks.size(); ++i) {
            const Response response = response_time(tasks, i);
            ASSERT_TRUE(response.bounded);
            ASSERT_EQ(response.worst_ns, simulated_worst(tasks, i, 60'000))
                << "round " << round << " task " << i;
            if (response.worst_ns > tasks[i].period_ns) ++late;
        }
    }
    EXPECT_GT(late, 10) << "sets whose response exceeds the period must have been among them";
}

} // namespace
