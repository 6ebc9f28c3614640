// Maps each machine's wires: on the bench, where one box runs all five machines, and on a box of its own.
#pragma once

#include "drivers/gpio/kind.hpp"
#include "kernel/machine/table/binding.hpp"

namespace woodworking {

inline constexpr auto lane_on_bench = tappet::wired("lane", "can2");
inline constexpr auto lane_wire = tappet::wired("lane", "can0");
inline constexpr auto belt_can = tappet::wired("belt-can", "can1");
inline constexpr auto belt_io =
    tappet::wired("belt-io", "io", tappet::line("acknowledge", 0), tappet::line("lamp", 1));
/// A station has two lines; on the bench they follow those of the stations before it.
constexpr auto station_io(std::string_view device, unsigned station) {
    return tappet::wired(device, "io", tappet::line("board", 2 + 2 * station),
                         tappet::line("tool", 3 + 2 * station));
}

} // namespace woodworking

namespace woodworking::at_conveyor::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_on_bench, belt_can, belt_io);
inline constexpr tappet::Binding lane_box = tappet::binding(lane_wire, belt_can, belt_io);
} // namespace woodworking::at_conveyor::bindings
namespace woodworking::at_saw::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_on_bench, station_io("station-io", 0));
inline constexpr tappet::Binding lane_box = tappet::binding(lane_wire, station_io("station-io", 0));
} // namespace woodworking::at_saw::bindings
namespace woodworking::at_drill::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_on_bench, station_io("station-io", 1));
inline constexpr tappet::Binding lane_box = tappet::binding(lane_wire, station_io("station-io", 0));
} // namespace woodworking::at_drill::bindings
namespace woodworking::at_polish::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_on_bench, station_io("station-io", 2));
inline constexpr tappet::Binding lane_box = tappet::binding(lane_wire, station_io("station-io", 0));
} // namespace woodworking::at_polish::bindings
namespace woodworking::at_glue::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_on_bench, station_io("station-io", 3));
inline constexpr tappet::Binding lane_box = tappet::binding(lane_wire, station_io("station-io", 0));
} // namespace woodworking::at_glue::bindings
