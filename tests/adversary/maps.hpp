// The wires of the test bench's machine, with each kind of output that a machine can have.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/gpio/line_port.hpp"
#include "drivers/modbus/client.hpp"

namespace adversary {

using namespace tappet;

// clang-format off
inline constexpr auto bed_signals = can::signal_map(
    can::receive(can::standard(0x181), "level", can::bytes(6), can::every(5ms), can::signal("height", 0, 16).times(0.1).in("mm"),
        can::signal("weight", 16, 32).as_float().in("kg")),
    can::transmit(can::standard(0x201), "pump", can::bytes(5), can::every(5ms),
        can::signal("speed", 0, 16).as_signed().times(0.1).in("rpm").range(-1000, 1000).safe(0),
        can::signal("on", 16, 1).safe(0),
        can::signal("spare", 17, 7).safe(0),
        can::signal("torque", 24, 16).times(0.01).in("Nm").safe(0)));

inline constexpr auto bed_lines = gpio::line_map(
    gpio::sensor("full"),
    gpio::sensor("start", gpio::debounce(5ms)),
    gpio::actuator("gate", gpio::safe(false)),
    gpio::output("valve", gpio::safe(false)),
    gpio::output("door", gpio::safe(false)),
    gpio::output("drain", gpio::safe(false)),
    gpio::output("mixer", gpio::safe(false)),
    gpio::output("lamp", gpio::safe(false)));

inline constexpr auto bed_registers = modbus::register_map(
    modbus::read("oven", modbus::input_registers(0, 1), modbus::every(100ms), modbus::word("temperature", 0).as_signed().times(0.1).in("degC")),
    modbus::read("meter", modbus::input_registers(2, 2), modbus::every(100ms), modbus::float_word("flow", 0).in("kg/s")),
    modbus::write("heat", modbus::holding_registers(4, 2), modbus::every(100ms), modbus::stale_after(1s),
        modbus::word("power", 0).times(0.1).in("%").safe(0),
        modbus::word("fan", 1).in("rpm").safe(0)),
    modbus::write("burner", modbus::coils(0, 1), modbus::every(100ms), modbus::stale_after(1s), modbus::bit("on", 0).safe(0)));
// clang-format on

} // namespace adversary
