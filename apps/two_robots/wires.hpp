// The signals on the wires of either robot: encoders and drives behind CAN modules, switches and power on
// lines.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/gpio/line_port.hpp"

namespace two_robots {

using namespace tappet;

inline constexpr Duration servo_period = 2ms; // 500 Hz

// clang-format off
inline constexpr auto robot_signals = can::signal_map(
    can::receive(can::standard(0x181), "encoders_a", can::bytes(8), can::every(servo_period), can::signal("joint_1", 0, 32), can::signal("joint_2", 32, 32)),
    can::receive(can::standard(0x182), "encoders_b", can::bytes(8), can::every(servo_period), can::signal("joint_3", 0, 32), can::signal("joint_4", 32, 32)),
    can::receive(can::standard(0x183), "encoders_c", can::bytes(8), can::every(servo_period), can::signal("joint_5", 0, 32), can::signal("joint_6", 32, 32)),
    can::transmit(can::standard(0x201), "drives_a", can::bytes(6), can::every(servo_period),
        can::signal("joint_1", 0, 16).as_signed().times(0.0003125).in("V").safe(0),
        can::signal("joint_2", 16, 16).as_signed().times(0.0003125).in("V").safe(0),
        can::signal("joint_3", 32, 16).as_signed().times(0.0003125).in("V").safe(0)),
    can::transmit(can::standard(0x202), "drives_b", can::bytes(6), can::every(servo_period),
        can::signal("joint_4", 0, 16).as_signed().times(0.0003125).in("V").safe(0),
        can::signal("joint_5", 16, 16).as_signed().times(0.0003125).in("V").safe(0),
        can::signal("joint_6", 32, 16).as_signed().times(0.0003125).in("V").safe(0)));

// The switch of a joint is active beyond an angle: a relative encoder finds its zero there, and an absolute
// one is checked there.
inline constexpr auto robot_lines = gpio::line_map(
    gpio::sensor("start", gpio::debounce(5ms)),
    gpio::sensor("ready", gpio::debounce(5ms)),
    gpio::sensor("work", gpio::debounce(5ms)),
    gpio::sensor("stop", gpio::debounce(5ms)),
    gpio::sensor("switch_1"), gpio::sensor("switch_2"), gpio::sensor("switch_3"),
    gpio::sensor("switch_4"), gpio::sensor("switch_5"), gpio::sensor("switch_6"),
    gpio::output("enable", gpio::safe(false)),   // of the drives
    gpio::output("release", gpio::safe(false))); // of the brakes
// clang-format on

} // namespace two_robots
