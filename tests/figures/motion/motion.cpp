// The cost of one cycle of six axes: kinematics, dynamics, inverses, trajectories and controllers, beside
// KDL; a machine's whole cascade, beside the same loop by hand.
#include "tests/figures/motion/groups.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

namespace tappet::figures {

namespace {

/// In nanoseconds, of the median of a row; adds nothing when it was not measured.
void add_goal(Result& result, const std::string& text, double ns, const std::string& figure,
              const std::string& row) {
    if (const Row* found = result.find(figure, row))
        result.goals.push_back({text, ns, found->summary.median, "ns", figure + ": " + row});
}

} // namespace

} // namespace tappet::figures

int main(int argc, char** argv) {
    using namespace tappet::figures;
    const Options options = read_options(argc, argv);
    Result result{.program = "motion", .setting = options.setting};
    std::vector<Group> groups;
    add_chains(groups);
    add_cascades(groups);
    add_loops(groups);
    run_candidates(options, argv, groups, result);
    add_goal(result,
             "forward kinematics and Jacobian of six joints in 100 ns, with the sine of kernel/motion", 100,
             "motion.kinematics", "folded, PUMA 560");
    add_goal(result, "inverse dynamics of six joints in 250 ns, with the sine of kernel/motion", 250,
             "motion.dynamics", "folded, PUMA 560");
    const Differences apart = largest_differences();
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "%.1e in frames and Jacobians, %.1e Nm in torques",
                  apart.kinematics, apart.torques);
    result.statements.push_back(
        {"ours and KDL compute the same, to 1e-11 over all postures that are measured",
         std::max(apart.kinematics, apart.torques) < 1e-11, text.data()});
    if (options.wants("motion.cascade.robot"))
        result.statements.push_back({"a machine's cascade and the same loop by hand put out the same",
                                     cascades_are_the_same(), "bit by bit, after all cycles"});
    return finish(options, result);
}
