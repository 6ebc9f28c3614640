// For any numbers, the inverses of a chain return numbers within its limits, or refuse.
#include "kernel/motion/closed_form.hpp"
#include "kernel/motion/least_squares.hpp"
#include "tests/kernel/base/hostile.hpp"
#include "tests/kernel/motion/random_motion.hpp"
#include "tests/kernel/motion/robots.hpp"

namespace tappet::motion {
namespace {

using namespace robots;
using test::any_chain, test::any_frame, test::any_joints;

constexpr int rounds = 2000;

struct Chains : tappet::test::Hostile {
    template <int joints>
    Joints<joints> joints_by(auto draw) {
        Joints<joints> q;
        for (int i = 0; i < joints; ++i) q[i] = draw();
        return q;
    }
    /// Usual values, and occasionally any number.
    double mostly(double most) { return random.one_in(8) ? value() : test::within(random, most); }
    double mostly_number(double most) { return random.one_in(8) ? number() : test::within(random, most); }
    template <int joints>
    JointRanges<joints> ranges() {
        JointRanges<joints> all;
        for (JointRange& range : all)
            if (!random.one_in(3)) {
                const double lowest = mostly(3.0);
                range = {lowest, random.one_in(6) ? value() : lowest + 4.0 * random.unit()};
            }
        return all;
    }
    template <class A, class B>
    Frame<A, B> frame_of_numbers() {
        auto frame = any_frame<A, B>(random);
        for (int i = 0; i < 3; ++i)
            if (random.one_in(5)) frame.position[i] = number();
        if (random.one_in(5)) frame.rotation(static_cast<Eigen::Index>(random.below(9))) = number();
        return frame;
    }
};

TEST_F(Chains, have_positions_within_reach_for_any_joint_values) {
    for (int n = 0; n < rounds; ++n) {
        const Joints<6> q = joints_by<6>([&] { return number(); });
        const auto pose = forward_with_jacobian(folded<puma_560>, q);
        const Eigen::Matrix3d square = pose.frame.rotation * pose.frame.rotation.transpose();
        ASSERT_NEAR((square - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-13);
        ASSERT_LE(pose.frame.position.norm(), 1.5);
        ASSERT_LE(pose.jacobian.matrix.cwiseAbs().maxCoeff(), 1.5);
    }
}

TEST_F(Chains, return_rates_within_their_limits_or_none) {
    int made = 0;
    for (int n = 0; n < 10 * rounds; ++n) {
        JacobianOf<Loaded<test::Base, test::End, 4>> jacobian;
        const bool is_wild = random.one_in(2);
        for (int i = 0; i < 24; ++i) jacobian.matrix(i) = is_wild ? mostly(2.0) : test::within(random, 2.0);
        Twist<test::End, test::Base, test::End, test::Base> twist;
        for (int i = 0; i < 3; ++i) {
            twist.linear[i] = mostly(1.0);
            twist.angular[i] = mostly(1.0);
        }
        const double damping = mostly(1.0);
        const Joints<4> most = joints_by<4>([&] { return random.one_in(8) ? value() : random.unit(); });
        const auto rates = damped_rates(jacobian, twist, damping, most);
        if (!rates) continue;
        ++made;
        for (int i = 0; i < 4; ++i)
            ASSERT_TRUE(is_number((*rates)[i]) && std::fabs((*rates)[i]) <= most[i] * (1.0 + 1e-12))
                << (*rates)[i] << " of " << most[i] << ", damping " << damping;
    }
    EXPECT_GT(made, rounds / 10);
}

TEST_F(Chains, return_joint_values_within_their_ranges_or_none) {
    int found = 0;
    for (int n = 0; n < rounds; ++n) {
        const Loaded robot{any_chain<4>(random)};
        const bool is_near = random.one_in(2);
        const Joints<4> from =
            joints_by<4>([&] { return is_near ? test::within(random, 1.0) : mostly_number(3.0); });
        const auto target = is_near ? forward(robot, from) : frame_of_numbers<test::Base, test::End>();
        const JointRanges<4> allowed = random.one_in(2) ? JointRanges<4>{} : ranges<4>();
        const auto got =
            least_squares(robot, target, from, allowed, {.most_steps = 20, .most_step = mostly(0.5)});
        if (!got) continue;
        ++found;
        ASSERT_LE(got->steps, 20);
        ASSERT_TRUE(got->q.allFinite());
        ASSERT_TRUE(is_within(got->q, allowed)) << got->q.transpose();
    }
    EXPECT_GT(found, rounds / 20);
}

TEST_F(Chains, return_finite_solutions_with_the_nearest_in_range) {
    int found = 0;
    for (int n = 0; n < rounds; ++n) {
        const Joints<6> near = joints_by<6>([&] { return mostly_number(3.0); });
        const auto target =
            random.one_in(2) ? forward(folded<puma_560>, near) : frame_of_numbers<World, Flange>();
        const auto solutions = closed_form(folded<puma_560>, target, near);
        for (const Joints<6>& q : solutions) ASSERT_TRUE(q.allFinite());
        const JointRanges<6> allowed = random.one_in(2) ? JointRanges<6>{} : ranges<6>();
        const Joints<6> from = random.one_in(2) ? near : joints_by<6>([&] { return mostly(3.0); });
        const auto best = nearest(solutions, from, allowed);
        if (!best) continue;
        ++found;
        ASSERT_TRUE(best->allFinite());
        ASSERT_TRUE(is_within(*best, allowed)) << best->transpose();
    }
    EXPECT_GT(found, rounds / 20);
}

/// From a table of a file: an invalid number stays invalid, without an undefined conversion.
TEST_F(Chains, from_any_table_are_computed) {
    for (int n = 0; n < rounds; ++n) {
        auto table = any_chain<3>(random);
        for (Link& link : table.links) {
            link.alpha_deg = mostly(180.0);
            link.theta_deg = mostly(180.0);
        }
        static_cast<void>(forward(Loaded{table}, any_joints<3>(random, 3.0)));
    }
}

TEST_F(Chains, use_sines_and_cosines_on_the_unit_circle) {
    for (int n = 0; n < 10 * rounds; ++n) {
        const double angle = number(), other = value();
        for (const auto& [sine, cosine] : {sine_cosine(angle), sine_cosine_of_degrees(angle)})
            ASSERT_NEAR(sine * sine + cosine * cosine, 1.0, 1e-15) << angle;
        for (const auto& [sine, cosine] : {sine_cosine(other), sine_cosine_of_degrees(other)})
            ASSERT_EQ(is_number(sine) && is_number(cosine), is_number(other)) << other;
        const double near = mostly_number(10.0);
        if (std::fabs(angle) < 1e6 && std::fabs(near) < 1e6) {
            ASSERT_LE(std::fabs(same_angle_near(angle, near) - near), std::numbers::pi + 1e-9);
        }
        const Eigen::Vector3d v{mostly_number(3.0), mostly_number(3.0), mostly_number(3.0)};
        if (v.cwiseAbs().maxCoeff() < 1e150) {
            const Eigen::Matrix3d m = rotation_about(v);
            ASSERT_NEAR((m * m.transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12)
                << v.transpose();
            ASSERT_LE(rotation_vector(m).norm(), std::numbers::pi + 1e-9);
        }
    }
}

} // namespace
} // namespace tappet::motion
