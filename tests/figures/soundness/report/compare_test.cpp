// Two commits: changes beyond the noise are reported, noise is not.
#include "tests/figures/report/compare.hpp"
#include "tests/figures/soundness/report/runs.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace tappet::figures {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

/// The time of ours after the change is `factor` of the one before, with `noise` from round to round.
std::vector<Round> rounds(double factor, double noise, std::size_t count = 6) {
    std::vector<Round> all;
    for (std::size_t i = 0; i < count; ++i) {
        const double drift = 1 + 0.2 * static_cast<double>(i); // drift of the machine: it affects both
        const double sign = i % 2 == 0 ? 1 : -1;
        all.push_back({{result("exchange", 10 * drift)},
                       {result("exchange", 10 * drift * factor * (1 + sign * noise))}});
    }
    return all;
}
const Change& ours(const Comparison& comparison) {
    for (const Change& change : comparison.changes)
        if (change.role == Standing::ours) return change;
    throw std::logic_error("nothing of ours was compared");
}

TEST(Compare, finds_what_got_slower) {
    const Comparison comparison = compare(rounds(1.2, 0.02), 0.05);
    EXPECT_EQ(ours(comparison).verdict, Verdict::slower);
    EXPECT_NEAR(ours(comparison).ratio, 1.2, 0.01);
    EXPECT_TRUE(comparison.slower());
    EXPECT_THAT(comparison_text(comparison, "old", "new"),
                AllOf(HasSubstr("1.20 x"), HasSubstr("1 slower, 0 faster")));
}

TEST(Compare, finds_what_got_faster_without_failing) {
    const Comparison comparison = compare(rounds(0.7, 0.02), 0.05);
    EXPECT_EQ(ours(comparison).verdict, Verdict::faster);
    EXPECT_FALSE(comparison.slower());
}

TEST(Compare, a_change_below_the_variation_counts_as_none) {
    EXPECT_EQ(ours(compare(rounds(1.1, 0.3), 0.05)).verdict, Verdict::same);
}

TEST(Compare, a_change_below_the_margin_counts_as_none_however_certain) {
    const Comparison comparison = compare(rounds(1.04, 0), 0.05);
    EXPECT_EQ(ours(comparison).verdict, Verdict::same);
    EXPECT_GT(ours(comparison).low, 1);
}

TEST(Compare, floors_and_peers_say_how_much_is_noise) {
    auto all = rounds(1.2, 0.01);
    for (Round& round : all)
        for (int i = 0; i < 10; ++i) { // the same code in both, and yet 30 % apart
            round.before[0].figures[0].rows.push_back(row("floor " + std::to_string(i), Standing::floor, 10));
            round.after[0].figures[0].rows.push_back(row("floor " + std::to_string(i), Standing::floor, 13));
        }
    const Comparison comparison = compare(all, 0.05);
    EXPECT_NEAR(comparison.threshold(), 0.3, 0.01);
    EXPECT_EQ(ours(comparison).verdict, Verdict::same);
    EXPECT_THAT(comparison_text(comparison, "old", "new"),
                AllOf(HasSubstr("floors and peers, the same code in both"),
                      HasSubstr("1.30 x  exchange.write: floor 7")));
}

TEST(Compare, a_figure_of_only_one_commit_is_listed_but_not_judged) {
    auto all = rounds(1, 0);
    for (Round& round : all) round.after[0].figures[0].id = "exchange.other";
    const Comparison comparison = compare(all, 0.05);
    EXPECT_TRUE(comparison.changes.empty());
    EXPECT_THAT(comparison.only_one, AllOf(Contains("only before: exchange.write, port"),
                                           Contains("only after: exchange.other, port")));
}

TEST(Compare, a_median_of_zero_gives_no_ratio) {
    auto all = rounds(1, 0);
    for (Round& round : all) round.before[0].figures[0].rows[0].summary.median = 0;
    for (const Change& change : compare(all, 0.05).changes) EXPECT_NE(change.row, "port");
}

TEST(Compare, counted_instructions_stand_beside_the_times) {
    auto all = rounds(1, 0);
    all[0].before[0].figures[0].rows[0].instructions = 100; // counted once
    all[0].after[0].figures[0].rows[0].instructions = 90;
    EXPECT_THAT(comparison_text(compare(all, 0.05), "old", "new"),
                HasSubstr("100 -> 90.0  exchange.write: port"));
}

TEST(Interval, is_that_of_students_t) {
    // Logarithms -0.1, 0, 0.1: mean 0, deviation 0.1, and t = 9.925 at 2 degrees of freedom.
    const Interval interval = mean_of_ratios({std::exp(-0.1), 1, std::exp(0.1)});
    EXPECT_NEAR(interval.mean, 1, 1e-12);
    EXPECT_NEAR(std::log(interval.high), 9.925 * 0.1 / std::sqrt(3), 1e-9);
    EXPECT_NEAR(std::log(interval.low), -std::log(interval.high), 1e-9);
}

TEST(Interval, is_unbounded_for_a_single_value) {
    const Interval interval = mean_of_ratios({1.5});
    EXPECT_EQ(interval.low, 0);
    EXPECT_TRUE(std::isinf(interval.high));
}

} // namespace
} // namespace tappet::figures
