// The groups of the program that measures the mathematics of motion.
#pragma once

#include "tests/figures/measure/candidates.hpp"

#include <type_traits>
#include <vector>

namespace tappet::figures {

/// The number of different inputs, used in turn: more than a processor can predict.
inline constexpr std::size_t many = 64;
inline std::size_t place = 0;
/// Each operation computes one value from the k-th input.
template <class Make>
void in_turn(std::size_t times, Make make) {
    for (std::size_t i = 0; i < times; ++i, ++place) {
        if constexpr (std::is_void_v<decltype(make(place))>) {
            make(place % many);
            clobber();
        } else {
            auto result = make(place % many);
            keep(result);
        }
    }
}

/// Kinematics, dynamics and their inverses, beside KDL.
void add_chains(std::vector<Group>& groups);
/// A machine's cascade beside the same loop by hand.
void add_cascades(std::vector<Group>& groups);
/// Returns whether both outputs are the same, bit by bit, after as many cycles as the machine has been
/// measured.
bool cascades_are_the_same();
/// Sines, trajectories, controllers and estimators.
void add_loops(std::vector<Group>& groups);

/// The largest differences between ours and KDL over the measured inputs: frames and Jacobians (m, 1),
/// torques (Nm).
struct Differences {
    double kinematics = 0;
    double torques = 0;
};
Differences largest_differences();

} // namespace tappet::figures
