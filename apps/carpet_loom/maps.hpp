// The signals on the loom's buses, as tables: frames and their signals, lines, registers.
#pragma once

#include "apps/carpet_loom/wires.hpp"
#include "drivers/can/bus.hpp"
#include "drivers/canopen/cia402.hpp"
#include "drivers/gpio/line_port.hpp"
#include "drivers/modbus/client.hpp"

namespace tappet::carpet {

namespace wires = loom::wires;

// clang-format off
inline constexpr auto can_signals = can::signal_map(
    can::receive(can::standard(wires::cob::main_drive_status), "main_drive", can::bytes(6), can::every(wires::drive_status_period),
        can::signal("statusword", 0, 16),
        can::signal("velocity", 16, 32).as_signed().times(0.1).in("rpm")),
    can::receive(can::standard(wires::cob::let_off_drive_status), "let_off", can::bytes(6), can::every(wires::drive_status_period),
        can::signal("statusword", 0, 16),
        can::signal("velocity", 16, 32).as_signed().times(0.001).in("rpm")),
    can::receive(can::standard(wires::cob::encoder_position), "encoder", can::bytes(4), can::every(wires::encoder_period),
        can::signal("position", 0, 16),
        can::signal("sample", 16, 16)),
    can::receive(can::standard(wires::cob::load_cell_tension), "load_cell", can::bytes(3), can::every(wires::load_cell_period),
        can::signal("tension", 0, 16).as_signed().times(0.1).in("N"),
        can::signal("status", 16, 8)),
    can::receive(can::standard(wires::cob::feeder_status), "feeder", can::bytes(3), can::every(wires::feeder_status_period),
        can::signal("status", 0, 8),
        can::signal("windings", 8, 16)),
    can::receive(can::standard(wires::cob::dobby_status), "dobby", can::bytes(5), can::on_demand(10ms),
        can::signal("pick_taken", 0, 32),
        can::signal("level", 32, 8)),
    can::transmit(can::standard(wires::cob::main_drive_command), "main_drive_command", can::bytes(6), can::every(2ms),
        can::signal("controlword", 0, 16).safe(canopen::controlword::quick_stop),
        can::signal("velocity", 16, 32).as_signed().times(0.1).in("rpm").safe(0)),
    can::transmit(can::standard(wires::cob::let_off_drive_command), "let_off_command", can::bytes(6), can::every(2ms),
        can::signal("controlword", 0, 16).safe(canopen::controlword::quick_stop),
        can::signal("velocity", 16, 32).as_signed().times(0.001).in("rpm").safe(0)),
    can::transmit(can::standard(wires::cob::feeder_command), "feeder_command", can::bytes(3), can::every(100ms),
        can::signal("colour", 0, 8).safe(0),
        can::signal("speed", 8, 16).safe(0)),
    can::transmit(can::standard(wires::cob::dobby_command), "dobby_command", can::bytes(6), can::every(10ms),
        can::signal("pick", 0, 32),
        can::signal("pattern", 32, 16)).safe_by_silence()); // it holds its shed

inline constexpr auto io_lines = gpio::line_map(
    gpio::sensor("emergency_stop"),
    gpio::sensor("drop_wire", gpio::debounce(2ms)),
    gpio::sensor("weft_detector"),
    gpio::sensor("button_start", gpio::debounce(5ms)),
    gpio::sensor("button_stop", gpio::debounce(5ms)),
    gpio::sensor("button_acknowledge", gpio::debounce(5ms)),
    gpio::actuator("weft_release", gpio::safe(false)),
    gpio::actuator("brake", gpio::safe(true)),
    gpio::output("lamp_run", gpio::safe(false)),
    gpio::output("lamp_stop", gpio::safe(false)),
    gpio::output("lamp_fault", gpio::safe(false)),
    gpio::actuator("yarn_cutter", gpio::safe(false)));

inline constexpr auto utility_registers = modbus::register_map(
    modbus::read("unit", modbus::input_registers(0, 4), modbus::every(250ms),
        modbus::word("temperature", 0).as_signed().times(0.1).in("degC"),
        modbus::word("humidity", 1).times(0.1).in("%"),
        modbus::word("oil_pressure", 2).times(0.01).in("bar"),
        modbus::word("oil_temperature", 3).as_signed().times(0.1).in("degC")),
    modbus::write("pump", modbus::coils(0, 1), modbus::every(1s), modbus::stale_after(5s),
        modbus::bit("on", 0).safe(false)));
// clang-format on

} // namespace tappet::carpet
