// Starts a generated machine in virtual time and measures a whole round of its engines beside the bare calls
// of the same steps.
#include "tests/figures/scale/probe.hpp"

#include "tests/figures/measure/candidates.hpp"

#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string>

namespace tappet::figures {

namespace {

double now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

struct World {
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{accepted(), clock};
    double configure_ns = 0;
    double ready_ns = 0; ///< every activity has run its first cycle

    World() {
        const double begin = now_ns();
        if (const auto configured = instance.configure({}); !configured) {
            std::cerr << configured.error().view() << '\n';
            std::exit(2);
        }
        configure_ns = now_ns() - begin;
        for (Engine& engine : instance.engines()) {
            if (const Sentence refusal = engine.initialise(); !refusal.empty()) {
                std::cerr << refusal.view() << '\n';
                std::exit(2);
            }
            engine.start(clock.now());
        }
        run_all();
        ready_ns = now_ns();
    }
    void run_all() {
        for (Engine& engine : instance.engines()) {
            clock.advance_to(engine.next_wake());
            engine.run(false);
        }
    }
    void call_all() {
        Cycle cycle;
        cycle.now = clock.now();
        const std::span<const ComponentRow> components = instance.machine().table.components;
        for (std::size_t c = 0; c < components.size(); ++c)
            components[c].type->step(instance.component(c), cycle);
    }
};

World* world = nullptr;
// One operation is one component's step.
void run_engines(std::size_t times) {
    for (std::size_t i = 0; i < times; i += world->instance.machine().table.components.size())
        world->run_all();
}
void run_steps(std::size_t times) {
    for (std::size_t i = 0; i < times; i += world->instance.machine().table.components.size())
        world->call_all();
}

Row single(const char* name, double value) {
    return {.name = name, .summary = {value, value, value, value, value, 1}};
}

int measure(int argc, char** argv) {
    const Options options = read_options(argc, argv);
    static World first;
    world = &first;
    const PlanView& plan = first.instance.machine().plan;
    const std::size_t components = first.instance.machine().table.components.size();
    Result result{.program = "probe", .setting = options.setting};
    std::vector<Group> groups;
    groups.push_back(
        {"probe.step",
         "one component's step",
         "",
         std::max<std::size_t>(components, 200),
         {{probe_engines, Standing::ours, &run_engines}, {probe_steps, Standing::floor, &run_steps}}});
    run_candidates(options, argv, groups, {}, result);
    result.figures.push_back({.id = "probe.memory",
                              .title = "static memory",
                              .unit = "bytes",
                              .rows = {single("all", static_cast<double>(plan.bytes)),
                                       single("stacks", static_cast<double>(plan.stack_bytes))}});
    result.figures.push_back(
        {.id = "probe.start",
         .title = "start",
         .rows = {single("configure", first.configure_ns), single("first cycle done", first.ready_ns)}});
    return finish(options, result);
}

} // namespace

} // namespace tappet::figures

int main(int argc, char** argv) { return tappet::figures::measure(argc, argv); }
