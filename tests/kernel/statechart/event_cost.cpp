// Counts the instructions of one event without the programs it calls: run under callgrind with
// --toggle-collect='measured_*'. Each event leaves two states, runs a transition program, enters two states,
// and refuses one guard on the way.
#include "kernel/statechart/execution.hpp"
#include "kernel/statechart/rows.hpp"

#include <cstdio>

namespace tappet {
namespace {

struct Tally {
    unsigned calls = 0;
    template <unsigned step> void count() noexcept TAPPET_REALTIME { calls += step; }
    bool refuse() const noexcept TAPPET_REALTIME { return calls == 0; }
};

constexpr auto swing = state_machine<Tally>(
    "swing",
    states(state("left", initial, entry<&Tally::count<1>>, exit<&Tally::count<2>>),
           state("l", in("left"), initial, entry<&Tally::count<3>>, exit<&Tally::count<4>>),
           state("right", entry<&Tally::count<5>>, exit<&Tally::count<6>>),
           state("r", in("right"), initial, entry<&Tally::count<7>>, exit<&Tally::count<8>>),
           state("plain", run<&Tally::count<9>>), state("other"), state("safe", final)),
    transitions(transition("l", "safe", on("swing"), guard<&Tally::refuse>),
                transition("left", "right", on("swing"), then<&Tally::count<10>>),
                transition("r", "safe", on("swing"), guard<&Tally::refuse>),
                transition("right", "left", on("swing"), then<&Tally::count<10>>),
                transition("l", "plain", on("plain")), transition("plain", "other", on("plain")),
                transition("other", "plain", on("plain")), transition("plain", "safe", after(1h)),
                transition("plain", "safe", guard<&Tally::refuse>)));
static_assert(check(swing.view()).empty());

} // namespace
} // namespace tappet

extern "C" {
[[gnu::noinline]] void measured_chain(tappet::StateMachineExecution& machine, tappet::Time now) {
    machine.dispatch(0, now);
}
[[gnu::noinline]] void measured_plain(tappet::StateMachineExecution& machine, tappet::Time now) {
    machine.dispatch(1, now);
}
[[gnu::noinline]] void measured_step(tappet::StateMachineExecution& machine, tappet::Time now) {
    machine.step(now);
}
}

int main() {
    constexpr int events = 1000;
    tappet::Tally counter;
    tappet::StateMachineExecution machine;
    machine.bind(tappet::resolved<tappet::swing>.view(), &counter);
    machine.start(tappet::at_ns(0));
    for (int i = 0; i < events; ++i) measured_chain(machine, tappet::at_ns(i));
    for (int i = 0; i < events; ++i) measured_plain(machine, tappet::at_ns(i));
    if (machine.path()[0] != "other") return 1;
    machine.dispatch(1, tappet::at_ns(events));
    for (int i = 0; i < events; ++i) measured_step(machine, tappet::at_ns(events + i));
    std::printf("%d events each, %u counted\n", events, counter.calls);
    return machine.path()[0] == "plain" ? 0 : 1;
}
