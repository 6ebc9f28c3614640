// Values between those of a slower writer: held, interpolated to the last one, or extrapolated from the last
// two.
#include "kernel/component/rate_transition.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tappet {
namespace {

/// A writer of a ramp of 1 every 4 ms, from 1 at 0 ms on; the reader reads each millisecond, after the write.
struct Reader {
    explicit Reader(RateTransition how) : between{how, 4ms} {}
    double at_ms(int ms) {
        const bool is_new = ms % 4 == 0 && ms < silent_from;
        if (is_new) written = 1.0 + ms / 4, stamp = Time{} + Duration{1ms} * ms;
        return between.at(Time{} + Duration{1ms} * ms, is_new, written, stamp);
    }
    BetweenValues between;
    double written = 0.0;
    Time stamp{};
    int silent_from = 1000;
};

TEST(RateTransitions, interpolate_smoothly_with_a_delay_of_one_period) {
    Reader reader{RateTransition::interpolate};
    double before = reader.at_ms(0);
    EXPECT_EQ(before, 1.0) << "the first value is as it is";
    for (int ms = 1; ms < 40; ++ms) {
        const double now = reader.at_ms(ms);
        EXPECT_LE(now - before, 0.25 + 1e-12) << ms;
        EXPECT_NEAR(now, ms < 4 ? 1.0 : 1.0 + (ms - 4) / 4.0, 1e-12) << ms;
        before = now;
    }
}

TEST(RateTransitions, extrapolate_without_delay) {
    Reader reader{RateTransition::extrapolate};
    static_cast<void>(reader.at_ms(0));
    for (int ms = 1; ms < 40; ++ms) {
        const double now = reader.at_ms(ms);
        EXPECT_NEAR(now, ms < 4 ? 1.0 : 1.0 + ms / 4.0, 1e-12) << ms;
    }
}

TEST(RateTransitions, stay_finite_between_the_largest_numbers) {
    for (const RateTransition how : {RateTransition::interpolate, RateTransition::extrapolate}) {
        BetweenValues between{how, 4ms};
        for (int period = 0; period < 10; ++period)
            for (int ms = 0; ms < 4; ++ms) {
                const Time now = at_ns(0) + (4 * period + ms) * 1ms;
                EXPECT_TRUE(is_number(between.at(now, ms == 0, period % 2 == 0 ? 1.7e308 : -1.7e308, now)));
            }
    }
}

TEST(RateTransitions, never_interpolate_across_a_stop_of_the_writer) {
    for (const RateTransition how : {RateTransition::interpolate, RateTransition::extrapolate}) {
        BetweenValues between{how, 4ms};
        static_cast<void>(between.at(at_ns(0), true, 30.0, at_ns(0)));
        for (int ms = 4; ms < 40; ++ms)
            EXPECT_EQ(between.at(at_ns(0) + ms * 1ms, ms == 4, 0.0, at_ns(0) + 4ms, ms == 4), 0.0);
    }
}

TEST(RateTransitions, limit_extrapolation_between_nearly_simultaneous_values) {
    BetweenValues between{RateTransition::extrapolate, 4ms};
    const Time second = at_ns(0) + 4ms, third = second + 10us;
    static_cast<void>(between.at(at_ns(0), true, 10.0, at_ns(0)));
    EXPECT_NEAR(between.at(second, true, 10.0, second), 10.0, 1e-12);
    EXPECT_NEAR(between.at(third, true, 10.5, third), 10.5, 1e-12);
    for (Duration later{}; later < 20ms; later += 1ms)
        EXPECT_LE(between.at(third + later, false, 10.5, third), 11.0);
}

TEST(RateTransitions, ignore_values_that_are_not_numbers) {
    for (const RateTransition how : {RateTransition::interpolate, RateTransition::extrapolate}) {
        BetweenValues between{how, 4ms};
        Time now{1s};
        static_cast<void>(between.at(now, true, 1.0, now));
        now += 4ms;
        static_cast<void>(between.at(now, true, std::numeric_limits<double>::quiet_NaN(), now));
        for (int i = 0; i < 3; ++i) {
            now += 4ms;
            EXPECT_EQ(between.at(now, true, 5.0, now), 5.0);
        }
    }
}

TEST(RateTransitions, restart_after_a_pause_of_the_reader) {
    for (const RateTransition how : {RateTransition::interpolate, RateTransition::extrapolate}) {
        Reader reader{how};
        for (int ms = 0; ms < 20; ++ms) static_cast<void>(reader.at_ms(ms));
        EXPECT_EQ(reader.at_ms(400), 101.0) << "as it is written, and not from where it was";
    }
}

TEST(RateTransitions, extrapolate_for_one_period_after_the_writer_falls_silent) {
    Reader ahead{RateTransition::extrapolate};
    Reader behind{RateTransition::interpolate};
    ahead.silent_from = behind.silent_from = 9;
    for (int ms = 0; ms < 60; ++ms) {
        const double far = ahead.at_ms(ms), near = behind.at_ms(ms);
        if (ms >= 12) {
            EXPECT_NEAR(far, 4.0, 1e-12) << "one period beyond the last value";
            EXPECT_NEAR(near, 3.0, 1e-12) << "the last value";
        }
    }
}

} // namespace
} // namespace tappet
