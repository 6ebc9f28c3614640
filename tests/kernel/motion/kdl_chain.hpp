// Converts a table to a KDL chain.
#pragma once

#include "kernel/motion/chain.hpp"

#include <kdl/chain.hpp>
#include <kdl/jntarray.hpp>

namespace tappet::motion::test {

template <class Base, class End, int joints>
KDL::Chain kdl_chain(const Chain<Base, End, joints>& chain) {
    constexpr double to_radians = 3.14159265358979323846 / 180.0;
    KDL::Chain result;
    for (const Link& link : chain.links) {
        const auto axis = link.joint == Joint::revolute ? KDL::Joint::RotZ : KDL::Joint::TransZ;
        const auto& [x, y, z] = link.centre_m;
        const Inertia& i = link.inertia;
        result.addSegment(KDL::Segment(
            KDL::Joint(axis, link.reversed ? -1.0 : 1.0),
            KDL::Frame::DH(link.a_m, link.alpha_deg * to_radians, link.d_m, link.theta_deg * to_radians),
            KDL::RigidBodyInertia(link.mass_kg, {x, y, z},
                                  KDL::RotationalInertia(i.xx, i.yy, i.zz, i.xy, i.xz, i.yz))));
    }
    return result;
}

template <int joints>
KDL::JntArray kdl_joints(const Joints<joints>& values) {
    KDL::JntArray result(joints);
    result.data = values;
    return result;
}

} // namespace tappet::motion::test
