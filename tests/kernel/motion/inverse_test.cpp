// Inverse kinematics: solutions reach the target, all branches are found, and steps are limited.
#include "kernel/motion/closed_form.hpp"
#include "kernel/motion/least_squares.hpp"
#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/motion/random_motion.hpp"
#include "tests/kernel/motion/robots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tappet::motion::test {
namespace {

using namespace tappet::test;
using ClosedForm = Seeded;
using LeastSquares = Seeded;
using DampedRates = Seeded;

constexpr double pi = std::numbers::pi;

/// An arm with a closed form, with any signs and lengths.
constexpr Chain<Base, End, 6> draw_arm(std::uint64_t seed) {
    Random random{seed};
    const auto sign = [&] { return random.one_in(2) ? -1.0 : 1.0; };
    const auto length = [&] { return sign() * (0.1 + random.unit()); };
    const auto some = [&] { return random.one_in(2) ? 0.0 : within(random, 0.3); };
    Chain<Base, End, 6> chain{};
    for (Link& link : chain.links) {
        link = Link{};
        link.theta_deg =
            random.one_in(2) ? 90.0 * static_cast<double>(random.between(-2, 2)) : within(random, 180.0);
        link.reversed = random.one_in(2);
        link.alpha_deg = 90.0 * sign();
    }
    chain.links[0].a_m = some();
    chain.links[0].d_m = length();
    chain.links[1].a_m = length();
    chain.links[1].d_m = some();
    chain.links[1].alpha_deg = random.one_in(2) ? 0.0 : 180.0;
    chain.links[2].a_m = some();
    chain.links[2].d_m = some();
    chain.links[3].d_m = length();
    chain.links[5].a_m = some();
    chain.links[5].d_m = length();
    chain.links[5].alpha_deg = within(random, 180.0);
    return chain;
}
template <std::uint64_t seed>
constexpr Chain<Base, End, 6> arm = draw_arm(seed);

double largest_turn_between(const Joints<6>& a, const Joints<6>& b) {
    double largest = 0.0;
    for (int i = 0; i < 6; ++i) largest = std::max(largest, std::fabs(same_angle_near(a[i], b[i]) - b[i]));
    return largest;
}

/// Every solution reaches the target, eight are different, and the joints that produced the target are among
/// them.
template <const auto& chain>
void leads_back(Random& random) {
    static_assert(has_closed_form(chain));
    for (int round = 0; round < 50; ++round) {
        const Joints<6> q = any_joints<6>(random, 3.0);
        const auto target = forward(folded<chain>, q);
        const auto found = closed_form(folded<chain>, target, q);
        EXPECT_GE(found.size(), 4u);
        double nearest_one = 10.0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const auto there = forward(folded<chain>, found[i]);
            EXPECT_NEAR((there.position - target.position).norm(), 0.0, 1e-9);
            EXPECT_NEAR((there.rotation - target.rotation).norm(), 0.0, 1e-9);
            nearest_one = std::min(nearest_one, largest_turn_between(found[i], q));
            for (std::size_t k = 0; k < i; ++k) EXPECT_GT(largest_turn_between(found[i], found[k]), 1e-9);
        }
        EXPECT_LT(nearest_one, 1e-6);
        const auto chosen = nearest<6>(found, q);
        ASSERT_TRUE(chosen);
        EXPECT_LT((*chosen - q).cwiseAbs().maxCoeff(), 1e-6);
    }
}

template <std::uint64_t... seeds>
void all_lead_back(std::integer_sequence<std::uint64_t, seeds...>, Random& random) {
    (leads_back<arm<seeds>>(random), ...);
}

TEST_F(ClosedForm, returns_the_joints_that_produced_the_target) {
    leads_back<robots::puma_560_links>(random);
    leads_back<robots::k361>(random);
    all_lead_back(std::make_integer_sequence<std::uint64_t, 16>{}, random);
}

TEST_F(ClosedForm, keeps_undetermined_joints_at_their_values) {
    const auto& k361 = folded<robots::k361>;
    // Stretched wrist: only the sum of joints 4 and 6 is known.
    const Joints<6> stretched{.3, .4, 1.1, .7, 0, -.2};
    const auto chosen = nearest<6>(closed_form(k361, forward(k361, stretched), stretched), stretched);
    ASSERT_TRUE(chosen);
    EXPECT_LT((*chosen - stretched).cwiseAbs().maxCoeff(), 1e-7);
    // The wrist above the first axis: sin(q2) 0.480 + sin(q2 + q3) 0.645 = 0.
    const double q2 = .5;
    const Joints<6> above{.3, q2, -q2 - std::asin(.480 / .645 * std::sin(q2)), .2, .6, .1};
    const auto kept = nearest<6>(closed_form(k361, forward(k361, above), above), above);
    ASSERT_TRUE(kept);
    EXPECT_LT((*kept - above).cwiseAbs().maxCoeff(), 1e-6);
}

TEST_F(ClosedForm, reports_targets_out_of_reach_or_outside_the_limits) {
    const auto& puma = folded<robots::puma_560_links>;
    const Joints<6> q{.1, .2, .3, .4, .5, .6};
    auto far = forward(puma, q);
    far.position.x() += 3.0;
    EXPECT_TRUE(closed_form(puma, far, q).empty());
    EXPECT_EQ(nearest<6>(closed_form(puma, far, q), q).error(), Refused{Refusal::out_of_reach});
    JointRanges<6> ranges;
    ranges[4] = {5.0, 5.1};
    EXPECT_EQ(nearest<6>(closed_form(puma, forward(puma, q), q), q, ranges).error(),
              (Refused{Refusal::outside_limits, 4}));
    // One whole turn further it is within the range.
    ranges[4] = {6.0, 8.0};
    const auto turned = nearest<6>(closed_form(puma, forward(puma, q), q), q, ranges);
    ASSERT_TRUE(turned);
    EXPECT_NEAR((*turned)[4], .5 + 2.0 * pi, 1e-9);
}

TEST_F(ClosedForm, exists_only_for_arms_with_a_spherical_wrist) {
    Chain<Base, End, 6> offset = draw_arm(1);
    static_assert(has_closed_form(draw_arm(1)));
    offset.links[4].d_m = 0.1;
    EXPECT_FALSE(has_closed_form(offset));
    offset = draw_arm(1);
    offset.links[2].joint = Joint::prismatic;
    EXPECT_FALSE(has_closed_form(offset));
    offset = draw_arm(1);
    offset.links[3].alpha_deg = 60.0;
    EXPECT_FALSE(has_closed_form(offset));
    EXPECT_FALSE(has_closed_form(Chain<Base, End, 5>{}));
}

TEST_F(LeastSquares, converges_from_nearby_in_a_few_steps) {
    int most_steps = 0;
    int failures = 0;
    for (int round = 0; round < 300; ++round) {
        const Loaded robot{any_chain<7>(random)};
        const Joints<7> q = any_joints<7>(random, 2.0);
        const auto target = forward(robot, q);
        const Joints<7> from = q + any_joints<7>(random, 0.1);
        const auto found = least_squares(robot, target, from);
        if (!found) {
            ++failures;
            continue;
        }
        most_steps = std::max(most_steps, found->steps);
        const auto there = forward(robot, found->q);
        EXPECT_NEAR((there.position - target.position).norm(), 0.0, 1e-9);
        EXPECT_NEAR(rotation_vector(there.rotation * target.rotation.transpose()).norm(), 0.0, 1.1e-9);
    }
    EXPECT_LE(most_steps, 60);
    EXPECT_LE(failures, 15) << "some of the chains drawn cannot move freely there";
    const auto& puma = folded<robots::puma_560_links>;
    const Joints<6> q{.1, .2, .3, .4, .9, .6};
    const auto found = least_squares(puma, forward(puma, q), Joints<6>{q + Joints<6>::Constant(0.1)});
    ASSERT_TRUE(found);
    EXPECT_LE(found->steps, 8);
    EXPECT_LT((found->q - q).cwiseAbs().maxCoeff(), 1e-7);
}

TEST_F(LeastSquares, refuses_unreachable_targets_and_respects_the_limits) {
    const auto& puma = folded<robots::puma_560_links>;
    const Joints<6> q{.1, .2, .3, .4, .9, .6};
    auto far = forward(puma, q);
    far.position.z() += 5.0;
    EXPECT_EQ(least_squares(puma, far, q).error(), Refused{Refusal::not_converged});
    JointRanges<6> ranges;
    ranges[0] = {.3, .4};
    EXPECT_EQ(least_squares(puma, forward(puma, q), Joints<6>{q + 0.2 * Joints<6>::Unit(0)}, ranges).error(),
              Refused{Refusal::not_converged});
}

TEST_F(DampedRates, produce_the_twist_and_stay_small_near_singularities) {
    const auto& k361 = folded<robots::k361>;
    const Joints<6> most = Joints<6>::Constant(2.0);
    for (int round = 0; round < 100; ++round) {
        const auto pose = forward_with_jacobian(k361, any_joints<6>(random, 3.0));
        const auto twist = pose.jacobian * any_joints<6>(random, 0.3);
        const auto found = damped_rates(pose.jacobian, twist, 1e-5, most);
        ASSERT_TRUE(found);
        const auto reached = pose.jacobian * *found;
        EXPECT_LT((reached.linear - twist.linear).norm() + (reached.angular - twist.angular).norm(), 1e-5);
    }
    // Stretched: a turn across the plane of the wrist would need unlimited joint rates.
    const auto pose = forward_with_jacobian(k361, Joints<6>{0, .3, 1.2, 0, 0, 0});
    TwistOf<std::remove_cvref_t<decltype(k361)>> twist;
    twist.angular = pose.frame.rotation.col(0) + pose.frame.rotation.col(1);
    const auto found = damped_rates(pose.jacobian, twist, 0.05, most);
    ASSERT_TRUE(found);
    EXPECT_LE(found->cwiseAbs().maxCoeff(), 2.0);
    const auto fast = damped_rates(pose.jacobian, twist, 0.05, Joints<6>{Joints<6>::Constant(1e-3)});
    ASSERT_TRUE(fast);
    EXPECT_NEAR(fast->cwiseAbs().maxCoeff(), 1e-3, 1e-15);
    EXPECT_LT((fast->normalized() - found->normalized()).norm(), 1e-12) << "the direction stays";
    EXPECT_EQ(damped_rates(pose.jacobian, twist, 0.0, most).error(), Refused{Refusal::limit_not_positive});
    twist.angular.y() = no_number;
    EXPECT_EQ(damped_rates(pose.jacobian, twist, 0.1, most).error(), (Refused{Refusal::not_a_number, 4}));
}

} // namespace
} // namespace tappet::motion::test
