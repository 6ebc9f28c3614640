// A machine that offers users, scripts and rows every way to an output: the faults that the adversary must
// find are planted in it.
#pragma once

#include "drivers/can/restarter.hpp"
#include "kernel/limits/limits.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/services/interpreter/command_interpreter.hpp"
#include "tests/adversary/parts.hpp"

namespace adversary {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

// clang-format off
inline constexpr auto table = machine("bed",
    components(
        component<can::Bus<bed_signals>>("can", device("bed-can")),
        component<gpio::LinePort<bed_lines>>("io", device("bed-io")),
        component<modbus::Client<bed_registers>>("unit", device("bed-unit")),
        component<Valve>("valve", properties_file("valve.cpf", optional)),
        component<Valve>("door"), component<Valve>("drain"), component<Valve>("mixer"), // by a property, by a row, by a script
        component<Pump>("pump"), component<Gate>("gate"), component<Oven>("oven"), component<Scale>("scale"), component<Doser>("doser"), component<Recipe>("recipe"), component<Beats>("beats"),
        component<can::Restarter>("restarter", device("bed-can")),
        component<BrowserService>("browser"), component<CommandInterpreter>("interpreter")),
    activities(
        activity("can",     on_device("can"), at_most(8, 1ms), runs("can"), deadline(500us), budget(30us)),
        activity("io",      on_device("io"),  at_most(8, 1ms), runs("io"),  deadline(300us), budget(16us)),
        activity("work",    every(5ms), runs("valve", "door", "drain", "mixer", "gate", "doser", "recipe", "beats"), budget(100us)),
        activity("pump",    every(10ms), runs("pump", "oven", "scale"), budget(100us)),
        activity("unit",    every(50ms), not_real_time, runs("unit")),
        activity("restarter", every(100ms), not_real_time, runs("restarter")),
        activity("browser", every(20ms), not_real_time, runs("browser", "interpreter"), stack(256 * 1024))),
    connections(
        data("can.level.height", "doser.height", stale_after(50ms), hold),
        data("can.faulted",      "restarter.faulted"),
        data("pump.speed",       "can.pump.speed"),
        data("pump.on",          "can.pump.on"),
        data("pump.spare",       "can.pump.spare"),
        data("pump.torque",      "can.pump.torque"),
        data("valve.on",         "io.valve", wakes),
        data("door.on",          "io.door", wakes),
        data("drain.on",         "io.drain", wakes),
        data("mixer.on",         "io.mixer", wakes),
        data("doser.lamp",       "io.lamp", wakes),
        data("unit.oven.temperature", "oven.temperature", stale_after(1s), hold),
        data("can.level.weight", "scale.weight", stale_after(50ms), hold),
        data("unit.meter.flow",  "scale.flow", stale_after(1s), hold),
        data("scale.share",      "doser.share", interpolated),
        data("oven.power",       "unit.heat.power"),
        data("oven.fan",         "unit.heat.fan"),
        data("oven.burner",      "unit.burner.on")),
    reactions(
        when("gate.lifts",    tell("io.gate.set")),
        when("gate.falls",    tell("io.gate.clear")),
        uses("doser.open",    "drain.open"),
        uses("doser.close",   "drain.close")),
    behaviours(
        behaviour("recipe", slot(nodes(200), data_bytes(2048), depth(4), command_slots(4), timers(2), text_bytes(8000), peers("mixer", "pump", "gate"),
            operations("mixer.open", "mixer.close", "mixer.turn", "gate.lift", "pump.run")), on_error(OnError::report))),
    limits(
        limit("scale.mean", -infinity, 1000.0)));
// clang-format on

} // namespace adversary
