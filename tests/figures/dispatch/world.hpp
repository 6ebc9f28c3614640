// A machine of a table that is configured, with its engine to be run by hand.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/machine/firmware.hpp"
#include "kernel/machine/instance/instance.hpp"

#include <cstdlib>
#include <iostream>

namespace tappet::figures {

inline constexpr Board figures_board{.name = "figures", .world = "host", .memory_budget_bytes = 1024 * 1024};

struct World {
    os::Clock clock;
    MachineInstance instance;
    World(os::Clock::Kind kind, const AcceptedMachine& machine) : clock{kind}, instance{machine, clock} {
        static_cast<void>(os::prove_processor_counter()); // as it is when the machine arms
        if (const auto configured = instance.configure({}); !configured) {
            std::cerr << configured.error().view() << '\n';
            std::exit(2);
        }
        engine().start(clock.now());
    }
    Engine& engine() { return instance.engines()[0]; }
};

} // namespace tappet::figures
