// Kinematics and dynamics of chains against values of the literature, and against general properties.
#include "kernel/motion/dynamics.hpp"
#include "kernel/motion/kinematics.hpp"
#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/motion/random_motion.hpp"
#include "tests/kernel/motion/robots.hpp"

#include <cmath>
#include <numbers>

namespace tappet::motion::test {
namespace {

using namespace robots;
using namespace tappet::test;
using K361 = Seeded;
using Chains = Seeded;
constexpr double pi = std::numbers::pi;

template <int n>
void expect_near(const Eigen::Matrix<double, n, 1>& found, const Eigen::Matrix<double, n, 1>& expected,
                 double apart) {
    for (int i = 0; i < n; ++i) EXPECT_NEAR(found[i], expected[i], apart) << "element " << i;
}

const Joints<6> zero = Joints<6>::Zero();
const Joints<6> one = Joints<6>::Ones();
const Joints<6> bent{0, pi / 4, pi, 0, pi / 4, 0};

TEST(Puma560, has_the_positions_of_the_literature) {
    const Joints<6> q{.1, .2, .3, .4, .5, .6};
    expect_near<3>(forward(folded<puma_560_links>, q).position,
                   {0.247802746924, -0.125940181452, 0.474457905695}, 1e-12);
}

TEST(Puma560, needs_the_torques_of_the_literature) {
    const auto& puma = folded<puma_560_links>;
    expect_near<6>(inverse_dynamics(puma, bent, zero, zero), {0, 31.639880378, 6.035138023, 0, .028252800, 0},
                   1e-9);
    expect_near<6>(inverse_dynamics(puma, bent, one, one),
                   {1.178006518, 35.460614988, 6.097063990, .000475490, .035114118, .000216569}, 1e-9);
    const Joints<6> q{.1, .2, .3, .4, .5, .6};
    const Joints<6> rates{.6, .5, .4, .3, .2, .1};
    const Joints<6> accelerations{-.3, -.1, .1, .3, .5, .7};
    expect_near<6>(inverse_dynamics(puma, q, rates, accelerations),
                   {-1.335289406, 32.180774265, -3.781865110, .002781300, -.021034783, .000017215}, 1e-9);
}

TEST(Puma560, includes_the_inertia_of_its_motors) {
    const auto& puma = folded<puma_560>;
    // The literature gives six digits.
    expect_near<6>(inverse_dynamics(puma, bent, zero, one),
                   {3.35311, 36.0025, 7.42596, .190043, .203441, .194133}, 6e-5);
    const Joints<6> diagonal{3.6594, 4.4137, .9378, .1925, .1713, .1941};
    for (int i = 0; i < 6; ++i) {
        const Joints<6> unit = Joints<6>::Unit(i);
        const Joints<6> torques =
            inverse_dynamics(puma, bent, zero, unit) - inverse_dynamics(puma, bent, zero, zero);
        EXPECT_NEAR(torques[i], diagonal[i], 6e-5) << "joint " << i;
    }
}

TEST(Puma560, has_the_friction_of_its_motors_at_its_joints) {
    for (const double sign : {1.0, -1.0}) {
        const Joints<6> rates = sign * 1e-3 * one;
        const Joints<6> friction = inverse_dynamics(folded<puma_560>, bent, rates, zero) -
                                   inverse_dynamics(folded<puma_560_links>, bent, rates, zero);
        for (std::size_t i = 0; i < 6; ++i) {
            const Drive& drive = puma_560.links[i].drive;
            const double gear = std::fabs(drive.gear);
            const double coulomb = sign > 0 ? drive.coulomb_forward : -drive.coulomb_backward;
            EXPECT_NEAR(friction[static_cast<int>(i)],
                        gear * (coulomb + drive.viscous_nm_s * gear * sign * 1e-3), 1e-12);
        }
    }
}

/// Converts the angles of the two mirrored 30-degree cones to the equivalent wrist angles.
Joints<6> of_cones(Joints<6> q) {
    const double alpha = pi / 2 - std::atan2(std::sqrt(3.0) * std::sin(q[4] / 2), 2 * std::cos(q[4] / 2));
    q[4] = 4 * std::asin(std::sin(q[4] / 2) / 2);
    q[3] += alpha;
    q[5] -= alpha;
    return q;
}

TEST_F(K361, has_the_positions_of_its_own_formulas) {
    const Joints<6> q = of_cones({.1, .2, 1.2426, 1.0373, 1.197, -1.0373});
    EXPECT_NEAR(q[4], 1.142269598239, 1e-12);
    const auto flange = forward(folded<k361>, q);
    expect_near<3>(flange.position, {-.172757547383, .764357664597, 1.631531171755}, 1e-12);
    expect_near<3>(Eigen::Vector3d{flange.rotation.col(2)}, {-.828109586, .274678942, .488657336}, 1e-9);
}

TEST_F(K361, equals_the_product_of_its_joint_transforms) {
    const Joints<6> q = any_joints<6>(random, pi);
    const auto x = [](double angle) { return rotation_about({angle, 0, 0}); };
    const auto z = [](double angle) { return rotation_about({0, 0, angle}); };
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    const Eigen::Matrix3d shoulder = z(q[0]) * x(-q[1]);
    const Eigen::Matrix3d wrist = shoulder * x(-q[2]) * z(q[3]) * x(-q[4]) * z(q[5]);
    const Eigen::Vector3d position =
        1.020 * up + shoulder * (0.480 * up) + shoulder * x(-q[2]) * (0.645 * up) + wrist * (0.120 * up);
    const auto flange = forward(folded<k361>, q);
    EXPECT_NEAR((flange.rotation - wrist).norm(), 0.0, 1e-14);
    EXPECT_NEAR((flange.position - position).norm(), 0.0, 1e-14);
}

TEST_F(Chains, move_as_their_jacobian_predicts) {
    for (int round = 0; round < 200; ++round) {
        const Loaded robot{any_chain<6>(random)};
        const Joints<6> q = any_joints<6>(random, 3.0);
        const Joints<6> rates = any_joints<6>(random, 1.0);
        const auto pose = forward_with_jacobian(robot, q);
        const double h = 1e-5;
        const auto before = forward(robot, Joints<6>{q - h * rates});
        const auto after = forward(robot, Joints<6>{q + h * rates});
        const auto twist = pose.jacobian * rates;
        const auto moved = difference(before, after);
        EXPECT_NEAR((twist.linear - moved.linear / (2 * h)).norm(), 0.0, 1e-7);
        EXPECT_NEAR((twist.angular - moved.angular / (2 * h)).norm(), 0.0, 1e-7);
    }
}

TEST_F(Chains, carry_a_load_at_their_end_by_the_transposed_jacobian) {
    for (int round = 0; round < 200; ++round) {
        const Loaded robot{any_chain<6>(random)};
        const Joints<6> q = any_joints<6>(random, 3.0);
        const auto pose = forward_with_jacobian(robot, q);
        const Wrench<Surroundings, End, End> load{any_vector(random, 10.0), any_vector(random, 10.0)};
        const Joints<6> torques =
            inverse_dynamics(robot, q, zero, zero, load) - inverse_dynamics(robot, q, zero, zero);
        const Wrench<End, End, Base> at_end{pose.frame.rotation * load.force,
                                            pose.frame.rotation * load.torque};
        expect_near<6>(torques, pose.jacobian.torques(at_end), 1e-10);
    }
}

TEST(ChainsDeathTest, refuse_values_that_are_not_numbers) {
    Joints<6> q = zero;
    q[4] = no_number;
    EXPECT_DEATH(static_cast<void>(forward(folded<k361>, q)), "contract 4 not-a-number: Argument element 4 ");
    q[4] = infinite;
    EXPECT_DEATH(static_cast<void>(inverse_dynamics(folded<puma_560>, zero, q, zero)),
                 "contract 4 not-a-number: Argument element 4 ");
}

} // namespace
} // namespace tappet::motion::test
