// Both arms: the K361 as measured, its wrist of two cones, and both kinematics against their inverses and
// their derivatives.
#include "apps/two_robots/kinematics.hpp"
#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

namespace two_robots {
namespace {

Joints any(Random& random, double most) {
    Joints q;
    for (int i = 0; i < 6; ++i) q[i] = most * (2.0 * random.unit() - 1.0);
    return q;
}

TEST(K361, has_the_pose_that_kdl_computes) { // KDL 1.5, and the cones multiplied out
    K361Kinematics arm;
    const auto flange = arm.posture(SixNumbers{Joints{.1, .2, 1.2426, 1.0373, 1.197, -1.0373}}).frame();
    EXPECT_NEAR(flange.position.x(), -.172757547383, 1e-11);
    EXPECT_NEAR(flange.position.y(), .764357664597, 1e-11);
    EXPECT_NEAR(flange.position.z(), 1.631531171755, 1e-11);
    EXPECT_NEAR(flange.rotation(0, 2), -.828109586, 1e-9);
    EXPECT_NEAR(flange.rotation(1, 2), .274678942, 1e-9);
    EXPECT_NEAR(flange.rotation(2, 2), .488657336, 1e-9);
}

TEST(K361, has_a_wrist_of_two_cones_that_bends_by_120_degrees_at_most) {
    Joints q = Joints::Zero();
    q[4] = 1.197;
    EXPECT_NEAR(ConeWrist::angles(q)[4], 1.142269598239, 1e-11);
    q[4] = std::numbers::pi;
    EXPECT_NEAR(ConeWrist::angles(q)[4], 2.0 * std::numbers::pi / 3.0, 1e-12);
    q[4] = 3.0; // beyond its range it goes to the end stop
    EXPECT_NEAR(ConeWrist::joints(q)[4], std::numbers::pi, 1e-9);
}

template <class Arm>
class AnyArm : public testing::Test {};
using Arms = testing::Types<K160Kinematics, K361Kinematics>;
TYPED_TEST_SUITE(AnyArm, Arms);

TYPED_TEST(AnyArm, comes_to_each_place_at_which_it_was) {
    TypeParam arm;
    Random random{7};
    for (int i = 0; i < 2000; ++i) {
        const Joints q = any(random, 1.8);
        const Posture posture = arm.posture(SixNumbers{q});
        const JointSolution solved = arm.solve(posture.flange, SixNumbers{q});
        ASSERT_TRUE(solved.found);
        const auto there = arm.posture(solved.joints).frame();
        ASSERT_LT((there.position - posture.frame().position).norm(), 1e-9);
        ASSERT_LT((there.rotation - posture.frame().rotation).norm(), 1e-7) << "joints " << q.transpose();
    }
}

TYPED_TEST(AnyArm, moves_as_the_difference_of_two_places_says) {
    TypeParam arm;
    Random random{8};
    constexpr double h = 1e-6;
    for (int i = 0; i < 500; ++i) {
        const Joints q = any(random, 2.0);
        const Eigen::Matrix<double, 6, 6> jacobian = arm.posture(SixNumbers{q}).jacobian().matrix;
        for (int joint = 0; joint < 6; ++joint) {
            Joints before = q, after = q;
            before[joint] -= h;
            after[joint] += h;
            const auto moved = motion::difference(arm.posture(SixNumbers{before}).frame(),
                                                  arm.posture(SixNumbers{after}).frame());
            ASSERT_LT((moved.linear / (2 * h) - jacobian.col(joint).head(3)).norm(), 1e-7);
            ASSERT_LT((moved.angular / (2 * h) - jacobian.col(joint).tail(3)).norm(), 1e-7);
        }
    }
}

TYPED_TEST(AnyArm, does_not_come_where_it_cannot_reach) {
    TypeParam arm;
    FlangeFrame far;
    far.position << 9, 0, 0;
    EXPECT_FALSE(arm.solve(FrameNumbers{far}, SixNumbers{Joints{Joints::Zero()}}).found);
}

} // namespace
} // namespace two_robots
