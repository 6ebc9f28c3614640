// Behaviours: state machine tables, the events they wait for, and the slots for loaded scripts.
#include "kernel/script/compiled.hpp"
#include "tests/diagnostics/rows/fault.hpp"
#include "tests/diagnostics/small_machine.hpp"

namespace {

using namespace small;
using namespace tappet::diagnostics;

struct Loaded {
    static constexpr bool slot_required = true;
    static constexpr auto interface() { return facets(); }
};
struct Observer {
    static constexpr bool sees_machine = true;
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

/// Commands the shaft, waits for the weft and sets the tension.
constexpr ScriptSource checking{"checking.osd", R"(
StateMachine Checking {
    initial state Good { entry { do tension.relax(); } transition weft.broken() select Bad }
    state Bad { transition wrapped() select Good }
    final state Off { }
}
RootStateMachine Checking checking
)"};
constexpr auto checking_reach =
    script_reach(reachable<Shaft>("shaft"), reachable<Weft>("weft", false), reachable<Tension>("tension"));
constexpr const ScriptUnit& checks = compiled_script<checking, checking_reach>;

constexpr Fault behaviour_faults[] = {
    {"behaviour_missing", [](Table& m) { m.behaviours.clear(); },
     R"(loom: component "weft": no behaviour drives it; add behaviour("weft", ...) to behaviours(...))"},
    {"behaviour_twice", [](Table& m) { m.add(behaviour("weft", weft_cycle)); },
     R"(loom: behaviour of "weft" appears twice in behaviours(...); a component has one behaviour: remove one)"},
    {"behaviour_component_unknown", [](Table& m) { m.behaviours[0].component = "wefd"; },
     R"(loom: behaviour of "wefd": there is no component "wefd"; did you mean "weft"?)"},
    {"behaviour_of_another_type", [](Table& m) { m.add(behaviour("tension", weft_cycle)); },
     R"(loom: behaviour of "tension": state machine "weft_cycle" is written for small::Weft but "tension" is a small::Tension; name a component of its type)"},
};
INSTANTIATE_TEST_SUITE_P(behaviours, Refusal, planted_into(small_loom, behaviour_faults), name_of);

Table loom_with_a_cycle() {
    Table m = small_loom();
    m.behaviours[0].type.machine.name = "faulty_cycle";
    m.states = {state("idle", initial), state("weaving"), state("safe", final)};
    m.transitions = {transition("idle", "weaving", on("shaft.window")),
                     transition("weaving", "safe", on("broken"))};
    return m;
}

void begin_on(Table& m, std::string_view event) { m.transitions[0].event = event; }

constexpr Fault cycle_faults[] = {
    {"behaviour_event_misspelt", [](Table& m) { m.transitions[1].event = "brokn"; },
     R"(loom: behaviour of "weft": state machine "faulty_cycle": transition 2 ("weaving" to "safe" on "brokn"): component "weft" has no event "brokn"; did you mean "broken"?)"},
    {"behaviour_event_is_an_operation", [](Table& m) { begin_on(m, "shaft.clear"); },
     R"(loom: behaviour of "weft": state machine "faulty_cycle": transition 1 ("idle" to "weaving" on "shaft.clear"): "shaft.clear" is an operation, not an event; name an event in on(...))"},
    {"behaviour_foreign_event_unknown", [](Table& m) { begin_on(m, "shaft.windw"); },
     R"(loom: behaviour of "weft": state machine "faulty_cycle": transition 1 ("idle" to "weaving" on "shaft.windw"): component "shaft" has no event "windw"; did you mean "window"?)"},
    {"behaviour_event_unknown", [](Table& m) { begin_on(m, "thunder"); },
     R"(loom: behaviour of "weft": state machine "faulty_cycle": transition 1 ("idle" to "weaving" on "thunder"): component "weft" has no event "thunder"; name it, or another component's as component.event)"},
    {"state_unknown", [](Table& m) { m.transitions[0] = transition("idle", "weavng", on("shaft.window")); },
     R"(loom: behaviour of "weft": state machine "faulty_cycle": transition 1 ("idle" to "weavng" on "shaft.window") leads to an unknown state "weavng"; did you mean "weaving"?)"},
    {"state_without_exit", [](Table& m) { m.transitions.pop_back(); },
     R"(loom: behaviour of "weft": state machine "faulty_cycle": state "weaving" has no way out; give it a transition, or mark it final)"},
    {"state_never_entered",
     [](Table& m) {
         m.states.push_back(state("washing"));
         m.transitions.push_back(transition("washing", "idle", after(2s)));
     },
     R"(loom: behaviour of "weft": state machine "faulty_cycle": state "washing" is never entered; lead a transition to it, make it initial, or drop it)"},
    {"state_machine_without_start", [](Table& m) { m.states[0] = state("idle"); },
     R"(loom: behaviour of "weft": state machine "faulty_cycle": no top state is initial; mark the one to start in)"},
    {"state_machine_without_safe_state", [](Table& m) { m.states[2] = state("safe"); },
     R"(loom: behaviour of "weft": state machine "faulty_cycle": no state is final; mark the safe state that the machine may be brought to from everywhere)"},
};
INSTANTIATE_TEST_SUITE_P(cycles, Refusal, planted_into(loom_with_a_cycle, cycle_faults), name_of);

/// A slot in the shaft, and the facets that it may reach.
constexpr Slot small_slot(const auto&... options) {
    return slot(nodes(10), data_bytes(64), depth(4), options...);
}
void reserve(Table& m, const auto&... options) { m.add(behaviour("shaft", small_slot(options...))); }
void begin_with_checks(Table& m, const auto&... options) {
    m.add(behaviour("shaft", checks, {}, small_slot(options...)));
}

constexpr Fault slot_faults[] = {
    {"slot_missing",
     [](Table& m) {
         m.components = {component<Loaded>("weft")};
         m.activities = {activity("all", every(1ms), budget(1us), runs("weft"))};
         m.connections.clear(), m.reactions.clear(), m.behaviours.clear();
     },
     R"(loom: component "weft": no slot is reserved for it; add behaviour("weft", slot(...)) to behaviours(...))"},
    {"slot_peer_unknown", [](Table& m) { reserve(m, peers("wefft")); },
     R"(loom: slot of "shaft": peers(...): there is no component "wefft"; did you mean "weft"?)"},
    {"slot_reach_unknown", [](Table& m) { reserve(m, operations("weft.relase")); },
     R"(loom: slot of "shaft": operations(...): component "weft" has no operation "relase"; did you mean "release"?)"},
    {"slot_event_unknown", [](Table& m) { reserve(m, events("weft.release")); },
     R"(loom: slot of "shaft": events(...): "weft.release" is an operation, not an event; name an event)"},
    {"slot_operation_is_an_output", [](Table& m) { reserve(m, operations("weft.reference")); },
     R"(loom: slot of "shaft": operations(...): "weft.reference" is an output, not an operation; name an operation)"},
    {"slot_angle_unknown", [](Table& m) { reserve(m, angle_of("encoder.angel")); },
     R"(loom: slot of "shaft": angle_of(...): component "encoder" has no output "angel"; did you mean "angle"?)"},
    {"slot_angle_is_no_angle", [](Table& m) { reserve(m, angle_of("encoder.turns")); },
     R"(loom: slot of "shaft": angle_of("encoder.turns") is an output of int; name an output of double, in degrees)"},
    {"slot_angle_of_another_activity", [](Table& m) { reserve(m, angle_of("encoder.angle")); },
     R"(loom: slot of "shaft": angle_of("encoder.angle") is written in another activity; name an output of activity "motion")"},
    {"slot_without_room", [](Table& m) { m.add(behaviour("shaft", Slot{})); },
     R"(loom: slot of "shaft" does not reserve all of nodes, data and depth; state all three)"},
    {"slot_of_all",
     [](Table& m) { m.add(behaviour("shaft", slot(nodes(0xffff'ffff), data_bytes(64), depth(4)))); },
     R"(loom: slot of "shaft" reserves more than 16777216 of one resource; write smaller numbers)"},
    {"slot_of_all_commands", [](Table& m) { reserve(m, command_slots(0x8000'0001)); },
     R"(loom: slot of "shaft" reserves more than 16777216 of one resource; write smaller numbers)"},
    {"slot_begins_beyond_its_peers", [](Table& m) { begin_with_checks(m); },
     R"(loom: slot of "shaft": its first script "checking.osd" reaches "weft", but loaded scripts cannot; add it to peers(...) of the slot)"},
    {"slot_begins_beyond_its_operations",
     [](Table& m) { begin_with_checks(m, peers("weft", "tension"), operations("tension.pre_tension")); },
     R"(loom: slot of "shaft": its first script "checking.osd" reaches "tension.relax", but loaded scripts cannot; add it to operations(...) of the slot)"},
    {"slot_begins_beyond_its_events",
     [](Table& m) {
         begin_with_checks(m, peers("weft", "tension"), operations("tension.relax"), events("weft.inserted"));
     },
     R"(loom: slot of "shaft": its first script "checking.osd" reaches "weft.broken", but loaded scripts cannot; add it to events(...) of the slot)"},
    {"slot_stack",
     [](Table& m) {
         m.add(component<Observer>("browser"), "hall");
         reserve(m);
     },
     R"(loom: slot of "shaft": scripts are compiled in activity "hall", whose stack of 65536 bytes is under 229376; enlarge its stack(...))"},
};
INSTANTIATE_TEST_SUITE_P(slots, Refusal, planted_into(small_loom, slot_faults), name_of);

} // namespace
