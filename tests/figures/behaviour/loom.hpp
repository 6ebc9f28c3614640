// One hierarchical machine of seven states (and the final one) and eight events in all forms: a loom's cycle.
// All forms count the same things, so that each can be checked against the others.
//
//     Off              power -> On, Fault: power -> Off
//     On               power -> Off, broken -> Fault
//       Idle           start [may] -> Weaving
//       Weaving        stop -> Idle, pick: counted
//         Slow         faster [may] -> Fast
//         Fast         slower -> Slow
//     Fault            reset -> On
#pragma once

#include "tests/figures/behaviour/bound.hpp"
#include "tests/figures/behaviour/loom_counts.hpp"

namespace tappet::figures {

struct Loom {
    Event<> power, start, stop, faster, slower, pick, broken, reset;
    LoomCounts counts{};

    void left() noexcept TAPPET_REALTIME { counts.exits += 1; }
    void entered() noexcept TAPPET_REALTIME { counts.entries += 1; }
    void picked() noexcept TAPPET_REALTIME { counts.picks += 1; }
    bool may() const noexcept TAPPET_REALTIME { return counts.picks >= 0; }
    bool worn() const noexcept TAPPET_REALTIME { return counts.picks < 0; }

    static constexpr auto interface() {
        return facets(
            event<&Loom::power>("power", "the main switch"), event<&Loom::start>("start", "the start button"),
            event<&Loom::stop>("stop", "the stop button"),
            event<&Loom::faster>("faster", "the speed button, up"),
            event<&Loom::slower>("slower", "the speed button, down"),
            event<&Loom::pick>("pick", "a weft is in"), event<&Loom::broken>("broken", "a warp end broke"),
            event<&Loom::reset>("reset", "the fault is repaired"));
    }
};

inline constexpr auto loom_table = state_machine<Loom>(
    "loom",
    states(state("off", initial, entry<&Loom::entered>, exit<&Loom::left>),
           state("on", entry<&Loom::entered>, exit<&Loom::left>),
           state("idle", in("on"), initial, entry<&Loom::entered>, exit<&Loom::left>),
           state("weaving", in("on"), entry<&Loom::entered>, exit<&Loom::left>),
           state("slow", in("weaving"), initial, entry<&Loom::entered>, exit<&Loom::left>),
           state("fast", in("weaving"), entry<&Loom::entered>, exit<&Loom::left>),
           state("fault", entry<&Loom::entered>, exit<&Loom::left>), state("safe", final)),
    transitions(transition("off", "on", on("power")),
                transition("idle", "weaving", on("start"), guard<&Loom::may>),
                transition("slow", "fast", on("faster"), guard<&Loom::may>),
                transition("fast", "slow", on("slower")), transition("weaving", "idle", on("stop")),
                internal("weaving", on("pick"), then<&Loom::picked>), transition("on", "fault", on("broken")),
                transition("fault", "on", on("reset")), transition("fault", "off", on("power")),
                transition("on", "off", on("power")), transition("off", "safe", guard<&Loom::worn>)));
static_assert(check(loom_table.view()).empty());

inline constexpr ScriptSource loom_source{"loom.osd", R"(
StateMachine Loom {
    var int exits = 0;
    var int entries = 0;
    var int picks = 0;

    initial state Off {
        entry { set entries = entries + 1; }
        exit { set exits = exits + 1; }
        transition power select On
        transitions { if picks < 0 then select Safe }
    }
    state On {
        entry { set entries = entries + 1; }
        exit { set exits = exits + 1; }
        initial state Idle {
            entry { set entries = entries + 1; }
            exit { set exits = exits + 1; }
            transition start if picks >= 0 then select Weaving
        }
        state Weaving {
            entry { set entries = entries + 1; }
            exit { set exits = exits + 1; }
            initial state Slow {
                entry { set entries = entries + 1; }
                exit { set exits = exits + 1; }
                transition faster if picks >= 0 then select Fast
            }
            state Fast {
                entry { set entries = entries + 1; }
                exit { set exits = exits + 1; }
                transition slower select Slow
            }
            transition stop select Idle
            transition pick { set picks = picks + 1; }
        }
        transition broken select Fault
        transition power select Off
    }
    state Fault {
        entry { set entries = entries + 1; }
        exit { set exits = exits + 1; }
        transition reset select On
        transition power select Off
    }
    final state Safe { }
}
RootStateMachine Loom loom
)"};
inline constexpr auto loom_reach = script_reach(reachable<Loom>("loom"));
inline constexpr ScriptUnit loom_script = compiled_script<loom_source, loom_reach>;

} // namespace tappet::figures
