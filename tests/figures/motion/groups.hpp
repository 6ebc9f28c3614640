// What the program of the mathematics of motion is made of.
#pragma once

#include "tests/figures/measure/candidates.hpp"

#include <vector>

namespace tappet::figures {

/// Kinematics, dynamics and their inverses, beside KDL.
void add_chains(std::vector<Group>& groups, std::vector<RatioGoal>& goals);
/// Sines, trajectories, controllers and estimators.
void add_loops(std::vector<Group>& groups);

/// By how much ours and KDL differ at most over what is measured: frames and Jacobians (m, 1), torques (Nm).
struct Differences {
    double kinematics = 0;
    double torques = 0;
};
Differences largest_differences();

} // namespace tappet::figures
