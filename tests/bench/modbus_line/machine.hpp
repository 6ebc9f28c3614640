// A machine with one Modbus device on a serial line: values in every byte order, a row that the device does
// not have, a set point, and a pump that runs while the value it reads is good.
#pragma once

#include "drivers/modbus/client.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"

namespace tappet::modbus_line {

/// The registers of tests/drivers/modbus/foreign_server.py.
inline constexpr auto registers = modbus::register_map(
    modbus::read("tank", modbus::input_registers(10, 1), modbus::every(100ms), modbus::word("level", 0)),
    modbus::read("orders", modbus::input_registers(40, 16), modbus::every(200ms),
                 modbus::double_word("abcd", 0).as_signed(), modbus::float_word("abcd_real", 2),
                 modbus::double_word("cdab", 4).as_signed().swapped(),
                 modbus::float_word("cdab_real", 6).swapped(),
                 modbus::double_word("badc", 8).as_signed().bytes_swapped(),
                 modbus::float_word("badc_real", 10).bytes_swapped(),
                 modbus::double_word("dcba", 12).as_signed().swapped().bytes_swapped(),
                 modbus::float_word("dcba_real", 14).swapped().bytes_swapped()),
    modbus::write("wanted", modbus::holding_registers(20, 2), modbus::every(500ms), modbus::stale_after(2s),
                  modbus::double_word("flow", 0).as_signed().swapped().safe(-2)),
    modbus::read("kept", modbus::holding_registers(20, 2), modbus::every(200ms),
                 modbus::double_word("flow", 0).as_signed().swapped()),
    modbus::read("nowhere", modbus::holding_registers(5000, 1), modbus::every(500ms),
                 modbus::word("nothing", 0)));

struct Pump {
    Input<double> level;
    Output<bool> runs;
    Output<double> flow;
    Property<double> wanted{-123456};

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        runs.write(level.good());
        flow.write(wanted.get());
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        runs.write(false);
        flow.write(0);
    }
    static constexpr auto interface() {
        return facets(input<&Pump::level>("level", "", "of the tank"),
                      output<&Pump::runs>("runs", "", "while the level is known"),
                      output<&Pump::flow>("flow", "", "that the device is told"),
                      property<&Pump::wanted>("wanted", "", "the flow", range(-200'000, 200'000)));
    }
};

// clang-format off
inline constexpr auto table = machine("modbus-line",
    components(
        component<modbus::Client<registers>>("unit", device("line")),
        component<Pump>("pump"),
        component<BrowserService>("browser")),
    activities( // the pump stops first, so that its last value reaches the device
        activity("unit",    every(50ms), runs("unit"),    not_real_time),
        activity("pump",    every(10ms), runs("pump"),    budget(50us)),
        activity("browser", every(20ms), runs("browser"), not_real_time, stack(224 * 1024))),
    connections(
        data("unit.tank.level", "pump.level", stale_after(800ms), hold),
        data("pump.flow",       "unit.wanted.flow")),
    reactions(),
    behaviours());
// clang-format on

} // namespace tappet::modbus_line
