// The press as a whole: the states of its axis as PLCopen names them, its drive, its lamp.
#pragma once

#include "apps/bearing_press/maps.hpp"
#include "drivers/canopen/cia402.hpp"
#include "kernel/component/component.hpp"
#include "kernel/program/operator_kinds.hpp"
#include "kernel/statechart/rows.hpp"

#include <cmath>

namespace bearing_press {

/// Process component: it reads all, says which chain shall run, and leads the drive. Real-time, periodic.
struct Axis {
    Input<std::int64_t> statusword;
    Input<double> position, velocity;
    Input<bool> home, end_switch, up, down, lines_faulted, bus_faulted;
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
        if (asked_ != wanted_) {
            run.reset();
            if (run.send(wanted_)) asked_ = wanted_;
        } else if (run.state() == CommandState::done && tells_ != nullptr) { // only who runs hears it
            tells_->emit(value_);
            tells_ = nullptr;
        }
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        controlword.write(canopen::controlword::quick_stop);
        lamp.write(false);
    }

    // ---- entries
    void disable() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::quick_stop, "stand"); }
    void halt() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::enabled, "stand"); }
    /// Towards the edge of the home switch, from whichever side.
    void seek() noexcept TAPPET_REALTIME {
        become(canopen::DriveGoal::enabled, "jog", &jog_at, home.get() ? homing_speed : -homing_speed);
    }
    void jog() noexcept TAPPET_REALTIME {
        become(canopen::DriveGoal::enabled, "jog", &jog_at, down.get() ? jog_speed : -jog_speed);
    }
    void go_down() noexcept TAPPET_REALTIME { go_to(above); }
    void go_up() noexcept TAPPET_REALTIME { go_to(rest); }
    void press() noexcept TAPPET_REALTIME { become(canopen::DriveGoal::enabled, "press"); }

    // ---- of transitions
    void acknowledge() noexcept TAPPET_REALTIME { drive_.acknowledge(); }
    void take_zero() noexcept TAPPET_REALTIME {
        zero_ = position.get();
        is_homed.write(true);
    }
    void count() noexcept TAPPET_REALTIME { seated.write(++seated_); }
    [[nodiscard]] bool may_enable() noexcept TAPPET_REALTIME { return obstacle().empty(); }
    [[nodiscard]] bool stands() noexcept TAPPET_REALTIME {
        return follows_ && std::abs(velocity.get()) < 1e-3;
    }
    [[nodiscard]] bool may_home() noexcept TAPPET_REALTIME { return stands() && !is_homed.last(); }
    [[nodiscard]] bool may_cycle() noexcept TAPPET_REALTIME { return stands() && is_homed.last(); }
    [[nodiscard]] bool is_let_go() noexcept TAPPET_REALTIME { return !up.get() && !down.get(); }
    [[nodiscard]] bool has_failed() noexcept TAPPET_REALTIME {
        return !follows_ || lines_faulted.get() || bus_faulted.get() || run.state() == CommandState::failed ||
               run.state() == CommandState::rejected;
    }
    [[nodiscard]] bool is_in_danger() noexcept TAPPET_REALTIME { return has_failed() || end_switch.get(); }
    /// Empty: nothing stands in the way of power.
    [[nodiscard]] std::string_view obstacle() noexcept TAPPET_REALTIME {
        if (lines_faulted.get()) return "the lines cannot be relied on";
        return bus_faulted.get() ? "the CAN bus cannot be relied on" : "";
    }

    static constexpr auto interface() {
        return facets(input<&Axis::statusword>("statusword", "", "of the drive (CiA 402)"),
                      input<&Axis::position>("position", "m", "of the slide"),
                      input<&Axis::velocity>("velocity", "m/s", "of the slide"),
                      input<&Axis::home>("home", "", "the slide is above zero"),
                      input<&Axis::end_switch>("end_switch", "", "the slide is at an end"),
                      input<&Axis::up>("up", "", "the button is held"),
                      input<&Axis::down>("down", "", "the button is held"),
                      input<&Axis::lines_faulted>("lines_faulted", "", "nobody knows what the switches say"),
                      input<&Axis::bus_faulted>("bus_faulted", "", "the drive is not heard"),
                      output<&Axis::controlword>("controlword", "", "of the drive (CiA 402)"),
                      output<&Axis::seated>("seated", "", "bearings, since the start"),
                      output<&Axis::lamp>("lamp", "", "the axis has power"),
                      output<&Axis::is_homed>("is_homed", "", "zero is known"),
                      event<&Axis::jog_at>("jog_at", "m/s: the speed of jogging"),
                      event<&Axis::aim>("aim", "m: where the next path leads"),
                      sends<&Axis::run>("run", "the chain that shall run"));
    }

private:
    static constexpr double homing_speed = 0.01, jog_speed = 0.02; // m/s
    static constexpr double rest = 0.02, above = 0.19;             // m below zero

    void become(canopen::DriveGoal goal, std::string_view chain, Event<double>* tells = nullptr,
                double value = 0.0) noexcept TAPPET_REALTIME {
        drive_.want(goal);
        lamp.write(goal == canopen::DriveGoal::enabled);
        asked_ = {};                              // anew, also the same: it may have fallen back meanwhile
        static_cast<void>(wanted_.assign(chain)); // shorter than any text
        tells_ = tells;
        value_ = value;
    }
    void go_to(double place) noexcept TAPPET_REALTIME {
        become(canopen::DriveGoal::enabled, "path", &aim, zero_ + place);
    }

    canopen::DriveControl drive_{};
    ScriptText wanted_{}, asked_{};
    Event<double>* tells_ = nullptr; ///< what the chain is told when it runs
    double value_ = 0.0;
    bool follows_ = false;
    double zero_ = 0.0;
    std::int64_t seated_ = 0;
};

// clang-format off
inline constexpr auto axis_states = state_machine<Axis>("axis_states",
    states( // PLCopen, Function blocks for motion control, 2.1
        state("Disabled",         initial, entry<&Axis::disable>),
        state("Standstill",       entry<&Axis::halt>),
        state("Homing",           entry<&Axis::seek>),
        state("ContinuousMotion", entry<&Axis::jog>),
        state("DiscreteMotion",   entry<&Axis::go_down>), // down to the bearing
        state("Pressing",         entry<&Axis::press>),   // led by force
        state("Returning",        entry<&Axis::go_up>),
        state("Stopping",         entry<&Axis::halt>),
        state("ErrorStop",        entry<&Axis::disable>),
        state("safe",             final, entry<&Axis::disable>)),
    transitions(
        transition("Disabled",         "Stopping",         on("io.start.rises"), guard<&Axis::may_enable>.because<&Axis::obstacle>("the drive gets no power"), then<&Axis::acknowledge>),
        transition("ErrorStop",        "Stopping",         on("io.start.rises"), guard<&Axis::may_enable>.because<&Axis::obstacle>("the drive gets no power"), then<&Axis::acknowledge>),
        transition("Stopping",         "Standstill",       guard<&Axis::stands>),
        transition("Standstill",       "Homing",           on("io.start.rises"), guard<&Axis::may_home>),
        transition("Standstill",       "DiscreteMotion",   on("io.start.rises"), guard<&Axis::may_cycle>.because("the slide moves, or the drive has no power")),
        transition("Standstill",       "ContinuousMotion", on("io.up.rises"),    guard<&Axis::stands>),
        transition("Standstill",       "ContinuousMotion", on("io.down.rises"),  guard<&Axis::stands>),
        transition("ContinuousMotion", "Stopping",         guard<&Axis::is_let_go>),
        transition("Homing",           "Stopping",         on("io.home.rises"), then<&Axis::take_zero>),
        transition("Homing",           "Stopping",         on("io.home.falls"), then<&Axis::take_zero>),
        transition("DiscreteMotion",   "Pressing",         on("path.arrived")),
        transition("Pressing",         "Returning",        on("press.seated"), then<&Axis::count>),
        transition("Returning",        "Standstill",       on("path.arrived")),
        transition("Homing",           "Stopping",         on("io.stop.rises"), because("stop was pressed")),
        transition("DiscreteMotion",   "Stopping",         on("io.stop.rises"), because("stop was pressed")),
        transition("Pressing",         "Stopping",         on("io.stop.rises"), because("stop was pressed")),
        transition("Returning",        "Stopping",         on("io.stop.rises"), because("stop was pressed")),
        transition("ContinuousMotion", "ErrorStop",        guard<&Axis::has_failed>,   because("drive, lines, bus or a controller failed")),
        transition("Standstill",       "ErrorStop",        guard<&Axis::has_failed>,   because("drive, lines, bus or a controller failed")),
        transition("Homing",           "ErrorStop",        guard<&Axis::is_in_danger>, because("a failure, or an end switch")),
        transition("DiscreteMotion",   "ErrorStop",        guard<&Axis::is_in_danger>, because("a failure, or an end switch")),
        transition("Pressing",         "ErrorStop",        guard<&Axis::is_in_danger>, because("a failure, or an end switch")),
        transition("Returning",        "ErrorStop",        guard<&Axis::is_in_danger>, because("a failure, or an end switch")),
        transition("DiscreteMotion",   "ErrorStop",        on("mode.fell_back"), because("a controller failed")),
        transition("Pressing",         "ErrorStop",        on("mode.fell_back"), because("a controller failed"))));
// clang-format on

} // namespace bearing_press
