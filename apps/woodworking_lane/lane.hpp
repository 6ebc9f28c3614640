// The woodworking lane on one screen: five machines on 100 m of wire.
#pragma once

#include "apps/woodworking_lane/belt.hpp"
#include "apps/woodworking_lane/maps.hpp"
#include "apps/woodworking_lane/station.hpp"
#include "drivers/system/station.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/services/browsing/browser_service.hpp"

namespace woodworking {

// clang-format off
// ---- the machines, each by itself

inline constexpr auto conveyor = machine("conveyor",
    components(
        component<can::Bus<belt_signals>>("drive", device("belt-can")),
        component<gpio::LinePort<belt_lines>>("io", device("belt-io")),
        component<Belt>("belt"),
        component<BrowserService>("browser")),
    activities(
        activity("drive",   on_device("drive"), at_most(4, 1ms), runs("drive"), deadline(1ms), budget(40us)),
        activity("io",      on_device("io"), at_most(2, 1ms),    runs("io"),    deadline(1ms), budget(20us)),
        activity("belt",    every(5ms),                          runs("belt"),                 budget(60us)),
        activity("browser", every(20ms), not_real_time,          runs("browser"), stack(224 * 1024))),
    connections(
        data("drive.drive.position", "belt.drive_position", stale_after(50ms), hold),
        data("drive.drive.speed",    "belt.drive_speed",    stale_after(50ms), hold),
        data("drive.scanner.code",   "belt.code"),
        data("drive.faulted",        "belt.bus_faulted"),
        data("belt.speed_command",   "drive.drive_command.speed", stale_after(20ms), hold),
        data("belt.lamp",            "io.lamp", wakes)),
    reactions(
        when("drive.scanner.received", tell("belt.scanned"))),
    behaviours(behaviour("belt", compiled<belt_states>)));

template <std::int64_t which, Duration::rep work_ns>
inline constexpr auto station_table = machine("station",
    components(
        component<gpio::LinePort<station_lines>>("io", device("station-io")),
        component<Station>("station", set("number", which), set("takes", Duration{work_ns})),
        component<BrowserService>("browser")),
    activities(
        activity("io",      on_device("io"), at_most(2, 1ms), runs("io"), deadline(1ms), budget(20us)),
        activity("station", every(5ms),                       runs("station"),           budget(60us)),
        activity("browser", every(20ms), not_real_time,       runs("browser"), stack(224 * 1024))),
    connections(
        data("station.tool", "io.tool", wakes)),
    reactions(
        when("io.board.rises", tell("station.board_seen"))),
    behaviours());

inline constexpr auto& saw = station_table<0, 800'000'000>;
inline constexpr auto& drill = station_table<1, 500'000'000>;
inline constexpr auto& polish = station_table<2, 1'200'000'000>;
inline constexpr auto& glue = station_table<3, 300'000'000>;

// ---- the crossings between them

inline constexpr auto lane = system("woodworking-lane",
    nodes(node<conveyor>("conveyor"), node<saw>("saw"), node<drill>("drill"), node<polish>("polish"), node<glue>("glue")),
    wire("lane", bit_rate(500'000), beats(20ms), silent_after(65ms), served_within(1ms, budget(30us)), // 100 m
        common_clock("conveyor", every(100ms), within(200us))),
    crossings(
        across(data("conveyor.belt.position", "saw.station.belt_position",    stale_after(60ms), hold), every(20ms), in_natural_bits(30), with_time),
        across(data("conveyor.belt.position", "drill.station.belt_position",  stale_after(60ms), hold), every(20ms), in_natural_bits(30), with_time),
        across(data("conveyor.belt.position", "polish.station.belt_position", stale_after(60ms), hold), every(20ms), in_natural_bits(30), with_time),
        across(data("conveyor.belt.position", "glue.station.belt_position",   stale_after(60ms), hold), every(20ms), in_natural_bits(30), with_time),
        // Each board's ticket moves with it from station to station.
        across(when("conveyor.belt.board_in",   tell("saw.station.board_comes")),    at_most(1, 500ms), within(120ms)),
        across(when("saw.station.board_out",    tell("drill.station.board_comes")),  at_most(1, 200ms), within(120ms), if_lost("saw.station.not_handed_on")),
        across(when("drill.station.board_out",  tell("polish.station.board_comes")), at_most(1, 200ms), within(120ms), if_lost("drill.station.not_handed_on")),
        across(when("polish.station.board_out", tell("glue.station.board_comes")),   at_most(1, 200ms), within(120ms), if_lost("polish.station.not_handed_on")),
        across(when("glue.station.board_out",   tell("conveyor.belt.board_leaves")), at_most(1, 200ms), within(120ms), if_lost("glue.station.not_handed_on")),
        // A station stops the belt, and releases it.
        across(uses("saw.station.stop_belt",    "conveyor.belt.stop_at"), at_most(1, 200ms), within(120ms)),
        across(uses("drill.station.stop_belt",  "conveyor.belt.stop_at"), at_most(1, 200ms), within(120ms)),
        across(uses("polish.station.stop_belt", "conveyor.belt.stop_at"), at_most(1, 200ms), within(120ms)),
        across(uses("glue.station.stop_belt",   "conveyor.belt.stop_at"), at_most(1, 200ms), within(120ms)),
        across(when("saw.station.done",    tell("conveyor.belt.go")), at_most(1, 200ms), within(120ms)),
        across(when("drill.station.done",  tell("conveyor.belt.go")), at_most(1, 200ms), within(120ms)),
        across(when("polish.station.done", tell("conveyor.belt.go")), at_most(1, 200ms), within(120ms)),
        across(when("glue.station.done",   tell("conveyor.belt.go")), at_most(1, 200ms), within(120ms)),
        // A silent station stops the belt; a station that does not hear the belt stops its tool.
        presence("saw",      "conveyor.belt.saw_is_there"),
        presence("drill",    "conveyor.belt.drill_is_there"),
        presence("polish",   "conveyor.belt.polish_is_there"),
        presence("glue",     "conveyor.belt.glue_is_there"),
        presence("conveyor", "saw.station.belt_is_there"),
        presence("conveyor", "drill.station.belt_is_there"),
        presence("conveyor", "polish.station.belt_is_there"),
        presence("conveyor", "glue.station.belt_is_there")),
    promises(
        reaction("saw.station.board_out", "drill.station.board_comes", within(25ms)),
        reaction("drill.station.stop_belt", "conveyor.belt.stop_at", within(25ms)),
        stops("saw",      "conveyor.belt.saw_is_there",   within(90ms)),
        stops("drill",    "conveyor.belt.drill_is_there", within(90ms)),
        stops("polish",   "conveyor.belt.polish_is_there", within(90ms)),
        stops("glue",     "conveyor.belt.glue_is_there",  within(90ms)),
        stops("conveyor", "saw.station.belt_is_there",    within(90ms))));
// clang-format on

} // namespace woodworking

// The table with which each box is flashed.
namespace woodworking::at_conveyor {
inline constexpr auto table = station<lane, "conveyor", conveyor>;
}
namespace woodworking::at_saw {
inline constexpr auto table = station<lane, "saw", saw>;
}
namespace woodworking::at_drill {
inline constexpr auto table = station<lane, "drill", drill>;
}
namespace woodworking::at_polish {
inline constexpr auto table = station<lane, "polish", polish>;
}
namespace woodworking::at_glue {
inline constexpr auto table = station<lane, "glue", glue>;
}
