// A machine whose one axis stands on a CiA 402 drive: what it does is asked for by people alone.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/canopen/axis.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/services/interpreter/command_interpreter.hpp"

namespace adversary_axis {

using namespace tappet;

// clang-format off
inline constexpr auto axis_signals = can::signal_map(
    can::receive(can::standard(0x181), "status", can::bytes(3), can::every(2ms), can::signal("word", 0, 16), can::signal("mode", 16, 8).as_signed()),
    can::receive(can::standard(0x281), "actual", can::bytes(8), can::every(2ms),
        can::signal("position", 0, 32).as_signed().times(0.001).in("mm"), can::signal("velocity", 32, 32).as_signed().times(0.001).in("mm/s")),
    can::transmit(can::standard(0x201), "control", can::bytes(3), can::every(2ms), can::signal("word", 0, 16).safe(2), can::signal("mode", 16, 8).as_signed().safe(0)),
    can::transmit(can::standard(0x301), "target", can::bytes(8), can::every(2ms),
        can::signal("position", 0, 32).as_signed().times(0.001).in("mm"), can::signal("velocity", 32, 32).as_signed().times(0.001).in("mm/s")).safe_by_silence(),
    can::transmit(can::standard(0x401), "profile", can::bytes(6), can::every(2ms),
        can::signal("velocity", 0, 32).times(0.001).in("mm/s"), can::signal("torque", 32, 16).as_signed().times(0.1)).safe_by_silence());

inline constexpr auto table = machine("axis-bed",
    components(
        component<can::Bus<axis_signals>>("can", device("axis-can")),
        component<canopen::Axis<"mm">>("axis", set("standing", 0.01)),
        component<BrowserService>("browser"), component<CommandInterpreter>("interpreter")),
    activities(
        activity("can",     on_device("can"), at_most(8, 1ms), runs("can"), deadline(500us), budget(30us)),
        activity("axis",    every(2ms), runs("axis"), budget(50us)),
        activity("browser", every(20ms), not_real_time, runs("browser", "interpreter"), stack(256 * 1024))),
    connections(
        data("can.status.word",       "axis.statusword",   stale_after(20ms), hold),
        data("can.status.mode",       "axis.mode_display", stale_after(20ms), hold),
        data("can.actual.position",   "axis.position",     stale_after(20ms), hold),
        data("can.actual.velocity",   "axis.velocity",     stale_after(20ms), hold),
        data("axis.controlword",      "can.control.word"),
        data("axis.mode",             "can.control.mode"),
        data("axis.target_position",  "can.target.position"),
        data("axis.target_velocity",  "can.target.velocity"),
        data("axis.profile_velocity", "can.profile.velocity"),
        data("axis.target_torque",    "can.profile.torque")),
    reactions(),
    behaviours());
// clang-format on

} // namespace adversary_axis
