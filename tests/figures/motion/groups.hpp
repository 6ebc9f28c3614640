// What the program of the mathematics of motion is made of.
#pragma once

#include "tests/figures/measure/candidates.hpp"

#include <vector>

namespace tappet::figures {

/// Kinematics, dynamics and their inverses, beside KDL.
void add_chains(std::vector<Group>& groups, std::vector<RatioGoal>& goals);
/// A machine's cascade beside the same loop by hand.
void add_cascades(std::vector<Group>& groups, std::vector<RatioGoal>& goals);
/// Whether both put out the same, bit by bit, after as many cycles as the machine has been measured.
bool cascades_are_the_same();
/// Sines, trajectories, controllers and estimators.
void add_loops(std::vector<Group>& groups);

/// By how much ours and KDL differ at most over what is measured: frames and Jacobians (m, 1), torques (Nm).
struct Differences {
    double kinematics = 0;
    double torques = 0;
};
Differences largest_differences();

} // namespace tappet::figures
