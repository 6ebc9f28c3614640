// The control kernel: the roles in each level, and the reads, writes and calls between them.
#include "tests/diagnostics/controlled.hpp"

namespace {

using namespace tappet;
using namespace tappet::diagnostics;

constexpr Fault level_faults[] = {
    {"level_of_nobody", [](Table& m) { m.control.levels.push_back(level("empty")); },
     R"(axis: level "empty": it names no component; give it its Sensor, Generator, Controller and Effector)"},
    {"level_twice", [](Table& m) { m.control.levels.push_back(axis_level); },
     R"(axis: level "axis": another level has this name; rename one)"},
    {"role_of_nobody", [](Table& m) { m.control.levels[0].roles[0] = sensor("encodre"); },
     R"(axis: level "axis": there is no component "encodre"; did you mean "encoder"?)"},
    {"role_twice", [](Table& m) { seat(m, sensor("encoder")); },
     R"(axis: level "axis": "encoder" is a Sensor twice; name it once, and read it where it is needed)"},
    {"role_in_two_levels",
     [](Table& m) { m.control.levels.push_back(level("second", estimator("encoder"))); },
     R"(axis: level "second": "encoder" is in level "axis" already; a component runs in one level)"},
    {"level_with_too_many", [](Table& m) { m.control.levels[0].too_many = true; },
     R"(axis: level "axis": it has more than 24 components; split it in two)"},
    {"role_and_process", [](Table& m) { m.control.processes.push_back(process("encoder")); },
     R"(axis: control: "encoder" is part of the data flow and cannot also be a process component; name it once)"},
    {"process_in_a_level", [](Table& m) { seat(m, process("slide")); },
     R"(axis: level "axis": "slide" is a process component, which serves all levels; write it beside the levels, in control(...))"},
    {"sensor_of_no_level", [](Table& m) { m.control.processes.push_back(sensor("slide")); },
     R"(axis: control: "slide" is a Sensor outside of a level; move it into a level(...))"},
    {"level_in_two_activities",
     [](Table& m) {
         seat(m, estimator("watcher"));
         m.control.processes.clear();
     },
     R"(axis: level "axis": "encoder" runs in activity "motion", but "watcher" in "watch"; let one activity run all of a level, so that each sees this step's values)"},
    {"level_that_blocks",
     [](Table& m) {
         m.put(activity(
             "motion", every(1ms), not_real_time,
             runs("mode", "slide", "encoder", "standing", "jogging", "position", "gentle", "limiter")));
     },
     R"(axis: level "axis": its activity "motion" is not a periodic real-time activity, which control needs; write every(...))"},
    {"level_without_sensor", [](Table& m) { m.control.levels[0].roles[0] = estimator("encoder"); },
     R"(axis: control: no level has a Sensor, so that nothing is fed back; add sensor("..."))"},
    {"level_without_controller",
     [](Table& m) {
         m.control.levels[0] = level("axis", sensor("encoder"), generator("standing"), effector("limiter"));
     },
     R"(axis: level "axis": it has no Controller, which makes outputs of set points and inputs; add controller("..."))"},
    {"level_without_effector",
     [](Table& m) {
         m.control.levels[0] =
             level("axis", sensor("encoder"), generator("standing"), controller("position"));
     },
     R"(axis: level "axis": it is the innermost and has no Effector, so that nothing reaches the hardware; add effector("..."))"},
};
INSTANTIATE_TEST_SUITE_P(control_levels, Refusal, planted_into(axis, level_faults), name_of);

constexpr Fault cascade_faults[] = {
    {"cascade_of_nothing", [](Table& m) { m.control.levels.clear(); },
     R"(cascade: control: it has no level, and so no loop; add level("...", ...))"},
    {"cascade_upside_down",
     [](Table& m) {
         m.put(activity("slow", every(500us), budget(50us), runs("path", "outer")));
         m.put(data("outer.velocity", "ramp.measured", scaled(1.0), stale_after(20ms), stop_machine));
     },
     R"(cascade: level "inside": it runs every 1000 us, slower than level "outside" above it, which runs every 500 us; an inner loop must not be slower: exchange the levels, or their periods)"},

    {"one_chain",
     [](Table& m) {
         m.add(component<ChainSwitch>("mode"));
         m.put(activity("fast", every(1ms), budget(50us),
                        runs("mode", "slide", "encoder", "ramp", "inner", "limiter")));
         m.control.exclusives = {exclusive("mode", fallback("stand", "ramp"))};
     },
     R"(cascade: exclusive "mode": it has fewer than two chains to switch between; add one, or leave it out)"},
    {"loop_late_by_a_row",
     [](Table& m) {
         m.components[5] = component<Follower>("inner", set("kp", 300.0));
         m.put(data("encoder.position", "inner.measured", delayed));
         m.control.loops = {loop("place", gain("inner.kp"))};
     },
     R"(cascade: loop "place": gain times period is 0.315 at the longest period, but with 1 step of delay the loop overshoots above 0.25; set inner.kp below 238.095, or add may_overshoot if that does no harm)"},
    {"loop_of_a_slow_sensor",
     [](Table& m) {
         m.components[5] = component<Follower>("inner", set("kp", 240.0));
         m.add(component<Encoder>("gauge"));
         m.put(activity("slow", every(4ms), budget(50us), runs("gauge", "path", "outer")));
         m.add(data("slide.place", "gauge.counted", stale_after(20ms), stop_machine));
         m.put(data("gauge.position", "inner.measured", in_steps, stale_after(20ms), stop_machine));
         m.control.levels[0] =
             level("outside", sensor("gauge"), generator("path"), controller("outer", tracks("sent")));
         m.control.loops = {loop("place", gain("inner.kp"))};
     },
     R"(cascade: loop "place": gain times period is 0.252 at the longest period, but with 5 steps of varying delay the loop overshoots above 6.698e-2; set inner.kp below 63.79, or add may_overshoot if that does no harm)"},
    {"cascade_periods",
     [](Table& m) {
         m.put(activity("slow", every(2500us), budget(50us), runs("path", "outer")));
         m.put(data("outer.velocity", "ramp.measured", scaled(1.0), stale_after(20ms), stop_machine));
     },
     R"(cascade: level "inside": its period of 1000 us does not divide that of level "outside" above it, 2500 us, so that commands would hold for different numbers of steps; choose periods of which one is a multiple of the other)"},
    {"cascade_without_staleness",
     [](Table& m) { m.put(data("outer.velocity", "ramp.measured", scaled(1.0))); },
     R"(cascade: connection "outer.velocity" -> "ramp.measured": it leads from activity "slow" to "fast" in a loop but does not say what to do when the writer falls silent; add stale_after(...) with hold, substitute(...) or stop_machine)"},
    {"command_in_steps",
     [](Table& m) { m.put(data("outer.velocity", "ramp.measured", scaled(1.0), stale_after(20ms), hold)); },
     R"(cascade: connection "outer.velocity" -> "ramp.measured": it does not say how the faster level reads a command of the slower one; add in_steps, interpolated (one period later) or extrapolated)"},
    {"interpolated_to_a_slower_reader",
     [](Table& m) {
         m.put(data("encoder.position", "path.measured", interpolated, stale_after(20ms), hold));
     },
     R"(cascade: connection "encoder.position" -> "path.measured": in_steps, interpolated and extrapolated need a writer whose period is a larger multiple of the reader's; this is not the case from activity "fast" to activity "slow"; remove the option, or change a period)"},
    {"interpolated_whole_numbers",
     [](Table& m) {
         m.add(component<Cycles>("counter"), "slow");
         m.add(component<CyclesShown>("shown"), "fast");
         m.add(data("counter.count", "shown.count", interpolated));
     },
     R"(cascade: connection "counter.count" -> "shown.count": int cannot be interpolated; write in_steps, or connect a floating-point value)"},
    {"set_point_across_levels",
     [](Table& m) { m.put(data("path.target", "inner.target", stale_after(20ms), stop_machine)); },
     R"(cascade: connection "path.target" -> "inner.target": a Generator of level "outside" must not write to a Controller of level "inside"; set points stay in their level; let a Controller of the outer level command the inner Generator)"},
    {"outer_controller_to_effector",
     [](Table& m) { m.put(data("outer.velocity", "limiter.velocity", stale_after(20ms), stop_machine)); },
     R"(cascade: connection "outer.velocity" -> "limiter.velocity": a Controller of level "outside" must not write to an Effector of level "inside"; a level has its own Controller; let the outer one command the inner Generator)"},
    {"inner_controller_commands_outer_generator",
     [](Table& m) {
         m.put(data("inner.velocity", "path.measured", scaled(1.0), stale_after(20ms), stop_machine));
     },
     R"(cascade: connection "inner.velocity" -> "path.measured": a Controller of level "inside" must not write to a Generator of level "outside"; a Controller commands the Generator of the level directly below its own; connect that one, if there is one)"},
};
INSTANTIATE_TEST_SUITE_P(control_cascades, Refusal, planted_into(cascade, cascade_faults), name_of);

constexpr Fault flow_faults[] = {
    {"sensor_to_effector",
     [](Table& m) {
         m.control.exclusives.clear();
         std::erase_if(m.connections, [](const ConnectionRow& row) {
             return row.to == "position.target" || row.to == "gentle.target" || row.to == "limiter.velocity";
         });
         m.add(data("encoder.position", "limiter.velocity", scaled(1.0)));
         m.components[0] = component<Observer>("mode");
         m.reactions.clear();
         m.add(data("standing.target", "position.target"));
         m.add(data("jogging.target", "gentle.target"));
     },
     R"(axis: connection "encoder.position" -> "limiter.velocity": a Sensor must not write to an Effector; put a Controller between them, which turns inputs into outputs)"},
    {"generator_to_effector",
     [](Table& m) {
         seat(m, component<Limiter>("second"), effector("second"),
              data("standing.target", "second.velocity", scaled(1.0)));
     },
     R"(axis: connection "standing.target" -> "second.velocity": a Generator must not write to an Effector; put a Controller between them, even if it only passes set points on)"},
    {"generator_to_generator",
     [](Table& m) {
         seat(m, component<Mover>("path"), generator("path"), data("standing.target", "path.measured"));
     },
     R"(axis: connection "standing.target" -> "path.measured": a Generator must not write to a Generator; merge both into one Generator, or let a Controller of the level above command it)"},
    {"controller_to_controller",
     [](Table& m) {
         seat(m, component<Asked>("second"), controller("second"),
              data("position.velocity", "second.target", scaled(1.0)));
     },
     R"(axis: connection "position.velocity" -> "second.target": a Controller must not write to a Controller; make two levels of it: the outer Controller commands the inner Generator)"},
    {"generator_to_estimator",
     [](Table& m) {
         seat(m, component<Observer>("model"), estimator("model"), data("standing.target", "model.measured"));
     },
     R"(axis: connection "standing.target" -> "model.measured": a Generator must not write to an Estimator; an Estimator reads inputs and the outputs of the previous step; connect those)"},
    {"outputs_of_this_step_to_estimator",
     [](Table& m) {
         seat(m, component<Observer>("model"), estimator("model"), data("position.velocity", "model.sent"));
     },
     R"(axis: connection "position.velocity" -> "model.sent": an Estimator reads outputs only from the previous step; add delayed)"},
    {"sensor_reads_the_kernel",
     [](Table& m) { m.put(data("limiter.sent", "encoder.counted", scaled(1.0), delayed)); },
     R"(axis: connection "limiter.sent" -> "encoder.counted": an Effector must not write to a Sensor; a Sensor reads hardware only; connect its input to a driver, or leave it out if it is optional)"},
    {"effector_to_effector",
     [](Table& m) {
         seat(m, component<Limiter>("second"), effector("second"), data("limiter.sent", "second.velocity"));
     },
     R"(axis: connection "limiter.sent" -> "second.velocity": an Effector must not write to an Effector; let a Controller write the value)"},
    {"process_writes_the_data_flow",
     [](Table& m) {
         seat(m, component<Mover>("path"), generator("path"),
              data("watcher.seen", "path.measured", stale_after(20ms)));
     },
     R"(axis: connection "watcher.seen" -> "path.measured": a process component may read the data flow but must not write to it; let "watcher" command "path" with an operation)"},
    {"from_outside_past_the_sensor",
     [](Table& m) {
         seat(m, component<Mover>("path"), generator("path"), data("slide.place", "path.measured"));
     },
     R"(axis: connection "slide.place" -> "path.measured": a value from outside of control(...) must enter through a Sensor, but "path" is a Generator; give "slide" a role in control(...), or read the value with a Sensor)"},
    {"controller_to_the_hardware",
     [](Table& m) {
         m.board = wired_box;
         m.binding = wired_binding;
         m.add(component<Drive>("drive", device("drive")));
         m.add(activity("wire", every(1ms), budget(10us), runs("drive")));
         m.add(data("position.velocity", "drive.driven", stale_after(20ms)));
     },
     R"(axis: connection "position.velocity" -> "drive.driven": only an Effector may write to hardware, within its limits, but "position" is a Controller; let it write to an Effector)"},
    {"reader_without_a_role",
     [](Table& m) {
         place(m, component<Observer>("model"));
         m.add(data("encoder.position", "model.measured"));
     },
     R"(axis: connection "encoder.position" -> "model.measured": "model" has no role in control(...), so that the value cannot be followed further; if it only observes, add process(...))"},
    {"driver_that_falls_silent",
     [](Table& m) {
         m.put(activity("motion", every(1ms), budget(100us),
                        runs("mode", "encoder", "standing", "jogging", "position", "gentle", "limiter")));
         m.add(activity("wire", every(1ms), budget(10us), runs("slide")));
         for (ConnectionRow& row : m.connections)
             if (row.to == "slide.driven") row = data(row.from, row.to, stale_after(5ms), substitute(0.0));
     },
     R"(axis: connection "slide.place" -> "encoder.counted": it leads from activity "wire" to "motion" in a loop but does not say what to do when the writer falls silent; add stale_after(...) with hold, substitute(...) or stop_machine)"},
    {"controller_called_by_generator",
     [](Table& m) {
         place(m, component<Careless>("path"));
         place(m, component<Asked>("second"));
         m.add(data("standing.target", "second.target"));
         m.add(data("encoder.position", "path.measured"));
         m.add(uses("path.ask", "second.far"));
         seat(m, generator("path"));
         seat(m, controller("second"));
     },
     R"(axis: use "path.ask" -> "second.far": a Generator must not call a Controller, so that each can be replaced alone; call it from a process component, or exchange the value through ports)"},
    {"nothing_leads_to_generator",
     [](Table& m) {
         place(m, component<Careless>("path"));
         place(m, component<Asked>("second"));
         m.add(data("path.target", "second.target"));
         seat(m, generator("path"));
         seat(m, controller("second"));
     },
     R"(axis: level "axis": no connection leads to the Generator "path"; connect one of its inputs)"},
    {"nobody_reads_estimator",
     [](Table& m) {
         seat(m, component<Observer>("model"), estimator("model"),
              data("encoder.position", "model.measured"));
     },
     R"(axis: level "axis": no component reads the outputs of the Estimator "model"; connect one of them, or leave it out)"},
    {"no_safe_values",
     [](Table& m) {
         place(m, component<Careless>("path"));
         place(m, component<Asked>("second"));
         m.add(data("encoder.position", "path.measured"));
         m.add(data("path.target", "second.target"));
         seat(m, generator("path"));
         seat(m, controller("second"));
         m.add(data("second.velocity", "watcher.measured", scaled(1.0)));
         m.connections.erase(m.connections.begin() + 14);
     },
     R"(axis: level "axis": the Generator "path" has no stop(), so that its readers would continue with its last value after it stopped; add one that writes safe values: void stop(const Cycle&) noexcept TAPPET_REALTIME)"},
};
INSTANTIATE_TEST_SUITE_P(control_flow, Refusal, planted_into(axis, flow_faults), name_of);

} // namespace
