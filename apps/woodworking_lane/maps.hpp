// The machines' own wires: the conveyor's drive and scanner on CAN; a station's light barrier and tool on
// lines.
#pragma once

#include "apps/woodworking_lane/values.hpp"
#include "drivers/can/bus.hpp"
#include "drivers/gpio/line_port.hpp"

namespace woodworking {

// clang-format off
inline constexpr auto belt_signals = can::signal_map(
    can::receive(can::standard(0x181), "drive", can::bytes(8), can::every(5ms),
        can::signal("position", 0, 32).in("mm"),
        can::signal("speed", 32, 16).in("mm/s")),
    can::receive(can::standard(0x281), "scanner", can::bytes(4), can::on_demand(100ms), can::signal("code", 0, 32)),
    can::transmit(can::standard(0x201), "drive_command", can::bytes(2), can::every(5ms),
        can::signal("speed", 0, 16).in("mm/s").safe(0)));

inline constexpr auto station_lines = gpio::line_map(
    gpio::sensor("board", gpio::debounce(1ms)),
    gpio::output("tool", gpio::safe(false)));

inline constexpr auto belt_lines = gpio::line_map(
    gpio::sensor("acknowledge", gpio::debounce(5ms)),
    gpio::output("lamp", gpio::safe(false))); // the belt runs
// clang-format on

} // namespace woodworking
