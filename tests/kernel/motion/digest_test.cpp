// One seed, one result, bit for bit: with both compilers, at every level of optimisation and on every
// processor.
#include "kernel/base/digest.hpp"
#include "kernel/motion/closed_form.hpp"
#include "kernel/motion/dynamics.hpp"
#include "kernel/motion/estimators.hpp"
#include "kernel/motion/filters.hpp"
#include "kernel/motion/least_squares.hpp"
#include "kernel/motion/path.hpp"
#include "kernel/motion/pid.hpp"
#include "kernel/motion/synchronised.hpp"
#include "tests/kernel/motion/random_motion.hpp"
#include "tests/kernel/motion/robots.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace tappet::motion::test {
namespace {

using namespace robots;

/// Normalises the sign of zero: a compile-time zero has none.
void add(Digest& digest, double value) { digest.add(std::bit_cast<std::uint64_t>(value + 0.0)); }
template <class M>
void add_all(Digest& digest, const M& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) add(digest, matrix.reshaped()[i]);
}
void add(Digest& digest, const AxisState& state) {
    add(digest, state.position);
    add(digest, state.velocity);
    add(digest, state.acceleration);
}

TEST(MotionDigest, is_the_same_everywhere_for_chains) {
    Digest digest;
    Random random{1};
    for (int round = 0; round < 200; ++round) {
        const Joints<6> q = any_joints<6>(random, 3.0);
        const Joints<6> rates = any_joints<6>(random, 1.0);
        const Joints<6> accelerations = any_joints<6>(random, 1.0);
        const Loaded loaded{any_chain<6>(random)};
        const auto pose = forward_with_jacobian(folded<puma_560>, q);
        add_all(digest, pose.frame.rotation);
        add_all(digest, pose.frame.position);
        add_all(digest, pose.jacobian.matrix);
        add_all(digest, forward_with_jacobian(loaded, q).jacobian.matrix);
        add_all(digest, inverse_dynamics(folded<puma_560>, q, rates, accelerations));
        add_all(digest, inverse_dynamics(loaded, q, rates, accelerations));
        for (const Joints<6>& posture : closed_form(folded<puma_560>, pose.frame, q))
            add_all(digest, posture);
        const Joints<6> from = q + 0.05 * rates;
        if (const auto found = least_squares(folded<puma_560>, pose.frame, from)) add_all(digest, found->q);
    }
    EXPECT_EQ(digest.value(), 15309880377354398204u);
}

TEST(MotionDigest, is_the_same_everywhere_for_trajectories_and_paths) {
    Digest digest;
    Random random{2};
    for (int round = 0; round < 200; ++round) {
        const AxisLimits limits{0.1 + random.unit(), 0.1 + random.unit(), 0.1 + 10.0 * random.unit()};
        const AxisState from{within(random, 1.0), within(random, 1.0), within(random, 1.0)};
        const double target = within(random, 2.0);
        for (const Planned& plan : {trapezoid(from, target, limits),
                                    jerk_limited(from.position, target, limits), stop(from, limits)})
            for (int i = 0; i <= 10; ++i) add(digest, plan->at_s(0.1 * i * plan->duration_s()));
        const auto begin = any_frame<Base, End>(random);
        const auto end = any_frame<Base, End>(random);
        const auto arc = Path<Base, End>::arc(begin, Point<Base>{any_vector(random, 1.0)}, end);
        const auto state = arc->at(from);
        add_all(digest, state.frame.rotation);
        add_all(digest, state.acceleration.linear);
    }
    EXPECT_EQ(digest.value(), 15051928072261985076u);
}

TEST(MotionDigest, is_the_same_everywhere_for_controllers) {
    Digest digest;
    Random random{3};
    Pid pid{{.proportional = 2.0,
             .integral = 1.0,
             .derivative = 0.1,
             .derivative_filter_s = 0.01,
             .highest = 1.0}};
    auto notch = *Biquad::notch(20.0 + random.unit(), 3.0, 1ms);
    LeadLag lead{20ms, 3ms};
    AlphaBeta tracker{AlphaBetaGains::for_tracking_index(0.1 + random.unit())};
    Kalman<2> filter{{0.0, 0.0}, Eigen::Matrix2d::Identity()};
    for (int k = 0; k < 1000; ++k) {
        const double value = within(random, 1.0);
        add(digest, pid(0.3, value, 1ms));
        add(digest, notch(value));
        add(digest, lead(value, 1ms));
        tracker.sample(value, Time{k * 1ms});
        add(digest, tracker.at(Time{k * 1ms + 300us}));
        filter.predict(Eigen::Matrix2d{{1.0, 1e-3}, {0.0, 1.0}}, 1e-4 * Eigen::Matrix2d::Identity());
        const auto distance = filter.update<1>(Eigen::Matrix<double, 1, 1>{value}, {1.0, 0.0},
                                               Eigen::Matrix<double, 1, 1>{0.1});
        ASSERT_TRUE(distance);
        add(digest, *distance);
        add_all(digest, filter.covariance());
    }
    EXPECT_EQ(digest.value(), 5612131515459241740u);
}

} // namespace
} // namespace tappet::motion::test
