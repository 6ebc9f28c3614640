// The PID controller against formulas and against a plant; the effects of a step, a limit and a hand-over.
#include "kernel/base/random.hpp"
#include "kernel/motion/pid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tappet::motion::test {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(Pid, equals_the_sum_of_its_terms) {
    Pid p{{.proportional = 2.0}};
    EXPECT_DOUBLE_EQ(p(3.0, 1.0, 1ms), 4.0);
    Pid i{{.integral = 10.0}};
    EXPECT_DOUBLE_EQ(i(2.0, 1.0, 100ms), 0.0) << "the integral of what was is put out next";
    EXPECT_DOUBLE_EQ(i(2.0, 1.0, 100ms), 1.0);
    EXPECT_DOUBLE_EQ(i(2.0, 1.0, 300ms), 2.0);
    Pid d{{.derivative = 0.5, .derivative_weight = 1.0}};
    EXPECT_DOUBLE_EQ(d(1.0, 0.0, 10ms), 0.0) << "before the first value there was none";
    EXPECT_DOUBLE_EQ(d(1.0, 0.1, 10ms), -5.0);
    EXPECT_DOUBLE_EQ(d(1.0, 0.1, 10ms), 0.0);
    Pid ff{{.proportional = 1.0}};
    EXPECT_DOUBLE_EQ(ff(1.0, 1.0, 1ms, 7.0), 7.0);
}

TEST(Pid, has_no_set_point_kick_unless_configured) {
    const PidGains smooth{.proportional = 1.0, .derivative = 1.0, .set_point_weight = 0.5};
    Pid weighted{smooth};
    weighted(0.0, 0.0, 1ms);
    EXPECT_DOUBLE_EQ(weighted(2.0, 0.0, 1ms), 1.0);
    PidGains rough = smooth;
    rough.derivative_weight = 1.0;
    Pid kicked{rough};
    kicked(0.0, 0.0, 1ms);
    EXPECT_DOUBLE_EQ(kicked(2.0, 0.0, 1ms), 1.0 + 2000.0);
}

TEST(Pid, filters_its_derivative) {
    Pid d{{.derivative = 2.0, .derivative_filter_s = 0.05}};
    double output = 0.0;
    for (int k = 0; k < 1000; ++k) output = d(0.0, 3.0 * k * 1e-3, 1ms);
    EXPECT_NEAR(output, -6.0, 1e-6);
    Pid early{{.derivative = 2.0, .derivative_filter_s = 0.05}};
    for (int k = 0; k <= 50; ++k) output = early(0.0, 3.0 * k * 1e-3, 1ms);
    EXPECT_NEAR(output, -6.0 * (1.0 - std::exp(-1.0)), 0.05) << "one time constant after the ramp's begin";
}

/// x. = u, sampled: the drive of an axis by its speed.
struct Axis {
    double position = 0.0;
    void run(double speed, double seconds) { position += speed * seconds; }
};

TEST(Pid, reaches_its_set_point_and_follows_a_ramp_with_feed_forward) {
    Pid step{{.proportional = 10.0}};
    Axis axis;
    for (int k = 0; k < 2000; ++k) axis.run(step(1.0, axis.position, 2ms), 2e-3);
    EXPECT_NEAR(axis.position, 1.0, 1e-9);
    for (const double feed : {0.0, 0.5}) {
        Pid ramp{{.proportional = 10.0}};
        Axis follower;
        double error = 0.0;
        for (int k = 0; k < 2000; ++k) {
            error = 0.5 * k * 2e-3 - follower.position;
            follower.run(ramp(0.5 * k * 2e-3, follower.position, 2ms, feed), 2e-3);
        }
        EXPECT_NEAR(error, feed > 0.0 ? 0.0 : 0.05, 1e-9);
    }
}

/// A first-order plant, 1 / (1 + s), held at its limit for long, then with a lower set point.
double overshoot(const PidGains& gains, bool limit_is_behind) {
    Pid pid{gains};
    double y = 0.0;
    double most = 0.0;
    for (int k = 0; k < 20000; ++k) {
        const double wanted = k < 10000 ? 5.0 : 0.5; // 5 is out of reach
        const double u = pid(wanted, y, 1ms);
        const double applied = std::clamp(u, -1.0, 1.0);
        if (limit_is_behind) pid.applied(applied);
        y += (applied - y) * 1e-3;
        if (k > 10000 + 1500) most = std::max(most, y - 0.5);
    }
    return most;
}

TEST(Pid, avoids_wind_up_at_its_own_and_at_downstream_limits) {
    const PidGains free{.proportional = 5.0, .integral = 5.0};
    EXPECT_GT(overshoot(free, false), 0.4) << "it must show what winding up is";
    PidGains limited = free;
    limited.lowest = -1.0;
    limited.highest = 1.0;
    EXPECT_LT(overshoot(limited, false), 0.02);
    limited.tracking_s = 0.2;
    EXPECT_LT(overshoot(limited, false), 0.02);
    PidGains behind = free;
    behind.tracking_s = 0.2;
    EXPECT_LT(overshoot(behind, true), 0.02);
}

TEST(Pid, takes_over_bumplessly) {
    Pid pid{{.proportional = 3.0, .integral = 2.0, .derivative = 0.1, .set_point_weight = 0.7}};
    for (int k = 0; k < 100; ++k) pid.track(1.0 + k, 0.5, 4.25, 0.5);
    EXPECT_EQ(pid.output(), 4.25);
    EXPECT_NEAR(pid(100.0, 0.5, 1ms, 0.5), 4.25, 1e-12);
}

TEST(Pid, takes_over_bumplessly_within_its_limits_from_any_set_point) {
    for (const double tracking : {0.0, 0.1}) {
        Pid pid{
            {.proportional = 1.0, .integral = 0.5, .tracking_s = tracking, .lowest = -10.0, .highest = 10.0}};
        for (const double set_point : {4.0, 30.0, -1000.0, 1e5}) {
            pid.track(set_point, 0.0, 4.25);
            EXPECT_NEAR(pid(set_point, 0.0, 1ms), 4.25, 1e-9) << set_point;
        }
    }
}

/// An axis is at zero while another controller drives it; the set point is 0 from the hand-over on.
struct HandOver {
    double away = 0.0;
    double until = 0.0; ///< time of its return, s
};
HandOver hand_over(const PidGains& gains, double set_point, double actual, double feed_forward = 0.0) {
    Pid pid{gains};
    pid.track(set_point, 0.0, actual, feed_forward);
    Axis axis;
    HandOver seen;
    for (int ms = 0; ms < 60'000; ++ms) {
        axis.run(pid(0.0, axis.position, 1ms), 1e-3);
        seen.away = std::max(seen.away, std::abs(axis.position));
        if (std::abs(axis.position) > 0.5) seen.until = ms * 1e-3;
    }
    return seen;
}

TEST(Pid, recovers_from_tracking_beyond_its_limits_in_one_step) {
    for (const double tracking : {0.0, 0.1}) {
        const PidGains gains{
            .proportional = 1.0, .integral = 0.5, .tracking_s = tracking, .lowest = -10.0, .highest = 10.0};
        // No integral between the limits has more effect than one at either limit.
        const HandOver worst = hand_over(gains, 0.0, 10.0);
        ASSERT_LT(worst.away, 6.5);
        for (const double far : {10.0, 12.0, 1e3, 1e5, 1e100, 1e308, -1e3, -1e308})
            for (const HandOver& seen :
                 {hand_over(gains, far, 0.0), hand_over(gains, 0.0, far), hand_over(gains, 0.0, 0.0, far)}) {
                EXPECT_LE(seen.away, worst.away + 0.02) << far;
                EXPECT_LE(seen.until, worst.until + 0.02) << far;
            }
    }
}

TEST(Pid, bounds_its_integral_by_its_limits) {
    Random random{3};
    const auto any = [&] {
        const double size = std::pow(10.0, 300.0 * random.unit() - 2.0);
        return random.one_in(2) ? size : -size;
    };
    for (int n = 0; n < 2000; ++n) {
        Pid pid{{.proportional = random.unit(),
                 .integral = 5.0 * random.unit(),
                 .tracking_s = 0.1 * random.unit(),
                 .lowest = -10.0,
                 .highest = random.one_in(2) ? 3.0 : infinite}};
        pid.track(any(), any(), any(), any());
        for (int k = 0; k < 3; ++k) pid(0.0, 0.0, 1ms);
        EXPECT_GE(pid.integral(), -10.0);
        EXPECT_LE(pid.integral(), std::max(pid.output(), 3.0));
    }
}

TEST(Pid, ignores_errors_within_its_dead_band) {
    Pid pid{{.proportional = 2.0, .integral = 1.0, .dead_band = 0.5}};
    EXPECT_EQ(pid(1.0, 0.6, 1s), 0.0);
    EXPECT_EQ(pid(1.0, 1.4, 1s), 0.0);
    EXPECT_DOUBLE_EQ(pid(1.0, 0.0, 1s), 1.0);
}

TEST(Pid, rejects_invalid_numbers_and_keeps_its_state) {
    Pid pid{{.proportional = 2.0, .integral = 1.0}};
    pid(1.0, 0.0, 1s);
    for (const double bad : {no_number, infinite}) {
        EXPECT_EQ(pid(bad, 0.0, 1s), 2.0);
        EXPECT_EQ(pid(1.0, bad, 1s), 2.0);
        EXPECT_EQ(pid(1.0, 0.0, 1s, bad), 2.0);
        pid.track(1.0, 0.0, bad);
        pid.applied(bad);
    }
    EXPECT_EQ(pid(1.0, 0.0, 0s), 2.0);
    EXPECT_EQ(pid.refused(), 11u);
    EXPECT_EQ(pid.integral(), 1.0);
    pid.reset();
    EXPECT_EQ(pid(0.0, 0.0, 1s), 0.0);
}

TEST(Pid, reports_faulty_gains) {
    EXPECT_EQ(check(PidGains{}), "");
    EXPECT_EQ(check(PidGains{.integral = no_number}), "a gain is not a finite number; write one");
    EXPECT_EQ(check(PidGains{.tracking_s = -1.0}), "a time constant is negative; write 0 for none");
    EXPECT_EQ(check(PidGains{.lowest = 1.0, .highest = 1.0}),
              "the output limits are an empty range; set lowest below highest");
    EXPECT_EQ(check(PidGains{.dead_band = -1.0}), "the dead band is negative; write 0 for none");
    const PidGains none{.lowest = 2.0, .highest = 1.0};
    EXPECT_DEATH(Pid{none}, "contract 5 refused-settings");
}

} // namespace
} // namespace tappet::motion::test
