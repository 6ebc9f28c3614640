// Two machines and the rows across, each at its end of a wire in memory: the measuring program runs their
// engines, under one virtual clock.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/component/component.hpp"
#include "tests/figures/wire/bare.hpp"

namespace tappet::figures {

/// Long enough to keep repeated values out of the measurement of events.
inline constexpr Duration value_period = 10s;
/// Half of this lies between the messages of a row.
inline constexpr Duration event_period = 40ms;
/// The size of the level on the wire, also in the bare program.
inline constexpr unsigned level_bits = 24;
inline constexpr double level_step = 0.1;

struct Teller {
    Output<double> level;
    Event<std::int32_t> full;
    static constexpr auto interface() {
        return facets(output<&Teller::level>("level", "mm", "as it is set"),
                      event<&Teller::full>("full", "a number"));
    }
};
struct Hearer {
    Input<double> level;
    std::int64_t sum = 0;
    void take(std::int32_t number) noexcept TAPPET_REALTIME { sum += number; }
    static constexpr auto interface() {
        return facets(input<&Hearer::level>("level", "mm", "as the other machine tells it"),
                      operation<&Hearer::take>("take", "adds it"));
    }
};

/// Both have heard each other, and each row works.
struct Ends {
    Teller* teller = nullptr;
    Hearer* hearer = nullptr;
    std::uint32_t telling = 0; ///< the activity of the teller
    Engine* sends = nullptr;   ///< the wire's, of the teller's machine
    Engine* receives = nullptr;
    Engine* hears = nullptr; ///< the hearer's own
    Memory* from = nullptr;
    Memory* to = nullptr;
    void (*advance)(Duration) = nullptr;
    Time (*now)() = nullptr;
    /// Each end processes all frames of the other, and answers; none is left.
    void (*exchange)() = nullptr;
    double (*hearer_level)() = nullptr;
    bool (*are_all_answered)() = nullptr; ///< the events
    // The ends of the wire without their engines, with the calls that the engines make.
    void (*end_sends)() = nullptr;                     ///< sends the frames that are due by the clock
    void (*end_receives)(const can::Frame&) = nullptr; ///< a frame that the bus has taken
    bare::Identifiers identifiers{};
};
Ends& ends();

} // namespace tappet::figures
