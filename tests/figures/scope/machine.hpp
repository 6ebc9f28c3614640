// The machines whose recording is measured: their components do the smallest visible work.
#pragma once

#include "kernel/services/scope/thread_scope.hpp"
#include "tests/figures/measure/world.hpp"

namespace tappet::figures {

/// The smallest visible work.
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

// clang-format off
inline constexpr auto ten_scoped = machine("ten",
    components(component<Idle>("a"), component<Idle>("b"), component<Idle>("c"), component<Idle>("d"), component<Idle>("e"),
               component<Idle>("f"), component<Idle>("g"), component<Idle>("h"), component<Idle>("i"), component<Idle>("j"),
               component<ThreadScope>("scope")),
    activities(activity("motion", on_work(), at_most(1, 1us), deadline(1s), budget(100ns),
                        runs("a", "b", "c", "d", "e", "f", "g", "h", "i", "j")),
               activity("background", every(20ms), not_real_time, runs("scope"))), connections(), reactions(when("a.kicks", tell("a.kick"))), behaviours());
// clang-format on

[[nodiscard]] inline scope::Directory& directory_of(World& world) {
    const AcceptedMachine& machine = world.instance.machine();
    return *reinterpret_cast<scope::Directory*>(machine.memory.data() + machine.plan.scope_at);
}

/// A step while another processor reads each cycle off the tape at once, and one without a reader.
void add_followed(const Options& options, Result& result);

} // namespace tappet::figures
