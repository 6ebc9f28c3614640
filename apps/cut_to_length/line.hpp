// The line's state component: its state machine, its drive, its lamp.
#pragma once

#include "apps/cut_to_length/maps.hpp"
#include "drivers/canopen/cia402.hpp"
#include "kernel/component/component.hpp"
#include "kernel/statechart/rows.hpp"

namespace cut_to_length {

/// Real-time, periodic.
struct Line {
    Input<std::int64_t> statusword;
    Input<bool> emergency_stop, lines_faulted, bus_faulted, wheel_valid;
    Output<std::int64_t> controlword;
    Output<double> target;
    Output<bool> lamp, knife_allowed;
    Property<double> speed{2.0};

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const auto status = static_cast<std::uint16_t>(statusword.get());
        controlword.write(drive_.controlword(status));
        follows_ = canopen::drive_state(status) == canopen::DriveState::operation_enabled;
        target.write(follows_ && runs_ ? speed.get() : 0.0);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        controlword.write(canopen::controlword::quick_stop);
        target.write(0.0);
        knife_allowed.write(false);
    }

    void enter_stopped() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::enabled, false, true); }
    void enter_running() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::enabled, true, true); }
    void enter_halted() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::quick_stop, false, false); }
    void acknowledge() noexcept TAPPET_REALTIME { drive_.acknowledge(); }
    [[nodiscard]] bool may_unlock() noexcept TAPPET_REALTIME { return !is_in_danger(); }
    [[nodiscard]] bool may_run() noexcept TAPPET_REALTIME { return follows_ && !is_in_danger(); }
    [[nodiscard]] bool is_in_danger() noexcept TAPPET_REALTIME {
        return emergency_stop.get() || lines_faulted.get() || bus_faulted.get() || !wheel_valid.get();
    }
    /// Returns why the guards above refuse.
    [[nodiscard]] std::string_view obstacle() noexcept TAPPET_REALTIME {
        if (emergency_stop.get()) return "the emergency stop is pressed";
        if (lines_faulted.get()) return "the lines cannot be relied on";
        if (bus_faulted.get()) return "the CAN bus cannot be relied on";
        return wheel_valid.get() ? "the drive is not enabled" : "the measuring wheel is not to be relied on";
    }
    [[nodiscard]] bool drive_is_lost() noexcept TAPPET_REALTIME { return !follows_; }

    static constexpr auto interface() {
        return facets(input<&Line::statusword>("statusword", "", "of the feed drive (CiA 402)"),
                      input<&Line::emergency_stop>("emergency_stop", "", "it is pressed"),
                      input<&Line::lines_faulted>("lines_faulted", "", "whether it is pressed is unknown"),
                      input<&Line::bus_faulted>("bus_faulted", "", "the drive is not heard"),
                      input<&Line::wheel_valid>("wheel_valid", "", "the position of the web is known"),
                      output<&Line::controlword>("controlword", "", "of the feed drive (CiA 402)"),
                      output<&Line::target>("target", "m/s", "speed of the web"),
                      output<&Line::lamp>("lamp", "", "the line runs"),
                      output<&Line::knife_allowed>("knife_allowed", "", "the line moves the web itself"),
                      property<&Line::speed>("speed", "m/s", "while it runs", range(0.1, 2.5)));
    }

private:
    void become(canopen::DriveGoal goal, bool runs, bool cuts) noexcept TAPPET_REALTIME {
        drive_.want(goal);
        runs_ = runs;
        lamp.write(runs);
        knife_allowed.write(cuts);
    }
    canopen::DriveControl drive_{};
    bool runs_ = false, follows_ = false;
};

// clang-format off
inline constexpr auto line_states = state_machine<Line>("line_states",
    states(
        state("locked",    initial, entry<&Line::enter_halted>), // nothing moves: press start once
        state("ready",     entry<&Line::enter_stopped>),         // the web stands, or brakes to a stand and is cut
        state("running",   entry<&Line::enter_running>),
        state("emergency", entry<&Line::enter_halted>),
        state("safe",      final, entry<&Line::enter_halted>)),
    transitions(
        transition("locked",    "ready",     on("io.start.rises"), guard<&Line::may_unlock>.because<&Line::obstacle>("the line may not be unlocked"), then<&Line::acknowledge>),
        transition("emergency", "ready",     on("io.start.rises"), guard<&Line::may_unlock>.because<&Line::obstacle>("the line may not be unlocked"), then<&Line::acknowledge>),
        transition("ready",     "running",   on("io.start.rises"), guard<&Line::may_run>.because<&Line::obstacle>("the line may not run")),
        transition("running",   "ready",     on("io.stop.rises"), because("stop was pressed")),
        transition("running",   "emergency", guard<&Line::drive_is_lost>, because("the drive does not follow")),
        transition("running",   "emergency", guard<&Line::is_in_danger>, because("emergency stop, lines, bus or wheel")),
        transition("ready",     "emergency", guard<&Line::is_in_danger>, because("emergency stop, lines, bus or wheel"))));
// clang-format on

} // namespace cut_to_length
