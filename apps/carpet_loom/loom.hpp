// The loom's state component: the operations and the guards of its state machine.
#pragma once

#include "apps/carpet_loom/loom_state.hpp"
#include "apps/carpet_loom/wires.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"
#include "kernel/pieces/changed.hpp"

namespace tappet::carpet {

namespace wires = loom::wires;

/// Its states are in loom_cycle.hpp. All real-time.
struct Loom {
    static constexpr bool behaviour_required = true;

    Input<bool> main_enabled, main_at_speed, main_fault, main_slips;
    Input<double> main_velocity;
    Input<bool> let_off_enabled, let_off_fault, tension_in_band;
    Input<bool> shaft_valid, shaft_standing, weft_working;
    Input<bool> motion_alive, shaft_alive, io_alive;
    Input<bool> bus_faulted, io_faulted, nodes_operational;
    Input<bool> drop_wire, emergency_stop;
    Input<double> oil_pressure;
    Output<bool> lamp_run, lamp_stop, lamp_fault;
    Output<double> pump;
    Output<std::int64_t> feeder_colour, feeder_speed;
    Output<LoomState> state;
    Output<StopCause> cause;
    Output<WaitsFor> waits_for;
    Event<> enable_drives, disable_drives, run_shaft, quick_stop;
    Event<> set_brake, release_brake;
    Event<> allow_weft, inhibit_weft;
    CommandCall<double&> stop_shaft;
    Property<double> least_oil_bar{wires::nominal::oil_pressure_least_bar};
    Property<std::int64_t> colour{1};

    // Guards.
    [[nodiscard]] bool prepared() noexcept TAPPET_REALTIME {
        const WaitsFor missing = first_missing();
        return missing == WaitsFor::nothing || missing == WaitsFor::drop_wire;
    }
    [[nodiscard]] bool may_start() noexcept TAPPET_REALTIME { return first_missing() == WaitsFor::nothing; }
    /// Returns which condition of these guards is missing.
    [[nodiscard]] std::string_view missing() noexcept TAPPET_REALTIME { return name_of(first_missing()); }
    [[nodiscard]] std::string_view obstacle() noexcept TAPPET_REALTIME {
        return name_of(emergency_stop.get() ? WaitsFor::emergency_stop : before_acknowledgement());
    }
    [[nodiscard]] bool at_speed() noexcept TAPPET_REALTIME { return main_at_speed.get(); }
    /// True when the brake may be released: the shaft stands still and nothing sets it again at once.
    [[nodiscard]] bool may_prepare() noexcept TAPPET_REALTIME {
        return !emergency_stop.get() && before_acknowledgement() == WaitsFor::acknowledgement;
    }
    [[nodiscard]] bool repaired() noexcept TAPPET_REALTIME { return !drop_wire.get() && may_prepare(); }
    [[nodiscard]] bool emergency_is_pressed() noexcept TAPPET_REALTIME { return emergency_stop.get(); }
    /// True: valve and brake may differ from what the loom believes; only the drive's quick stop is reliable.
    [[nodiscard]] bool bus_is_off() noexcept TAPPET_REALTIME { return bus_faulted.get(); }
    [[nodiscard]] bool encoder_is_stale() noexcept TAPPET_REALTIME { return !shaft_valid.get(); }
    [[nodiscard]] bool drives_are_off() noexcept TAPPET_REALTIME {
        return !main_enabled.get() || !let_off_enabled.get();
    }
    /// True when the drive turns and the shaft's encoder does not: frozen, or its coupling is broken.
    [[nodiscard]] bool encoder_stands() noexcept TAPPET_REALTIME {
        return main_at_speed.get() && shaft_standing.get();
    }
    [[nodiscard]] bool node_is_silent() noexcept TAPPET_REALTIME { return !nodes_operational.get(); }
    [[nodiscard]] bool drive_is_faulty() noexcept TAPPET_REALTIME {
        return main_fault.get() || let_off_fault.get();
    }
    [[nodiscard]] bool drive_slips() noexcept TAPPET_REALTIME { return main_slips.get(); }
    /// True when a condition that was once met since preparation began is not met now.
    [[nodiscard]] bool something_is_lost() noexcept TAPPET_REALTIME { return (had_ & ~there()) != 0; }
    [[nodiscard]] bool oil_is_lost() noexcept TAPPET_REALTIME { return !oil_good(); }
    [[nodiscard]] bool stop_is_refused() noexcept TAPPET_REALTIME {
        return stop_shaft.state() == CommandState::rejected || stop_shaft.state() == CommandState::failed;
    }
    [[nodiscard]] bool operator_stopped() noexcept TAPPET_REALTIME {
        return cause_ == StopCause::operator_stop;
    }

    // Programs of the state machine.
    /// Enters the locked state from any other: nothing moves until somebody acknowledges at the machine.
    void enter_locked() noexcept TAPPET_REALTIME {
        set_cause(StopCause::none);
        pump.write(0.0);
        disable_drives.emit();
        make_safe(LoomState::locked);
    }
    void enter_preparing() noexcept TAPPET_REALTIME {
        tell(LoomState::preparing, false, false, false);
        set_cause(StopCause::none);
        had_ = there();
        pump.write(1.0);
        release_brake.emit();
        enable_drives.emit();
    }
    /// Continues to prepare; an acknowledgement enables the drives again.
    void enter_asking() noexcept TAPPET_REALTIME { tell(LoomState::preparing, false, false, true); }
    void enter_ready() noexcept TAPPET_REALTIME { tell(LoomState::ready, false, true, false); }
    void enter_run_up() noexcept TAPPET_REALTIME {
        tell(LoomState::run_up, true, false, false);
        set_cause(StopCause::none);
        release_brake.emit();
        allow_weft.emit();
        run_shaft.emit();
    }
    void enter_weave() noexcept TAPPET_REALTIME { tell(LoomState::weave, true, false, false); }
    void enter_stopping() noexcept TAPPET_REALTIME {
        tell(LoomState::stopping, false, false, false);
        static_cast<void>(stop_shaft.send()); // during an older stop: this one is already requested
    }
    void enter_stopped() noexcept TAPPET_REALTIME { tell(LoomState::stopped, false, false, true); }
    void enter_emergency() noexcept TAPPET_REALTIME {
        set_cause(StopCause::emergency);
        make_safe(LoomState::emergency);
    }
    void enter_fault() noexcept TAPPET_REALTIME {
        set_cause(StopCause::fault);
        make_safe(LoomState::fault);
    }
    void enter_safe() noexcept TAPPET_REALTIME {
        disable_drives.emit(); // a turning shaft gets the quick stop that follows
        make_safe(LoomState::safe);
        lamp_fault.write(false);
        pump.write(0.0);
    }
    void because_weft() noexcept TAPPET_REALTIME { set_cause(StopCause::weft); }
    void because_warp() noexcept TAPPET_REALTIME { set_cause(StopCause::warp); }
    void because_operator() noexcept TAPPET_REALTIME { set_cause(StopCause::operator_stop); }

    /// Every input that decides wakes it, also when the input becomes stale.
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        had_ |= there();
        waits_for_.write(waits_for, first_missing());
    }

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        feeder_colour.write(colour.get());
        feeder_speed.write(feeder_windings_per_minute);
        pump.write(0.0);
        set_cause(StopCause::none);
    }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            input<&Loom::main_enabled>("main_enabled", "", "the main drive is enabled"),
            input<&Loom::main_at_speed>("main_at_speed", "", "the shaft turns at weaving speed"),
            input<&Loom::main_fault>("main_fault", "", "the main drive is faulty or silent"),
            input<&Loom::main_slips>("main_slips", "", "the main drive does not keep its speed"),
            input<&Loom::main_velocity>("main_velocity", "rpm", "of the main drive, as it says itself"),
            input<&Loom::let_off_enabled>("let_off_enabled", "", "the let-off drive is enabled"),
            input<&Loom::let_off_fault>("let_off_fault", "", "the let-off drive is faulty or silent"),
            input<&Loom::tension_in_band>("tension_in_band", "", "the warp has its tension"),
            input<&Loom::shaft_valid>("shaft_valid", "", "the encoder can be relied on"),
            input<&Loom::shaft_standing>("shaft_standing", "", "the shaft stands"),
            input<&Loom::weft_working>("weft_working", "", "wefts can be released and are judged"),
            input<&Loom::motion_alive>("motion_alive", "", "the activity that leads the drives shows life"),
            input<&Loom::shaft_alive>("shaft_alive", "", "the activity of the shaft shows life"),
            input<&Loom::io_alive>("io_alive", "", "the activity of the lines shows life"),
            input<&Loom::bus_faulted>("bus_faulted", "", "the CAN bus cannot be relied on"),
            input<&Loom::io_faulted>("io_faulted", "", "the lines cannot be relied on"),
            input<&Loom::nodes_operational>("nodes_operational", "", "every CAN node works"),
            input<&Loom::drop_wire>("drop_wire", "", "a warp end is broken"),
            input<&Loom::emergency_stop>("emergency_stop", "", "the emergency stop is pressed"),
            input<&Loom::oil_pressure>("oil_pressure", "bar", "of the lubrication"),
            output<&Loom::lamp_run>("lamp_run", "", "the loom runs"),
            output<&Loom::lamp_stop>("lamp_stop", "", "the loom stands and may be started"),
            output<&Loom::lamp_fault>("lamp_fault", "", "something waits to be repaired and acknowledged"),
            output<&Loom::pump>("pump", "", "lubrication pump on"),
            output<&Loom::feeder_colour>("feeder_colour", "", "yarn of the feeder"),
            output<&Loom::feeder_speed>("feeder_speed", "1/min", "windings of the feeder"),
            output<&Loom::state>("state", "", "where the state machine is"),
            output<&Loom::waits_for>("waits_for", "", "what is missing before it may start; written on change"),
            output<&Loom::cause>("cause", "", "of the last stop"),
            event<&Loom::enable_drives>("enable_drives", "drives on, tension loop closed"),
            event<&Loom::disable_drives>("disable_drives", "drives off"),
            event<&Loom::run_shaft>("run_shaft", "turn at weaving speed"),
            sends<&Loom::stop_shaft>("stop_shaft", "stop the shaft at the stop angle"),
            event<&Loom::quick_stop>("quick_stop", "stop the drives at once", heard_by(4)),
            event<&Loom::set_brake>("set_brake", "brake on", heard_by(1)),
            event<&Loom::release_brake>("release_brake", "brake off"),
            event<&Loom::allow_weft>("allow_weft", "wefts may be released"),
            event<&Loom::inhibit_weft>("inhibit_weft", "no weft, valve closed", heard_by(2)),
            property<&Loom::least_oil_bar>("least_oil_bar", "bar", "below it the loom does not run", range(0, 10)),
            property<&Loom::colour>("colour", "", "yarn of the feeder", range(0, 7)));
    }
    // clang-format on

private:
    static constexpr std::int64_t feeder_windings_per_minute = 1500; // 1.25 times what 600 picks/min take

    [[nodiscard]] bool oil_good() noexcept TAPPET_REALTIME {
        return oil_pressure.good() && oil_pressure.get() >= least_oil_bar.get();
    }
    [[nodiscard]] WaitsFor first_missing() noexcept TAPPET_REALTIME {
        if (emergency_stop.get()) return WaitsFor::emergency_stop;
        switch (state.last()) {
        case LoomState::stopped:
            if (drop_wire.get()) return WaitsFor::drop_wire;
            [[fallthrough]];
        case LoomState::locked:
        case LoomState::emergency:
        case LoomState::fault: return before_acknowledgement();
        default: break;
        }
        if (!nodes_operational.get()) return WaitsFor::can_nodes;
        if (!shaft_is_known()) return WaitsFor::encoder;
        if (!weft_working.get()) return WaitsFor::machine_part;
        if (!main_enabled.get()) return WaitsFor::main_drive;
        if (!let_off_enabled.get()) return WaitsFor::let_off_drive;
        if (!oil_good()) return WaitsFor::oil_pressure;
        if (!tension_in_band.get()) return WaitsFor::warp_tension;
        return drop_wire.get() ? WaitsFor::drop_wire : WaitsFor::nothing;
    }
    /// Returns why an acknowledgement would be refused; WaitsFor::acknowledgement when it would not.
    [[nodiscard]] WaitsFor before_acknowledgement() noexcept TAPPET_REALTIME {
        if (bus_faulted.get()) return WaitsFor::bus;
        if (io_faulted.get()) return WaitsFor::lines;
        if (!motion_alive.get() || !io_alive.get()) return WaitsFor::machine_part;
        if (stands()) return WaitsFor::acknowledgement;
        const bool heard = shaft_valid.get() || main_velocity.flow() != Flow::stale;
        return heard ? WaitsFor::shaft_to_stand : WaitsFor::encoder;
    }
    [[nodiscard]] bool shaft_is_known() noexcept TAPPET_REALTIME {
        return shaft_valid.get() && shaft_alive.get();
    }
    /// Returns true when the shaft stands, by the encoder; a drive that reports turning overrules it. Without
    /// an encoder the drive alone decides.
    [[nodiscard]] bool stands() noexcept TAPPET_REALTIME {
        const bool known = main_velocity.good();
        const double rpm = main_velocity.get();
        const bool slow = rpm < standing_rpm && -rpm < standing_rpm;
        if (known && !slow) return false;
        return shaft_valid.get() ? shaft_standing.get() : known;
    }
    /// Returns one bit for each condition that holds now.
    [[nodiscard]] std::uint32_t there() noexcept TAPPET_REALTIME {
        std::uint32_t bits = nodes_operational.get() ? 1u : 0u;
        bits |= shaft_is_known() ? 2u : 0u;
        bits |= main_enabled.get() ? 4u : 0u;
        bits |= weft_working.get() ? 16u : 0u;
        return bits | (let_off_enabled.get() ? 8u : 0u);
    }
    void set_cause(StopCause why) noexcept TAPPET_REALTIME {
        cause_ = why;
        cause.write(why);
    }
    void make_safe(LoomState now) noexcept TAPPET_REALTIME {
        inhibit_weft.emit();
        quick_stop.emit();
        set_brake.emit();
        tell(now, false, false, true);
    }
    void tell(LoomState now, bool run, bool stop, bool fault) noexcept TAPPET_REALTIME {
        state.write(now);
        waits_for_.write(waits_for, first_missing());
        lamp_run.write(run);
        lamp_stop.write(stop);
        lamp_fault.write(fault);
    }

    static constexpr double standing_rpm = 1.0;

    std::uint32_t had_ = 0; // conditions of there() met at any time since preparation began
    StopCause cause_ = StopCause::none;
    Changed<WaitsFor> waits_for_;
};

} // namespace tappet::carpet
