// The joints' sensor, alone: it accepts a calibration only for an angle that a joint can have. The
// controllers take over at the joints' present angles.
#include "apps/two_robots/controllers.hpp"
#include "apps/two_robots/joints.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace two_robots {
namespace {

struct Sensed : testing::Test {
    Output<std::int64_t> counts[6];
    JointSensor joints;
    Time now{};
    int count = 0;
    Sensed() {
        Input<std::int64_t>* const inputs[]{&joints.counts_1, &joints.counts_2, &joints.counts_3,
                                            &joints.counts_4, &joints.counts_5, &joints.counts_6};
        for (int i = 0; i < 6; ++i) {
            PortAccess::data<std::int64_t>.link_local(inputs[i], &counts[i], nullptr);
            counts[i].write(0);
        }
        joints.start({now, now, 1ms});
        step();
    }
    void step() {
        now += 1ms;
        joints.step({now, now, 1ms});
    }
};

TEST_F(Sensed, joints_refuse_impossible_calibration_angles) {
    using Real = std::numeric_limits<double>;
    for (const double none :
         {Real::max(), -Real::max(), Real::infinity(), Real::quiet_NaN(), 1e306, 1e4 + 1}) {
        joints.calibrate(1, none);
        step();
        EXPECT_FALSE(joints.is_calibrated(1)) << none;
        EXPECT_EQ(joints.positions.last(), Joints::Zero()) << none;
        EXPECT_EQ(joints.rates.last(), Joints::Zero()) << none;
    }
    joints.calibrate(1, -0.5);
    step();
    EXPECT_TRUE(joints.is_calibrated(1));
    EXPECT_EQ(joints.positions.last()[0], -0.5);
    EXPECT_EQ(joints.rates.last(), Joints::Zero()) << "which is no motion";
}

TEST_F(Sensed, joints_keep_their_angles_while_counts_per_rad_is_zero) {
    const Joints before = joints.positions.last();
    Joints none = joints.counts_per_rad.get();
    none[2] = 0.0;
    joints.counts_per_rad.set(none);
    counts[2].write(17);
    step();
    EXPECT_EQ(joints.positions.last(), before);
}

TEST_F(Sensed, joints_compute_rates_over_the_time_that_passed) {
    const auto turn = [&](int ms) {
        for (int i = 0; i < ms; ++i) {
            counts[0].write(++count);
            step();
        }
    };
    Joints per_rad = joints.counts_per_rad.get();
    per_rad[0] = 1000.0;
    joints.counts_per_rad.set(per_rad);
    turn(100); // 1 rad/s
    EXPECT_NEAR(joints.rates.last()[0], 1.0, 1e-9);
    Joints none = per_rad;
    none[5] = 0.0; // its angles are refused, and so are all
    joints.counts_per_rad.set(none);
    counts[5].write(1);
    turn(500);
    counts[5].write(0);
    joints.counts_per_rad.set(per_rad);
    turn(1);
    EXPECT_NEAR(joints.rates.last()[0], 1.0, 1e-9) << "and not the way of 501 ms in one of them";
    EXPECT_NEAR(joints.positions.last()[0], 0.601, 1e-9);
    now += 3ms; // cycles that were missed
    counts[0].write(count += 4);
    step();
    EXPECT_NEAR(joints.rates.last()[0], 1.0, 1e-9);
    joints.start({now, now, 1ms});
    EXPECT_EQ(joints.rates.last(), Joints::Zero()) << "there is no way before the first place";
}

template <class Controller>
double most_after_a_far_target(double far) {
    Output<Joints> target, rate, positions, sent;
    Output<bool> calibrated;
    Controller controller;
    PortAccess::data<Joints>.link_local(&controller.target, &target, nullptr);
    PortAccess::data<Joints>.link_local(&controller.rate, &rate, nullptr);
    PortAccess::data<Joints>.link_local(&controller.positions, &positions, nullptr);
    PortAccess::data<Joints>.link_local(&controller.sent, &sent, nullptr);
    PortAccess::data<bool>.link_local(&controller.calibrated, &calibrated, nullptr);
    for (Output<Joints>* each : {&target, &rate, &positions, &sent}) each->write(Joints::Zero());
    calibrated.write(false);
    target.write(Joints::Constant(far));
    controller.start({});
    target.write(Joints::Zero());
    double most = 0.0;
    for (int ms = 0; ms < 3000; ++ms) {
        controller.step({.period = 1ms});
        const double asked = largest(controller.wanted.last());
        if (!(asked <= most)) most = asked;
    }
    return most;
}

TEST(JointControllers, ignore_a_target_that_was_far_at_the_hand_over) {
    for (const double far : {5.0, -5.0, 1e300}) {
        EXPECT_EQ(most_after_a_far_target<JointPid>(far), 0.0) << far;
        EXPECT_EQ(most_after_a_far_target<JointFeedForward>(far), 0.0) << far;
    }
}

} // namespace
} // namespace two_robots
