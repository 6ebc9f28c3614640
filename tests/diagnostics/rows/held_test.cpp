// Outputs that are held in some states: their names, and what the programs of scripts do to them.
#include "kernel/machine/table/compiled.hpp"
#include "kernel/script/compiled.hpp"
#include "kernel/script/load.hpp"
#include "tests/diagnostics/rows/fault.hpp"

#include <memory>

namespace {

using namespace tappet;
using namespace tappet::diagnostics;

/// Has what a driver has.
struct Lines {
    Input<bool> motor;
    Input<std::int64_t> recipe;
    void set() noexcept TAPPET_REALTIME {}
    void clear() noexcept TAPPET_REALTIME {}
    static void gate_output(void*, std::size_t, OutputGate&) noexcept {}
    static constexpr auto interface() {
        return facets(input<&Lines::motor>("motor", "", "it drives", drives_output(0, 0)),
                      input<&Lines::recipe>("recipe", "", "sent on demand", optional),
                      operation<&Lines::set>("valve.set", "opens", drives_output(1, 0)),
                      operation<&Lines::clear>("valve.clear", "closes", drives_output(1, 0)),
                      operation<&Lines::set>("brake.set", "holds", drives_output(2, 1)),
                      operation<&Lines::clear>("brake.clear", "lets go", drives_output(2, 1)));
    }
};
struct Filler {
    Output<bool> motor;
    Event<> go, full, open, close;
    static constexpr auto interface() {
        return facets(output<&Filler::motor>("motor", "", "shall run"), event<&Filler::go>("go", "begin"),
                      event<&Filler::full>("full", "it is"), event<&Filler::open>("open", "the valve"),
                      event<&Filler::close>("close", "the valve"));
    }
};
constexpr auto filler_states = state_machine<Filler>(
    "filler_states", states(state("idle", initial), state("filling"), state("safe", final)),
    transitions(transition("idle", "filling", on("go")), transition("filling", "idle", on("full"))));

/// The small loom with a filler, whose outputs may be on while it fills.
Table filling() {
    Table table = small_loom();
    table.add(component<Lines>("io"));
    table.add(component<Filler>("filler"));
    table.add(activity("filling", every(20ms), not_real_time, runs("filler", "io")));
    table.add(data("filler.motor", "io.motor"));
    table.add(when("filler.open", tell("io.valve.set")));
    table.add(when("filler.close", tell("io.valve.clear")));
    table.add(behaviour("filler", filler_states));
    table.held = {held_in("io.motor", "filler", "filling"), held_in("io.valve", "filler", "filling"),
                  held_in("io.brake", "filler", "filling")};
    return table;
}

constexpr Fault faults[] = {
    {"held_in_without_a_dot", [](Table& m) { m.held = {held_in("motor", "filler", "filling")}; },
     R"(loom: held_in "motor": it is not of the form "component.output"; name both)"},
    {"held_in_of_nobody", [](Table& m) { m.held = {held_in("oi.motor", "filler", "filling")}; },
     R"(loom: held_in "oi.motor": there is no component "oi"; did you mean "io"?)"},
    {"held_in_of_no_output", [](Table& m) { m.held = {held_in("io.vavle", "filler", "filling")}; },
     R"(loom: held_in "io.vavle": component "io" has no output "vavle"; did you mean "valve"?)"},
    {"held_in_of_a_port", [](Table& m) { m.held = {held_in("filler.motor", "filler", "filling")}; },
     R"(loom: held_in "filler.motor": it is a port, which others may write past; name the row of the driver that it drives, such as "io.motor")"},
    {"held_in_of_a_frame_on_demand", [](Table& m) { m.held = {held_in("io.recipe", "filler", "filling")}; },
     R"(loom: held_in "io.recipe": it has no safe value that could be sent at any time; name an output line, or a signal or register that states .safe(..) in a row that is sent cyclically)"},
    {"held_in_states_of_nobody", [](Table& m) { m.held = {held_in("io.motor", "filer", "filling")}; },
     R"(loom: held_in "io.motor": there is no component "filer"; did you mean "filler"?)"},
    {"held_in_states_of_a_component_without", [](Table& m) { m.held = {held_in("io.motor", "shaft", "on")}; },
     R"(loom: held_in "io.motor": no behaviour of the table drives component "shaft", and the states of a loaded one are not known; name a component of behaviours(..) without a slot)"},
    {"held_in_no_state", [](Table& m) { m.held = {held_in("io.motor", "filler", "filling", "idel")}; },
     R"(loom: held_in "io.motor": the behaviour of "filler" has no state "idel"; did you mean "idle"?)"},
};
INSTANTIATE_TEST_SUITE_P(held, Refusal, planted_into(filling, faults), name_of);

// ---- scripts

inline constexpr auto filler_reach = script_reach(reachable<Filler>("filler"), reachable<Lines>("io"));

/// The script, and the sentence that refuses it.
struct HeldScript {
    std::string_view name;
    std::string_view text;
    std::string_view sentence;

    friend std::ostream& operator<<(std::ostream& out, const HeldScript& row) { return out << row.name; }
};
class HeldByScript : public testing::TestWithParam<HeldScript> {};

TEST_P(HeldByScript, is_refused_or_not) {
    const auto rows = std::make_unique<ScriptBuffer<script_sizes_for(64, 1024, 2)>>();
    const ScriptOutcome outcome =
        compile_loaded(GetParam().text, "filler.osd", filler_reach.view(), rows->room());
    ASSERT_EQ(outcome.fault.view(), "");
    Table table = filling();
    table.behaviours.back().script = &outcome.unit;
    EXPECT_EQ(table.refusal(), GetParam().sentence);
}

constexpr HeldScript held_scripts[] = {
    {"held_in_good_script", R"(
StateMachine M {
    initial state idle { transition go select filling }
    state filling {
        entry { set motor = true; do open(); do io.brake.clear(); }
        exit { set motor = false; do close(); do io.brake.set(); }
        transition full select idle
    }
    final state safe { }
}
RootStateMachine M m
)",
     ""},
    {"held_in_good_script_that_ends_in_its_run", R"(
StateMachine M {
    initial state idle { transition go select filling }
    state filling {
        entry { do io.valve.set(); }
        run { do io.valve.clear(); }
        transition full select idle
    }
    final state safe { }
}
RootStateMachine M m
)",
     ""},
    {"held_in_on_elsewhere", R"(
StateMachine M {
    initial state idle {
        entry { do io.valve.set(); }
        transition go select filling
    }
    state filling {
        transition full select idle
    }
    final state safe { }
}
RootStateMachine M m
)",
     R"(loom: held_in "io.valve": the entry program of "idle" of "M" turns it on in line 4, outside of its states; exchange set and clear there, or add "idle" to the states)"},
    {"held_in_exchanged_by_operations", R"(
StateMachine M {
    initial state idle { transition go select filling }
    state filling {
        entry { do io.valve.clear(); }
        exit { do io.valve.set(); }
        transition full select idle
    }
    final state safe { }
}
RootStateMachine M m
)",
     R"(loom: held_in "io.valve": state "filling" of "M" is left to "idle" and leaves it on (line 6); turn it off in the exit program of "filling": set and clear may be exchanged there)"},
    {"held_in_exchanged_by_events", R"(
StateMachine M {
    initial state idle { transition go select filling }
    state filling {
        entry { do close(); }
        exit { do open(); }
        transition full select idle
    }
    final state safe { }
}
RootStateMachine M m
)",
     R"(loom: held_in "io.valve": state "filling" of "M" is left to "idle" and leaves it on (line 6); turn it off in the exit program of "filling": set and clear may be exchanged there)"},
    {"held_in_exchanged_of_what_is_safe_when_set", R"(
StateMachine M {
    initial state idle { transition go select filling }
    state filling {
        entry { do io.brake.set(); }
        exit { do io.brake.clear(); }
        transition full select idle
    }
    final state safe { }
}
RootStateMachine M m
)",
     R"(loom: held_in "io.brake": state "filling" of "M" is left to "idle" and leaves it on (line 6); turn it off in the exit program of "filling": set and clear may be exchanged there)"},
    {"held_in_left_on_by_an_output", R"(
StateMachine M {
    initial state idle { transition go select filling }
    state filling {
        entry { set motor = true; }
        transition full select idle
    }
    final state safe { entry { set motor = false; } }
}
RootStateMachine M m
)",
     R"(loom: held_in "io.motor": state "filling" of "M" is left to "idle" and leaves it on (line 5); turn it off in the exit program of "filling": set and clear may be exchanged there)"},
    {"held_in_left_on_for_the_final_state", R"(
StateMachine M {
    initial state idle { entry { set motor = false; } transition go select filling }
    state filling {
        entry { set motor = true; }
        transition full select idle
    }
    final state safe { }
}
RootStateMachine M m
)",
     R"(loom: held_in "io.motor": state "filling" of "M" is left to "safe" and leaves it on (line 5); turn it off in the exit program of "filling": set and clear may be exchanged there)"},
    {"held_in_on_by_a_transition", R"(
StateMachine M {
    initial state idle { transition go select filling }
    state filling {
        transition full { do io.valve.set(); } select idle
    }
    final state safe { }
}
RootStateMachine M m
)",
     R"(loom: held_in "io.valve": the transition program of "filling" of "M" turns it on in line 5, outside of its states; exchange set and clear there, or add "idle" to the states)"},
};
INSTANTIATE_TEST_SUITE_P(held, HeldByScript, testing::ValuesIn(held_scripts),
                         [](const auto& row) { return std::string{row.param.name}; });

inline constexpr ScriptSource exchanged{"filler.osd", R"(
StateMachine M {
    initial state idle { transition go select filling }
    state filling {
        entry { set motor = false; }
        exit { set motor = true; }
        transition full select idle
    }
    final state safe { }
}
RootStateMachine M m
)"};
constexpr const ScriptUnit& exchanged_unit = compiled_script<exchanged, filler_reach>;

TEST(HeldByNativeCode, is_refused_alike) {
    Table table = filling();
    table.behaviours.back() = behaviour("filler", compiled<exchanged_unit>);
    EXPECT_EQ(
        table.refusal(),
        R"(loom: held_in "io.motor": state "filling" of "M" is left to "idle" and leaves it on (line 6); )"
        R"(turn it off in the exit program of "filling": set and clear may be exchanged there)");
}

} // namespace
