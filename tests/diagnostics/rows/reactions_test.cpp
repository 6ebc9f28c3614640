// Reactions: the operations that run upon an event, and the targets of a component's calls.
#include "tests/diagnostics/peers.hpp"
#include "tests/diagnostics/rows/fault.hpp"

namespace {

using namespace small;
using namespace tappet::diagnostics;

struct Archive {
    bool store(int) noexcept { return true; }
    static constexpr auto interface() {
        return facets(command<&Archive::store>("store", "on the disk", may_block));
    }
};

struct Watch {
    Event<> broken;
    static constexpr auto interface() {
        return facets(event<&Watch::broken>("broken", "must be heard", heard_by(1)));
    }
};

struct Relay {
    Event<double> passed;
    void pass(double angle) noexcept TAPPET_REALTIME { passed(angle); }
    static constexpr auto interface() {
        return facets(event<&Relay::passed>("passed", "on"),
                      operation<&Relay::pass>("pass", "it on", any_thread));
    }
};
struct Notes {
    void note(double) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(operation<&Notes::note>("note", "the angle")); }
};

constexpr Fault end_faults[] = {
    {"reaction_missing", [](Table& m) { m.reactions.erase(m.reactions.begin()); },
     R"(loom: component "shaft": no reaction names its required operation "on_index"; add when("...", tell("shaft.on_index")))"},
    {"reaction_twice",
     [](Table& m) { m.reactions = {m.reactions[0], m.reactions[3], m.reactions[4], m.reactions[3]}; },
     R"(loom: reaction "weft.broken" -> "shaft.clear" appears twice in reactions(...), rows 2 and 4; remove one)"},
    {"reaction_component_unknown", [](Table& m) { m.put(when("shaft.window", call("tenison.pre_tension"))); },
     R"(loom: reaction "shaft.window" -> "tenison.pre_tension": there is no component "tenison"; did you mean "tension"?)"},
    {"reaction_event_unknown", [](Table& m) { m.add(when("shaft.windwo", call("tension.pre_tension"))); },
     R"(loom: reaction "shaft.windwo" -> "tension.pre_tension": component "shaft" has no event "windwo"; did you mean "window"?)"},
    {"reaction_operation_unknown", [](Table& m) { m.put(when("shaft.window", call("tension.pretension"))); },
     R"(loom: reaction "shaft.window" -> "tension.pretension": component "tension" has no operation "pretension"; did you mean "pre_tension"?)"},
    {"reaction_exchanged", [](Table& m) { m.add(when("tension.pre_tension", call("shaft.window"))); },
     R"(loom: reaction "tension.pre_tension" -> "shaft.window" runs from an operation to an event; exchange the two)"},
    {"reaction_of_a_port", [](Table& m) { m.add(when("shaft.speed", call("tension.pre_tension"))); },
     R"(loom: reaction "shaft.speed" -> "tension.pre_tension": "shaft.speed" is an output, not an event; name an event first)"},
    {"reaction_to_an_event", [](Table& m) { m.add(when("shaft.window", tell("weft.broken"))); },
     R"(loom: reaction "shaft.window" -> "weft.broken": "weft.broken" is an event, not an operation; name an operation second)"},
    {"reaction_signature_empty", [](Table& m) { m.add(when("weft.broken", tell("shaft.on_index"))); },
     R"(loom: reaction "weft.broken" -> "shaft.on_index": the event carries () but the operation takes (double); give both the same arguments)"},
    {"reaction_signature", [](Table& m) { m.put(when("encoder.index", tell("shaft.clear"))); },
     R"(loom: reaction "encoder.index" -> "shaft.clear": the event carries (double) but the operation takes (); give both the same arguments)"},
    {"reaction_queue_of_nothing", [](Table& m) { m.put(when("weft.broken", tell("shaft.clear", queue(0)))); },
     R"(loom: reaction "weft.broken" -> "shaft.clear": queue(0) has no room for an emission; write queue(n) with n of at least 1)"},
    {"reaction_queue_of_all",
     [](Table& m) { m.put(when("weft.broken", tell("shaft.clear", queue(0xffff'ffff)))); },
     R"(loom: reaction "weft.broken" -> "shaft.clear": queue(4294967295) is larger than the limit of 65536; write a smaller queue(n))"},
    {"event_unheard",
     [](Table& m) {
         m.add(component<Watch>("watch"));
         m.add(activity("all", every(1ms), budget(1us), runs("watch")));
     },
     R"(loom: component "watch": its event "broken" has 0 reactions but needs at least 1; add when("watch.broken", ...) to reactions(...))"},
};
INSTANTIATE_TEST_SUITE_P(reactions, Refusal, planted_into(small_loom, end_faults), name_of);

constexpr Fault call_faults[] = {
    {"reaction_across_activities", [](Table& m) { m.put(when("weft.broken", call("shaft.clear"))); },
     R"(loom: reaction "weft.broken" -> "shaft.clear": a synchronous call would run "shaft.clear" of activity "motion" in activity "logic"; use tell(...), or declare the operation any_thread if it is safe there)"},
    {"reaction_blocks", [](Table& m) { m.add(when("weft.broken", call("climate.log"))); },
     R"(loom: reaction "weft.broken" -> "climate.log": component "climate" may block; use tell(...))"},
    {"reaction_from_another_activity",
     [](Table& m) {
         m.add(component<Relay>("relay"));
         m.add(component<Notes>("panel"));
         m.add(activity("all", every(1ms), budget(1us), runs("relay", "panel")));
         m.add(when("encoder.index", call("relay.pass")));
         m.add(when("relay.passed", call("panel.note")));
     },
     R"(loom: reaction "relay.passed" -> "panel.note": activity "field" runs functions of "relay" too, and would call "panel.note" of activity "all"; use tell(...), or declare it any_thread if it is safe there)"},
};
INSTANTIATE_TEST_SUITE_P(calls_across, Refusal, planted_into(small_loom, call_faults), name_of);

// ---- handles and waits

struct Panel {
    EventHandle indexes;
    EventWait<double> next_index;
    EventWait<int> next_count;
    Event<double> opened;
    void show(double) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(event<&Panel::opened>("opened", "by hand"),
                      handle<&Panel::indexes>("indexes", "of the encoder", optional),
                      awaits<&Panel::next_index>("next_index", "of the encoder", optional),
                      operation<&Panel::show>("show", "the angle", any_thread));
    }
};
struct HeardPanel : Panel {
    static constexpr auto interface() {
        return facets(event<&Panel::opened>("broken", "must be heard", heard_by(1)),
                      handle<&Panel::indexes>("indexes", "of the encoder"),
                      operation<&Panel::show>("show", "the angle", any_thread));
    }
};
struct HandlingPanel : Panel {
    static constexpr auto interface() { return facets(handle<&Panel::indexes>("indexes", "of the encoder")); }
};
struct WaitingPanel : Panel {
    static constexpr auto interface() {
        return facets(awaits<&Panel::next_index>("next_index", "of the encoder"));
    }
};
struct CountingPanel : Panel {
    static constexpr auto interface() {
        return facets(awaits<&Panel::next_count>("next_index", "of the encoder"));
    }
};

Table loom_with_a_panel() {
    Table m = small_loom();
    m.add(component<Panel>("panel"));
    m.add(activity("all", every(1ms), budget(1us), runs("panel")));
    return m;
}

constexpr Fault handle_faults[] = {
    {"handle_unbound", [](Table& m) { m.put(component<HandlingPanel>("panel")); },
     R"(loom: component "panel": no reaction is handled by its "indexes"; add handled_by("panel.indexes") to a when(...))"},
    {"event_unheard_when_disconnected",
     [](Table& m) {
         m.put(component<HeardPanel>("panel"));
         m.add(when("panel.broken", tell("panel.show"), handled_by("panel.indexes")));
     },
     R"(loom: component "panel": its event "broken" has 0 reactions but needs at least 1; add when("panel.broken", ...) to reactions(...))"},
    {"reaction_handle_unknown",
     [](Table& m) { m.add(when("encoder.index", tell("panel.show"), handled_by("panel.index"))); },
     R"(loom: reaction "encoder.index" -> "panel.show": component "panel" has no handle of a reaction "index"; did you mean "indexes"?)"},
    {"reaction_handle_is_no_handle",
     [](Table& m) { m.add(when("encoder.index", tell("panel.show"), handled_by("panel.show"))); },
     R"(loom: reaction "encoder.index" -> "panel.show": "panel.show" is an operation; name a handle in handled_by(...))"},
    {"reaction_handle_twice",
     [](Table& m) {
         m.add(when("encoder.index", tell("panel.show"), handled_by("panel.indexes")));
         m.add(when("encoder.index", tell("panel.next_index"), handled_by("panel.indexes")));
     },
     R"(loom: reaction "encoder.index" -> "panel.next_index": its handle "panel.indexes" is already used by reaction "encoder.index" -> "panel.show"; give each row its own handle)"},
    {"reaction_disconnected_for_ever",
     [](Table& m) { m.add(when("encoder.index", tell("panel.show"), disconnected)); },
     R"(loom: reaction "encoder.index" -> "panel.show" starts disconnected and nothing can connect it; add handled_by("component.handle"))"},
};
INSTANTIATE_TEST_SUITE_P(handles, Refusal, planted_into(loom_with_a_panel, handle_faults), name_of);

constexpr Fault wait_faults[] = {
    {"reaction_calls_a_wait", [](Table& m) { m.add(when("encoder.index", call("panel.next_index"))); },
     R"(loom: reaction "encoder.index" -> "panel.next_index": "panel.next_index" waits for an event; use tell(...))"},
    {"wait_told_twice",
     [](Table& m) {
         m.add(when("encoder.index", tell("panel.next_index")));
         m.add(when("panel.opened", tell("panel.next_index")));
     },
     R"(loom: reaction "panel.opened" -> "panel.next_index": reaction "encoder.index" tells "panel.next_index" too; give each row a wait of its own)"},
    {"wait_types",
     [](Table& m) {
         m.put(component<CountingPanel>("panel"));
         m.add(when("encoder.index", tell("panel.next_index")));
     },
     R"(loom: reaction "encoder.index" -> "panel.next_index": the event carries (double) but the wait takes (int); give both the same arguments)"},
    {"wait_untold", [](Table& m) { m.put(component<WaitingPanel>("panel")); },
     R"(loom: component "panel": no reaction tells its wait "next_index"; add when("...", tell("panel.next_index")))"},
};
INSTANTIATE_TEST_SUITE_P(waits, Refusal, planted_into(loom_with_a_panel, wait_faults), name_of);

// ---- uses

struct Gauge {
    MethodCall<double(int)> force;
    static constexpr auto interface() { return facets(calls<&Gauge::force>("force", "of a press")); }
};
struct StrokeDial {
    MethodCall<int(int)> strokes;
    static constexpr auto interface() {
        return facets(calls<&StrokeDial::strokes>("strokes", "of the press"));
    }
};

constexpr Fault use_faults[] = {
    {"use_missing", [](Table& m) { m.reactions = {spare_close, spare_force, desk_force}; },
     R"(mill: component "desk": nothing is connected to its command call "close"; add uses("desk.close", "...") to reactions(...), or declare it optional)"},
    {"use_of_a_method_missing", [](Table& m) { m.reactions = {spare_close, desk_close, desk_force}; },
     R"(mill: component "spare": nothing is connected to its method call "force"; add uses("spare.force", "...") to reactions(...), or declare it optional)"},
    {"use_twice", [](Table& m) { m.add(desk_force); },
     R"(mill: use "desk.force" -> "press.force" appears twice in reactions(...), rows 4 and 5; remove one)"},
    {"use_of_two_goals",
     [](Table& m) {
         m.components = {component<Press>("left"), component<Press>("right"), component<Gauge>("desk")};
         m.activities = {activity("motion", every(1ms), budget(100us), runs("left", "right", "desk"))};
         m.reactions = {uses("desk.force", "left.force"), uses("desk.force", "right.force")};
     },
     R"(mill: use "desk.force" -> "right.force": row 1 already connects "desk.force" to "left.force"; a call has one target: remove a row, or give "desk" a second call)"},
    {"use_component_unknown", [](Table& m) { m.put(uses("desk.force", "pres.force")); },
     R"(mill: use "desk.force" -> "pres.force": there is no component "pres"; did you mean "press"?)"},
    {"use_call_unknown", [](Table& m) { m.add(uses("desk.closs", "press.close")); },
     R"(mill: use "desk.closs" -> "press.close": component "desk" has no command call "closs"; did you mean "close"?)"},
    {"use_command_unknown", [](Table& m) { m.put(uses("desk.close", "press.clos")); },
     R"(mill: use "desk.close" -> "press.clos": component "press" has no command "clos"; did you mean "close"?)"},
    {"use_method_unknown", [](Table& m) { m.put(uses("desk.force", "press.forse")); },
     R"(mill: use "desk.force" -> "press.forse": component "press" has no method "forse"; did you mean "force"?)"},
    {"use_exchanged", [](Table& m) { m.add(uses("press.close", "desk.close")); },
     R"(mill: use "press.close" -> "desk.close" runs from a command to a command call; exchange the two)"},
    {"use_by_an_event", [](Table& m) { m.add(uses("desk.tired", "press.force")); },
     R"(mill: use "desk.tired" -> "press.force": "desk.tired" is an event, not a method call or a command call; name one of these first)"},
    {"use_of_a_call", [](Table& m) { m.put(uses("desk.force", "spare.force")); },
     R"(mill: use "desk.force" -> "spare.force": "spare.force" is a method call, not a method or a command; name one of these second)"},
    {"use_of_an_operation", [](Table& m) { m.put(uses("desk.force", "press.oil")); },
     R"(mill: use "desk.force" -> "press.oil": "press.oil" is an operation, which only an event runs; declare it a method or a command)"},
    {"use_calls_a_command", [](Table& m) { m.put(uses("desk.force", "press.open")); },
     R"(mill: use "desk.force" -> "press.open": a command is sent, not called; make "desk.force" a CommandCall)"},
    {"use_sends_a_method", [](Table& m) { m.put(uses("desk.close", "press.force")); },
     R"(mill: use "desk.close" -> "press.force": a method is called, not sent; make "desk.close" a MethodCall)"},
    {"use_result", [](Table& m) { m.put(uses("desk.force", "press.strokes")); },
     R"(mill: use "desk.force" -> "press.strokes": the call and the method have different results; give both the same)"},
    {"use_across_activities",
     [](Table& m) {
         m.put(component<StrokeDial>("desk"));
         m.reactions = {spare_close, spare_force, uses("desk.strokes", "press.strokes")};
     },
     R"(mill: use "desk.strokes" -> "press.strokes": the call would run "press.strokes" of activity "motion" in activity "desk"; declare the method any_thread if it is safe there, or make it a command)"},
    {"use_of_what_may_block", [](Table& m) { m.put(uses("desk.force", "press.weigh")); },
     R"(mill: use "desk.force" -> "press.weigh": the method may block, but activity "desk" of its caller is real-time; make it a command, or call it from an activity that is not_real_time)"},
    {"command_that_may_block",
     [](Table& m) {
         m.add(component<Archive>("archive"));
         m.add(activity("archive", every(100ms), budget(1us), runs("archive")));
     },
     R"(mill: component "archive": its command "store" may block, but its activity "archive" is real-time; run it in an activity that is not_real_time)"},
    {"use_sent_by_its_own", [](Table& m) { m.put(uses("desk.close", "press.close", sent_by("desk"))); },
     R"(mill: use "desk.close" -> "press.close": sent_by(...) names the component that has the command; remove it)"},
    {"use_sent_by_unknown", [](Table& m) { m.put(uses("desk.close", "press.close", sent_by("spar"))); },
     R"(mill: use "desk.close" -> "press.close": in sent_by(...), there is no component "spar"; did you mean "spare"?)"},
    {"use_sent_by_of_a_method", [](Table& m) { m.put(uses("desk.force", "press.force", sent_by("spare"))); },
     R"(mill: use "desk.force" -> "press.force": sent_by("spare") is for commands only; remove it)"},
};
INSTANTIATE_TEST_SUITE_P(uses, Refusal, planted_into(mill, use_faults), name_of);

} // namespace
