// Limits of joints, and the solutions of an inverse within them.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/motion/chain.hpp"
#include "kernel/motion/refused.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <expected>
#include <limits>
#include <numbers>

namespace tappet::motion {

/// rad or m; unlimited by default.
struct JointRange {
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
};
template <int joints>
using JointRanges = std::array<JointRange, static_cast<std::size_t>(joints)>;

/// Returns false for a value that is not finite, and for an empty range. Real-time.
template <int joints>
bool is_within(const Joints<joints>& q, const JointRanges<joints>& ranges) noexcept TAPPET_REALTIME {
    for (int i = 0; i < joints; ++i) {
        const auto [lowest, highest] = ranges[static_cast<std::size_t>(i)];
        if (!(q[i] >= lowest && q[i] <= highest)) return false;
    }
    return true;
}

/// Returns the same angle modulo whole turns, nearest to `near`. Real-time.
inline double same_angle_near(double angle, double near) noexcept TAPPET_REALTIME {
    constexpr double turn = 2.0 * std::numbers::pi;
    return angle - turn * std::floor((angle - near) / turn + 0.5);
}

/// Returns the solution for revolute joints with the least sum of squared distances from `near`, within the
/// ranges. Refused: there is no solution, or the joint that leaves its range in the last one examined.
/// Real-time: one pass.
template <int joints, std::size_t most>
std::expected<Joints<joints>, Refused> nearest(const Bounded<Joints<joints>, most>& solutions,
                                               const Joints<joints>& near,
                                               const JointRanges<joints>& ranges = {}) noexcept
    TAPPET_REALTIME {
    std::expected<Joints<joints>, Refused> best = std::unexpected(Refused{Refusal::out_of_reach});
    double least = std::numeric_limits<double>::infinity();
    for (Joints<joints> q : solutions) {
        double way = 0.0;
        int outside = -1;
        for (int i = 0; i < joints && outside < 0; ++i) {
            const auto [lowest, highest] = ranges[static_cast<std::size_t>(i)];
            q[i] = same_angle_near(q[i], near[i]);
            if (q[i] < lowest) q[i] += 2.0 * std::numbers::pi;
            if (q[i] > highest) q[i] -= 2.0 * std::numbers::pi;
            if (!(q[i] >= lowest && q[i] <= highest)) outside = i;
            way += (q[i] - near[i]) * (q[i] - near[i]);
        }
        if (outside >= 0) {
            if (!best) best = std::unexpected(Refused{Refusal::outside_limits, outside});
        } else if (way < least) {
            least = way;
            best = q;
        }
    }
    return best;
}

} // namespace tappet::motion
