// Where each machine's wires stand on the bench, on which all five are in one box.
#pragma once

#include "kernel/machine/table/binding.hpp"

namespace woodworking {

inline constexpr tappet::BoundDevice lane_wire = tappet::wired("lane", "can2"),
                                     belt_can = tappet::wired("belt-can", "can1"),
                                     belt_io = tappet::wired("belt-io", "io", tappet::line("acknowledge", 0),
                                                             tappet::line("lamp", 1));
/// A station has two lines, behind those of the ones before it.
constexpr tappet::BoundDevice station_io(std::string_view device, unsigned station) {
    return tappet::wired(device, "io", tappet::line("board", 2 + 2 * station),
                         tappet::line("tool", 3 + 2 * station));
}

} // namespace woodworking

namespace woodworking::at_conveyor::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_wire, belt_can, belt_io);
}
namespace woodworking::at_saw::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_wire, station_io("station-io", 0));
}
namespace woodworking::at_drill::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_wire, station_io("station-io", 1));
}
namespace woodworking::at_polish::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_wire, station_io("station-io", 2));
}
namespace woodworking::at_glue::bindings {
inline constexpr tappet::Binding bench = tappet::binding(lane_wire, station_io("station-io", 3));
}
