// The signals on the cutter's wires: a measuring wheel and a feed drive on CAN; buttons, knife and lamp on
// lines.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/gpio/line_port.hpp"

namespace cut_to_length {

using namespace tappet;

inline constexpr int codes_per_mm = 8; // of the measuring wheel
inline constexpr int wheel_bits = 16;
inline constexpr Duration knife_dead_time = 15ms; // from its line's edge to the blade in the web

// clang-format off
inline constexpr auto can_signals = can::signal_map(
    can::receive(can::standard(0x181), "wheel", can::bytes(2), can::every(1ms), can::signal("position", 0, wheel_bits)),
    can::receive(can::standard(0x182), "feed", can::bytes(2), can::every(10ms), can::signal("statusword", 0, 16)),
    can::transmit(can::standard(0x202), "feed_command", can::bytes(4), can::every(5ms),
        can::signal("controlword", 0, 16).safe(0),
        can::signal("speed", 16, 16).times(0.001).in("m/s").safe(0)));

inline constexpr auto io_lines = gpio::line_map(
    gpio::sensor("start", gpio::debounce(5ms)),
    gpio::sensor("stop", gpio::debounce(5ms)),
    gpio::sensor("emergency_stop"),
    gpio::actuator("knife", gpio::safe(false)), // one edge makes one turn of the knife
    gpio::output("lamp", gpio::safe(false)));
// clang-format on

} // namespace cut_to_length
