// Starts a generated machine in virtual time and measures a whole round of its engines beside the bare calls
// of the same steps.
#include "tests/figures/scale/probe.hpp"

#include "tests/figures/measure/world.hpp"

namespace tappet::figures {

namespace {

World& world() {
    static World only{os::Clock::Kind::virtual_time, accepted()};
    return only;
}
// One operation is one component's step.
void run_engines(std::size_t times) {
    World& all = world();
    const std::size_t components = all.instance.machine().table.components.size();
    for (std::size_t i = 0; i < times; i += components) all.run_all();
}
void run_steps(std::size_t times) {
    MachineInstance& instance = world().instance;
    const std::span<const ComponentRow> components = instance.machine().table.components;
    for (std::size_t i = 0; i < times; i += components.size()) {
        Cycle cycle;
        cycle.now = world().clock.now();
        for (std::size_t c = 0; c < components.size(); ++c)
            components[c].type->step(instance.component(c), cycle);
    }
}

int measure(int argc, char** argv) {
    const Options options = read_options(argc, argv);
    const AcceptedMachine& machine = world().instance.machine();
    world().run_all(); // each has had its first cycle
    const double configuring_ns = static_cast<double>(world().configuring.count());
    Result result{.program = "probe", .setting = options.setting};
    std::vector<Group> groups;
    groups.push_back(
        {"probe.step",
         "one component's step",
         "",
         std::max<std::size_t>(machine.table.components.size(), 200),
         {{probe_engines, Standing::ours, &run_engines}, {probe_steps, Standing::floor, &run_steps}}});
    run_candidates(options, argv, groups, result);
    result.figures.push_back(
        {.id = "probe.memory",
         .title = "static memory",
         .unit = "bytes",
         .rows = {{.name = "all", .summary = single(static_cast<double>(machine.plan.bytes))},
                  {.name = "stacks", .summary = single(static_cast<double>(machine.plan.stack_bytes))}}});
    result.figures.push_back({.id = "probe.start",
                              .title = "start",
                              .rows = {{.name = "configure", .summary = single(configuring_ns)}}});
    return finish(options, result);
}

} // namespace

} // namespace tappet::figures

int main(int argc, char** argv) { return tappet::figures::measure(argc, argv); }
