// A machine whose one axis uses a CiA 402 drive: it homes, moves to positions and follows, while users send
// it any other request.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/canopen/axis.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/services/interpreter/command_interpreter.hpp"

namespace adversary_axis {

using namespace tappet;

/// One motion after another, with pauses. While the axis follows positions, they continue from its current
/// one, long enough for other requests to come in between.
struct Work {
    Input<bool> follows;
    Input<double> position;
    Output<double> place;
    Event<> power_on, reset, release;
    CommandCall<> home;
    CommandCall<double, double> move_to;
    CommandCall<double, double, double> superimpose;
    CommandCall<std::int64_t> synchronize;

    void start(const Cycle&) noexcept TAPPET_REALTIME { waits_ = turn_ = 0; }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const bool leads = std::exchange(leads_, follows.get()) && leads_;
        place.write(leads ? place.last() + 0.01 : position.get());
        if (in_flight(home.state()) || in_flight(move_to.state()) || in_flight(synchronize.state()) ||
            in_flight(superimpose.state()))
            waits_ = 0;
        if (++waits_ < pause) return;
        waits_ = 0;
        switch (turn_++ % 9) {
        case 0:
            reset.emit();
            release.emit();
            return power_on.emit();
        case 1: return static_cast<void>(home.send());
        case 2: return static_cast<void>(move_to.send(25.0, 40.0));
        case 3: return static_cast<void>(synchronize.send(8));
        case 4: return static_cast<void>(superimpose.send(2.0, 5.0, 50.0));
        case 8: return static_cast<void>(move_to.send(-25.0, 20.0));
        default: return;
        }
    }
    static constexpr auto interface() {
        return facets(
            input<&Work::follows>("follows", "", "the axis", optional),
            input<&Work::position>("position", "mm", "of the axis"),
            output<&Work::place>("place", "mm", "where it is led"),
            event<&Work::power_on>("power_on", "asked for"), event<&Work::reset>("reset", "asked for"),
            event<&Work::release>("release", "asked for"), sends<&Work::home>("home", "its reference"),
            sends<&Work::move_to>("move_to", "a place"),
            sends<&Work::superimpose>("superimpose", "a distance"),
            sends<&Work::synchronize>("synchronize", "with positions"));
    }

private:
    static constexpr int pause = 300; // cycles
    int waits_ = 0, turn_ = 0;
    bool leads_ = false;
};

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
        component<Work>("work"),
        component<BrowserService>("browser"), component<CommandInterpreter>("interpreter")),
    activities(
        activity("can",     on_device("can"), at_most(8, 1ms), runs("can"), deadline(500us), budget(30us)),
        activity("axis",    every(2ms), runs("work", "axis"), budget(50us)),
        activity("browser", every(20ms), not_real_time, runs("browser", "interpreter"), stack(256 * 1024))),
    connections(
        data("can.status.word",       "axis.statusword",   stale_after(20ms), hold),
        data("can.status.mode",       "axis.mode_display", stale_after(20ms), hold),
        data("can.actual.position",   "axis.position",     stale_after(20ms), hold),
        data("can.actual.velocity",   "axis.velocity",     stale_after(20ms), hold),
        data("can.actual.position",   "work.position",     stale_after(20ms), hold),
        data("axis.follows",          "work.follows", delayed),
        data("work.place",            "axis.set_point"),
        data("axis.controlword",      "can.control.word"),
        data("axis.mode",             "can.control.mode"),
        data("axis.target_position",  "can.target.position"),
        data("axis.target_velocity",  "can.target.velocity"),
        data("axis.profile_velocity", "can.profile.velocity"),
        data("axis.target_torque",    "can.profile.torque")),
    reactions(
        uses("work.home",        "axis.home"),
        uses("work.move_to",     "axis.move_to"),
        uses("work.superimpose", "axis.superimpose"),
        uses("work.synchronize", "axis.synchronize"),
        when("work.power_on",    call("axis.power_on")),
        when("work.reset",       call("axis.reset")),
        when("work.release",     call("axis.release"))),
    behaviours());
// clang-format on

} // namespace adversary_axis
