// Prediction of a shaft's motion: positions follow the quadratic, crossings are their inverse.
#include "kernel/cam/motion.hpp"

#include "tests/kernel/base/seeded.hpp"

namespace tappet {
namespace {

ShaftMotion moving(double velocity, double acceleration) {
    ShaftMotion motion;
    motion.state = {ShaftPosition{5, 100_deg}, velocity, acceleration};
    motion.stamp = Time{1s};
    return motion;
}

TEST(ShaftMotion, extrapolates_acceleration_only_within_its_horizon) {
    const ShaftMotion motion = moving(1000.0, 10'000.0);
    EXPECT_NEAR((motion.at(Time{1010ms}).position - motion.state.position).in_degrees(), 10.5, 1e-6);
    EXPECT_NEAR((motion.at(Time{1030ms}).position - motion.state.position).in_degrees(), 22.0 + 12.0, 1e-6);
    EXPECT_NEAR(motion.at(Time{1030ms}).velocity_deg_s, 1200.0, 1e-9);
}

TEST(ShaftMotion, stops_without_reversing_when_braked) {
    const ShaftMotion motion = moving(1000.0, -100'000.0);
    const ShaftState stopped = motion.at(Time{2s});
    EXPECT_NEAR((stopped.position - motion.state.position).in_degrees(), 5.0, 1e-6);
    EXPECT_EQ(stopped.velocity_deg_s, 0.0);
    EXPECT_EQ(motion.when(motion.state.position + 6_deg, motion.stamp), never);
    EXPECT_NE(motion.when(motion.state.position + 4_deg, motion.stamp), never);
}

TEST(ShaftMotion, never_reaches_angles_behind_it_or_any_at_standstill) {
    const ShaftMotion forward = moving(1000.0, 0.0);
    EXPECT_EQ(forward.when(forward.state.position - 1_deg, forward.stamp), never);
    const ShaftMotion backward = moving(-1000.0, 0.0);
    EXPECT_EQ(backward.when(backward.state.position + 1_deg, backward.stamp), never);
    const ShaftMotion standing = moving(0.0, 0.0);
    EXPECT_EQ(standing.when(standing.state.position, standing.stamp), never);
}

TEST(ShaftMotion, does_not_predict_beyond_an_hour) {
    const ShaftMotion creeping = moving(1e-9, 0.0);
    EXPECT_EQ(creeping.when(creeping.state.position + 350_deg, creeping.stamp), never);
}

using AnyShaftMotion = test::Seeded;

TEST_F(AnyShaftMotion, reaches_the_target_at_the_predicted_time) {
    int reached = 0;
    for (int i = 0; i < 100'000; ++i) {
        const double velocity = (random.unit() - 0.5) * 24'000.0;
        const double acceleration = (random.unit() - 0.5) * 400'000.0;
        const double way = (random.unit() - 0.5) * 1440.0;
        const std::int64_t wait_us = random.between(-2'000, 40'000);
        const ShaftMotion motion = moving(velocity, acceleration);
        const ShaftPosition target = motion.state.position + Rotation::degrees(way);
        const Time not_before = motion.stamp + std::chrono::microseconds{wait_us};
        const Time when = motion.when(target, not_before);
        if (when == never) continue;
        ++reached;
        ASSERT_GE(when, std::max(not_before, motion.stamp));
        // At the instant of stopping, rounding by a nanosecond shifts the position; elsewhere the error is
        // speed times a nanosecond.
        ASSERT_NEAR((motion.at(when).position - target).in_degrees(), 0.0, 1e-4);
    }
    EXPECT_GT(reached, 10'000);
}

} // namespace
} // namespace tappet
