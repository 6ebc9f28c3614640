// Two machines and what crosses between them, each at its end of a wire of memory: their engines are run by
// who measures, under one virtual clock.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/component/component.hpp"
#include "tests/figures/wire/bare.hpp"

namespace tappet::figures {

/// So long that what repeats of itself is not seen among the events.
inline constexpr Duration value_period = 10s;
/// A row's messages stand half of its time apart.
inline constexpr Duration event_period = 40ms;
/// How the level stands on the wire; the bare program has it so, too.
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
    /// Each hears what the other has sent, and answers; nothing is left on the way.
    void (*exchange)() = nullptr;
    double (*hearer_level)() = nullptr;
    bool (*are_all_answered)() = nullptr; ///< the events
    // The ends of the wire without their engines: as those call them.
    void (*end_sends)() = nullptr;                     ///< what is due by the clock
    void (*end_receives)(const can::Frame&) = nullptr; ///< a frame that the bus has taken
    bare::Identifiers identifiers{};
};
Ends& ends();

} // namespace tappet::figures
