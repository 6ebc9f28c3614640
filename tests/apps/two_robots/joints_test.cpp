// The joints' sensor, alone: what somebody says of a joint's angle is taken only when a joint can have it.
#include "apps/two_robots/joints.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace two_robots {
namespace {

struct Sensed : testing::Test {
    Output<std::int64_t> counts[6];
    JointSensor joints;
    Time now{};
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

TEST_F(Sensed, joints_have_no_angle_that_is_beyond_all_turns) {
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

TEST_F(Sensed, joints_whose_counts_mean_no_angle_are_not_written) {
    const Joints before = joints.positions.last();
    Joints none = joints.counts_per_rad.get();
    none[2] = 0.0;
    joints.counts_per_rad.set(none);
    counts[2].write(17);
    step();
    EXPECT_EQ(joints.positions.last(), before);
}

} // namespace
} // namespace two_robots
