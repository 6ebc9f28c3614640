// Machines that send a clock and that receive it, and one that receives whatever a test makes up.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/can/clock.hpp"
#include "kernel/machine/accept.hpp"
#include "tests/drivers/components/board.hpp"

#include <vector>

namespace tappet::test {

inline constexpr auto clock_row = can::clock(can::standard(0x090), can::every(100ms));
inline constexpr auto no_signals = can::signal_map();
/// Frames of other nodes, which wake the clock master while its own frame waits.
inline constexpr auto urgent_frames = [] {
    can::Services<1, 0> heard{};
    heard.frames[0].identifier = can::standard(1);
    heard.frames[0].name = "urgent";
    heard.frames[0].length = 8;
    return heard;
}();
inline constexpr auto telling_frames =
    can::together(can::clock_frames<clock_row, can::Direction::transmit>, urgent_frames);
using TellingBus = can::Bus<no_signals, telling_frames>;
using ToldBus = can::Bus<no_signals, can::clock_frames<clock_row, can::Direction::receive>>;
using Teller = can::ClockTeller<clock_row>;
using Told = can::ToldClock<clock_row>;

/// Records the received clock in each cycle.
struct ClockWatcher {
    struct Seen {
        Time now{};
        Duration ahead{}, error{};
        std::int64_t exchanges = 0;
        bool known = false;
    };
    Input<Duration> ahead{}, error{};
    Input<bool> known{};
    Input<std::int64_t> exchanges{};
    std::vector<Seen> seen{};

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's list",
                      seen.push_back({cycle.now, ahead.get(), error.get(), exchanges.get(), known.get()}));
    }
    static constexpr auto interface() {
        return facets(input<&ClockWatcher::ahead>("ahead", "s", "as told", optional),
                      input<&ClockWatcher::error>("error", "s", "as told", optional),
                      input<&ClockWatcher::known>("known", "", "as told", optional),
                      input<&ClockWatcher::exchanges>("exchanges", "", "as told", optional));
    }
};

/// Delivers the frames of a test with the stamps that they have.
struct ClockFeeder {
    BufferOutput<can::Frame> frames{};
    std::vector<can::Frame> to_give{};

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        for (const can::Frame& frame : to_give) static_cast<void>(frames.push(frame));
        TAPPET_ESCAPE("a test's list", to_give.clear());
    }
    static constexpr auto interface() {
        return facets(output<&ClockFeeder::frames>("frames", "", "as the test has them"));
    }
};

// clang-format off
inline constexpr auto telling_machine = machine("teller",
    components(
        component<TellingBus>("can", device("wire")),
        component<Teller>("clock", device("wire"))),
    activities(activity("can", on_device("can"), at_most(8, 1ms), runs("can", "clock"), deadline(500us), budget(20us))),
    connections(), reactions(), behaviours());

/// `settings`: for the clock's properties.
constexpr auto told_machine_with(auto... settings) {
    return machine("told",
        components(
            component<ToldBus>("can", device("wire")),
            component<Told>("clock", set("rate_over", 500ms), settings...),
            component<ClockWatcher>("watcher")),
        activities(
            activity("can", on_device("can"), at_most(8, 1ms), runs("can"), deadline(500us), budget(20us)),
            activity("clock", every(5ms), runs("clock", "watcher"), budget(20us))),
        connections(
            buffer<16>("can.services", "clock.received"),
            data("clock.ahead", "watcher.ahead"),
            data("clock.error", "watcher.error"),
            data("clock.known", "watcher.known"),
            data("clock.exchanges", "watcher.exchanges")),
        reactions(), behaviours());
}
inline constexpr auto told_machine = told_machine_with();
inline constexpr auto told_without_drift = told_machine_with(set("drift", 0.0));
inline constexpr auto told_without_own_late = told_machine_with(set("own_late", 0ns));
inline constexpr auto told_without_teller_late = told_machine_with(set("teller_late", 0ns));

inline constexpr auto fed_machine = machine("fed",
    components(
        component<ClockFeeder>("feeder"),
        component<Told>("clock", set("rate_over", 2s)),
        component<ClockWatcher>("watcher")),
    activities(activity("clock", every(5ms), runs("feeder", "clock", "watcher"), budget(20us))),
    connections(
        buffer<16>("feeder.frames", "clock.received"),
        data("clock.ahead", "watcher.ahead"),
        data("clock.error", "watcher.error"),
        data("clock.known", "watcher.known"),
        data("clock.exchanges", "watcher.exchanges")),
    reactions(), behaviours());
// clang-format on

} // namespace tappet::test
