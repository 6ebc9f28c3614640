// Trajectories against their limits, an integrator and a search for shorter ones, for any numbers.
#include "kernel/motion/synchronised.hpp"
#include "kernel/motion/trajectory.hpp"
#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/motion/random_motion.hpp"

#include <cmath>

namespace tappet::motion::test {
namespace {

using namespace tappet::test;

struct Trajectories : Seeded {
    /// Over four decades.
    double any_size() { return std::pow(10.0, within(random, 2.0)); }
    AxisLimits any_limits() {
        const double velocity = any_size();
        const double acceleration = any_size();
        const double jerk = any_size();
        return {velocity, acceleration, jerk};
    }
};

constexpr double slack = 1.0 + 1e-9;

struct Most {
    double velocity, acceleration, jerk;
};

/// Samples a profile in equal steps: position is the integral of velocity (Simpson), velocity that of
/// acceleration, and nothing exceeds `most`. The tolerance allows for a kink inside a step.
void expect_whole(const Profile& profile, const Most& most) {
    constexpr int steps = 3000;
    const double h = profile.duration_s() / steps;
    double position = profile.at_s(0.0).position;
    double velocity = profile.at_s(0.0).velocity;
    AxisState before = profile.at_s(0.0);
    double largest = std::fabs(position);
    for (int i = 1; i <= steps; ++i) {
        const AxisState middle = profile.at_s((i - 0.5) * h);
        const AxisState now = profile.at_s(i < steps ? i * h : profile.duration_s() * (1.0 - 1e-15));
        position += h / 6.0 * (before.velocity + 4.0 * middle.velocity + now.velocity);
        velocity += h / 6.0 * (before.acceleration + 4.0 * middle.acceleration + now.acceleration);
        EXPECT_LE(std::fabs(now.velocity), most.velocity * slack + 1e-12);
        EXPECT_LE(std::fabs(now.acceleration), most.acceleration * slack + 1e-12);
        EXPECT_LE(std::fabs(now.acceleration - before.acceleration),
                  most.jerk * h * slack + 1e-9 * most.acceleration);
        largest = std::max(largest, std::fabs(now.position));
        before = now;
    }
    const double kinks = static_cast<double>(Profile::most_pieces);
    EXPECT_NEAR(position, profile.end().position, kinks * most.acceleration * h * h + 1e-9 * largest);
    const double jumps = std::isinf(most.jerk) ? most.acceleration * h : most.jerk * h * h;
    EXPECT_NEAR(velocity, 0.0, kinks * jumps + 1e-9 * most.velocity);
    // The end is set, not computed; the last piece still reaches it.
    EXPECT_NEAR(before.position, profile.end().position, 1e-9 * (largest + most.velocity * h));
    EXPECT_NEAR(before.velocity, 0.0, 1e-7 * (most.velocity + most.acceleration * h));
    EXPECT_EQ(profile.end().velocity, 0.0);
    EXPECT_EQ(profile.end().acceleration, 0.0);
}

TEST_F(Trajectories, by_trapezoid_reach_rest_from_any_state_within_limits) {
    for (int round = 0; round < 300; ++round) {
        const AxisLimits limits = any_limits();
        const AxisState from{within(random, 10.0), limits.velocity * within(random, 3.0), 0.0};
        const double target = from.position + within(random, 1.0) * any_size();
        const auto plan = trapezoid(from, target, limits);
        ASSERT_TRUE(plan);
        EXPECT_LE(plan->pieces(), 3u);
        EXPECT_EQ(plan->end().position, target);
        EXPECT_EQ(plan->at_s(-1.0).velocity, plan->pieces() > 0 ? from.velocity : 0.0);
        expect_whole(*plan,
                     {std::max(limits.velocity, std::fabs(from.velocity)), limits.acceleration, infinite});
    }
}

TEST_F(Trajectories, by_trapezoid_are_time_optimal) {
    // Full acceleration at all times except at full speed is time optimal.
    for (int round = 0; round < 100; ++round) {
        const AxisLimits limits = any_limits();
        const AxisState from{0.0, limits.velocity * within(random, 2.0), 0.0};
        const auto plan = trapezoid(from, within(random, 1.0) * any_size(), limits);
        ASSERT_TRUE(plan);
        for (int i = 0; i < 100; ++i) {
            const AxisState state = plan->at_s(random.unit() * plan->duration_s());
            if (state.acceleration == 0.0)
                EXPECT_NEAR(std::fabs(state.velocity), limits.velocity, 1e-12 * limits.velocity);
            else
                EXPECT_EQ(std::fabs(state.acceleration), limits.acceleration);
        }
    }
}

TEST_F(Trajectories, by_trapezoid_reverse_when_they_cannot_stop_in_time) {
    const auto plan = trapezoid({0.0, 10.0, 0.0}, 1.0, {20.0, 10.0, 0.0});
    ASSERT_TRUE(plan);
    // It is at 5 after 1 s, and needs 2 sqrt(4 / 10) s to return.
    EXPECT_NEAR(plan->at_s(1.0).position, 5.0, 1e-12);
    EXPECT_NEAR(plan->duration_s(), 1.0 + 2.0 * std::sqrt(0.4), 1e-12);
}

/// The time from rest to rest by another method: bisection on the highest speed.
double searched_duration(double way, const AxisLimits& limits) {
    const auto ramp = [&](double peak) {
        const double flat = peak - limits.acceleration * limits.acceleration / limits.jerk;
        return flat > 0.0 ? limits.acceleration / limits.jerk + peak / limits.acceleration
                          : 2.0 * std::sqrt(peak / limits.jerk);
    };
    double low = 0.0;
    double high = limits.velocity;
    if (high * ramp(high) <= way) return way / high + ramp(high);
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (middle * ramp(middle) < way ? low : high) = middle;
    }
    return 2.0 * ramp(high);
}

TEST_F(Trajectories, of_bounded_jerk_are_time_optimal_within_limits) {
    for (int round = 0; round < 300; ++round) {
        const AxisLimits limits = any_limits();
        const double from = within(random, 10.0);
        const double target = from + within(random, 1.0) * any_size();
        const auto plan = jerk_limited(from, target, limits);
        ASSERT_TRUE(plan);
        EXPECT_EQ(plan->end().position, target);
        EXPECT_NEAR(plan->duration_s(), searched_duration(std::fabs(target - from), limits),
                    1e-7 * plan->duration_s());
        expect_whole(*plan, {limits.velocity, limits.acceleration, limits.jerk});
    }
}

TEST_F(Trajectories, of_bounded_jerk_stop_from_any_state) {
    for (int round = 0; round < 300; ++round) {
        const AxisLimits limits = any_limits();
        const AxisState from{within(random, 10.0), within(random, 1.0) * any_size(),
                             limits.acceleration * within(random, 1.5)};
        const auto plan = stop(from, limits);
        ASSERT_TRUE(plan);
        EXPECT_LE(plan->pieces(), 3u);
        const double gained = 0.5 * from.acceleration * from.acceleration / limits.jerk;
        expect_whole(*plan, {std::fabs(from.velocity) + gained,
                             std::max(limits.acceleration, std::fabs(from.acceleration)), limits.jerk});
        // Full jerk at all times except at full deceleration is time optimal. A sample may hit the edge of
        // two pieces, once in a million.
        int misses = 0;
        for (int i = 0; i < 100; ++i) {
            const double h = 1e-6 * plan->duration_s();
            const double t = random.unit() * (plan->duration_s() - h);
            const AxisState now = plan->at_s(t);
            const double jerk = std::fabs(plan->at_s(t + h).acceleration - now.acceleration) / h;
            const bool holds = std::fabs(now.acceleration) > limits.acceleration * (1.0 - 1e-12);
            if (std::fabs(jerk - limits.jerk) > 1e-3 * limits.jerk && !(holds && jerk < 1e-3 * limits.jerk))
                ++misses;
        }
        EXPECT_LE(misses, 3);
    }
}

TEST_F(Trajectories, stop_immediately_when_already_at_rest) {
    const auto plan = stop({3.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->duration_s(), 0.0);
    EXPECT_EQ(plan->at_s(0.0).position, 3.0);
    EXPECT_EQ(plan->at_s(-1.0).position, 3.0);
    EXPECT_EQ(Profile{}.at_s(-1.0).position, 0.0);
}

TEST_F(Trajectories, of_many_axes_end_together_within_each_limit) {
    for (int round = 0; round < 100; ++round) {
        Synchronised<6>::Limits limits;
        for (AxisLimits& one : limits) one = any_limits();
        const Joints<6> from = any_joints<6>(random, 3.0);
        Joints<6> target = any_joints<6>(random, 3.0);
        target[2] = from[2]; // already at rest
        const auto plan = Synchronised<6>::plan(from, target, limits);
        ASSERT_TRUE(plan);
        const double end = plan->duration_s();
        EXPECT_EQ(plan->at_s(end).position, target);
        EXPECT_EQ(plan->at_s(end).velocity, Joints<6>::Zero());
        const auto late = plan->at_s(end * 0.999);
        const double h = end / 500;
        for (int axis = 0; axis < 6; ++axis) {
            EXPECT_EQ(late.position[axis] == target[axis], axis == 2) << "it is there too early";
            const AxisLimits& most = limits[static_cast<std::size_t>(axis)];
            for (int i = 1; i < 500; ++i) {
                const auto now = plan->at_s(i * h);
                const auto before = plan->at_s((i - 1) * h);
                EXPECT_LE(std::fabs(now.velocity[axis]), most.velocity * slack);
                EXPECT_LE(std::fabs(now.acceleration[axis]), most.acceleration * slack);
                EXPECT_LE(std::fabs(now.acceleration[axis] - before.acceleration[axis]),
                          most.jerk * h * slack + 1e-9);
                EXPECT_NEAR(now.position[axis] - before.position[axis],
                            0.5 * h * (now.velocity[axis] + before.velocity[axis]),
                            most.acceleration * h * h);
            }
        }
    }
}

TEST_F(Trajectories, are_refused_for_invalid_numbers_and_limits) {
    const AxisLimits good{1.0, 1.0, 1.0};
    EXPECT_EQ(trapezoid({no_number, 0, 0}, 1.0, good).error(), Refused{Refusal::not_a_number});
    EXPECT_EQ(trapezoid({0, 0, 0}, no_number, good).error(), Refused{Refusal::not_a_number});
    EXPECT_EQ(trapezoid({0, 0, 0}, 1.0, {0.0, 1.0, 1.0}).error(), Refused{Refusal::limit_not_positive});
    EXPECT_EQ(trapezoid({0, 0, 0}, 1.0, {1.0, no_number, 1.0}).error(), Refused{Refusal::limit_not_positive});
    EXPECT_EQ(jerk_limited(0.0, infinite, good).error(), Refused{Refusal::not_a_number});
    EXPECT_EQ(jerk_limited(0.0, 1.0, {1.0, 1.0, -1.0}).error(), Refused{Refusal::limit_not_positive});
    EXPECT_EQ(stop({0, 0, no_number}, good).error(), Refused{Refusal::not_a_number});
    EXPECT_EQ(stop({0, 1, 0}, {1.0, 1.0, 0.0}).error(), Refused{Refusal::limit_not_positive});
    EXPECT_EQ(trapezoid({0, 1e200, 0}, 1.0, good).error(), Refused{Refusal::not_a_number})
        << "its square is none";
    EXPECT_EQ(jerk_limited(0.0, 1e10, {1e-300, 1.0, 1.0}).error(), Refused{Refusal::not_a_number});
    EXPECT_EQ(stop({0, 0, 1e200}, good).error(), Refused{Refusal::not_a_number});
    Synchronised<3>::Limits limits{good, good, {1.0, 0.0, 1.0}};
    const auto plan = Synchronised<3>::plan({0, 0, 0}, {1, 1, 1}, limits);
    ASSERT_FALSE(plan);
    EXPECT_EQ(describe(plan.error()).view(),
              "element 2: a limit is not positive; give each one a value above 0");
}

} // namespace
} // namespace tappet::motion::test
