// The cost of calls: a method, a command, an event, a cam row, a change of properties, and a step of the
// engine that executes them.
#include "kernel/os/stamps.hpp"
#include "tests/figures/dispatch/groups.hpp"

int main(int argc, char** argv) {
    using namespace tappet::figures;
    const Options options = read_options(argc, argv);
    Result result{.program = "dispatch"};
    static_cast<void>(tappet::os::prove_processor_counter()); // as when the machine arms
    std::vector<Group> groups;
    add_calls(groups);
    add_commands(groups);
    add_events(groups);
    add_steps(groups);
    add_cycles(groups);
    run_candidates(options, argv, groups, result);
    return finish(options, result);
}
