// Two things are called equal only when a difference would have been seen.
#include "tests/figures/measure/equivalence.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

namespace tappet::figures {
namespace {

constexpr double median = 0.5, margin = 0.05;

/// Times of a machine whose speed drifts: `slowness` of each pair is common to both sides.
std::vector<PairOfBlocks> measured(Random& random, std::size_t pairs, double ratio, double scatter) {
    std::vector<PairOfBlocks> all(pairs);
    for (PairOfBlocks& pair : all) {
        const double slowness = 1000 + 500 * random.unit();
        for (int i = 0; i < 20; ++i) {
            pair.theirs.push_back(slowness * (1 + scatter * random.unit()));
            pair.ours.push_back(slowness * ratio * (1 + scatter * random.unit()));
        }
    }
    return all;
}

class Equivalence : public testing::Test {
protected:
    Random random{static_cast<std::uint64_t>(::getpid())};
};

TEST_F(Equivalence, is_found_although_the_machine_drifts) {
    const Comparison found = compare(measured(random, 400, 1.0, 0.1), median, margin);
    EXPECT_EQ(found.verdict(), Verdict::equivalent) << found.low << " to " << found.high;
    EXPECT_GE(found.worst(), 1.0);
    EXPECT_LE(found.worst(), 1.05);
}

TEST_F(Equivalence, is_denied_where_ours_is_slower_or_faster_than_the_margin_allows) {
    EXPECT_EQ(compare(measured(random, 400, 1.2, 0.1), median, margin).verdict(), Verdict::different);
    EXPECT_EQ(compare(measured(random, 400, 0.8, 0.1), median, margin).verdict(), Verdict::different);
}

TEST_F(Equivalence, is_not_concluded_from_a_few_samples) {
    for (std::size_t pairs = 1; pairs < fewest_pairs; ++pairs)
        for (const double ratio : {0.5, 1.0, 2.0})
            EXPECT_EQ(compare(measured(random, pairs, ratio, 3.0), median, margin).verdict(),
                      Verdict::undecided);
}

TEST_F(Equivalence, is_wrongly_found_at_the_margin_in_one_of_twenty_runs) {
    int wrong = 0;
    constexpr int runs = 200;
    for (int run = 0; run < runs; ++run)
        wrong += compare(measured(random, 40, 1.05, 0.2), median, margin, 200, random.next()).verdict() ==
                 Verdict::equivalent;
    EXPECT_LT(wrong, runs * 3 / 20) << "one in twenty is ten; thirty would be more than chance";
}

TEST_F(Equivalence, is_judged_at_the_chosen_quantile) {
    std::vector<PairOfBlocks> all = measured(random, 400, 1.0, 0.05);
    for (PairOfBlocks& pair : all) pair.ours[random.below(pair.ours.size())] *= 3; // one in twenty is late
    EXPECT_EQ(compare(all, median, margin).verdict(), Verdict::equivalent);
    EXPECT_EQ(compare(all, 0.99, margin).verdict(), Verdict::different);
}

TEST_F(Equivalence, interval_holds_the_ratio_and_shrinks_with_more_pairs) {
    const Comparison few = compare(measured(random, 30, 1.1, 0.5), median, margin);
    const Comparison many = compare(measured(random, 3000, 1.1, 0.5), median, margin);
    EXPECT_LE(few.low, few.ratio);
    EXPECT_GE(few.high, few.ratio);
    EXPECT_LT(many.high - many.low, few.high - few.low);
    EXPECT_NEAR(many.ratio, 1.1, 0.02);
}

TEST_F(Equivalence, is_undecided_without_samples) {
    EXPECT_EQ(compare({}, median, margin).verdict(), Verdict::undecided);
    EXPECT_EQ(compare({{{}, {}}}, median, margin).verdict(), Verdict::undecided);
    EXPECT_EQ(compare({{{1, 2}, {}}}, median, margin).verdict(), Verdict::undecided);
    EXPECT_EQ(compare({{{}, {1, 2}}}, median, margin).verdict(), Verdict::undecided);
    EXPECT_EQ(compare({{{1, 2}, {0, 0}}}, median, margin).verdict(), Verdict::undecided);
}

TEST_F(Equivalence, verdict_depends_on_nothing_but_samples_and_seed) {
    const auto all = measured(random, 50, 1.0, 0.3);
    const Comparison once = compare(all, 0.9, margin, 500, 7), again = compare(all, 0.9, margin, 500, 7);
    EXPECT_EQ(once.low, again.low);
    EXPECT_EQ(once.high, again.high);
}

} // namespace
} // namespace tappet::figures
