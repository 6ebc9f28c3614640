// Counts instructions under callgrind: of a cycle that writes a hundred ports, recorded and not.
//     recording_counts          started by the test: starts valgrind on itself, once for each form
//     recording_counts FORM     runs that form's cycles and measures the last 100
#include "kernel/machine/accept.hpp"
#include "tests/figures/measure/callgrind.hpp"
#include "tests/figures/recording/machine.hpp"

#include <cstdio>
#include <iostream>
#include <string_view>

using namespace tappet;
using namespace tappet::figures;

extern "C" {
[[gnu::noinline]] void measured_cycle(Engine& engine) { engine.run(false); }
}

namespace {

constexpr int unmeasured = 100, measured = 100;

constexpr auto one_port = machine_with(reporting(report("0.a")));

template <const auto& table>
int drive() {
    World world{os::Clock::Kind::virtual_time, AtRunTime<table, figures_board>::machine()};
    Engine& engine = world.engine();
    for (int cycle = 0; cycle < unmeasured + measured; ++cycle) {
        world.clock.advance_to(engine.next_wake());
        cycle < unmeasured ? engine.run(false) : measured_cycle(engine);
    }
    return engine.statistics().cycles == unmeasured + measured ? 0 : 1;
}

int drive_form(std::string_view form) {
    Bank::moves = form != "on_change_still";
    if (form == "without") return drive<silent>();
    if (form == "one_port") return drive<one_port>();
    if (form == "each_step") return drive<each_step>();
    if (form == "each_tenth") return drive<each_tenth>();
    if (form == "on_change" || form == "on_change_still") return drive<changes>();
    return 2;
}

} // namespace

int main(int words, char** word) {
    if (words == 2) return drive_form(word[1]);
    /// The bound for each port, beyond the copy itself: the check whether it is due, its number and its value
    /// with their places.
    constexpr double most_a_port = 40;
    const auto count = [&](const char* form) { return count_measured(word[0], form, form) / measured; };
    const double without = count("without");
    bool good = without > 0;
    std::printf("%-16s %7.1f instructions a cycle of 100 ports\n", "without", without);
    for (const char* form : {"one_port", "each_step", "each_tenth", "on_change", "on_change_still"}) {
        const double with = count(form);
        const double a_port = (with - without) / (std::string_view{form} == "one_port" ? 1 : 100);
        std::printf("%-16s %7.1f, %5.1f a recorded port\n", form, with, a_port);
        good &= with > 0 && (std::string_view{form} == "one_port" || a_port <= most_a_port);
    }
    if (!good) std::cerr << "recording takes more than " << most_a_port << " instructions a port\n";
    return good ? 0 : 1;
}
