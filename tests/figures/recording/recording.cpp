// What recording values costs the machine that is recorded: a step that writes a hundred ports, with them on
// its tape and without.
#include "kernel/machine/accept.hpp"
#include "tests/figures/measure/candidates.hpp"
#include "tests/figures/recording/machine.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <iterator>

namespace tappet::figures {

namespace {

struct World {
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance;
    explicit World(const AcceptedMachine& machine) : instance{machine, clock} {
        const auto configured = instance.configure({});
        const Sentence refusal =
            configured ? instance.engines()[0].initialise() : Sentence{configured.error()};
        if (!refusal.empty()) {
            std::cerr << refusal.view() << '\n';
            std::exit(2);
        }
        instance.engines()[0].start(clock.now());
    }
};

/// As its activity does it in each period, by a clock that costs nothing and is there at once.
template <const auto& table> void step(std::size_t times) {
    static World world{AtRunTime<table, board>::machine()};
    Engine& engine = world.instance.engines()[0];
    for (std::size_t i = 0; i < times; ++i) {
        world.clock.advance_to(engine.next_wake());
        engine.run(false);
    }
}

std::vector<Group> groups() {
    return {{"recording.step.100",
             "step of an engine whose ten components write a hundred ports, each another value",
             "thesis 3.3, reporting",
             16,
             {{"each port in each step", Standing::ours, &step<each_step>},
              {"each port on change", Standing::ours, &step<changes>},
              {"each port in each tenth step", Standing::ours, &step<each_tenth>},
              {"no reporting in the table", Standing::floor, &step<silent>}}}};
}

/// Of the medians of the same run.
void add_statement(Result& result) {
    constexpr double period_ns = 1e6;
    for (const Figure& figure : result.figures) {
        double recorded = 0, without = 0;
        for (const Row& each : figure.rows) {
            if (each.name == "each port in each step") recorded = each.summary.median;
            if (each.name == "no reporting in the table") without = each.summary.median;
        }
        std::array<char, 80> text{};
        std::snprintf(text.data(), text.size(), "%.0f ns with it, %.0f ns without", recorded, without);
        result.statements.push_back(
            {"a hundred ports recorded at 1 kHz take less than a hundredth of the period",
             recorded - without < 0.01 * period_ns, text.data()});
    }
}

} // namespace

} // namespace tappet::figures

int main(int argc, char** argv) {
    using namespace tappet::figures;
    const Options options = read_options(argc, argv);
    Result result{.program = "recording", .setting = options.setting};
    run_candidates(options, argv, groups(), {}, result);
    add_statement(result);
    return finish(options, result);
}
