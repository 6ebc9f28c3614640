// A small machine for tests of the worlds: three activities, one with several components, that record their
// life cycle.
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/machine/accept.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/os/sleep.hpp"

#include <atomic>
#include <string>
#include <vector>

namespace tappet::watched {

/// The stops in the supervisor's order; filled after the cycles, so that no two threads access it at once.
inline std::vector<std::string>& stops() {
    static std::vector<std::string> list;
    return list;
}

/// The order that the test's thread gives a worker once.
enum class Order : int { none, overrun, hang, break_contract, sleep };

/// Uses only the time of its orders; its output shows whether it is safe.
struct Worker {
    Output<std::int64_t> level;
    std::atomic<Order> order{Order::none};
    std::atomic<bool> let_go{false}; ///< ends a hang
    std::atomic<std::int64_t> at_wire{-1};
    std::uint64_t cycles = 0;
    bool breaks_at_stop = false;
    os::Clock* clock = nullptr;
    std::string_view name{};
    Duration overrun{2500us};

    Sentence configure(Setup& setup) {
        clock = setup.clock;
        name = setup.component;
        return {};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        level.write(1);
        at_wire.store(1);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        ++cycles;
        switch (order.exchange(Order::none)) {
        case Order::none: break;
        case Order::overrun: clock->consume(overrun); break;
        case Order::hang:
            while (!let_go.load()) {
            }
            break;
        case Order::break_contract: TAPPET_CONTRACT(false, Contract::precondition, 7); break;
        case Order::sleep: TAPPET_ESCAPE("as if others had the processor", os::sleep_for(overrun)); break;
        }
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        level.write(0);
        at_wire.store(0);
        TAPPET_CONTRACT(!breaks_at_stop, Contract::precondition, 8);
        TAPPET_ESCAPE("a test's note, after the cycles", stops().push_back(std::string{name}));
    }
    static constexpr auto interface() { return facets(output<&Worker::level>("level", "", "0: safe")); }
};

/// May block, and does so until another component is safe, like a writer to a terminal that is stopped.
struct Blocking {
    std::atomic<const std::atomic<std::int64_t>*> until_safe{nullptr};
    std::atomic<bool> blocks{false};
    bool finalised = false;
    void finalise() { finalised = true; }
    void work(const Cycle&) {
        const auto* const wire = until_safe.load();
        if (wire == nullptr) return;
        blocks.store(true);
        while (wire->load() != 0) os::sleep_for(1ms);
    }
    static constexpr auto interface() { return facets(); }
};

// clang-format off
template <class... Extra>
constexpr auto watched_machine(std::string_view name, const Extra&... of_motion) { return machine(name,
    components(
        component<Worker>("driver"),
        component<Worker>("left"), component<Worker>("middle"), component<Worker>("right"),
        component<Worker>("logic")),
    activities(
        activity("drivers", every(2ms), runs("driver"),                  budget(50us), stack(256 * 1024)),
        activity("motion",  every(1ms), runs("left", "middle", "right"), budget(50us), stack(256 * 1024), of_motion...),
        activity("logic",   every(5ms), runs("logic"),                   budget(50us), stack(256 * 1024))),
    connections(), reactions(), behaviours()); }
inline constexpr auto table = watched_machine("watched");

/// The activity without real time is last, so that it would be stopped first.
inline constexpr auto blocked_table = machine("blocked",
    components(component<Worker>("driver"), component<Worker>("logic"), component<Blocking>("console")),
    activities(
        activity("drivers", every(2ms),  runs("driver"),  budget(50us), stack(256 * 1024)),
        activity("logic",   every(50ms), runs("logic"),   budget(5ms),  stack(256 * 1024)),
        activity("console", every(10ms), runs("console"), not_real_time, stack(256 * 1024))),
    connections(), reactions(), behaviours());

/// The same machine in separate memory, for tests that leave a thread behind on one of its stacks.
inline constexpr auto parked_table = table;
inline constexpr auto twice_broken_table = table;
inline constexpr auto supervised_table = table;
inline constexpr auto hung_table = table;

/// The same machine, stopped by a late cycle of "motion".
inline constexpr auto strict_table = watched_machine("strict", stop_when_late);
// clang-format on

/// The name of the component blamed for a miss.
inline std::string_view culprit(const Engine& engine, const Miss& miss) {
    return miss.function == Miss::nobody ? "nobody"
                                         : engine.plan().parts[miss.function / functions_per_part].name;
}

inline constexpr std::size_t drivers = 0, motion = 1, logic = 2;
inline constexpr std::array<std::string_view, 3> of_motion{"left", "middle", "right"};

} // namespace tappet::watched
