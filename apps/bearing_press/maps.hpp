// The signals on the press's wires: the drive and the force sensor on CAN; buttons, switches and lamp on
// lines.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/gpio/line_port.hpp"

namespace bearing_press {

using namespace tappet;

// clang-format off
inline constexpr auto can_signals = can::signal_map(
    can::receive(can::standard(0x181), "axis", can::bytes(8), can::every(1ms),
        can::signal("statusword", 0, 16),
        can::signal("position", 16, 32)), // micrometres
    can::receive(can::standard(0x182), "cell", can::bytes(4), can::every(1ms),
        can::signal("force", 0, 32).as_signed().times(0.01).in("N")),
    can::transmit(can::standard(0x201), "command", can::bytes(6), can::every(1ms), // cyclic synchronous velocity
        can::signal("controlword", 0, 16).safe(0),
        can::signal("velocity", 16, 32).as_signed().times(1e-6).in("m/s").safe(0)));

inline constexpr auto io_lines = gpio::line_map(
    gpio::sensor("start", gpio::debounce(5ms)),
    gpio::sensor("stop", gpio::debounce(5ms)),
    gpio::sensor("up", gpio::debounce(5ms)),
    gpio::sensor("down", gpio::debounce(5ms)),
    gpio::sensor("home"),      // active above the edge that defines zero
    gpio::sensor("upper_end"), // the ends of the slide's travel
    gpio::sensor("lower_end"),
    gpio::output("lamp", gpio::safe(false)));
// clang-format on

} // namespace bearing_press
