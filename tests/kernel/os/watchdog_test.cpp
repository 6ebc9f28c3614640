// The requests that the output latch passes to the watchdog in each of its states.
#include "kernel/os/watchdog.hpp"

#include "kernel/os/clock.hpp"
#include "tests/kernel/os/watchdog_device.hpp"

#include <gtest/gtest.h>

namespace tappet::os {
namespace {

using State = OutputLatch::State;

struct AWatchdog : testing::Test {
    WatchdogDevice device;
    OutputLatch outputs;
    Watchdog watchdog{outputs};
    Time now = Clock::monotonic();

    void open() { ASSERT_TRUE(watchdog.open(device.path(), 10s)); }
    /// The kicks that pass through during the time.
    int kicks_in(Duration time) {
        const int before = device.kicks();
        for (const Time end = now + time; now < end; now += 100ms) watchdog.kick(now);
        return device.kicks() - before;
    }
};

TEST_F(AWatchdog, is_kicked_while_the_outputs_are_safe) {
    open();
    EXPECT_EQ(device.kicks(), 1) << "opening is one";
    now += 1s;
    EXPECT_EQ(kicks_in(80s), 80) << "eight times as often as it must";
}

TEST_F(AWatchdog, is_kicked_while_the_machine_was_recently_alive) {
    open();
    now += 1s;
    ASSERT_TRUE(outputs.drive(now + 2s));
    EXPECT_EQ(kicks_in(60s), 2);
    ASSERT_TRUE(outputs.drive(now + 2s));
    EXPECT_EQ(kicks_in(60s), 2);
}

TEST_F(AWatchdog, is_not_kicked_beyond_its_bound_after_the_outputs_are_lost) {
    open();
    now += 1s;
    const Time bound = now + 3s;
    outputs.lose(bound);
    EXPECT_EQ(kicks_in(2s), 2);
    outputs.lose(bound + 1h);
    EXPECT_EQ(kicks_in(60s), 1) << "nobody puts the bound off";
    EXPECT_FALSE(outputs.drive(now + 1h)) << "no machine may be started";
    outputs.leave_untouched();
    EXPECT_EQ(kicks_in(60s), 0);
}

TEST_F(AWatchdog, stays_armed_without_a_kick_while_the_outputs_are_unsafe) {
    open();
    outputs.lose(Time::min());
    watchdog.hand_over();
    EXPECT_EQ(device.kicks(), 1);
    const auto opened = watchdog.open(device.path(), 10s);
    ASSERT_FALSE(opened);
    EXPECT_TRUE(opened.error().view().contains("the outputs may not be safe")) << opened.error().view();
    EXPECT_EQ(device.openings(), 1);
}

TEST_F(AWatchdog, keeps_running_when_released_while_the_outputs_are_unsafe) {
    open();
    outputs.lose(Time::min());
    watchdog.stand_down();
    EXPECT_FALSE(device.is_stood_down());
    outputs.guardian_says_safe();
    open();
    watchdog.stand_down();
    EXPECT_TRUE(device.is_stood_down());
}

TEST(AnOutputLatch, becomes_safe_again_only_by_the_guardian) {
    OutputLatch outputs;
    EXPECT_EQ(outputs.state(), State::safe) << "nothing has driven them";
    ASSERT_TRUE(outputs.drive(Time::min()));
    outputs.leave_untouched();
    EXPECT_EQ(outputs.state(), State::safe);
    ASSERT_TRUE(outputs.drive(Time::min()));
    EXPECT_EQ(outputs.state(), State::unknown);
    outputs.lose(Time::max());
    static_cast<void>(outputs.drive(Time::max()));
    outputs.leave_untouched();
    outputs.lose(Time::max());
    EXPECT_EQ(outputs.state(), State::unsafe);
    outputs.guardian_says_safe();
    EXPECT_EQ(outputs.state(), State::safe);
}

} // namespace
} // namespace tappet::os
