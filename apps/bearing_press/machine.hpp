// A press seats bearings in their housings: one axis under position or force control. The machine on a page.
#pragma once

#include "apps/bearing_press/axis.hpp"
#include "apps/bearing_press/loops.hpp"
#include "drivers/can/restarter.hpp"
#include "drivers/instruments/encoder.hpp"
#include "drivers/instruments/force_sensor.hpp"
#include "drivers/instruments/velocity_axis.hpp"
#include "kernel/control/control.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"

namespace bearing_press {

// clang-format off
inline constexpr auto table = machine("bearing-press",
    components(
        component<can::Bus<can_signals>>("can", device("axis-can")),
        component<gpio::LinePort<io_lines>>("io", device("panel-io")),
        component<ChainSwitch>("mode"),
        component<instruments::Encoder<"m">>("gauge", set("counts_per_unit", 1e6)),
        component<instruments::ForceSensor>("cell", set("most", 5000.0)),
        component<Speed>("speed"),
        component<Idle>("idle"), component<Standing>("standing"), component<Jogging>("jogging"), component<Path>("path"), component<Approach>("approach"),
        component<Place>("place", set("kp", 20.0)), component<Press>("press", set("kf", 1e-5)),
        component<Ramp>("ramp"), component<Trim>("trim"),
        component<instruments::VelocityAxis<"m/s">>("drive", set("most", fastest)),
        component<Axis>("axis"),                                    // the press's state machine
        component<can::Restarter>("restarter", device("axis-can")),
        component<BrowserService>("browser")),
    activities( // threads; their priorities follow from the deadlines
        activity("can",       on_device("can"), at_most(4, 1ms), runs("can"), deadline(300us), budget(30us)),
        activity("loops",     every(1ms, phase(300us)),                       deadline(600us), budget(60us),
            runs("mode", "gauge", "cell", "speed", "idle", "standing", "jogging", "path", "approach", "place", "press", "ramp", "trim", "drive")),
        activity("io",        on_device("io"),  at_most(4, 1ms), runs("io"),  deadline(900us), budget(16us)),
        activity("axis",      every(5ms),                        runs("axis"), budget(30us)),
        activity("restarter", every(100ms), not_real_time,       runs("restarter")),
        activity("browser",   every(20ms), not_real_time,        runs("browser"), stack(224 * 1024))),
    connections( // data flow
        data("can.axis.position", "gauge.counts",  stale_after(20ms), hold), // when stale, axis.statusword stops the drive
        data("can.cell.force",    "cell.measured", stale_after(20ms), stop_machine),
        data("gauge.position", "speed.position"),
        data("gauge.position", "idle.position"),
        data("gauge.position", "standing.position"), data("drive.velocity", "standing.sent", delayed),
        data("gauge.position", "jogging.position"),  data("drive.velocity", "jogging.sent",  delayed),
        data("gauge.position", "path.position"),     data("gauge.position", "approach.position"),
        data("gauge.position", "place.position"),    data("drive.velocity", "place.sent",    delayed),
        data("cell.force",     "press.force"),       data("drive.velocity", "press.sent",    delayed),
        data("idle.target",     "place.target"),     data("idle.speed",     "place.speed"),
        data("standing.target", "place.target"),     data("standing.speed", "place.speed"),
        data("jogging.target",  "place.target"),     data("jogging.speed",  "place.speed"),
        data("path.target",     "place.target"),     data("path.speed",     "place.speed"),
        data("approach.target", "press.target"),
        data("place.velocity", "ramp.command"),      data("press.velocity", "ramp.command"),
        data("drive.velocity", "ramp.sent", delayed),
        data("ramp.target",    "trim.target"),       data("speed.velocity", "trim.velocity"), data("drive.velocity", "trim.sent", delayed),
        data("trim.wanted",    "drive.wanted"),
        data("drive.velocity", "can.command.velocity", stale_after(10ms), substitute(0.0)),
        data("can.axis.statusword", "axis.statusword", stale_after(20ms), substitute(0.0)), // when silent: the drive follows nothing
        data("gauge.position", "axis.position"),     data("speed.velocity", "axis.velocity"),
        data("io.home", "axis.home"), data("io.upper_end", "axis.upper_end"), data("io.lower_end", "axis.lower_end"), data("io.stop", "axis.stop_held"), data("io.up", "axis.up"), data("io.down", "axis.down"),
        data("io.faulted", "axis.lines_faulted"), data("can.faulted", "axis.bus_faulted"), data("can.faulted", "restarter.faulted"),
        data("axis.controlword", "can.command.controlword", stale_after(30ms), substitute(0.0)),
        data("axis.lamp", "io.lamp", wakes)),
    reactions( // execution flow
        uses("axis.run", "mode.run"),
        when("axis.jog_at", tell("jogging.at")),
        when("axis.aim",    tell("path.aim"))),
    behaviours(behaviour("axis", compiled<axis_states>)),
    control( // feedback
        level("travel",
            generator("idle"), generator("standing"), generator("jogging"), generator("path"), generator("approach"),
            controller("place", tracks("sent")), controller("press", tracks("sent"))),
        level("speed",
            sensor("gauge"), sensor("cell"), estimator("speed"), generator("ramp"), controller("trim", tracks("sent")), effector("drive")),
        process("axis"),
        exclusive("mode",
            fallback("off",   "idle",     "place"), // also while the drive has no power
            chain("stand",    "standing", "place"),
            chain("jog",      "jogging",  "place"),
            chain("path",     "path",     "place"),
            chain("press",    "approach", "press")),
        loop("place",   gain("place.kp"), transport(10ms)),                     // wire, drive and ramp
        loop("contact", gain("press.kf"), stiffness(2.0e6), transport(10ms)))); // the housing's bore, N/m
// clang-format on

} // namespace bearing_press
