// Kinematics, dynamics and inverses of the PUMA 560 and the K361: folded into code, loaded, and by KDL.
#include "tests/figures/motion/groups.hpp"

#include "kernel/base/random.hpp"
#include "kernel/motion/closed_form.hpp"
#include "kernel/motion/dynamics.hpp"
#include "kernel/motion/least_squares.hpp"
#include "tests/kernel/motion/kdl_chain.hpp"
#include "tests/kernel/motion/robots.hpp"

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include <algorithm>
#include <array>

namespace tappet::figures {

namespace {

using namespace motion;
using robots::k361;
using robots::puma_560;
using robots::puma_560_links;

/// Postures and motions without predictable sines; KDL has them in its own form.
struct Given {
    std::array<Joints<6>, many> q, rates, accelerations;
    std::array<KDL::JntArray, many> kdl_q, kdl_rates, kdl_accelerations;
    std::array<FrameOf<Folded<puma_560_links>>, many> targets;
    std::array<KDL::Frame, many> kdl_targets;
    Given() {
        Random random{1};
        for (std::size_t i = 0; i < many; ++i) {
            for (int axis = 0; axis < 6; ++axis) {
                q[i][axis] = 4.0 * random.unit() - 2.0;
                rates[i][axis] = random.unit() - 0.5;
                accelerations[i][axis] = 2.0 * random.unit() - 1.0;
            }
            kdl_q[i] = test::kdl_joints<6>(q[i]);
            kdl_rates[i] = test::kdl_joints<6>(rates[i]);
            kdl_accelerations[i] = test::kdl_joints<6>(accelerations[i]);
            targets[i] = forward(folded<puma_560_links>, q[i]);
            const auto& r = targets[i].rotation;
            const auto& p = targets[i].position;
            kdl_targets[i] = {
                {r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)},
                {p.x(), p.y(), p.z()}};
        }
    }
};
Given& given() {
    static Given all;
    return all;
}

const Loaded loaded_puma{puma_560_links};

template <const auto& chain>
void pose(std::size_t times) {
    in_turn(times, [&at = given()](std::size_t k) { return forward_with_jacobian(folded<chain>, at.q[k]); });
}
template <const auto& chain>
void frame_alone(std::size_t times) {
    in_turn(times, [&at = given()](std::size_t k) { return forward(folded<chain>, at.q[k]); });
}
void pose_loaded(std::size_t times) {
    in_turn(times, [&at = given()](std::size_t k) { return forward_with_jacobian(loaded_puma, at.q[k]); });
}

struct Kdl {
    KDL::Chain chain = test::kdl_chain(puma_560_links);
    KDL::ChainFkSolverPos_recursive forward{chain};
    KDL::ChainJntToJacSolver jacobian{chain};
    KDL::ChainIdSolver_RNE dynamics{chain, {0, 0, -9.81}};
    KDL::ChainIkSolverPos_LMA inverse{chain, 1e-9};
    KDL::Wrenches loads = KDL::Wrenches(6);
    KDL::Frame frame{};
    KDL::Jacobian matrix{6};
    KDL::JntArray torques{6};
    KDL::JntArray found{6};
};
Kdl& kdl() {
    static Kdl all;
    return all;
}

void pose_kdl(std::size_t times) {
    in_turn(times, [&at = given(), &peer = kdl()](std::size_t k) {
        peer.forward.JntToCart(at.kdl_q[k], peer.frame);
        peer.jacobian.JntToJac(at.kdl_q[k], peer.matrix);
    });
}

template <const auto& chain>
void torques(std::size_t times) {
    in_turn(times, [&at = given()](std::size_t k) -> Joints<6> {
        return inverse_dynamics(folded<chain>, at.q[k], at.rates[k], at.accelerations[k]);
    });
}
void torques_loaded(std::size_t times) {
    in_turn(times, [&at = given()](std::size_t k) -> Joints<6> {
        return inverse_dynamics(loaded_puma, at.q[k], at.rates[k], at.accelerations[k]);
    });
}
void torques_kdl(std::size_t times) {
    in_turn(times, [&at = given(), &peer = kdl()](std::size_t k) {
        peer.dynamics.CartToJnt(at.kdl_q[k], at.kdl_rates[k], at.kdl_accelerations[k], peer.loads,
                                peer.torques);
    });
}

void all_postures(std::size_t times) {
    in_turn(times, [&at = given()](std::size_t k) {
        return closed_form(folded<puma_560_links>, at.targets[k], at.q[k]);
    });
}
constexpr double beside = 0.05; // distance of each joint from its target, rad: some cycles of a fast motion
void by_least_squares(std::size_t times) {
    in_turn(times, [&at = given()](std::size_t k) {
        const Joints<6> from = at.q[k] + Joints<6>::Constant(beside);
        return least_squares(folded<puma_560_links>, at.targets[k], from);
    });
}
void by_kdl(std::size_t times) {
    in_turn(times, [&at = given(), &peer = kdl(), from = KDL::JntArray{6}](std::size_t k) mutable {
        from.data = at.q[k] + Joints<6>::Constant(beside);
        peer.inverse.CartToJnt(from, at.kdl_targets[k], peer.found);
    });
}

} // namespace

Differences largest_differences() {
    const Given& at = given();
    Kdl& peer = kdl();
    Differences largest;
    for (std::size_t k = 0; k < many; ++k) {
        const auto ours = forward_with_jacobian(folded<puma_560_links>, at.q[k]);
        peer.forward.JntToCart(at.kdl_q[k], peer.frame);
        peer.jacobian.JntToJac(at.kdl_q[k], peer.matrix);
        for (int row = 0; row < 3; ++row) {
            largest.kinematics =
                std::max(largest.kinematics, std::abs(ours.frame.position[row] - peer.frame.p[row]));
            for (int column = 0; column < 3; ++column)
                largest.kinematics = std::max(largest.kinematics, std::abs(ours.frame.rotation(row, column) -
                                                                           peer.frame.M(row, column)));
        }
        largest.kinematics =
            std::max(largest.kinematics, (ours.jacobian.matrix - peer.matrix.data).cwiseAbs().maxCoeff());
        const Joints<6> torque =
            inverse_dynamics(folded<puma_560_links>, at.q[k], at.rates[k], at.accelerations[k]);
        peer.dynamics.CartToJnt(at.kdl_q[k], at.kdl_rates[k], at.kdl_accelerations[k], peer.loads,
                                peer.torques);
        largest.torques = std::max(largest.torques, (torque - peer.torques.data).cwiseAbs().maxCoeff());
    }
    return largest;
}

void add_chains(std::vector<Group>& groups) {
    groups.push_back({"motion.kinematics",
                      "forward kinematics and Jacobian of six joints",
                      "",
                      64,
                      {{"folded, PUMA 560", Standing::ours, &pose<puma_560_links>},
                       {"folded, K361", Standing::ours, &pose<k361>},
                       {"folded, PUMA 560, the frame alone", Standing::ours, &frame_alone<puma_560_links>},
                       {"loaded, PUMA 560", Standing::ours, &pose_loaded},
                       {"KDL, PUMA 560", Standing::peer, &pose_kdl}},
                      {{"forward kinematics and Jacobian at most a quarter of KDL's",
                        "folded, PUMA 560",
                        0.25,
                        {"KDL, PUMA 560"}}}});
    groups.push_back(
        {"motion.dynamics",
         "inverse dynamics of six joints, recursive Newton-Euler",
         "",
         64,
         {{"folded, PUMA 560", Standing::ours, &torques<puma_560_links>},
          {"folded, PUMA 560 with its drives", Standing::ours, &torques<puma_560>},
          {"loaded, PUMA 560", Standing::ours, &torques_loaded},
          {"KDL, PUMA 560", Standing::peer, &torques_kdl}},
         {{"inverse dynamics at most a third of KDL's", "folded, PUMA 560", 0.33, {"KDL, PUMA 560"}}}});
    groups.push_back({"motion.inverse",
                      "inverse kinematics of six joints",
                      "",
                      16,
                      {{"closed form, all eight postures", Standing::ours, &all_postures},
                       {"least squares to 1e-9, from 0.05 rad beside", Standing::ours, &by_least_squares},
                       {"KDL, Levenberg-Marquardt to 1e-9, from 0.05 rad beside", Standing::peer, &by_kdl}}});
}

} // namespace tappet::figures
