// The carpet loom on one page: its components, the activities that run them, the data flow and the execution
// flow. Read it with main_shaft.hpp, weft_insertion.hpp, loom_cycle.hpp and cams.hpp at hand.
#pragma once

#include "apps/carpet_loom/console.hpp"
#include "apps/carpet_loom/last_resort.hpp"
#include "apps/carpet_loom/loom.hpp"
#include "apps/carpet_loom/loom_cycle.hpp"
#include "apps/carpet_loom/main_drive.hpp"
#include "apps/carpet_loom/main_shaft.hpp"
#include "apps/carpet_loom/maps.hpp"
#include "apps/carpet_loom/network.hpp"
#include "apps/carpet_loom/warp_tension.hpp"
#include "apps/carpet_loom/weft_insertion.hpp"
#include "drivers/can/restarter.hpp"
#include "drivers/canopen/manager.hpp"
#include "kernel/limits/limits.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/services/scope/thread_scope.hpp"
#include "kernel/services/time/timed_event.hpp"
#include "kernel/services/time/watchdog.hpp"

namespace tappet::carpet {

// clang-format off
inline constexpr auto table = machine("carpet-loom",
    components(
        component<can::Bus<can_signals, canopen::frames<loom_network>>>("can", device("loom-can")),
        component<gpio::LinePort<io_lines>>("io", device("loom-io")),
        component<MainShaft>("shaft", properties_file("shaft.cpf", optional)), // angle, angle events, brake angle
        component<WeftInsertion>("weft"),                    // release, arrival, pattern
        component<MainDrive>("main", set("speed_rpm", 600.0), properties_file("main.cpf", optional)),
        component<WarpTension>("warp", set("set_point_n", 300.0), set("band_n", 30.0), properties_file("warp.cpf", optional)),
        component<canopen::Manager<loom_network>>("network"), // CANopen: configures, starts and watches the nodes
        component<Loom>("loom"),                             // the loom's state machine
        component<can::Restarter>("restarter", device("loom-can")), // restarts the bus after bus-off, a few times
        component<modbus::Client<utility_registers>>("utility", device("loom-utility")),
        component<Watchdog>("motion_dog", watches("motion"), set("limit", 20ms)), // silent once the activity "motion" hangs
        component<Watchdog>("shaft_dog", watches("shaft.speed_rpm"), set("limit", 20ms)), // the speed is written at each encoder sample
        component<Watchdog>("io_dog", watches("io"), set("limit", 4ms)), // silent: io was woken and did not run
        component<Watchdog>("logic_dog", watches("logic"), set("limit", 20ms)),
        component<LastResort>("last_resort"),                // acts when logic or shaft hangs
        component<TimedEvent>("new_shift"),
        component<WeftRecord>("record"),                     // arrival angles of the wefts in this shift
        component<Console>("console"),
        component<ThreadScope>("scope"),                     // the worst cycles of the last hour: tappet-browse scope
        component<BrowserService>("browser")),               // outside access: see tappet-browse
    activities( // threads; their priorities follow from the deadlines; a stop begins with the last row
        activity("can",     on_device("can"), at_most(9, 1ms), runs("can"),           deadline(500us), budget(30us)),
        activity("io",      on_device("io"),  at_most(8, 1ms), runs("io"),             deadline(300us), budget(16us)),
        activity("utility", every(100ms),     runs("utility"), not_real_time),
        activity("shaft",   on_work(),        at_most(8, 1ms), runs("shaft", "weft"),  deadline(620us), budget(20us)),
        activity("motion",  every(1ms),                        runs("network", "main", "warp"),         budget(60us)),
        activity("watch",   every(5ms),                        runs("motion_dog", "shaft_dog", "io_dog", "logic_dog", "last_resort"), deadline(250us), budget(30us)),
        activity("logic",   on_work(),        at_most(8, 2ms), runs("loom"),           deadline(2ms),   budget(25us)),
        activity("restarter", every(100ms),    runs("restarter"), not_real_time),
        activity("console", every(250ms),     runs("new_shift", "record", "console"), not_real_time),
        activity("scope",   every(20ms),      runs("scope"),   not_real_time, stack(32 * 1024)),
        activity("browser", every(20ms),      runs("browser"), not_real_time, stack(224 * 1024))),
    connections( // data flow
        data("can.encoder.position",      "shaft.code",           wakes, stale_after(10ms), hold),
        data("shaft.speed_rpm",           "warp.shaft_speed",     stale_after(20ms), hold),
        data("can.main_drive.statusword", "main.statusword",      stale_after(50ms), hold),
        data("can.main_drive.velocity",   "main.velocity",        stale_after(50ms), hold),
        data("main.controlword",          "can.main_drive_command.controlword", stale_after(20ms), hold),
        data("main.target",               "can.main_drive_command.velocity",    stale_after(20ms), hold),
        data("can.load_cell.tension",     "warp.measured",        stale_after(20ms), hold),
        data("can.let_off.statusword",    "warp.statusword",      stale_after(50ms), hold),
        data("warp.controlword",          "can.let_off_command.controlword",    stale_after(20ms), hold),
        data("warp.target",               "can.let_off_command.velocity",       stale_after(20ms), hold),
        data("weft.pick",                 "can.dobby_command.pick"),
        data("weft.pattern",              "can.dobby_command.pattern"),
        data("loom.feeder_colour",        "can.feeder_command.colour"),
        data("loom.feeder_speed",         "can.feeder_command.speed"),
        buffer<64>("can.services",        "network.received"),
        buffer<32>("network.to_send",     "can.to_send",          wakes),
        data("main.enabled",              "loom.main_enabled",    wakes),
        data("main.at_speed",             "loom.main_at_speed",   wakes),
        data("main.fault",                "loom.main_fault",      wakes),
        data("main.slips",                "loom.main_slips",      wakes),
        data("can.main_drive.velocity",   "loom.main_velocity",   stale_after(50ms), hold), // read at an acknowledgement
        data("warp.enabled",              "loom.let_off_enabled", wakes),
        data("warp.fault",                "loom.let_off_fault",   wakes),
        data("warp.in_band",              "loom.tension_in_band", wakes),
        data("shaft.valid",               "loom.shaft_valid",     wakes),
        data("shaft.standing",            "loom.shaft_standing",  wakes),
        data("weft.working",              "loom.weft_working",    wakes),
        data("motion_dog.alive",          "loom.motion_alive",    wakes),
        data("shaft_dog.alive",           "loom.shaft_alive",     wakes),
        data("shaft_dog.alive",           "last_resort.shaft_alive"),
        data("logic_dog.alive",           "last_resort.logic_alive"),
        data("io_dog.alive",              "loom.io_alive",        wakes),
        data("can.faulted",               "loom.bus_faulted",     wakes),
        data("can.faulted",               "restarter.faulted"),
        data("io.faulted",                "loom.io_faulted",      wakes),
        data("network.operational",       "loom.nodes_operational", wakes),
        data("io.drop_wire",              "loom.drop_wire",       wakes),
        data("io.emergency_stop",         "loom.emergency_stop",  wakes),
        data("utility.unit.oil_pressure", "loom.oil_pressure",    wakes, stale_after(15s), hold),
        data("loom.pump",                 "utility.pump.on"),
        data("loom.lamp_run",             "io.lamp_run",          wakes),
        data("loom.lamp_stop",            "io.lamp_stop",         wakes),
        data("loom.lamp_fault",           "io.lamp_fault",        wakes),
        buffer<64>("weft.arrivals",       "record.arrivals",      drop_oldest), // no arrival is lost: 250 ms hold three
        data("loom.state",                "console.state"),
        data("loom.cause",                "console.cause"),
        data("loom.waits_for",            "console.waits_for"),
        data("shaft.speed_rpm",           "console.speed_rpm"),
        data("shaft.angle_deg",           "console.angle_deg"),
        data("shaft.stop_error_deg",      "console.stop_error_deg"),
        data("shaft.stops",               "console.stops"),
        data("weft.picks_woven",          "console.picks"),
        data("can.load_cell.tension",     "console.tension_n",    stale_after(1s), hold),
        data("can.frames_lost",           "console.frames_lost"),
        data("can.state",                 "console.bus_state"),
        data("restarter.restarts",        "console.bus_restarts"),
        data("io.edges_lost",             "console.edges_lost"),
        data("utility.unit.oil_pressure", "console.oil_bar",      stale_after(15s), hold),
        data("utility.outages",           "console.outages")),
    reactions( // execution flow
        when("shaft.weft_opens",     call("weft.on_release_angle")), // in the shaft's activity, at once
        when("shaft.weft_closes",    call("weft.on_close_angle")),
        when("shaft.window_opens",   call("weft.on_window_opens")),
        when("shaft.window_closes",  call("weft.on_window_closes")),
        when("shaft.beat_up",        call("weft.on_beat_up")),
        when("shaft.offer_pattern",  call("weft.on_offer_pattern")),
        uses("weft.angle_at",        "shaft.angle_at"),              // a method: runs in the caller's thread
        when("weft.open_valve",      tell("io.weft_release.set")),   // in the engine of io
        when("weft.close_valve",     tell("io.weft_release.clear")),
        when("weft.drive_cutter",    tell("io.yarn_cutter.set")),
        when("weft.rest_cutter",     tell("io.yarn_cutter.clear")),
        when("io.weft_detector.rises", tell("weft.on_arrival"), handled_by("weft.detector"), disconnected),
        when("weft.missed",          call("shaft.stop_at_angle")),   // a direct call, because the brake's angle is near
        when("shaft.brake_now",      tell("io.brake.set")),
        when("shaft.brake_now",      tell("main.halt")),
        when("shaft.brake_now",      call("weft.hold")),
        when("shaft.rests",          call("weft.on_rest")),          // the yarn cutter rests, too
        when("shaft.stopped",        tell("record.on_stop", keep_latest)),
        when("record.begun",         call("new_shift.every")),
        when("new_shift.due",        call("record.forget")),
        when("loom.enable_drives",   tell("main.enable")),
        when("loom.enable_drives",   tell("warp.enable")),
        when("loom.disable_drives",  tell("main.disable")),
        when("loom.disable_drives",  tell("warp.disable")),
        when("loom.run_shaft",       tell("main.run")),
        uses("loom.stop_shaft",      "shaft.stop"),                  // a command: sent, executing, done
        when("loom.quick_stop",      tell("main.quick_stop")),
        when("loom.quick_stop",      tell("warp.hold")),
        when("loom.quick_stop",      tell("shaft.brake_was_set")),
        when("loom.quick_stop",      tell("can.purge")),             // no stale command follows an emergency stop
        when("loom.set_brake",       tell("io.brake.set")),
        when("loom.release_brake",   tell("io.brake.clear")),
        when("loom.release_brake",   tell("shaft.release")),
        when("loom.allow_weft",      tell("weft.allow")),
        when("loom.inhibit_weft",    tell("weft.inhibit")),
        when("loom.inhibit_weft",    tell("io.weft_release.clear")), // direct, in case the shaft's activity hangs
        when("io.line_fault",        tell("weft.lose_lines")),          // the brake may be on now, even when other activities hang
        when("logic_dog.silent",     call("last_resort.act")),       // logic hangs: the state machine cannot react
        when("shaft_dog.silent",     call("last_resort.let_cutter_rest")), // shaft hangs: no beat-up ends the cut
        when("last_resort.rest_cutter", tell("io.yarn_cutter.clear")),
        when("last_resort.set_brake",   tell("io.brake.set")),
        when("last_resort.close_valve", tell("io.weft_release.clear")),
        when("last_resort.close_valve", tell("weft.inhibit")),       // a braked shaft passes the release angle, too
        when("last_resort.quick_stop",  tell("main.quick_stop")),
        when("last_resort.quick_stop",  tell("warp.hold"))),
    behaviours(
        behaviour("loom", compiled<loom_cycle>),
        behaviour("weft", slot(nodes(200), data_bytes(2048), depth(8), command_slots(4), timers(2),
                               peers("shaft", "loom"), operations("weft.lift", "weft.weave_carpet"),
                               events("shaft.beat_up", "shaft.offer_pattern"), angle_of("shaft.angle_deg"), trial(4)))),
    limits( // bounds of the drives' targets, whatever a component writes
        limit("main.target",                 0.0, 700.0, stop_on_breach),
        limit("warp.target",                -5.0,  40.0)));
// clang-format on

} // namespace tappet::carpet
