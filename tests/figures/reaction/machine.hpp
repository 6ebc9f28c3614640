// The machine whose reactions are measured: one periodic activity, and one that sends events to an activity
// on its own processor and to one on another.
#pragma once

#include "kernel/base/random.hpp"
#include "kernel/machine/table/board.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/os/clock.hpp"
#include "tests/figures/measure/ticks.hpp"
#include "tests/figures/reaction/bare.hpp"

#include <array>
#include <atomic>
#include <cstdint>

namespace tappet::figures::reaction {

inline constexpr Duration period = 500us;

/// Records the lateness of its cycles. It reads the clock itself, so that all work of the framework before a
/// component counts.
struct Ticker {
    TickBlock block;
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        block.add((os::Clock::monotonic() - cycle.release).count());
    }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

/// Its operation is the target of the event.
struct Receiver {
    Arrival arrival;
    void take(std::uint64_t value) noexcept TAPPET_REALTIME { arrival.note(value); }
    static constexpr auto interface() {
        return facets(operation<&Receiver::take>("take", "notes when it came"));
    }
};

/// In each requested cycle it sends that many values: each once by its event and once by the bare program, in
/// a random order.
struct Sender {
    static constexpr std::size_t pairs_in_cycle = 8;
    enum class Reach : std::uint8_t { none, near, far };

    Event<std::uint64_t> near;
    Event<std::uint64_t> far;

    struct Route {
        Arrival* ours = nullptr;
        BareReceiver* bare = nullptr;
    };
    Route to_near, to_far;                 ///< before the machine is armed
    std::atomic<Reach> reach{Reach::none}; ///< set by the measuring thread; back to none when done
    std::array<std::uint64_t, pairs_in_cycle> took_ours{}, took_bare{}; ///< in ticks; 0: it did not arrive

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const Reach asked = reach.load(std::memory_order_acquire);
        if (asked == Reach::none) return;
        const bool is_far = asked == Reach::far;
        const Route route = is_far ? to_far : to_near;
        for (std::size_t i = 0; i < pairs_in_cycle; ++i) {
            const bool bare_first = random_.below(2) == 0;
            if (bare_first) took_bare[i] = send_bare(route, is_far);
            took_ours[i] = send_ours(route, is_far);
            if (!bare_first) took_bare[i] = send_bare(route, is_far);
        }
        reach.store(Reach::none, std::memory_order_release);
    }

    static constexpr auto interface() {
        return facets(event<&Sender::near>("near", "to the same processor"),
                      event<&Sender::far>("far", "to another processor"));
    }

private:
    std::uint64_t send_ours(const Route& route, bool is_far) noexcept TAPPET_REALTIME {
        ++sent_;
        const std::uint64_t begin = ticks();
        if (is_far)
            far.emit(sent_);
        else
            near.emit(sent_);
        return route.ours->wait_for(sent_, begin, is_far);
    }
    std::uint64_t send_bare(const Route& route, bool is_far) noexcept TAPPET_REALTIME {
        ++sent_;
        const std::uint64_t begin = ticks();
        route.bare->post(sent_);
        return route.bare->arrival().wait_for(sent_, begin, is_far);
    }
    std::uint64_t sent_ = 0;
    Random random_{1};
};

// clang-format off
inline constexpr auto table = machine("reaction",
    components(component<Ticker>("ticker"), component<Sender>("sender"), component<Receiver>("near"), component<Receiver>("far")),
    activities(
        activity("ticker", every(period), runs("ticker"), budget(50us)),
        activity("sender", every(2ms),    runs("sender"), budget(1ms)),
        activity("near",   on_work(), at_most(8, 2ms), runs("near"), deadline(500us), budget(20us)),
        activity("far",    on_work(), at_most(8, 2ms), runs("far"),  deadline(400us), budget(20us))),
    connections(),
    reactions(when("sender.near", tell("near.take")), when("sender.far", tell("far.take"))),
    behaviours());

inline constexpr std::size_t ticker = 0, sender = 1, near = 2, far = 3; ///< activities
inline constexpr int here = 0, there = 1;                               ///< processors

inline constexpr Board board{
    .name = "host", .world = "host", .memory_budget_bytes = 4 * 1024 * 1024, .processors = 2, .highest_priority = 60,
    .only_warned = warn_only("realtime-kernel", "clock-source", "rt-throttling", "cpu-governor", "heap-sealed", "cpu-dma-latency",
                             "memory-locked", "memory-lockable", "swap", "clock-resolution")};
inline constexpr Binding bound = binding(place("ticker", there), place("sender", here), place("near", here), place("far", there));
// clang-format on

} // namespace tappet::figures::reaction
