// Motion pieces: ramps, integrals, dead-time compensation.
#include "kernel/pieces/hand_over.hpp"
#include "kernel/pieces/integrator.hpp"
#include "kernel/pieces/lead.hpp"
#include "kernel/pieces/ramp.hpp"
#include "tests/kernel/base/seeded.hpp"

#include <algorithm>
#include <cmath>

namespace tappet {
namespace {

using test::no_number, test::infinite;
constexpr Time at(Duration time) { return Time{time}; }

TEST(Ramp, respects_its_rate_and_does_not_overshoot) {
    Ramp ramp{10.0, 20.0};
    EXPECT_DOUBLE_EQ(ramp(3.0, 100ms), 1.0);
    EXPECT_DOUBLE_EQ(ramp(3.0, 150ms), 2.5);
    EXPECT_DOUBLE_EQ(ramp(3.0, 100ms), 3.0);
    EXPECT_DOUBLE_EQ(ramp(-3.0, 100ms), 1.0) << "down it is faster";
    EXPECT_DOUBLE_EQ(ramp(-3.0, 1s), -3.0);
    ramp.reset(5.0);
    EXPECT_DOUBLE_EQ(ramp(5.0, 1s), 5.0);
}

TEST(Ramp, ignores_invalid_numbers_and_non_positive_rates) {
    Ramp ramp{10.0};
    EXPECT_EQ(ramp(no_number, 1s), 0.0);
    EXPECT_EQ(ramp(1.0, 0ms), 0.0);
    EXPECT_EQ(ramp(infinite, 1s), 0.0);
    Ramp stands{-1.0, no_number};
    EXPECT_EQ(stands(5.0, 1s), 0.0);
    EXPECT_EQ(stands(-5.0, 1s), 0.0);
}

TEST(HandOver, moves_bumplessly_from_the_old_value_to_the_wanted_one) {
    for (const double is : {0.0, 0.2, -0.5})
        for (const double wanted : {0.0, 0.1, -0.3, 0.5}) {
            HandOver from;
            double before = from.begin(is, wanted, 0.5);
            EXPECT_EQ(before, is);
            for (int k = 0; k < 1000; ++k) {
                const double now = from(wanted, 0.02);
                ASSERT_LE(std::abs(now - before), 0.02 + 1e-12);
                ASSERT_TRUE(now >= std::min(is, wanted) && now <= std::max(is, wanted));
                before = now;
            }
            EXPECT_NEAR(before, wanted, 1e-8);
        }
}

TEST(HandOver, forgets_an_earlier_wanted_value) {
    for (const double far : {1.0, -1e300, 1.7e308, no_number, -infinite})
        for (const double is : {0.0, 0.2, 1e300, no_number}) {
            HandOver from;
            const double first = from.begin(is, far, 0.5);
            ASSERT_LE(std::abs(first), 0.5);
            static_cast<void>(from(far, 0.02));
            double most = 0.0, least = 0.0;
            for (int k = 0; k < 400; ++k) {
                const double now = from(0.0, 0.02);
                most = std::max(most, now), least = std::min(least, now);
            }
            EXPECT_GE(least, 0.0) << far << " from " << is;
            EXPECT_LE(most, std::max(first, 0.0)) << far << " from " << is;
            EXPECT_NEAR(from(0.1, 0.02), 0.1, 1e-3) << "it does what is wanted then";
        }
}

TEST(Integrator, integrates_by_trapezoids_from_the_first_sample_on) {
    Integrator litres;
    EXPECT_EQ(litres(2.0, at(1s)), 0.0);
    EXPECT_DOUBLE_EQ(litres(4.0, at(2s)), 3.0);
    EXPECT_DOUBLE_EQ(litres(4.0, at(2500ms)), 5.0);
    litres.pause();
    EXPECT_DOUBLE_EQ(litres(4.0, at(10s)), 5.0) << "what was not seen is not added";
    EXPECT_DOUBLE_EQ(litres(4.0, at(11s)), 9.0);
    litres.reset(1.0);
    EXPECT_DOUBLE_EQ(litres.value(), 1.0);
}

TEST(Integrator, ignores_invalid_or_old_samples_and_stays_within_its_limits) {
    Integrator bounded{-1.0, 2.0};
    static_cast<void>(bounded(1.0, at(1s)));
    EXPECT_DOUBLE_EQ(bounded(1.0, at(2s)), 1.0);
    EXPECT_DOUBLE_EQ(bounded(no_number, at(3s)), 1.0);
    EXPECT_DOUBLE_EQ(bounded(1.0, at(4s)), 1.0) << "it begins anew after it";
    EXPECT_DOUBLE_EQ(bounded(1.0, at(3s)), 1.0) << "time does not run backwards";
    EXPECT_DOUBLE_EQ(bounded(100.0, at(5s)), 2.0);
    EXPECT_DOUBLE_EQ(bounded(-100.0, at(6s)), 2.0);
    EXPECT_DOUBLE_EQ(bounded(-100.0, at(7s)), -1.0) << "at once: nothing was wound up";
}

TEST(Lead, predicts_a_position_and_the_time_to_drive_an_actuator) {
    Lead belt{100ms};
    belt.sample(10.0, at(0ms));
    EXPECT_FALSE(belt.good(at(0ms)));
    EXPECT_EQ(belt.drive_at(12.0, 5ms), never);
    belt.sample(10.5, at(10ms)); // 50 a second
    EXPECT_TRUE(belt.good(at(20ms)));
    EXPECT_DOUBLE_EQ(belt.at(at(30ms)), 11.5);
    EXPECT_EQ(belt.drive_at(11.5, 5ms), at(25ms));
    EXPECT_EQ(belt.drive_at(10.6, 5ms), at(7ms)) << "it is late already: the time is past";
    EXPECT_EQ(belt.drive_at(10.0, 5ms), never) << "it was there before";
    EXPECT_EQ(belt.drive_at(99.0, 5ms), never) << "that is too far to be known";
    EXPECT_DOUBLE_EQ(belt.at(at(10s)), 15.5) << "no further than it may look";
    EXPECT_FALSE(belt.good(at(111ms)));
}

TEST(Lead, derives_no_speed_from_nearly_simultaneous_samples) {
    Lead belt{100ms};
    for (int i = 0; i < 5; ++i) {
        belt.sample(i, at(i * 10ms));
        belt.sample(i + 0.01, at(i * 10ms + 1us)); // two noisy measurements
        if (i > 0) {
            EXPECT_NEAR(belt.at(at(i * 10ms + 20ms)), i + 2.0, 0.05) << i;
        }
    }
    for (int i = 0; i < 20; ++i) belt.sample(5.0 + 0.5 * i, at(50ms + i * 1ms));
    EXPECT_NEAR(belt.per_s(), 500.0, 1e-6) << "samples that come faster from now on are believed soon";
}

TEST(Lead, forgets_a_sample_after_the_next_two) {
    for (const double one : {no_number, infinite, -infinite, 1.7e308, -1.7e308, 1e306, 1e-310}) {
        Lead belt{100ms};
        Time now{};
        for (const double value : {1.0, 1.0, one}) belt.sample(value, now += 1ms);
        EXPECT_TRUE(!belt.good(now) || is_number(belt.at(now))) << one;
        for (int n = 0; n < 2; ++n) belt.sample(1.0, now += 1ms);
        EXPECT_TRUE(belt.good(now)) << one;
        EXPECT_EQ(belt.at(now + 5ms), 1.0) << one;
    }
}

TEST(Lead, restarts_after_an_invalid_or_old_sample) {
    Lead belt{100ms};
    belt.sample(0.0, at(0ms));
    belt.sample(1.0, at(10ms));
    belt.sample(no_number, at(20ms));
    EXPECT_FALSE(belt.good(at(20ms)));
    belt.sample(2.0, at(30ms));
    EXPECT_FALSE(belt.good(at(30ms)));
    belt.sample(2.0, at(40ms));
    EXPECT_TRUE(belt.good(at(40ms)));
    EXPECT_EQ(belt.drive_at(3.0, 0ms), never) << "it stands";
    belt.sample(1.0, at(5ms));
    EXPECT_FALSE(belt.good(at(5ms)));
    belt.reset();
    belt.sample(4.0, at(50ms));
    EXPECT_DOUBLE_EQ(belt.at(at(60ms)), 4.0);
}

} // namespace
} // namespace tappet
