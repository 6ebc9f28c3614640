// Frames, joints and chains drawn at random, for general properties.
#pragma once

#include "kernel/base/random.hpp"
#include "kernel/motion/chain.hpp"
#include "kernel/motion/frame.hpp"

namespace tappet::motion::test {

/// In [-most, most).
constexpr double within(Random& random, double most) { return (2.0 * random.unit() - 1.0) * most; }

inline Eigen::Vector3d any_vector(Random& random, double most) {
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i) v[i] = within(random, most);
    return v;
}

template <class A, class B>
Frame<A, B> any_frame(Random& random) {
    const Eigen::Vector3d turn = any_vector(random, 3.0);
    const Eigen::Vector3d place = any_vector(random, 2.0);
    return {rotation_about(turn), place};
}

template <int joints>
Joints<joints> any_joints(Random& random, double most) {
    Joints<joints> q;
    for (int i = 0; i < joints; ++i) q[i] = within(random, most);
    return q;
}

struct Base;
struct End;

/// Half of its numbers are zero or quarter turns, as in real robots. The mass of a link is four points about
/// its centre, so that its inertia is physical.
template <int joints>
constexpr Chain<Base, End, joints> any_chain(Random& random) {
    Chain<Base, End, joints> chain{};
    const auto some = [&](double most) { return random.one_in(2) ? 0.0 : within(random, most); };
    for (Link& link : chain.links) {
        link = Link{}; // without it g++ 12 does not treat the table as a constant
        link.a_m = some(1.0);
        link.d_m = some(1.0);
        link.alpha_deg =
            random.one_in(2) ? static_cast<double>(random.between(-2, 2)) * 90.0 : within(random, 180.0);
        link.theta_deg =
            random.one_in(2) ? static_cast<double>(random.between(-2, 2)) * 90.0 : within(random, 180.0);
        link.joint = random.one_in(4) ? Joint::prismatic : Joint::revolute;
        link.reversed = random.one_in(3);
        link.mass_kg = some(20.0);
        if (link.mass_kg < 0.0) link.mass_kg = -link.mass_kg;
        for (double& centre : link.centre_m) centre = some(0.3);
        const bool is_bare = random.one_in(4);
        for (int point = 0; point < 4 && !is_bare; ++point) {
            const double m = random.unit();
            const double x = some(0.4);
            const double y = some(0.4);
            const double z = some(0.4);
            Inertia& inertia = link.inertia;
            inertia.xx += m * (y * y + z * z);
            inertia.yy += m * (x * x + z * z);
            inertia.zz += m * (x * x + y * y);
            inertia.xy -= m * x * y;
            inertia.yz -= m * y * z;
            inertia.xz -= m * x * z;
        }
    }
    for (double& g : chain.gravity_m_s2) g = some(10.0);
    return chain;
}

} // namespace tappet::motion::test
