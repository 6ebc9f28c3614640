// A rotary knife behind a measuring wheel cuts a running web to length: the machine on one page.
#pragma once

#include "apps/cut_to_length/line.hpp"
#include "apps/cut_to_length/measuring.hpp"
#include "drivers/can/restarter.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"

namespace cut_to_length {

// clang-format off
inline constexpr auto table = machine("cut-to-length",
    components(
        component<can::Bus<can_signals>>("can", device("feed-can")),
        component<gpio::LinePort<io_lines>>("io", device("line-io")),
        component<Measuring>("measuring", set("length_mm", 500.0)), // fires the knife
        component<Line>("line", set("speed", 2.0)),                 // the states of the whole
        component<can::Restarter>("restarter", device("feed-can")), // restarts a bus that went off, a few times
        component<BrowserService>("browser")),                      // who looks in from outside: see tappet-browse
    activities( // threads; their priorities follow from the deadlines
        activity("can",       on_device("can"), at_most(4, 1ms), runs("can"),       deadline(500us), budget(30us)),
        activity("io",        on_device("io"),  at_most(4, 1ms), runs("io"),        deadline(300us), budget(16us)),
        activity("measuring", on_work(),        at_most(4, 1ms), runs("measuring"), deadline(600us), budget(20us)),
        activity("line",      every(5ms),                        runs("line"),                       budget(30us)),
        activity("restarter", every(100ms), not_real_time,       runs("restarter")),
        activity("browser",   every(20ms), not_real_time,        runs("browser"), stack(224 * 1024))),
    connections( // data flow
        data("can.wheel.position",   "measuring.position", wakes, stale_after(20ms), hold),
        data("can.feed.statusword",  "line.statusword",    stale_after(50ms), substitute(0.0)), // silent: it follows nothing
        data("can.faulted",          "line.bus_faulted"),
        data("can.faulted",          "restarter.faulted"),
        data("io.emergency_stop",    "line.emergency_stop"),
        data("io.faulted",           "line.lines_faulted"),
        data("line.knife_allowed",   "measuring.knife_allowed"),
        data("line.controlword",     "can.feed_command.controlword", stale_after(20ms), hold),
        data("line.target",          "can.feed_command.speed",       stale_after(20ms), hold),
        data("line.lamp",            "io.lamp", wakes)),
    reactions( // execution flow
        when("measuring.cut_now",      tell("io.knife.set")),
        when("measuring.knife_turned", tell("io.knife.clear"))),
    behaviours(behaviour("line", compiled<line_states>)));
// clang-format on

} // namespace cut_to_length
