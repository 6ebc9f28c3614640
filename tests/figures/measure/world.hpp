// A machine that is configured and started, whose engines the measuring program runs; for programs that link
// tappet_machine.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/machine/firmware.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "tests/figures/measure/candidates.hpp"

#include <cstdlib>
#include <iostream>

namespace tappet::figures {

inline constexpr Board figures_board{
    .name = "figures", .world = "host", .memory_budget_bytes = 8 * 1024 * 1024};

/// A machine that does not start gives no measurement: exits with 2 and the sentence.
inline void exit_if(const Sentence& refusal) {
    if (refusal.empty()) return;
    std::cerr << refusal.view() << '\n';
    std::exit(2);
}

struct World {
    os::Clock clock;
    MachineInstance instance;
    Duration configuring{}; ///< the time of the configuration
    World(os::Clock::Kind kind, const AcceptedMachine& machine) : clock{kind}, instance{machine, clock} {
        const Time begin = os::Clock::monotonic();
        const auto configured = instance.configure({});
        configuring = os::Clock::monotonic() - begin;
        if (!configured) exit_if(configured.error());
        for (Engine& engine : instance.engines()) {
            exit_if(engine.initialise());
            engine.start(clock.now());
        }
    }
    Engine& engine() { return instance.engines()[0]; }
    /// As the activities do it, in virtual time: asks when an engine is due, waits, runs it.
    void run_all() {
        for (Engine& each : instance.engines()) {
            clock.advance_to(each.next_wake());
            each.run(false);
        }
    }
};

template <std::size_t readings>
void read_clock(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i)
        for (std::size_t k = 0; k < readings; ++k) {
            Time now = os::Clock::monotonic();
            keep(now);
        }
}

} // namespace tappet::figures
