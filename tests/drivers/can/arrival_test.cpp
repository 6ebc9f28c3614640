// Arrivals of frames in the machine's time, whatever is done to the wall clock.
#include "drivers/can/arrival.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

struct ArrivalsTest : testing::Test {
    static constexpr Duration year_2026 = 1'767'225'600s;
    Duration ahead = year_2026; ///< the wall clock, of the machine's
    Arrivals arrivals;
    ArrivalsTest() { arrivals.begin(wall(0s), at(0s)); }
    static Time at(Duration machine) { return Time{machine}; }
    [[nodiscard]] Time wall(Duration machine) const { return Time{machine + ahead}; }
    /// A frame that was stamped `stamp` by the wall clock, read at `now`.
    Time read(Time stamp, Duration now) { return arrivals.of(stamp, wall(now), at(now)); }
};

TEST_F(ArrivalsTest, use_the_time_stamp_of_the_kernel_however_late_they_are_read) {
    EXPECT_EQ(read(wall(10ms), 10ms + 40us), at(10ms));
    EXPECT_EQ(read(wall(20ms), 25ms), at(20ms));
    EXPECT_EQ(read(wall(30ms), 5s), at(30ms)) << "an old frame is not made young";
}

TEST_F(ArrivalsTest, do_not_move_with_a_slewed_clock) {
    EXPECT_EQ(read(wall(10ms), 11ms), at(10ms));
    for (int i = 2; i < 100; ++i) { // 500 us a second, as an NTP daemon steers at most
        ahead += 500us;
        EXPECT_EQ(read(wall(1s * i), 1s * i + 1ms), at(1s * i));
    }
}

TEST_F(ArrivalsTest, use_the_current_time_when_the_clock_was_set_before_reading) {
    for (const Duration step :
         {Duration{400ms}, Duration{2ms}, Duration{-2ms}, Duration{3600s}, Duration{-3600s}}) {
        arrivals.begin(wall(0s), at(0s));
        EXPECT_EQ(read(wall(10ms), 11ms), at(10ms));
        const Time stamp = wall(20ms);
        ahead += step;
        EXPECT_EQ(read(stamp, 21ms), at(21ms)) << step.count();
        EXPECT_EQ(read(wall(30ms), 31ms), at(30ms)) << "those after it are as ever";
    }
}

TEST_F(ArrivalsTest, keep_their_order_though_the_clock_was_set_meanwhile) {
    for (const Duration step : {Duration{3600s}, Duration{-3600s}}) {
        arrivals.begin(wall(0s), at(0s));
        const Time first = wall(10ms);
        const Time second = wall(12ms);
        ahead += step;
        EXPECT_EQ(read(first, 20ms), at(20ms));
        const Time next = read(second, 20ms + 10us);
        EXPECT_GE(next, at(20ms));
        EXPECT_LE(next, at(20ms + 10us));
    }
}

TEST_F(ArrivalsTest, are_never_later_than_now) { EXPECT_EQ(read(wall(12ms), 11ms), at(11ms)); }

} // namespace
} // namespace tappet::can
