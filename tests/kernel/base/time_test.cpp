// Sums and differences with a time saturate at the earliest and the latest time.
#include "kernel/base/time.hpp"

#include <gtest/gtest.h>

namespace tappet {
namespace {

TEST(TimeSums, are_exact_within_the_range) {
    EXPECT_EQ(at_ns(5) + 3ns, at_ns(8));
    EXPECT_EQ(1us + at_ns(5), at_ns(1005));
    EXPECT_EQ(at_ns(5) - 2ms, at_ns(-1'999'995));
    EXPECT_EQ(at_ns(5) - at_ns(9), -4ns);
    EXPECT_EQ(at_ns(5) + std::chrono::hours{1} - std::chrono::hours{1}, at_ns(5));
}

TEST(TimeSums, saturate_at_the_latest_and_the_earliest_time) {
    constexpr Duration longest = Duration::max();
    EXPECT_EQ(at_ns(1) + longest, never);
    EXPECT_EQ(longest + at_ns(1), never);
    EXPECT_EQ(never + 1ns, never) << "whoever adds to it waits for it no longer";
    EXPECT_EQ(Time{1s} + std::chrono::seconds{9223372036}, never) << "the longest that may be written";
    EXPECT_EQ(at_ns(-2) - longest, Time::min());
    EXPECT_EQ(at_ns(2) - Duration::min(), never);
    EXPECT_EQ(at_ns(-2) + Duration::min(), Time::min());
}

TEST(TimeSums, keep_the_sign_of_a_difference) {
    EXPECT_EQ(never - at_ns(-1), Duration::max());
    EXPECT_EQ(Time::min() - at_ns(1), Duration::min());
    EXPECT_EQ(at_ns(1) - Time::min(), Duration::max());
    static_assert(never - Time::min() == Duration::max(), "at compile time, too");
}

} // namespace
} // namespace tappet
