// The press as a machine: the states of its axis in PLCopen's names, its drive, its lamp.
#pragma once

#include "apps/bearing_press/maps.hpp"
#include "drivers/canopen/cia402.hpp"
#include "kernel/component/component.hpp"
#include "kernel/program/operator_kinds.hpp"
#include "kernel/statechart/rows.hpp"

#include <cmath>

namespace bearing_press {

/// Process component: reads all inputs, selects the control chain, and leads the drive. Real-time, periodic.
struct Axis {
    Input<std::int64_t> statusword;
    Input<double> position, velocity;
    Input<bool> home, upper_end, lower_end, up, down, stop_held, lines_faulted, bus_faulted;
    Output<std::int64_t> controlword, seated;
    Output<bool> lamp, is_homed;
    Event<double> jog_at, aim;
    CommandCall<const ScriptText&> run;

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        is_homed.write(false);
        seated.write(seated_);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const auto status = static_cast<std::uint16_t>(statusword.get());
        controlword.write(drive_.controlword(status));
        follows_ = canopen::drive_state(status) == canopen::DriveState::operation_enabled;
        if (in_flight(run.state())) return;
        if (asked_ != wanted_ &&
            (follows_ || !needs_power_)) { // a led drive without power would jump once enabled
            run.reset();
            if (run.send(wanted_)) asked_ = wanted_;
        } else if (run.state() == CommandState::done && tells_ != nullptr) { // only a running chain hears it
            tells_->emit(value_);
            tells_ = nullptr;
        }
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        controlword.write(canopen::controlword::quick_stop);
        lamp.write(false);
    }

    // ---- entries
    /// Clears is_homed: nobody counts the motion of a disabled drive.
    void disable() noexcept TAPPET_REALTIME {
        is_homed.write(false);
        become(canopen::DriveGoal::quick_stop, "off");
    }
    void halt() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::enabled, "stand"); }
    /// Moves towards the edge of the home switch, from either side.
    void seek() noexcept TAPPET_REALTIME {
        become(canopen::DriveGoal::enabled, "jog", &jog_at, home.get() ? homing_speed : -homing_speed);
    }
    void jog() noexcept TAPPET_REALTIME {
        jogs_down_ = down.get();
        become(canopen::DriveGoal::enabled, "jog", &jog_at, jogs_down_ ? jog_speed : -jog_speed);
    }
    void go_down() noexcept TAPPET_REALTIME { go_to(above); }
    void go_up() noexcept TAPPET_REALTIME { go_to(rest); }
    void press() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::enabled, "press"); }

    // ---- effects of transitions
    void acknowledge() noexcept TAPPET_REALTIME { drive_.acknowledge(); }
    void take_zero() noexcept TAPPET_REALTIME {
        zero_ = position.get();
        is_homed.write(true);
    }
    void count() noexcept TAPPET_REALTIME { seated.write(++seated_); }
    [[nodiscard]] bool may_enable() noexcept TAPPET_REALTIME { return obstacle().empty(); }
    [[nodiscard]] bool has_power() noexcept TAPPET_REALTIME { return follows_; }
    [[nodiscard]] bool stands() noexcept TAPPET_REALTIME {
        return follows_ && std::abs(velocity.get()) < 1e-3 && run.state() == CommandState::done;
    }
    [[nodiscard]] bool may_move() noexcept TAPPET_REALTIME { return stands() && obstacle().empty(); }
    [[nodiscard]] bool may_home() noexcept TAPPET_REALTIME {
        return may_move() && !is_homed.last() && !at_end();
    }
    [[nodiscard]] bool may_cycle() noexcept TAPPET_REALTIME {
        return may_move() && is_homed.last() && !at_end();
    }
    /// Returns true when the button is released or the slide is at the end towards which it moves.
    [[nodiscard]] bool jogs_no_more() noexcept TAPPET_REALTIME {
        return jogs_down_ ? !down.get() || lower_end.get() : !up.get() || upper_end.get();
    }
    [[nodiscard]] bool has_failed() noexcept TAPPET_REALTIME {
        return !follows_ || lines_faulted.get() || bus_faulted.get() || run.state() == CommandState::failed ||
               run.state() == CommandState::rejected;
    }
    [[nodiscard]] bool is_in_danger() noexcept TAPPET_REALTIME { return has_failed() || at_end(); }
    /// Returns what prevents a start; empty when nothing does.
    [[nodiscard]] std::string_view obstacle() noexcept TAPPET_REALTIME {
        if (lines_faulted.get()) return "the lines cannot be relied on";
        if (bus_faulted.get()) return "the CAN bus cannot be relied on";
        return stop_held.get() ? "stop is pressed" : "";
    }

    static constexpr auto interface() {
        return facets(
            input<&Axis::statusword>("statusword", "", "of the drive (CiA 402)"),
            input<&Axis::position>("position", "m", "of the slide"),
            input<&Axis::velocity>("velocity", "m/s", "of the slide"),
            input<&Axis::home>("home", "", "the slide is above zero"),
            input<&Axis::upper_end>("upper_end", "", "the slide is at that end"),
            input<&Axis::lower_end>("lower_end", "", "the slide is at that end"),
            input<&Axis::stop_held>("stop_held", "", "the button is held"),
            input<&Axis::up>("up", "", "the button is held"),
            input<&Axis::down>("down", "", "the button is held"),
            input<&Axis::lines_faulted>("lines_faulted", "", "the levels of the switches are unknown"),
            input<&Axis::bus_faulted>("bus_faulted", "", "the drive is not heard"),
            output<&Axis::controlword>("controlword", "", "of the drive (CiA 402)"),
            output<&Axis::seated>("seated", "", "bearings, since the start"),
            output<&Axis::lamp>("lamp", "", "the axis has power"),
            output<&Axis::is_homed>("is_homed", "", "zero is known"),
            event<&Axis::jog_at>("jog_at", "m/s: the speed of jogging"),
            event<&Axis::aim>("aim", "m: where the next path leads"),
            sends<&Axis::run>("run", "selects the chain that runs"));
    }

private:
    static constexpr double homing_speed = 0.01, jog_speed = 0.02; // m/s
    static constexpr double rest = 0.02, above = 0.19;             // m below zero

    void become(canopen::DriveGoal goal, std::string_view chain, Event<double>* tells = nullptr,
                double value = 0.0) noexcept TAPPET_REALTIME {
        drive_.want(goal);
        needs_power_ = goal == canopen::DriveGoal::enabled;
        lamp.write(goal == canopen::DriveGoal::enabled);
        asked_ = {}; // sends the same chain again too: it may have fallen back meanwhile
        static_cast<void>(wanted_.assign(chain)); // shorter than any text
        tells_ = tells;
        value_ = value;
    }
    [[nodiscard]] bool at_end() noexcept TAPPET_REALTIME { return upper_end.get() || lower_end.get(); }
    void go_to(double place) noexcept TAPPET_REALTIME {
        become(canopen::DriveGoal::enabled, "path", &aim, zero_ + place);
    }

    canopen::DriveControl drive_{};
    ScriptText wanted_{}, asked_{};
    Event<double>* tells_ = nullptr; ///< event for the chain, sent when it runs
    double value_ = 0.0;
    bool follows_ = false, needs_power_ = false, jogs_down_ = false;
    double zero_ = 0.0;
    std::int64_t seated_ = 0;
};

// clang-format off
inline constexpr auto axis_states = state_machine<Axis>("axis_states",
    states( // PLCopen, Function blocks for motion control, 2.1
        state("Disabled",         initial, entry<&Axis::disable>),
        state("Enabling",         entry<&Axis::halt>),
        state("Standstill",       entry<&Axis::halt>),
        state("Homing",           entry<&Axis::seek>),
        state("ContinuousMotion", entry<&Axis::jog>),
        state("DiscreteMotion",   entry<&Axis::go_down>), // down to the bearing
        state("Pressing",         entry<&Axis::press>),   // controlled by force
        state("Returning",        entry<&Axis::go_up>),
        state("Stopping",         entry<&Axis::halt>),
        state("ErrorStop",        entry<&Axis::disable>),
        state("safe",             final, entry<&Axis::disable>)),
    transitions(
        transition("Disabled",         "Enabling",         on("io.start.rises"), guard<&Axis::may_enable>.because<&Axis::obstacle>("the drive gets no power"), then<&Axis::acknowledge>),
        transition("ErrorStop",        "Enabling",         on("io.start.rises"), guard<&Axis::may_enable>.because<&Axis::obstacle>("the drive gets no power"), then<&Axis::acknowledge>),
        transition("Enabling",         "Stopping",         guard<&Axis::has_power>),
        transition("Enabling",         "ErrorStop",        after(1s), because("the drive takes no power")),
        transition("Stopping",         "Standstill",       guard<&Axis::stands>),
        transition("Standstill",       "Homing",           on("io.start.rises"), guard<&Axis::may_home>),
        transition("Standstill",       "DiscreteMotion",   on("io.start.rises"), guard<&Axis::may_cycle>.because<&Axis::obstacle>("the slide moves, or is at an end")),
        transition("Standstill",       "ContinuousMotion", on("io.up.rises"),    guard<&Axis::may_move>),
        transition("Standstill",       "ContinuousMotion", on("io.down.rises"),  guard<&Axis::may_move>),
        transition("ContinuousMotion", "Stopping",         guard<&Axis::jogs_no_more>),
        transition("Homing",           "Stopping",         on("io.home.rises"), then<&Axis::take_zero>),
        transition("Homing",           "Stopping",         on("io.home.falls"), then<&Axis::take_zero>),
        transition("DiscreteMotion",   "Pressing",         on("path.arrived")),
        transition("Pressing",         "Returning",        on("press.seated"), then<&Axis::count>),
        transition("Returning",        "Standstill",       on("path.arrived")),
        transition("Homing",           "Stopping",         on("io.stop.rises"), because("stop was pressed")),
        transition("ContinuousMotion", "Stopping",         on("io.stop.rises"), because("stop was pressed")),
        transition("DiscreteMotion",   "Stopping",         on("io.stop.rises"), because("stop was pressed")),
        transition("Pressing",         "Stopping",         on("io.stop.rises"), because("stop was pressed")),
        transition("Returning",        "Stopping",         on("io.stop.rises"), because("stop was pressed")),
        transition("Standstill",       "ErrorStop",        guard<&Axis::has_failed>,   because("drive, lines, bus or a controller failed")),
        transition("Stopping",         "ErrorStop",        guard<&Axis::has_failed>,   because("drive, lines, bus or a controller failed")),
        transition("ContinuousMotion", "ErrorStop",        guard<&Axis::has_failed>,   because("drive, lines, bus or a controller failed")),
        transition("Homing",           "ErrorStop",        guard<&Axis::is_in_danger>, because("a failure, or an end switch")),
        transition("DiscreteMotion",   "ErrorStop",        guard<&Axis::is_in_danger>, because("a failure, or an end switch")),
        transition("Pressing",         "ErrorStop",        guard<&Axis::is_in_danger>, because("a failure, or an end switch")),
        transition("Returning",        "ErrorStop",        guard<&Axis::is_in_danger>, because("a failure, or an end switch")),
        transition("Standstill",       "ErrorStop",        on("mode.fell_back"), because("a controller stopped")),
        transition("Stopping",         "ErrorStop",        on("mode.fell_back"), because("a controller stopped")),
        transition("ContinuousMotion", "ErrorStop",        on("mode.fell_back"), because("a controller stopped")),
        transition("Homing",           "ErrorStop",        on("mode.fell_back"), because("a controller stopped")),
        transition("DiscreteMotion",   "ErrorStop",        on("mode.fell_back"), because("a controller stopped")),
        transition("Pressing",         "ErrorStop",        on("mode.fell_back"), because("a controller stopped")),
        transition("Returning",        "ErrorStop",        on("mode.fell_back"), because("a controller stopped"))));
// clang-format on

} // namespace bearing_press
