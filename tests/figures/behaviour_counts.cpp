// Counts instructions under callgrind: of an event transition, early and late in a machine's life, and
// against a switch written by hand.
//     behaviour_counts                started by the test: starts valgrind on itself, once for each form
//     behaviour_counts FORM EVENTS    drives that form by that many events and measures the last two
#include "tests/figures/behaviour/by_hand.hpp"
#include "tests/figures/behaviour/steps.hpp"
#include "tests/figures/measure/callgrind.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

using namespace tappet;
using namespace tappet::figures;

extern "C" {
[[gnu::noinline]] bool measured_event(StateMachineExecution& machine, Time now) {
    return machine.dispatch(0, now) == StateOutcome::taken;
}
[[gnu::noinline]] bool measured_by_hand(HandSwing& machine, Time now) { return machine.dispatch(0, now); }
}

namespace {

/// The bound on an execution's instructions, as a factor over the switch written by hand: it also keeps all
/// active states, budgets, positions.
constexpr double most_times = 1.5;

template <class Machine, class Measured>
int drive(Machine& machine, Measured measured, int events) {
    bool good = true;
    for (int i = 0; i < events - 2; ++i) static_cast<void>(machine.dispatch(0, at_ns(i)));
    for (int i = events - 2; i < events; ++i) good &= measured(machine, at_ns(i));
    return good ? 0 : 1;
}
template <const auto& source, Form form>
int drive_bound(int events) {
    Bound<Swing, source, form> bound;
    return drive(bound.machine, &measured_event, events);
}
int drive_form(std::string_view form, int events) {
    if (form == "compiled") return drive_bound<swing_script, Form::compiled>(events);
    if (form == "loaded") return drive_bound<swing_script, Form::loaded>(events);
    if (form == "table") return drive_bound<swing_table, Form::compiled>(events);
    if (form != "by_hand") return 2;
    HandSwing machine;
    return drive(machine, &measured_by_hand, events);
}

} // namespace

int main(int words, char** word) {
    if (words == 3) return drive_form(word[1], std::atoi(word[2]));
    bool good = true;
    std::array<double, 4> counts{};
    const std::array<const char*, 4> forms{"by_hand", "table", "compiled", "loaded"};
    for (std::size_t i = 0; i < forms.size(); ++i) {
        const std::string form = forms[i];
        const double early = count_measured(word[0], form + " 4", form);
        const double late = count_measured(word[0], form + " 4000", form);
        counts[i] = late;
        std::printf("%-10s %5.1f instructions an event, %5.1f after 4000 events\n", forms[i], early / 2,
                    late / 2);
        good &= early > 0 && early == late;
    }
    const double ratio = counts[2] / counts[0];
    std::printf("a compiled script takes %.2f times what the switch takes (limit %.2f)\n", ratio, most_times);
    return good && ratio <= most_times ? 0 : 1;
}
