// Random chains against KDL, which uses another method: joint by joint, with dense matrices.
#include "kernel/motion/dynamics.hpp"
#include "kernel/motion/kinematics.hpp"
#include "tests/kernel/base/seeded.hpp"
#include "tests/kernel/motion/kdl_chain.hpp"
#include "tests/kernel/motion/random_motion.hpp"

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include <algorithm>
#include <utility>

namespace tappet::motion::test {
namespace {

using Kdl = tappet::test::Seeded;

/// Kinematics, Jacobian and inverse dynamics of both, with a load on the last link.
template <int joints, class Robot>
void agree(const Robot& robot, const Chain<Base, End, joints>& chain, Random& random) {
    const KDL::Chain kdl = kdl_chain(chain);
    const Joints<joints> q = any_joints<joints>(random, 3.2);
    const Joints<joints> rates = any_joints<joints>(random, 3.0);
    const Joints<joints> accelerations = any_joints<joints>(random, 10.0);
    const Eigen::Vector3d force = any_vector(random, 50.0);
    const Eigen::Vector3d torque = any_vector(random, 5.0);

    const auto pose = forward_with_jacobian(robot, q);
    KDL::Frame frame;
    KDL::ChainFkSolverPos_recursive{kdl}.JntToCart(kdl_joints<joints>(q), frame);
    for (int row = 0; row < 3; ++row) {
        EXPECT_NEAR(pose.frame.position[row], frame.p[row], 1e-12);
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(pose.frame.rotation(row, column), frame.M(row, column), 1e-13);
    }
    EXPECT_EQ(forward(robot, q).position, pose.frame.position);

    KDL::Jacobian jacobian(joints);
    KDL::ChainJntToJacSolver{kdl}.JntToJac(kdl_joints<joints>(q), jacobian);
    EXPECT_LT((pose.jacobian.matrix - jacobian.data).cwiseAbs().maxCoeff(), 1e-12);

    const auto& [x, y, z] = chain.gravity_m_s2;
    KDL::ChainIdSolver_RNE solver{kdl, {x, y, z}};
    KDL::Wrenches loads(joints);
    loads.back() = KDL::Wrench{{-force.x(), -force.y(), -force.z()}, {-torque.x(), -torque.y(), -torque.z()}};
    KDL::JntArray torques(joints);
    ASSERT_EQ(solver.CartToJnt(kdl_joints<joints>(q), kdl_joints<joints>(rates),
                               kdl_joints<joints>(accelerations), loads, torques),
              0);
    const Joints<joints> ours = inverse_dynamics(robot, q, rates, accelerations, {force, torque});
    const double size = std::max(1.0, torques.data.cwiseAbs().maxCoeff());
    EXPECT_LT((ours - torques.data).cwiseAbs().maxCoeff(), 1e-12 * size);
}

template <int joints>
void many_agree(int rounds, Random& random) {
    for (int round = 0; round < rounds; ++round) {
        const auto chain = any_chain<joints>(random);
        agree<joints>(Loaded{chain}, chain, random);
    }
}

TEST_F(Kdl, agrees_on_thousands_of_loaded_chains) {
    many_agree<1>(300, random);
    many_agree<2>(300, random);
    many_agree<3>(500, random);
    many_agree<6>(1500, random);
    many_agree<7>(1000, random);
}

template <int joints>
constexpr Chain<Base, End, joints> draw(std::uint64_t seed) {
    Random random{seed};
    return any_chain<joints>(random);
}
template <std::uint64_t seed, int joints>
constexpr Chain<Base, End, joints> drawn = draw<joints>(seed);

/// The compiler generated these: each has its own code.
template <int joints, std::uint64_t... seeds>
void folded_agree(std::integer_sequence<std::uint64_t, seeds...>, Random& random) {
    for (int round = 0; round < 100; ++round)
        (agree<joints>(folded<drawn<seeds, joints>>, drawn<seeds, joints>, random), ...);
}

TEST_F(Kdl, agrees_on_chains_folded_by_the_compiler) {
    folded_agree<3>(std::make_integer_sequence<std::uint64_t, 8>{}, random);
    folded_agree<6>(std::make_integer_sequence<std::uint64_t, 8>{}, random);
}

} // namespace
} // namespace tappet::motion::test
