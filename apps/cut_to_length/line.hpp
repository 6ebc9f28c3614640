// The line as a whole: its states, its drive, its lamp.
#pragma once

#include "apps/cut_to_length/maps.hpp"
#include "drivers/canopen/cia402.hpp"
#include "kernel/component/component.hpp"
#include "kernel/statechart/rows.hpp"

namespace cut_to_length {

/// Real-time, periodic.
struct Line {
    Input<std::int64_t> statusword;
    Input<bool> emergency_stop;
    Output<std::int64_t> controlword;
    Output<double> target;
    Output<bool> lamp;
    Property<double> speed{2.0};

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const auto status = static_cast<std::uint16_t>(statusword.get());
        controlword.write(drive_.controlword(status));
        const bool follows = canopen::drive_state(status) == canopen::DriveState::operation_enabled;
        target.write(follows && runs_ ? speed.get() : 0.0);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        controlword.write(canopen::controlword::quick_stop);
        target.write(0.0);
    }

    void enter_stopped() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::enabled, false); }
    void enter_running() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::enabled, true); }
    void enter_emergency() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::quick_stop, false); }
    [[nodiscard]] bool may_run() noexcept TAPPET_REALTIME { return !emergency_stop.get(); }

    static constexpr auto interface() {
        return facets(input<&Line::statusword>("statusword", "", "of the feed drive (CiA 402)"),
                      input<&Line::emergency_stop>("emergency_stop", "", "it is pressed"),
                      output<&Line::controlword>("controlword", "", "of the feed drive (CiA 402)"),
                      output<&Line::target>("target", "m/s", "speed of the web"),
                      output<&Line::lamp>("lamp", "", "the line runs"),
                      property<&Line::speed>("speed", "m/s", "while it runs", range(0.1, 2.5)));
    }

private:
    void become(canopen::DriveGoal goal, bool runs) noexcept TAPPET_REALTIME {
        drive_.want(goal);
        drive_.acknowledge();
        runs_ = runs;
        lamp.write(runs);
    }
    canopen::DriveControl drive_{};
    bool runs_ = false;
};

// clang-format off
inline constexpr auto line_states = state_machine<Line>("line_states",
    states(
        state("locked",    initial, entry<&Line::enter_emergency>), // nothing moves: press start once
        state("stopped",   entry<&Line::enter_stopped>),
        state("running",   entry<&Line::enter_running>),
        state("emergency", entry<&Line::enter_emergency>),
        state("safe",      final, entry<&Line::enter_emergency>)),
    transitions(
        transition("locked",    "stopped",   on("io.start.rises"), guard<&Line::may_run>),
        transition("stopped",   "running",   on("io.start.rises"), guard<&Line::may_run>),
        transition("running",   "stopped",   on("io.stop.rises"), because("stop was pressed")),
        transition("running",   "emergency", on("io.emergency_stop.rises"), because("the emergency stop was pressed")),
        transition("running",   "emergency", on("can.bus_fault"), because("the CAN bus is off")),
        transition("stopped",   "emergency", on("io.emergency_stop.rises"), because("the emergency stop was pressed")),
        transition("emergency", "stopped",   on("io.start.rises"), guard<&Line::may_run>)));
// clang-format on

} // namespace cut_to_length
