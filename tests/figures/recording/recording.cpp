// The cost of recording values for the recorded machine: a step that writes a hundred ports, with and without
// them on its tape.
#include "kernel/machine/accept.hpp"
#include "tests/figures/measure/world.hpp"
#include "tests/figures/recording/machine.hpp"

#include <array>
#include <cstdio>

namespace tappet::figures {

namespace {

/// As its activity does it in each period, with a clock that costs nothing and never waits.
template <const auto& table> void step(std::size_t times) {
    static World world{os::Clock::Kind::virtual_time, AtRunTime<table, figures_board>::machine()};
    Engine& engine = world.engine();
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

/// Compares the medians of the same run.
void add_statement(Result& result) {
    constexpr double period_ns = 1e6;
    const Row* recorded = result.find("recording.step.100", "each port in each step");
    const Row* without = result.find("recording.step.100", "no reporting in the table");
    if (recorded == nullptr || without == nullptr) return;
    const double with_it = recorded->summary.median, without_it = without->summary.median;
    std::array<char, 80> text{};
    std::snprintf(text.data(), text.size(), "%.0f ns with it, %.0f ns without", with_it, without_it);
    result.statements.push_back({"a hundred ports recorded at 1 kHz take less than a hundredth of the period",
                                 with_it - without_it < 0.01 * period_ns, text.data()});
}

} // namespace

} // namespace tappet::figures

int main(int argc, char** argv) {
    using namespace tappet::figures;
    const Options options = read_options(argc, argv);
    Result result{.program = "recording", .setting = options.setting};
    run_candidates(options, argv, groups(), result);
    add_statement(result);
    return finish(options, result);
}
