// Function times evaluated without a division give the same result as with one.
#include "kernel/activity/timing.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

namespace tappet {
namespace {

TEST(FunctionTiming, ignores_the_first_pass_and_keeps_the_longest_later_one) {
    FunctionTiming timing;
    timing.add(900us);
    EXPECT_EQ(timing.usual(), 900us) << "all that is known";
    EXPECT_EQ(timing.longest, 0us);
    timing.add(0us);
    EXPECT_EQ(timing.longest, 0us);
    timing.add(30us);
    timing.add(10us);
    EXPECT_EQ(timing.passes, 4u);
    EXPECT_EQ(timing.last, 10us);
    EXPECT_EQ(timing.longest, 30us);
    EXPECT_EQ(timing.total, 40us);
    EXPECT_EQ(timing.usual(), Duration{13'333});
}

TEST(FunctionTiming, detects_excess_exactly_as_division_would) {
    Random random{20'26};
    FunctionTiming timing;
    std::uint64_t above = 0;
    for (int i = 0; i < 20'000; ++i) {
        const auto any = [&] { return Duration{static_cast<std::int64_t>(random.next() % 40)}; };
        const Duration took = any();
        const Duration excess = any() / 4;
        const bool exceeds = timing.exceeds_usual(took, excess);
        ASSERT_EQ(exceeds, took - timing.usual() > excess)
            << "pass " << i << ", took " << took.count() << ", usual " << timing.usual().count();
        above += exceeds ? 1u : 0u;
        timing.add(any());
        if (random.next() % 50 == 0) timing = {};
    }
    EXPECT_GT(above, 1000u);
    EXPECT_LT(above, 19'000u);
}

TEST(FunctionTiming, handles_times_whose_product_with_the_passes_overflows) {
    FunctionTiming timing;
    for (int i = 0; i < 100; ++i) timing.add(1us);
    EXPECT_TRUE(timing.exceeds_usual(Duration::max(), 0us));
    EXPECT_FALSE(timing.exceeds_usual(1us, 0us));
    EXPECT_TRUE(timing.exceeds_usual(Duration{1001}, 0us));
    EXPECT_FALSE(timing.exceeds_usual(1s, Duration::max())) << "of an activity without a deadline";
}

} // namespace
} // namespace tappet
