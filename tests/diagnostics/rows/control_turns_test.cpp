// The control kernel: components that take turns, and the stability of loops.
#include "tests/diagnostics/controlled.hpp"

namespace {

using namespace tappet;
using namespace tappet::diagnostics;

/// Process components that take turns in answering a call, and their caller.
struct Answering {
    double far() noexcept TAPPET_REALTIME { return 1.0; }
    static constexpr auto interface() { return facets(method<&Answering::far>("far", "how far")); }
};
struct Asking {
    MethodCall<double()> ask;
    static constexpr auto interface() { return facets(calls<&Asking::ask>("ask", "how far")); }
};
/// Reads the sent value in another size than it writes.
struct Misread : Follower {
    static constexpr auto interface() {
        return facets(
            input<&Misread::target>("target", "m", "the next place"),
            input<&Misread::measured>("measured", "m", "the place"),
            input<&Misread::sent>("sent", "mm/s", "in the step before"),
            output<&Misread::velocity>("velocity", "m/s", "wanted"),
            property<&Misread::kp>("kp", "1/s", "speed for each unit of the error", range(0.0, 999.9)));
    }
};
void answer_by_turns(Table& m, const ExclusiveRow& row) {
    m.add(component<ChainSwitch>("gauge"));
    m.put(activity(
        "motion", every(1ms), budget(100us),
        runs("gauge", "mode", "slide", "encoder", "standing", "jogging", "position", "gentle", "limiter")));
    for (const std::string_view name : {"drawn", "measured"}) {
        place(m, component<Answering>(name));
        m.control.processes.push_back(process(name));
    }
    place(m, component<Asking>("asker"));
    m.add(uses("asker.ask", "drawn.far"));
    m.add(uses("asker.ask", "measured.far"));
    m.control.exclusives.push_back(row);
}

constexpr Fault turn_faults[] = {
    {"call_that_nobody_answers_for_a_while",
     [](Table& m) {
         answer_by_turns(m, exclusive("gauge", fallback("drawn", "drawn"), chain("measured", "measured"),
                                      chain("neither")));
     },
     R"(axis: exclusive "gauge": while chain "neither" runs, no component answers "asker.ask"; add one that does to the chain, and a row uses(...) to it)"},
    {"call_of_two_who_answer_at_once",
     [](Table& m) {
         answer_by_turns(m, exclusive("gauge", fallback("both", "drawn", "measured"), chain("one", "drawn")));
     },
     R"(axis: use "asker.ask" -> "measured.far": row 4 already connects "asker.ask" to "drawn.far"; a call has one target: remove a row, or give "asker" a second call)"},
    {"switch_of_nobody", [](Table& m) { m.control.exclusives[0].by = "mod"; },
     R"(axis: exclusive "mod": there is no component "mod"; did you mean "mode"?)"},
    {"switch_of_another_type", [](Table& m) { m.control.exclusives[0].by = "slide"; },
     R"(axis: exclusive "slide": "slide" cannot switch chains; make it a component<ChainSwitch>)"},
    {"switch_without_a_row", [](Table& m) { place(m, component<ChainSwitch>("second")); },
     R"(axis: component "second" switches chains, but no row says which; add exclusive("second", fallback(...), chain(...)) to control(...))"},
    {"no_fallback", [](Table& m) { m.control.exclusives[0].chains[0].is_fallback = false; },
     R"(axis: exclusive "mode": it needs exactly one fallback(...), which runs first and when a chain fails; begin with fallback("...", ...), and write chain(...) for the others)"},
    {"chains_of_one_name", [](Table& m) { m.control.exclusives[0].chains[2].name = "jog"; },
     R"(axis: exclusive "mode": two chains are called "jog"; rename one)"},
    {"chain_with_too_many", [](Table& m) { m.control.exclusives[0].chains[1].too_many = true; },
     R"(axis: exclusive "mode": it has more than 12 components in a chain; split it in two)"},
    {"member_with_a_behaviour",
     [](Table& m) {
         m.add(behaviour("jogging", compiled<moving>));
         const StateMachineTable& table = m.behaviours[0].type.machine;
         m.states.assign(table.states.begin(), table.states.end());
         m.transitions.assign(table.transitions.begin(), table.transitions.end());
     },
     R"(axis: exclusive "mode": "jogging" has a behaviour, which cannot end within a step; give the behaviour to the process component)"},
    {"member_of_two",
     [](Table& m) {
         m.add(component<ChainSwitch>("second"));
         m.put(activity("motion", every(1ms), budget(100us),
                        runs("mode", "second", "slide", "encoder", "standing", "jogging", "position",
                             "gentle", "limiter")));
         m.control.exclusives.push_back(
             exclusive("second", fallback("still", "standing"), chain("on", "jogging")));
     },
     R"(axis: exclusive "mode": "standing" is also in exclusive "second"; keep it in one)"},
    {"chain_of_nobody",
     [](Table& m) { static_cast<void>(m.control.exclusives[0].chains[1].members.push("spindle")); },
     R"(axis: exclusive "mode": there is no component "spindle"; add it to components(...))"},
    {"chain_of_no_level",
     [](Table& m) { static_cast<void>(m.control.exclusives[0].chains[1].members.push("slide")); },
     R"(axis: exclusive "mode": "slide" has no role in control(...); give it one first)"},
    {"switch_after_its_chains",
     [](Table& m) {
         m.put(activity(
             "motion", every(1ms), budget(100us),
             runs("slide", "encoder", "standing", "jogging", "position", "gentle", "limiter", "mode")));
     },
     R"(axis: exclusive "mode": "mode" runs after "standing" and would switch in the middle of a step; name it first in runs(...))"},
    {"switch_elsewhere",
     [](Table& m) {
         m.put(activity("motion", every(1ms), budget(100us),
                        runs("slide", "encoder", "standing", "jogging", "position", "gentle", "limiter")));
         m.put(activity("watch", every(5ms), budget(100us), runs("mode", "watcher")));
     },
     R"(axis: exclusive "mode": "standing" runs in activity "motion", but "mode" in "watch"; it can switch in its own activity only; run both in one activity)"},
    {"chain_without_a_writer", [](Table& m) { m.control.exclusives[0].chains[1] = chain("jog", "position"); },
     R"(axis: exclusive "mode": while chain "jog" runs, no component writes "position.target"; add one that does to the chain)"},
    {"two_writers_without_turns",
     [](Table& m) { m.control.exclusives[0].chains[1] = chain("jog", "jogging", "standing", "position"); },
     R"(axis: connection "jogging.target" -> "position.target": "position.target" is written by "standing.target" already; an input has one writer: remove one row, or use a buffer)"},
    {"member_without_start", [](Table& m) { m.components[4] = component<Careless>("jogging"); },
     R"(axis: exclusive "mode": "jogging" of chain "jog" has no start(), so that it would continue from its last run; add one that writes first values from its inputs: void start(const Cycle&) noexcept TAPPET_REALTIME)"},
    {"rows_by_turns_that_differ",
     [](Table& m) {
         for (ConnectionRow& row : m.connections)
             if (row.from == "jogging.target") row = data(row.from, row.to, initially(1.0));
     },
     R"(axis: connection "jogging.target" -> "position.target": this row and "standing.target" write in different chains but have different options; give both rows the same options, and no scale)"},
    {"reader_by_turns_elsewhere",
     [](Table& m) {
         for (ConnectionRow& row : m.connections)
             if (row.to == "watcher.measured")
                 row = data("standing.target", "watcher.measured", stale_after(20ms));
         m.add(data("jogging.target", "watcher.measured", stale_after(20ms)));
     },
     R"(axis: connection "standing.target" -> "watcher.measured": a value that several chains write can be read only in their activity "motion"; connect a value derived from it there)"},
    {"controller_that_does_not_track", [](Table& m) { m.control.levels[0].roles[4] = controller("gentle"); },
     R"(axis: level "axis": the Controller "gentle" or one of its writers runs in a chain, but it does not know what was sent last, so that the axis would jump; connect an Effector's output to one of its inputs, delayed, and name that input: controller("gentle", tracks("...")))"},
    {"tracks_without_start",
     [](Table& m) {
         m.control.exclusives[0].chains[0] = fallback("stand", "standing");
         m.control.exclusives[0].chains[1] = chain("jog", "jogging");
         m.control.exclusives[0].chains.used = 2;
         m.components[6] = component<Asked>("gentle");
         std::erase_if(m.connections, [](const ConnectionRow& row) {
             return row.to == "gentle.measured" || row.to == "gentle.sent" || row.from == "gentle.velocity";
         });
         m.control.levels[0].roles[4] = controller("gentle", tracks("target"));
     },
     R"(axis: level "axis": the Controller "gentle" tracks what was sent but has no start(); add one that writes the first output from it: void start(const Cycle&) noexcept TAPPET_REALTIME)"},
    {"tracks_no_input",
     [](Table& m) { m.control.levels[0].roles[4] = controller("gentle", tracks("velocity")); },
     R"(axis: level "axis": "gentle" has no input "velocity" to track; name the one that receives what was sent)"},
    {"tracks_something_else",
     [](Table& m) { m.control.levels[0].roles[4] = controller("gentle", tracks("measured")); },
     R"(axis: level "axis": "gentle.measured" tracks a value that does not come from an Effector, which alone knows what was sent; connect it to one)"},
    {"tracks_in_another_unit",
     [](Table& m) {
         m.components[6] = component<Misread>("gentle");
         m.put(data("limiter.sent", "gentle.sent", delayed, converted));
     },
     R"(axis: level "axis": "gentle.sent" tracks in mm/s, and "gentle.velocity" writes in m/s; give both the unit of what is sent)"},
};
INSTANTIATE_TEST_SUITE_P(control_turns, Refusal, planted_into(axis, turn_faults), name_of);

void gain_of(Table& m, double position, const LoopRow& row) {
    m.components[5] = component<Follower>("position", set("kp", position));
    m.control.loops[0] = row;
}

constexpr Fault loop_faults[] = {
    {"loop_of_no_gain", [](Table& m) { m.control.loops[0] = loop("place"); },
     R"(axis: loop "place": it has no gain; name the Controller's property: gain("..."))"},
    {"loop_of_a_gain_misspelt", [](Table& m) { m.control.loops[0] = loop("place", gain("position.pk")); },
     R"(axis: loop "place": component "position" has no property "pk"; did you mean "kp"?)"},
    {"loop_of_a_port", [](Table& m) { m.control.loops[0] = loop("place", gain("position.velocity")); },
     R"(axis: loop "place": "position.velocity" is not a property that is a number; name the one that holds the gain)"},
    {"loop_of_a_gain_unsaid", [](Table& m) { m.components[5] = component<Follower>("position"); },
     R"(axis: loop "place": the table does not set "position.kp", which decides whether the loop is stable; add set("kp", ...) to the row of "position")"},
    {"loop_of_no_controller",
     [](Table& m) {
         place(m, component<Tuned>("spare", set("kp", 1.0)));
         m.control.loops[0] = loop("place", gain("spare.kp"));
     },
     R"(axis: loop "place": "spare" is not a Controller of a level; name the property of one)"},
    {"loop_too_late",
     [](Table& m) { m.control.loops[0] = loop("place", gain("position.kp"), transport(40ms)); },
     R"(axis: loop "place": its transport is more than 32 periods; sample more slowly)"},
    {"loop_too_late_for_ever",
     [](Table& m) { m.control.loops[0] = loop("place", gain("position.kp"), transport(Duration::max())); },
     R"(axis: loop "place": its transport is more than 32 periods; sample more slowly)"},
    {"loop_of_two_controllers",
     [](Table& m) { m.control.loops[0] = loop("place", gain("position.kp"), integral("gentle.kp")); },
     R"(axis: loop "place": its two gains belong to different components; name two of one component)"},
    {"loop_with_ranges_beyond_it",
     [](Table& m) {
         gain_of(m, 1.0, loop("place", gain("position.kp"), integral("position.kp"), may_overshoot));
     },
     R"(axis: loop "place": people may set position.kp to 0 and position.kp to 900 while it runs, which is not stable; give both a range of stable gains, below 1818.182)"},
    {"loop_turned_round",
     [](Table& m) { m.control.loops[0] = loop("place", gain("position.kp"), stiffness(-1.0)); },
     R"(axis: loop "place": its gains, stiffness and transport must be positive; if the feedback has the other sign, invert it in the Sensor)"},
    {"loop_that_is_not_stable",
     [](Table& m) { gain_of(m, 700.0, loop("place", gain("position.kp"), transport(2ms))); },
     R"(axis: loop "place": gain times period is 0.77 at the longest period, but with 2 steps of delay the loop is stable only below 0.618; set position.kp below 561.849, or shorten the delay)"},
    {"loop_with_a_range_beyond_it",
     [](Table& m) { gain_of(m, 100.0, loop("place", gain("position.kp"), transport(2ms))); },
     R"(axis: loop "place": people may set position.kp to 900 while it runs, which is not stable; give it a range of stable gains, below 561.849)"},
    {"loop_that_overshoots",
     [](Table& m) { m.components[5] = component<Follower>("position", set("kp", 300.0)); },
     R"(axis: loop "place": gain times period is 0.33 at the longest period, but with 1 step of delay the loop overshoots above 0.25; set position.kp below 227.273, or add may_overshoot if that does no harm)"},
    {"contact_that_bounces",
     [](Table& m) {
         gain_of(m, 3.15e-3, loop("contact", gain("position.kp"), stiffness(2.0e5), transport(2ms)));
     },
     R"(axis: loop "contact": gain times period is 0.693 at the longest period, but with 2 steps of delay the loop is stable only below 0.618; set position.kp below 2.809e-3, or shorten the delay)"},
    {"loop_that_overshoots_by_its_integral",
     [](Table& m) {
         m.control.loops[0] = loop("place", gain("position.kp"), integral("position.kp"), transport(1ms));
     },
     R"(axis: loop "place": with an integral around an axis it overshoots after each step of the set point; add may_overshoot if that does no harm, or leave the integral out)"},
    {"loop_with_too_much_integral",
     [](Table& m) {
         gain_of(m, 404.5,
                 loop("place", gain("position.kp"), integral("position.kp"), stiffness(1.0), transport(3ms)));
     },
     R"(axis: loop "place": it is not stable with an integral gain of 404.5; set position.kp lower)"},
};
INSTANTIATE_TEST_SUITE_P(control_loops, Refusal, planted_into(axis, loop_faults), name_of);

} // namespace
