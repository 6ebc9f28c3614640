// A rotary knife behind a measuring wheel cuts a running web to length: the machine on one page.
#pragma once

#include "apps/cut_to_length/line.hpp"
#include "drivers/can/restarter.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/pieces/cam_shaft.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/services/reporting/reporting.hpp"

namespace cut_to_length {

// clang-format off
// One length of web is one turn. The blade meets the web at the complete length, then the line rests.
inline constexpr auto cams = cam_table(600_rpm, cam("cut", window(0_deg, 60_deg), dead_time(knife_dead_time)));

inline constexpr auto table = machine("cut-to-length",
    components(
        component<can::Bus<can_signals>>("can", device("feed-can")),
        component<gpio::LinePort<io_lines>>("io", device("line-io")),
        component<CamShaft<cams>>("wheel", set("codes_per_turn", 500 * codes_per_mm), set("counter_bits", wheel_bits)),
        component<Line>("line", set("speed", 2.0)),             // the line's state machine
        component<can::Restarter>("restarter", device("feed-can")), // restarts the bus after bus-off, a few times
        component<BrowserService>("browser")),                      // outside access: see tappet-browse
    activities( // threads; their priorities follow from the deadlines
        activity("can",       on_device("can"), at_most(4, 1ms), runs("can"),       deadline(500us), budget(30us)),
        activity("io",        on_device("io"),  at_most(4, 1ms), runs("io"),        deadline(300us), budget(16us)),
        activity("wheel",     on_work(),        at_most(4, 1ms), runs("wheel"),     deadline(600us), budget(20us)),
        activity("line",      every(5ms),                        runs("line"),                       budget(30us)),
        activity("restarter", every(100ms), not_real_time,       runs("restarter")),
        activity("browser",   every(20ms), not_real_time,        runs("browser"), stack(224 * 1024))),
    connections( // data flow
        data("can.wheel.position",   "wheel.code", wakes, stale_after(20ms), hold),
        data("can.feed.statusword",  "line.statusword",    stale_after(50ms), substitute(0.0)), // when silent: the drive follows nothing
        data("can.faulted",          "line.bus_faulted"),
        data("can.faulted",          "restarter.faulted"),
        data("io.emergency_stop",    "line.emergency_stop"),
        data("io.faulted",           "line.lines_faulted"),
        data("wheel.valid",          "line.wheel_valid"),
        data("line.knife_allowed",   "wheel.enabled"),
        data("line.controlword",     "can.feed_command.controlword", stale_after(20ms), hold),
        data("line.target",          "can.feed_command.speed",       stale_after(20ms), hold),
        data("line.lamp",            "io.lamp", wakes)),
    reactions( // execution flow
        when("wheel.cut.enters", tell("io.knife.set")),
        when("wheel.cut.leaves", tell("io.knife.clear"))),
    behaviours(behaviour("line", compiled<line_states>)),
    reporting( // what tappet-browse report writes to files
        report("line.target"),
        report("wheel.*",     on_change()),
        report("line.speed",  on_change())));
// clang-format on

} // namespace cut_to_length
