// The evaluation of the records of experiments: each statement can be found true and false.
#include "tests/figures/experiments/findings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace tappet::experiments {
namespace {

using figures::Samples;
using figures::Standing;
using figures::Statement;
using testing::ElementsAre;
using testing::HasSubstr;

Samples always(double value) {
    Samples samples;
    for (int i = 0; i < 1000; ++i) samples.add(value);
    return samples;
}
Samples mixed(double one, double other) {
    Samples samples = always(one);
    samples.add(always(other));
    return samples;
}

/// The statement whose text contains it.
Statement stated(const Findings& findings, std::string_view text) {
    const auto all = statements_of(findings);
    const auto found =
        std::ranges::find_if(all, [&](const Statement& each) { return each.text.contains(text); });
    EXPECT_NE(found, all.end()) << "nothing is stated about: " << text;
    return found == all.end() ? Statement{} : *found;
}

TaskResult& task(Findings& findings, std::string_view application, Setting setting, std::string_view name) {
    Experiment& experiment = findings.at(application, setting);
    TaskResult& made = experiment.tasks.emplace_back();
    made.name = name;
    made.real_time = true;
    made.executions = 1000;
    return made;
}

TEST(Evaluate, measures_periods_between_starts_without_the_warm_up) {
    const Execution records[] = {{.begin = 1000, .busy = 1},
                                 {.begin = 2000, .busy = 200, .exchange = 20},
                                 {.begin = 3500, .busy = 300, .exchange = 30},
                                 {.begin = 4000, .busy = 400, .exchange = 40}};
    TaskResult result;
    evaluate(records, Setting::data, 2.0, 1000, result);
    EXPECT_THAT(result.latencies.values(), ElementsAre(0.4, 0.6, 0.8)) << "us";
    EXPECT_THAT(result.periods.values(), ElementsAre(3.0, 1.0)) << "us";
    EXPECT_THAT(result.exchanges.values(), ElementsAre(40, 60)) << "ns; of the last one nobody saw the rest";
    EXPECT_EQ(result.executions, 3u);
}

TEST(Evaluate, separates_cycles_by_the_number_of_commands_served) {
    const Execution records[] = {{.begin = 0, .served = 1, .serving = 700},
                                 {.begin = 10, .served = 2, .serving = 900},
                                 {.begin = 20, .served = 0},
                                 {.begin = 30}};
    TaskResult commands;
    evaluate(records, Setting::commands, 1.0, 0, commands);
    EXPECT_THAT(commands.one_served.values(), ElementsAre(700));
    EXPECT_THAT(commands.two_served.values(), ElementsAre(900));
    EXPECT_THAT(commands.served.values(), ElementsAre(700, 900));
}

TEST(Figures, put_the_mutex_and_the_bare_copies_beside_the_connectors) {
    Findings findings;
    task(findings, "small", Setting::data, "high").exchanges = always(100);
    task(findings, "small", Setting::locked, "high").exchanges = always(300);
    task(findings, "small", Setting::none, "high").copies = always(10);
    const auto figures = figures_of(findings);
    const auto found = std::ranges::find(figures, "experiments.small.exchange.high", &figures::Figure::id);
    ASSERT_NE(found, figures.end());
    ASSERT_EQ(found->rows.size(), 3u);
    EXPECT_EQ(found->rows[0].role, Standing::ours);
    EXPECT_EQ(found->rows[0].summary.median, 100);
    EXPECT_EQ(found->rows[1].role, Standing::peer);
    EXPECT_EQ(found->rows[2].role, Standing::floor);
}

TEST(Plots, show_both_ways_of_exchange_in_the_figure_of_the_thesis) {
    Findings findings;
    task(findings, "concurrent", Setting::data, "medium").exchanges = always(100);
    task(findings, "concurrent", Setting::locked, "medium").exchanges = always(300);
    const auto plots = plots_of(findings);
    ASSERT_EQ(plots.size(), 1u);
    EXPECT_EQ(plots[0].id, "experiments.figure.4.18");
    EXPECT_EQ(plots[0].series.size(), 2u);
}

TEST(Plots, show_a_peak_and_a_distant_worst_case_together) {
    Samples samples = always(101);
    samples.add(20'100);
    const auto series = figures::log_histogram("", Standing::ours, samples, 10);
    ASSERT_EQ(series.points.size(), 24u) << "ten bins for each factor of ten";
    EXPECT_DOUBLE_EQ(series.points.front().first, 100);
    EXPECT_EQ(series.points.front().second, 1000);
    EXPECT_LE(series.points.back().first, 20'100);
    EXPECT_EQ(series.points.back().second, 1);
    EXPECT_EQ(series.points[10].second, 0);
    EXPECT_TRUE(figures::log_histogram("", Standing::ours, {}).points.empty());
}

TEST(Plots, show_periods_as_deviations_from_the_row) {
    Findings findings;
    TaskResult& low = task(findings, "large", Setting::none, "low");
    low.period_us = 10'000;
    low.periods = mixed(9'990, 10'020);
    const auto plots = plots_of(findings);
    ASSERT_EQ(plots.size(), 1u);
    EXPECT_EQ(plots[0].id, "experiments.figure.4.9.large");
    EXPECT_EQ(plots[0].series.at(0).points.front().first, -10);
}

TEST(HistogramFiles, hold_every_sample_of_a_task_once) {
    Findings findings;
    TaskResult& high = task(findings, "large", Setting::events, "high");
    high.periods = mixed(999, 1001);
    high.sends = always(120);
    const std::string directory = testing::TempDir() + "histograms-" + std::to_string(::getpid());
    EXPECT_EQ(write_histograms(findings, directory), "");
    std::ifstream file{directory + "/large-events-high.txt"};
    std::vector<double> counts; // of each block
    for (std::string line; std::getline(file, line);)
        if (line.starts_with('#'))
            counts.push_back(0);
        else if (!line.empty())
            counts.back() += std::stod(line.substr(line.find(' ')));
    EXPECT_THAT(counts, ElementsAre(2000, 1000));
    std::filesystem::remove_all(directory);
}

TEST(HistogramFiles, say_why_they_were_not_written) {
    Findings findings;
    task(findings, "large", Setting::events, "high").periods = always(1);
    EXPECT_THAT(write_histograms(findings, "/dev/null/nowhere"),
                HasSubstr("cannot write /dev/null/nowhere/"));
}

TEST(Statements, say_nothing_about_experiments_that_were_not_run) {
    EXPECT_TRUE(statements_of(Findings{}).empty());
}

TEST(Statements, exchange_without_locks_is_faster_or_not) {
    for (const double ours : {100.0, 400.0}) {
        Findings findings;
        task(findings, "minimal", Setting::data, "high").exchanges = always(ours);
        task(findings, "minimal", Setting::locked, "high").exchanges = always(300);
        EXPECT_EQ(stated(findings, "in the minimal application the exchange without locks is faster").held,
                  ours < 300);
        EXPECT_EQ(stated(findings, "about three times").held, ours < 300);
        EXPECT_EQ(stated(findings, "faster on average, for every priority").held, ours < 300);
        EXPECT_EQ(stated(findings, "better worst case for the highest").held, ours < 300);
    }
}

TEST(Statements, twice_as_fast_is_not_three_times) {
    Findings findings;
    task(findings, "minimal", Setting::data, "high").exchanges = always(150);
    task(findings, "minimal", Setting::locked, "high").exchanges = always(300);
    EXPECT_FALSE(stated(findings, "about three times").held);
}

TEST(Statements, one_slower_application_refutes_the_claim_for_all) {
    Findings findings;
    for (const char* name : {"minimal", "small"}) {
        task(findings, name, Setting::data, "high").exchanges = always(name[0] == 'm' ? 100 : 400);
        task(findings, name, Setting::locked, "high").exchanges = always(300);
    }
    const Statement all = stated(findings, "on average, for every priority");
    EXPECT_FALSE(all.held);
    EXPECT_THAT(all.measured, HasSubstr("small high 400 ns, locks 300 ns"));
}

TEST(Statements, the_highest_priority_waits_or_does_not) {
    for (const std::int64_t blocked : {0, 1}) {
        Findings findings;
        task(findings, "small", Setting::data, "high").blocked = blocked;
        task(findings, "small", Setting::locked, "high").waited_for_locks =
            static_cast<std::uint64_t>(blocked);
        EXPECT_EQ(stated(findings, "the highest priority never waits").held, blocked == 0);
        EXPECT_EQ(stated(findings, "the highest priority waits for lower ones").held, blocked != 0);
    }
}

TEST(Statements, odds_to_wait_must_grow_with_each_application) {
    for (const std::uint64_t large : {1u, 9u}) {
        Findings findings;
        task(findings, "minimal", Setting::locked, "high").waited_for_locks = 2;
        task(findings, "large", Setting::locked, "high").waited_for_locks = large;
        EXPECT_EQ(stated(findings, "the odds grow").held, large == 9);
    }
}

TEST(Statements, peaks_of_the_latency_must_lie_where_predicted) {
    const auto judge = [](double one, double other) {
        Findings findings;
        task(findings, "small", Setting::none, "high").latencies = always(510);
        task(findings, "small", Setting::none, "low").latencies = mixed(one, other);
        return std::pair{stated(findings, "preempted once (1 ms) and twice").held,
                         stated(findings, "one load of the highest apart").held};
    };
    EXPECT_EQ(judge(1020, 1530), (std::pair{true, true}));
    EXPECT_EQ(judge(510, 1020), (std::pair{false, true}));
    EXPECT_EQ(judge(510, 1530), (std::pair{false, false}));
    EXPECT_EQ(judge(1020, 1020), (std::pair{false, false}));
}

TEST(Statements, the_highest_priority_is_as_steady_as_a_bare_thread_or_not) {
    for (const double worst : {501.0, 700.0}) {
        Findings findings;
        TaskResult& high = task(findings, "large", Setting::none, "high");
        high.latencies = mixed(500, worst);
        high.period_us = 1000;
        high.periods = mixed(1000, 500 + worst);
        TaskResult& bare = findings.bare("large");
        bare.latencies = mixed(500, 501);
        bare.period_us = 1000;
        bare.periods = mixed(1000, 1001);
        EXPECT_EQ(stated(findings, "latencies are highly deterministic").held, worst == 501);
        EXPECT_EQ(stated(findings, "the period of the highest remains stable").held, worst == 501);
    }
}

TEST(Statements, serving_takes_its_share_of_the_load_or_more) {
    for (const double two : {20'000.0, 23'000.0}) {
        Findings findings;
        TaskResult& high = task(findings, "concurrent", Setting::events, "high");
        high.load_us = 100;
        high.one_served = always(10'000);
        high.two_served = always(two);
        EXPECT_EQ(stated(findings, "10 or 20 % of the load").held, two == 20'000);
    }
}

TEST(Statements, a_missed_deadline_counts_against_its_application) {
    Findings findings;
    task(findings, "large", Setting::events, "low").misses = 3;
    const Statement met = stated(findings, "no real-time activity missed a deadline");
    EXPECT_FALSE(met.held);
    EXPECT_THAT(met.measured, HasSubstr("large 3 of 1000"));
}

} // namespace
} // namespace tappet::experiments
