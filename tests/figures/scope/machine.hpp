// The machines whose recording is measured: components that do as little as can be seen, and what brings them
// to life.
#pragma once

#include "kernel/machine/firmware.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/services/scope/thread_scope.hpp"
#include "tests/figures/measure/candidates.hpp"

#include <array>
#include <cstdlib>
#include <iostream>

namespace tappet::figures {

/// As little as can be seen.
struct Idle {
    std::uint64_t steps = 0;
    Event<> kicks;
    void kick() noexcept TAPPET_REALTIME {}
    void step(const Cycle&) noexcept TAPPET_REALTIME { ++steps; }
    static constexpr auto interface() {
        return facets(event<&Idle::kicks>("kicks", "wakes another"),
                      operation<&Idle::kick>("kick", "woke it"));
    }
};

inline constexpr Board board{.name = "figures", .world = "host", .memory_budget_bytes = 4 * 1024 * 1024};

struct World {
    os::Clock clock;
    MachineInstance instance;
    World(os::Clock::Kind kind, const AcceptedMachine& machine) : clock{kind}, instance{machine, clock} {
        if (const auto configured = instance.configure({}); !configured) {
            std::cerr << configured.error().view() << '\n';
            std::exit(2);
        }
        for (Engine& engine : instance.engines()) {
            if (const Sentence refusal = engine.initialise(); !refusal.empty()) {
                std::cerr << refusal.view() << '\n';
                std::exit(2);
            }
            engine.start(clock.now());
        }
    }
    [[nodiscard]] scope::Directory& directory() {
        const AcceptedMachine& machine = instance.machine();
        return *reinterpret_cast<scope::Directory*>(machine.memory.data() + machine.plan.scope_at);
    }
};

/// A step while another processor reads each cycle off the tape at once, and while none does.
void add_followed(const Options& options, Result& result);

} // namespace tappet::figures
