// Behaviours for an engine's step: run programs with a condition that never holds, a condition that holds in
// each step, a time-out, and a program that is a loop of statements; each as a script and as a C++ table.
#pragma once

#include "tests/figures/behaviour/bound.hpp"

#include <cstdint>

namespace tappet::figures {

/// The component that all of them act on.
struct Swing {
    Event<> beat;
    std::int64_t exits = 0;
    std::int64_t entries = 0;
    std::int64_t runs = 0;
    std::int64_t turns = 0;
    std::int64_t due = 1;

    void left() noexcept TAPPET_REALTIME { exits += 1; }
    void entered() noexcept TAPPET_REALTIME { entries += 1; }
    void turned() noexcept TAPPET_REALTIME { runs += 2; }
    void ran() noexcept TAPPET_REALTIME { runs += 1; }
    bool may() const noexcept TAPPET_REALTIME { return runs >= 0; }
    bool tired() const noexcept TAPPET_REALTIME { return runs < 0; }
    void changed() noexcept TAPPET_REALTIME { turns += 1; }
    void done() noexcept TAPPET_REALTIME {
        due = 0;
        turns += 1;
    }
    void rested() noexcept TAPPET_REALTIME { due = 1; }
    bool is_due() const noexcept TAPPET_REALTIME { return due == 1; }

    static constexpr auto interface() { return facets(event<&Swing::beat>("beat", "to the other side")); }
};

inline constexpr auto swing_table = state_machine<Swing>(
    "swing",
    states(state("left", initial, entry<&Swing::entered>, run<&Swing::ran>, exit<&Swing::left>),
           state("right", entry<&Swing::entered>, run<&Swing::ran>, exit<&Swing::left>),
           state("safe", final)),
    transitions(transition("left", "right", on("beat"), guard<&Swing::may>, then<&Swing::turned>),
                transition("right", "left", on("beat"), guard<&Swing::may>, then<&Swing::turned>),
                transition("left", "safe", guard<&Swing::tired>),
                transition("right", "safe", guard<&Swing::tired>)));
static_assert(check(swing_table.view()).empty());

inline constexpr ScriptSource swing_source{"swing.osd", R"(
StateMachine Swing {
    var int exits = 0;
    var int entries = 0;
    var int runs = 0;

    initial state Left {
        entry { set entries = entries + 1; }
        run { set runs = runs + 1; }
        exit { set exits = exits + 1; }
        transition beat if runs >= 0 then { set runs = runs + 2; } select Right
        transitions { if runs < 0 then select Safe }
    }
    state Right {
        entry { set entries = entries + 1; }
        run { set runs = runs + 1; }
        exit { set exits = exits + 1; }
        transition beat if runs >= 0 then { set runs = runs + 2; } select Left
        transitions { if runs < 0 then select Safe }
    }
    final state Safe { }
}
RootStateMachine Swing swing
)"};

inline constexpr auto relay_table =
    state_machine<Swing>("relay",
                         states(state("left", initial, handles<&Swing::rested>),
                                state("right", handles<&Swing::rested>), state("safe", final)),
                         transitions(transition("left", "right", guard<&Swing::is_due>, then<&Swing::done>),
                                     transition("right", "left", guard<&Swing::is_due>, then<&Swing::done>),
                                     transition("right", "safe", on("beat"))));
static_assert(check(relay_table.view()).empty());

inline constexpr ScriptSource relay_source{"relay.osd", R"(
StateMachine Relay {
    var int turns = 0;
    var int due = 1;

    initial state Left {
        handle { set due = 1; }
        transitions { if due == 1 then { set due = 0; set turns = turns + 1; } select Right }
    }
    state Right {
        handle { set due = 1; }
        transitions { if due == 1 then { set due = 0; set turns = turns + 1; } select Left }
        transition beat select Safe
    }
    final state Safe { }
}
RootStateMachine Relay relay
)"};

inline constexpr auto clock_table = state_machine<Swing>(
    "clock", states(state("left", initial), state("right"), state("safe", final)),
    transitions(transition("left", "right", after(std::chrono::milliseconds{1}), then<&Swing::changed>),
                transition("right", "left", after(std::chrono::milliseconds{1}), then<&Swing::changed>),
                transition("right", "safe", on("beat"))));
static_assert(check(clock_table.view()).empty());

inline constexpr ScriptSource clock_source{"clock.osd", R"(
StateMachine Clock {
    var int turns = 0;

    initial state Left { transitions { after 1ms { set turns = turns + 1; } select Right } }
    state Right {
        transitions { after 1ms { set turns = turns + 1; } select Left }
        transition beat select Safe
    }
    final state Safe { }
}
RootStateMachine Clock clock
)"};

/// Eight statements in each turn.
inline constexpr std::int64_t turns_of_sums = 250;
inline constexpr std::size_t statements_of_sums = 8 * turns_of_sums;
inline constexpr ScriptSource sums_source{"sums.osd", R"(
program sums {
    var int i = 0;
    var int a = 0;
    var int b = 1;
    var double x = 0.0;
    while (i < 250) {
        set i = i + 1;
        set a = a + i;
        set b = a - b;
        if (b > 100000) then { set b = 1; }
        set x = x + 0.5;
        set x = x * 0.75;
        set a = a - b;
    }
}
)"};

inline constexpr ScriptReach<1> swing_reach{{reachable<Swing>("swing")}, 20'000};
inline constexpr ScriptUnit swing_script = compiled_script<swing_source, swing_reach>;
inline constexpr ScriptUnit relay_script = compiled_script<relay_source, swing_reach>;
inline constexpr ScriptUnit clock_script = compiled_script<clock_source, swing_reach>;
inline constexpr ScriptUnit sums_script = compiled_script<sums_source, swing_reach>;

} // namespace tappet::figures
