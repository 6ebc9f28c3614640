// The control kernel: who reads, writes and calls whom, what runs by turns, and which loops can be stable.
#include "kernel/machine/table/compiled.hpp"
#include "kernel/statechart/rows.hpp"
#include "tests/diagnostics/rows/fault.hpp"
#include "tests/kernel/control/axis.hpp"

namespace {

using namespace tappet;
using namespace tappet::diagnostics;

/// Knows two models of the axis, and what it was told to do.
struct Observer {
    Input<double> measured;
    Input<double> sent;
    Output<double> speed;
    void start(const Cycle&) noexcept TAPPET_REALTIME { speed.write(0.0); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { speed.write(0.0); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { speed.write(measured.get() + sent.get()); }
    static constexpr auto interface() {
        return facets(input<&Observer::measured>("measured", "m", "the place", optional),
                      input<&Observer::sent>("sent", "m/s", "in the step before", optional),
                      output<&Observer::speed>("speed", "m/s", "estimated"));
    }
};

/// A Generator that says neither what it begins with nor what it leaves behind.
struct Careless {
    Input<double> measured;
    Output<double> target;
    MethodCall<double()> ask;
    void step(const Cycle&) noexcept TAPPET_REALTIME { target.write(measured.get()); }
    static constexpr auto interface() {
        return facets(input<&Careless::measured>("measured", "m", "the place", optional),
                      output<&Careless::target>("target", "m", "the next place"),
                      calls<&Careless::ask>("ask", "how far", optional));
    }
};

/// A Controller that others ask.
struct Asked {
    Input<double> target;
    Output<double> velocity;
    double far() noexcept TAPPET_REALTIME { return target.get(); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(0.0); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(target.get()); }
    static constexpr auto interface() {
        return facets(input<&Asked::target>("target", "m", "the next place"),
                      output<&Asked::velocity>("velocity", "m/s", "wanted"),
                      method<&Asked::far>("far", "how far"));
    }
};

struct Drive {
    static constexpr std::string_view device_kind = "test.drive";
    Input<double> driven;
    Output<double> place;
    void step(const Cycle&) noexcept TAPPET_REALTIME { place.write(driven.get()); }
    static constexpr auto interface() {
        return facets(input<&Drive::driven>("driven", "m/s", "wanted", optional),
                      output<&Drive::place>("place", "m", "measured"));
    }
};

/// Has a gain, and no role.
struct Tuned {
    Property<double> kp;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(property<&Tuned::kp>("kp", "1/s", "of nothing", range(0.0, 10.0)));
    }
};

constexpr auto moving = state_machine<Mover>("moving", states(state("on", initial), state("off", final)),
                                             transitions(transition("on", "off", after(1s))));

/// Counts in whole numbers, and somebody sees it.
struct Counter {
    Output<std::int32_t> count;
    void step(const Cycle&) noexcept TAPPET_REALTIME { count.write(count.last() + 1); }
    static constexpr auto interface() { return facets(output<&Counter::count>("count", "", "of cycles")); }
};
struct Shown {
    Input<std::int32_t> count;
    void step(const Cycle&) noexcept TAPPET_REALTIME { static_cast<void>(count.get()); }
    static constexpr auto interface() { return facets(input<&Shown::count>("count", "", "of cycles")); }
};

constexpr Board controlled_box{.name = "box", .memory_budget_bytes = 1 << 20};
constexpr Board wired_box{.name = "box",
                          .memory_budget_bytes = 1 << 20,
                          .devices = board_devices(board_device("drive0", "test.drive", "drive0"))};
constexpr Binding wired_binding = binding(wired("drive", "drive0"));

/// One level with three chains, of tests/kernel/control, with a stable loop.
Table axis() {
    static constexpr auto machine = axis_machine();
    Table table{machine.view(), controlled_box, unbound};
    table.is_controlled = true;
    table.control.levels = {axis_level};
    table.control.processes = {process("watcher")};
    table.control.exclusives = {axis_modes};
    table.components[5] = component<Follower>("position", set("kp", 200.0));
    table.control.loops = {loop("place", gain("position.kp"), transport(1ms))};
    return table;
}

/// Two levels: the outer one every 4 ms commands the inner one every 1 ms.
Table cascade() {
    static constexpr auto machine = tappet::machine(
        "cascade",
        components(component<Slide>("slide"), component<Encoder>("encoder"), component<Mover>("path"),
                   component<Follower>("outer"), component<Mover>("ramp"), component<Follower>("inner"),
                   component<Limiter>("limiter")),
        activities(
            activity("slow", every(4ms), budget(50us), runs("path", "outer")),
            activity("fast", every(1ms), budget(50us), runs("slide", "encoder", "ramp", "inner", "limiter"))),
        connections(data("slide.place", "encoder.counted"),
                    data("encoder.position", "path.measured", stale_after(20ms), stop_machine),
                    data("encoder.position", "outer.measured", stale_after(20ms), stop_machine),
                    data("path.target", "outer.target"),
                    data("limiter.sent", "outer.sent", stale_after(20ms), stop_machine),
                    data("outer.velocity", "ramp.measured", scaled(1.0), interpolated, stale_after(20ms),
                         stop_machine),
                    data("encoder.position", "inner.measured"), data("ramp.target", "inner.target"),
                    data("limiter.sent", "inner.sent", delayed), data("inner.velocity", "limiter.velocity"),
                    data("limiter.sent", "slide.driven", delayed)),
        reactions(), behaviours());
    Table table{machine.view(), controlled_box, unbound};
    table.is_controlled = true;
    table.control.levels = {level("outside", generator("path"), controller("outer", tracks("sent"))),
                            level("inside", sensor("encoder"), generator("ramp"),
                                  controller("inner", tracks("sent")), effector("limiter"))};
    return table;
}

/// A component more, in the activity of the level.
void place(Table& m, const ComponentRow& row) {
    m.add(row);
    static_cast<void>(m.activities[0].runs.push(row.name));
}
void seat(Table& m, const RoleRow& role) { static_cast<void>(m.control.levels.back().roles.push(role)); }

constexpr Fault level_faults[] = {
    {"level_of_nobody", [](Table& m) { m.control.levels.push_back(level("empty")); },
     R"(axis: level "empty": it names no component; give it its Sensor, Generator, Controller and Effector)"},
    {"level_twice", [](Table& m) { m.control.levels.push_back(axis_level); },
     R"(axis: level "axis": there are two of that name; rename one)"},
    {"role_of_nobody", [](Table& m) { m.control.levels[0].roles[0] = sensor("encodre"); },
     R"(axis: level "axis": there is no component "encodre"; did you mean "encoder"?)"},
    {"role_twice", [](Table& m) { seat(m, sensor("encoder")); },
     R"(axis: level "axis": "encoder" is a Sensor twice; name it once, and read it where it is needed)"},
    {"role_in_two_levels",
     [](Table& m) { m.control.levels.push_back(level("second", estimator("encoder"))); },
     R"(axis: level "second": "encoder" sits in level "axis" already; a component runs in one level)"},
    {"level_with_too_many", [](Table& m) { m.control.levels[0].too_many = true; },
     R"(axis: level "axis": it has more than the 24 components that it may have; make two of it)"},
    {"role_and_process", [](Table& m) { m.control.processes.push_back(process("encoder")); },
     R"(axis: control: "encoder" writes the data flow and cannot be a process component too; name it once)"},
    {"process_in_a_level", [](Table& m) { seat(m, process("slide")); },
     R"(axis: level "axis": "slide" is a process component, which serves all levels; write it beside the levels, in control(...))"},
    {"sensor_of_no_level", [](Table& m) { m.control.processes.push_back(sensor("slide")); },
     R"(axis: control: "slide" is a Sensor of no level; write it into a level(...))"},
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
     R"(axis: level "axis": its activity "motion" does not run in real time with a period; a control action has one: write every(...))"},
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
INSTANTIATE_TEST_SUITE_P(control_levels, Refusal, testing::ValuesIn(planted_into(axis, level_faults)),
                         name_of);

constexpr Fault cascade_faults[] = {
    {"cascade_of_nothing", [](Table& m) { m.control.levels.clear(); },
     R"(cascade: control: it has no level, and so no loop; add level("...", ...))"},
    {"cascade_upside_down",
     [](Table& m) {
         m.put(activity("slow", every(500us), budget(50us), runs("path", "outer")));
         m.put(data("outer.velocity", "ramp.measured", scaled(1.0), stale_after(20ms), stop_machine));
     },
     R"(cascade: level "inside": it runs every 1000 us, slower than level "outside" above it, which runs every 500 us; an inner loop is the faster one: exchange the levels, or their periods)"},

    {"one_chain",
     [](Table& m) {
         m.add(component<ChainSwitch>("mode"));
         m.put(activity("fast", every(1ms), budget(50us),
                        runs("mode", "slide", "encoder", "ramp", "inner", "limiter")));
         m.control.exclusives = {exclusive("mode", fallback("stand", "ramp"))};
     },
     R"(cascade: exclusive "mode": it has no two chains between which to hand over; add one, or leave it out)"},
    {"loop_late_by_a_row",
     [](Table& m) {
         m.components[5] = component<Follower>("inner", set("kp", 300.0));
         m.put(data("encoder.position", "inner.measured", delayed));
         m.control.loops = {loop("place", gain("inner.kp"))};
     },
     R"(cascade: loop "place": gain times period is 0.3, and the most that does not overshoot with 1 step of delay is 0.25; set inner.kp below 250, or add may_overshoot if that does no harm)"},
    {"cascade_periods",
     [](Table& m) {
         m.put(activity("slow", every(2500us), budget(50us), runs("path", "outer")));
         m.put(data("outer.velocity", "ramp.measured", scaled(1.0), stale_after(20ms), stop_machine));
     },
     R"(cascade: level "inside": its period of 1000 us does not divide that of level "outside" above it, 2500 us, so that not every command would hold for as many steps; choose periods of which one is a multiple of the other)"},
    {"cascade_without_staleness",
     [](Table& m) { m.put(data("outer.velocity", "ramp.measured", scaled(1.0))); },
     R"(cascade: connection "outer.velocity" -> "ramp.measured": it leads from activity "slow" to "fast" in a loop and does not say what holds when the writer falls silent; add stale_after(...) with hold, substitute(...) or stop_machine)"},
    {"command_in_steps",
     [](Table& m) { m.put(data("outer.velocity", "ramp.measured", scaled(1.0), stale_after(20ms), hold)); },
     R"(cascade: connection "outer.velocity" -> "ramp.measured": a command of a slower level reaches the faster one in steps or on a line; add in_steps, interpolated (later by a period) or extrapolated)"},
    {"interpolated_to_a_slower_reader",
     [](Table& m) {
         m.put(data("encoder.position", "path.measured", interpolated, stale_after(20ms), hold));
     },
     R"(cascade: connection "encoder.position" -> "path.measured": in_steps, interpolated and extrapolated are for a reader whose period divides the longer one of the writer; activity "fast" and activity "slow" are not such; remove it, or change a period)"},
    {"interpolated_whole_numbers",
     [](Table& m) {
         m.add(component<Counter>("counter"));
         m.add(component<Shown>("shown"));
         m.put(activity("slow", every(4ms), budget(50us), runs("path", "outer", "counter")));
         m.put(activity("fast", every(1ms), budget(50us),
                        runs("slide", "encoder", "ramp", "inner", "limiter", "shown")));
         m.add(data("counter.count", "shown.count", interpolated));
     },
     R"(cascade: connection "counter.count" -> "shown.count": between two values of int lie none; write in_steps, or connect a floating number)"},
    {"set_point_across_levels",
     [](Table& m) { m.put(data("path.target", "inner.target", stale_after(20ms), stop_machine)); },
     R"(cascade: connection "path.target" -> "inner.target": a Generator of level "outside" does not write for a Controller of level "inside"; set points stay in their level; let a Controller of the outer level command the inner Generator)"},
    {"outer_controller_to_effector",
     [](Table& m) { m.put(data("outer.velocity", "limiter.velocity", stale_after(20ms), stop_machine)); },
     R"(cascade: connection "outer.velocity" -> "limiter.velocity": a Controller of level "outside" does not write for an Effector of level "inside"; a level has its own Controller; let the outer one command the inner Generator)"},
    {"inner_controller_commands_outer_generator",
     [](Table& m) {
         m.put(data("inner.velocity", "path.measured", scaled(1.0), stale_after(20ms), stop_machine));
     },
     R"(cascade: connection "inner.velocity" -> "path.measured": a Controller of level "inside" does not write for a Generator of level "outside"; a Controller commands the Generator of the level right below its own)"},
};
INSTANTIATE_TEST_SUITE_P(control_cascades, Refusal, testing::ValuesIn(planted_into(cascade, cascade_faults)),
                         name_of);

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
     R"(axis: connection "encoder.position" -> "limiter.velocity": a Sensor does not write for an Effector; put a Controller between them, which makes outputs of inputs)"},
    {"generator_to_effector",
     [](Table& m) {
         place(m, component<Limiter>("second"));
         m.add(data("standing.target", "second.velocity", scaled(1.0)));
         seat(m, effector("second"));
     },
     R"(axis: connection "standing.target" -> "second.velocity": a Generator does not write for an Effector; put a Controller between them, be it one that passes set points on)"},
    {"generator_to_generator",
     [](Table& m) {
         place(m, component<Mover>("path"));
         m.add(data("standing.target", "path.measured"));
         seat(m, generator("path"));
     },
     R"(axis: connection "standing.target" -> "path.measured": a Generator does not write for a Generator; make one Generator of both, or let a Controller of the level above command it)"},
    {"controller_to_controller",
     [](Table& m) {
         place(m, component<Asked>("second"));
         m.add(data("position.velocity", "second.target", scaled(1.0)));
         seat(m, controller("second"));
     },
     R"(axis: connection "position.velocity" -> "second.target": a Controller does not write for a Controller; make two levels of it: the outer Controller commands the inner Generator)"},
    {"generator_to_estimator",
     [](Table& m) {
         place(m, component<Observer>("model"));
         m.add(data("standing.target", "model.measured"));
         seat(m, estimator("model"));
     },
     R"(axis: connection "standing.target" -> "model.measured": a Generator does not write for an Estimator; an Estimator sees inputs and the outputs of the step before; read those)"},
    {"outputs_of_this_step_to_estimator",
     [](Table& m) {
         place(m, component<Observer>("model"));
         m.add(data("position.velocity", "model.sent"));
         seat(m, estimator("model"));
     },
     R"(axis: connection "position.velocity" -> "model.sent": outputs reach an Estimator from the step before; add delayed)"},
    {"sensor_reads_the_kernel",
     [](Table& m) { m.put(data("limiter.sent", "encoder.counted", scaled(1.0), delayed)); },
     R"(axis: connection "limiter.sent" -> "encoder.counted": an Effector does not write for a Sensor; a Sensor reads hardware only)"},
    {"process_writes_the_data_flow",
     [](Table& m) {
         place(m, component<Mover>("path"));
         m.add(data("watcher.seen", "path.measured", stale_after(20ms)));
         seat(m, generator("path"));
     },
     R"(axis: connection "watcher.seen" -> "path.measured": a process component reads all of the data flow and writes none of it, so that nobody looks for the writer of a value in two places; let "watcher" command "path" by an operation)"},
    {"from_outside_past_the_sensor",
     [](Table& m) {
         place(m, component<Mover>("path"));
         m.add(data("slide.place", "path.measured"));
         seat(m, generator("path"));
     },
     R"(axis: connection "slide.place" -> "path.measured": what comes from outside of the control kernel comes by a Sensor, and "path" is a Generator; give "slide" its role in control(...), or let a Sensor bring it)"},
    {"controller_to_the_hardware",
     [](Table& m) {
         m.board = wired_box;
         m.binding = wired_binding;
         m.add(component<Drive>("drive", device("drive")));
         m.add(activity("wire", every(1ms), budget(10us), runs("drive")));
         m.add(data("position.velocity", "drive.driven", stale_after(20ms)));
     },
     R"(axis: connection "position.velocity" -> "drive.driven": only an Effector reaches the hardware, within its limits, and "position" is a Controller; let it write for an Effector)"},
    {"reader_without_a_role",
     [](Table& m) {
         place(m, component<Observer>("model"));
         m.add(data("encoder.position", "model.measured"));
     },
     R"(axis: connection "encoder.position" -> "model.measured": "model" has no role in control(...), so that nobody sees where the value goes on to; if it only looks add process(...))"},
    {"driver_that_falls_silent",
     [](Table& m) {
         m.put(activity("motion", every(1ms), budget(100us),
                        runs("mode", "encoder", "standing", "jogging", "position", "gentle", "limiter")));
         m.add(activity("wire", every(1ms), budget(10us), runs("slide")));
         for (ConnectionRow& row : m.connections)
             if (row.to == "slide.driven") row = data(row.from, row.to, stale_after(5ms), substitute(0.0));
     },
     R"(axis: connection "slide.place" -> "encoder.counted": it leads from activity "wire" to "motion" in a loop and does not say what holds when the writer falls silent; add stale_after(...) with hold, substitute(...) or stop_machine)"},
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
     R"(axis: use "path.ask" -> "second.far": a Generator does not call a Controller, so that each can be replaced alone; let a process component call it, or exchange the value by ports)"},
    {"nothing_leads_to_generator",
     [](Table& m) {
         place(m, component<Careless>("path"));
         place(m, component<Asked>("second"));
         m.add(data("path.target", "second.target"));
         seat(m, generator("path"));
         seat(m, controller("second"));
     },
     R"(axis: level "axis": nothing leads to the Generator "path"; connect an input of it with what it makes its values of)"},
    {"nobody_reads_estimator",
     [](Table& m) {
         place(m, component<Observer>("model"));
         m.add(data("encoder.position", "model.measured"));
         seat(m, estimator("model"));
     },
     R"(axis: level "axis": nobody reads what the Estimator "model" writes; connect an output of it, or leave it out)"},
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
     R"(axis: level "axis": the Generator "path" has no stop(), so that others would go on with its last value when it has stopped; write safe values there: void stop(const Cycle&) noexcept TAPPET_REALTIME)"},
};
INSTANTIATE_TEST_SUITE_P(control_flow, Refusal, testing::ValuesIn(planted_into(axis, flow_faults)), name_of);

constexpr Fault turn_faults[] = {
    {"switch_of_nobody", [](Table& m) { m.control.exclusives[0].by = "mod"; },
     R"(axis: exclusive "mod": there is no component "mod"; did you mean "mode"?)"},
    {"switch_of_another_type", [](Table& m) { m.control.exclusives[0].by = "slide"; },
     R"(axis: exclusive "slide": "slide" cannot hand over between chains; make it a component<ChainSwitch>)"},
    {"switch_without_a_row", [](Table& m) { place(m, component<ChainSwitch>("second")); },
     R"(axis: component "second" hands over between chains, and no row says which; add exclusive("second", fallback(...), chain(...)) to control(...))"},
    {"no_fallback", [](Table& m) { m.control.exclusives[0].chains[0].is_fallback = false; },
     R"(axis: exclusive "mode": what runs first, and when a part of a chain fails, is not said once; begin with fallback("...", ...), and let the others be chain(...))"},
    {"chains_of_one_name", [](Table& m) { m.control.exclusives[0].chains[2].name = "jog"; },
     R"(axis: exclusive "mode": two chains are called "jog"; rename one)"},
    {"chain_with_too_many", [](Table& m) { m.control.exclusives[0].chains[1].too_many = true; },
     R"(axis: exclusive "mode": it has more than the 12 components in a chain that it may have; make two of it)"},
    {"member_with_a_behaviour",
     [](Table& m) {
         m.add(behaviour("jogging", compiled<moving>));
         const StateMachineTable& table = m.behaviours[0].type.machine;
         m.states.assign(table.states.begin(), table.states.end());
         m.transitions.assign(table.transitions.begin(), table.transitions.end());
     },
     R"(axis: exclusive "mode": "jogging" has a behaviour, which cannot end within a step; let the process component have it)"},
    {"member_of_two",
     [](Table& m) {
         m.add(component<ChainSwitch>("second"));
         m.put(activity("motion", every(1ms), budget(100us),
                        runs("mode", "second", "slide", "encoder", "standing", "jogging", "position",
                             "gentle", "limiter")));
         m.control.exclusives.push_back(
             exclusive("second", fallback("still", "standing"), chain("on", "jogging")));
     },
     R"(axis: exclusive "mode": "standing" is a part of exclusive "second" too; keep it in one)"},
    {"chain_of_nobody",
     [](Table& m) { static_cast<void>(m.control.exclusives[0].chains[1].members.push("spindle")); },
     R"(axis: exclusive "mode": there is no component "spindle"; add it to components(...))"},
    {"chain_of_no_level",
     [](Table& m) { static_cast<void>(m.control.exclusives[0].chains[1].members.push("slide")); },
     R"(axis: exclusive "mode": "slide" has no role in a level; write it there first)"},
    {"switch_after_its_chains",
     [](Table& m) {
         m.put(activity(
             "motion", every(1ms), budget(100us),
             runs("slide", "encoder", "standing", "jogging", "position", "gentle", "limiter", "mode")));
     },
     R"(axis: exclusive "mode": "mode" runs after "standing" and would hand over in the midst of a step; name it first in runs(...))"},
    {"switch_elsewhere",
     [](Table& m) {
         m.put(activity("motion", every(1ms), budget(100us),
                        runs("slide", "encoder", "standing", "jogging", "position", "gentle", "limiter")));
         m.put(activity("watch", every(5ms), budget(100us), runs("mode", "watcher")));
     },
     R"(axis: exclusive "mode": "standing" runs in activity "motion", but "mode" in "watch"; one hands over in its own activity only, between two steps)"},
    {"chain_without_a_writer", [](Table& m) { m.control.exclusives[0].chains[1] = chain("jog", "position"); },
     R"(axis: exclusive "mode": while chain "jog" runs nobody writes "position.target"; add the component that does to the chain)"},
    {"two_writers_without_turns",
     [](Table& m) { m.control.exclusives[0].chains[1] = chain("jog", "jogging", "standing", "position"); },
     R"(axis: connection "jogging.target" -> "position.target": "position.target" is written by "standing.target" already; an input has one writer: remove one row, or use a buffer)"},
    {"member_without_start", [](Table& m) { m.components[4] = component<Careless>("jogging"); },
     R"(axis: exclusive "mode": "jogging" of chain "jog" has no start(), so that it would go on where it was when it ran last; write its first values there, made of what it reads: void start(const Cycle&) noexcept TAPPET_REALTIME)"},
    {"rows_by_turns_that_differ",
     [](Table& m) {
         for (ConnectionRow& row : m.connections)
             if (row.from == "jogging.target") row = data(row.from, row.to, initially(1.0));
     },
     R"(axis: connection "jogging.target" -> "position.target": it and "standing.target" write by turns and say different things of the input; give both rows the same options, and no scale)"},
    {"reader_by_turns_elsewhere",
     [](Table& m) {
         for (ConnectionRow& row : m.connections)
             if (row.to == "watcher.measured")
                 row = data("standing.target", "watcher.measured", stale_after(20ms));
         m.add(data("jogging.target", "watcher.measured", stale_after(20ms)));
     },
     R"(axis: connection "standing.target" -> "watcher.measured": what is written by turns is read in the writers' activity "motion" only; read what comes of it there)"},
    {"controller_that_does_not_track", [](Table& m) { m.control.levels[0].roles[4] = controller("gentle"); },
     R"(axis: level "axis": the Controller "gentle" runs by turns, or those who write for it do, and it does not see what was sent before, so that the axis would jump; connect an Effector's output to an input of it, delayed, and name that: controller("gentle", tracks("...")))"},
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
     R"(axis: level "axis": the Controller "gentle" tracks what was sent and has no start() in which it would begin there; write its first output there: void start(const Cycle&) noexcept TAPPET_REALTIME)"},
    {"tracks_no_input",
     [](Table& m) { m.control.levels[0].roles[4] = controller("gentle", tracks("velocity")); },
     R"(axis: level "axis": "gentle" has no input "velocity" by which to track; name the one that tells what was sent)"},
    {"tracks_something_else",
     [](Table& m) { m.control.levels[0].roles[4] = controller("gentle", tracks("measured")); },
     R"(axis: level "axis": what "gentle.measured" tracks does not come from an Effector, which alone knows what was sent; connect it there)"},
};
INSTANTIATE_TEST_SUITE_P(control_turns, Refusal, testing::ValuesIn(planted_into(axis, turn_faults)), name_of);

constexpr Fault loop_faults[] = {
    {"loop_of_no_gain", [](Table& m) { m.control.loops[0] = loop("place"); },
     R"(axis: loop "place": it has no gain; name the Controller's property: gain("..."))"},
    {"loop_of_a_gain_misspelt", [](Table& m) { m.control.loops[0] = loop("place", gain("position.pk")); },
     R"(axis: loop "place": component "position" has no property "pk"; did you mean "kp"?)"},
    {"loop_of_a_port", [](Table& m) { m.control.loops[0] = loop("place", gain("position.velocity")); },
     R"(axis: loop "place": "position.velocity" is no property of a number; name the one that holds the gain)"},
    {"loop_of_a_gain_unsaid", [](Table& m) { m.components[5] = component<Follower>("position"); },
     R"(axis: loop "place": the table does not say what "position.kp" is, and it decides whether the loop is stable; add set("kp", ...) to the row of "position")"},
    {"loop_of_no_controller",
     [](Table& m) {
         place(m, component<Tuned>("spare", set("kp", 1.0)));
         m.control.loops[0] = loop("place", gain("spare.kp"));
     },
     R"(axis: loop "place": "spare" is no Controller of a level; name the property of one)"},
    {"loop_too_late",
     [](Table& m) { m.control.loops[0] = loop("place", gain("position.kp"), transport(40ms)); },
     R"(axis: loop "place": its transport is more than 32 periods; sample more slowly)"},
    {"loop_of_two_controllers",
     [](Table& m) { m.control.loops[0] = loop("place", gain("position.kp"), integral("gentle.kp")); },
     R"(axis: loop "place": its two gains are of two components; name those of one)"},
    {"loop_with_ranges_beyond_it",
     [](Table& m) {
         m.components[5] = component<Follower>("position", set("kp", 1.0));
         m.control.loops[0] = loop("place", gain("position.kp"), integral("position.kp"), may_overshoot);
     },
     R"(axis: loop "place": people may set position.kp to 0 beside 999.9 of position.kp while it runs, which is not stable; give both a range of gains that are, below 2000)"},
    {"loop_turned_round",
     [](Table& m) { m.control.loops[0] = loop("place", gain("position.kp"), stiffness(-1.0)); },
     R"(axis: loop "place": its gains, stiffness and transport are to be positive; a loop that feeds back with the other sign turns it round in the Sensor)"},
    {"loop_that_is_not_stable",
     [](Table& m) {
         m.components[5] = component<Follower>("position", set("kp", 700.0));
         m.control.loops[0] = loop("place", gain("position.kp"), transport(2ms));
     },
     R"(axis: loop "place": gain times period is 0.7, and the most that is stable with 2 steps of delay is 0.618; set position.kp below 618.034, or shorten the delay)"},
    {"loop_with_a_range_beyond_it",
     [](Table& m) {
         m.components[5] = component<Follower>("position", set("kp", 100.0));
         m.control.loops[0] = loop("place", gain("position.kp"), transport(2ms));
     },
     R"(axis: loop "place": people may set position.kp to 999.9 while it runs, which is not stable; give it a range of gains that are, below 618.034)"},
    {"loop_that_overshoots",
     [](Table& m) { m.components[5] = component<Follower>("position", set("kp", 300.0)); },
     R"(axis: loop "place": gain times period is 0.3, and the most that does not overshoot with 1 step of delay is 0.25; set position.kp below 250, or add may_overshoot if that does no harm)"},
    {"contact_that_bounces",
     [](Table& m) {
         m.components[5] = component<Follower>("position", set("kp", 3.15e-3));
         m.control.loops[0] = loop("contact", gain("position.kp"), stiffness(2.0e5), transport(2ms));
     },
     R"(axis: loop "contact": gain times period is 0.63, and the most that is stable with 2 steps of delay is 0.618; set position.kp below 3.09e-3, or shorten the delay)"},
    {"loop_that_overshoots_by_its_integral",
     [](Table& m) {
         m.control.loops[0] = loop("place", gain("position.kp"), integral("position.kp"), transport(1ms));
     },
     R"(axis: loop "place": with an integral around an axis it overshoots after each step of the set point; add may_overshoot if that does no harm, or leave the integral out)"},
    {"loop_with_too_much_integral",
     [](Table& m) {
         m.control.loops[0] =
             loop("place", gain("position.kp"), integral("position.kp"), stiffness(1.0), transport(1ms));
         m.components[5] = component<Follower>("position", set("kp", 999.7));
     },
     R"(axis: loop "place": it is not stable with an integral gain of 999.7; set position.kp lower)"},
};
INSTANTIATE_TEST_SUITE_P(control_loops, Refusal, testing::ValuesIn(planted_into(axis, loop_faults)), name_of);

} // namespace
