// What it takes to have something done: a method, a command, an event, a cam row, a change of properties, and
// a step of the engine that does it all.
#include "tests/figures/dispatch/groups.hpp"

int main(int argc, char** argv) {
    using namespace tappet::figures;
    const Options options = read_options(argc, argv);
    Result result{.program = "dispatch"};
    std::vector<Group> groups;
    std::vector<RatioGoal> goals;
    add_calls(groups);
    add_commands(groups, goals);
    add_events(groups, goals);
    add_steps(groups, goals);
    add_cycles(groups, goals);
    run_candidates(options, argv, groups, goals, result);
    return finish(options, result);
}
