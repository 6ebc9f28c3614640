// A CiA 402 drive on a bus as a component: an axis with PLCopen's states, whose motions are commands.
#pragma once

#include "drivers/canopen/drive_motion.hpp"
#include "kernel/component/component.hpp"
#include "kernel/pieces/changed.hpp"

#include <array>
#include <cstdint>

namespace tappet::canopen {

/// Effector: Axis<"mm">; velocities are in that unit per second. All real-time, each cycle of a periodic
/// activity. The rows of its four inputs from the drive must state stale_after(...): a silent drive causes an
/// error stop.
template <text unit> struct Axis {
    using AxisMode = motion::AxisMode;
    static constexpr auto speed_unit = [] {
        text<unit.view().size() + 2> both;
        *std::copy_n(unit.characters, unit.view().size(), both.characters) = '/';
        both.characters[unit.view().size() + 1] = 's';
        return both;
    }();

    Input<std::int64_t> statusword, mode_display;
    Input<double> position, velocity;
    Input<double> set_point;
    Output<std::int64_t> controlword, mode;
    Output<double> target_position, target_velocity, target_torque, profile_velocity;
    Output<AxisMode> state;
    Output<bool> follows, lags, limited;
    Event<> stopped_by_error;
    Property<double> standing{1e-3};

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        motion_ = {};
        motion_.begin_at(position.get());
        standing_changed();
        mode.write(static_cast<std::int64_t>(OperationMode::profile_position));
        controlword.write(controlword::disable_voltage);
        target_position.write(position.get());
        write_speeds({});
        tell();
    }
    void changed() noexcept TAPPET_REALTIME { standing_changed(); }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        follow(cycle.now);
        const AxisMode before = motion_.state();
        const bool heard = statusword.good() && mode_display.good() && position.good() && velocity.good();
        const DriveOrder order =
            motion_.step({heard, static_cast<std::uint16_t>(statusword.get()), mode_display.get(),
                          position.get(), velocity.get(), cycle.period});
        controlword.write(order.controlword);
        mode.write(order.mode);
        target_position.write(order.position);
        write_speeds(order);
        tell();
        if (motion_.state() == AxisMode::error_stop && before != AxisMode::error_stop)
            stopped_by_error.emit();
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        controlword.write(controlword::quick_stop);
        write_speeds({});
        motion_ = {};
        tell();
    }

    void power_on() noexcept TAPPET_REALTIME { motion_.power(true); }
    void power_off() noexcept TAPPET_REALTIME { motion_.power(false); }
    void reset() noexcept TAPPET_REALTIME { motion_.reset(); }
    void release() noexcept TAPPET_REALTIME { motion_.release(); }
    /// Starts cyclic set points: 8 positions, 9 velocities, 10 torques.
    bool synchronize(std::int64_t cyclic) noexcept TAPPET_REALTIME {
        if (cyclic < 8 || cyclic > 10 ||
            !motion_.synchronize(OperationMode{static_cast<std::int8_t>(cyclic)}))
            return false;
        begins_ = true;
        follows_in_ = cyclic;
        return true;
    }
    bool home() noexcept TAPPET_REALTIME { return takes(home_, motion_.home(), {}); }
    bool move_to(double place, double at) noexcept TAPPET_REALTIME {
        return takes(move_to_, motion_.move_to(place, at), {place, at});
    }
    bool move_at(double at) noexcept TAPPET_REALTIME { return motion_.move_at(at).has_value(); }
    bool superimpose(double distance, double at, double acceleration) noexcept TAPPET_REALTIME {
        return takes(superimpose_, motion_.superimpose(distance, at, acceleration),
                     {distance, at, acceleration});
    }
    bool halt() noexcept TAPPET_REALTIME { return takes(halt_, motion_.halt(), {}); }
    bool stop_axis() noexcept TAPPET_REALTIME { return motion_.stop().has_value(); }
    [[nodiscard]] CommandProgress homed() noexcept TAPPET_REALTIME { return progress_of(home_, {}); }
    [[nodiscard]] CommandProgress moved(double place, double at) noexcept TAPPET_REALTIME {
        return progress_of(move_to_, {place, at});
    }
    [[nodiscard]] CommandProgress superimposed(double distance, double at, double acceleration) noexcept
        TAPPET_REALTIME {
        return progress_of(superimpose_, {distance, at, acceleration});
    }
    [[nodiscard]] CommandProgress halted() noexcept TAPPET_REALTIME { return progress_of(halt_, {}); }
    /// Done when the axis stands; it is still held then.
    [[nodiscard]] CommandProgress is_stopped() noexcept TAPPET_REALTIME {
        if (motion_.state() != AxisMode::stopping) return CommandProgress::failed;
        return motion_.stands() ? CommandProgress::done : CommandProgress::executing;
    }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            input<&Axis::statusword>("statusword", "", "6041h"),
            input<&Axis::mode_display>("mode_display", "", "6061h"),
            input<&Axis::position>("position", unit.view(), "6064h, as it is"),
            input<&Axis::velocity>("velocity", speed_unit.view(), "606Ch, as it is"),
            input<&Axis::set_point>("set_point", "", "set point of the present cyclic mode, written since it began; positions count once the axis follows", optional),
            output<&Axis::controlword>("controlword", "", "6040h"),
            output<&Axis::mode>("mode", "", "6060h"),
            output<&Axis::target_position>("target_position", unit.view(), "607Ah"),
            output<&Axis::target_velocity>("target_velocity", speed_unit.view(), "60FFh"),
            output<&Axis::profile_velocity>("profile_velocity", speed_unit.view(), "6081h, of a motion to a place"),
            output<&Axis::target_torque>("target_torque", "", "6071h"),
            output<&Axis::state>("state", "", "as PLCopen names it; written on change"),
            output<&Axis::follows>("follows", "", "its set points, in a cyclic mode; written on change"),
            output<&Axis::lags>("lags", "", "behind its set point; written on change"),
            output<&Axis::limited>("limited", "", "held by a limit of the drive's; written on change"),
            event<&Axis::stopped_by_error>("stopped_by_error", "a fault, a silence, a mode that the drive does not enter, or lost power"),
            property<&Axis::standing>("standing", speed_unit.view(), "up to this speed it stands", range(0, 1e9)),
            operation<&Axis::power_on>("power_on", "MC_Power"),
            operation<&Axis::power_off>("power_off", "MC_Power, not enabled"),
            operation<&Axis::reset>("reset", "MC_Reset: resets one fault"),
            operation<&Axis::release>("release", "ends a stop"),
            command<&Axis::home, &Axis::homed>("home", "MC_Home"),
            command<&Axis::move_to, &Axis::moved>("move_to", "MC_MoveAbsolute: place, velocity"),
            command<&Axis::move_at>("move_at", "MC_MoveVelocity"),
            command<&Axis::superimpose, &Axis::superimposed>("superimpose", "MC_MoveSuperimposed: distance, velocity, acceleration; while it follows positions, or stands"),
            command<&Axis::synchronize>("synchronize", "with set points: 8 positions, 9 velocities, 10 torques; not 8 over a superimposed distance"),
            command<&Axis::halt, &Axis::halted>("halt", "MC_Halt"),
            command<&Axis::stop_axis, &Axis::is_stopped>("stop", "MC_Stop: accepts no motion until it is released"));
    }
    // clang-format on

private:
    /// Follows set points written since synchronize(), and none from before.
    void follow(Time now) noexcept TAPPET_REALTIME {
        const std::int64_t ordered = mode.last();
        // Until the mode is ordered, the writer still uses the unit of the previous mode.
        if (begins_ && ordered != follows_in_) return;
        double wanted = 0;
        const Flow flow = set_point.read(wanted);
        if (std::exchange(begins_, false)) is_led_ = false, led_at_ = now;
        const bool is_place = ordered == static_cast<std::int64_t>(OperationMode::cyclic_position);
        if (flow == Flow::never_written && std::exchange(is_led_, false) && !is_place) motion_.follow(0);
        // A stale velocity or torque is replaced by the row's substitute. A stale position is not followed.
        if (flow != Flow::fresh && (flow != Flow::stale || is_place || !is_led_)) return;
        // A value hidden by a force, from before synchronize(), or not a number.
        if (set_point.stamp() < led_at_ || !motion::is_number(wanted)) {
            if (!is_place) motion_.follow(0);
            return;
        }
        led_at_ = std::min(set_point.stamp(), now); // a stamp in the future must not block later values
        is_led_ = true;
        motion_.follow(wanted);
    }
    void standing_changed() noexcept TAPPET_REALTIME { motion_.set_standing(standing.get()); }
    void write_speeds(const DriveOrder& order) noexcept TAPPET_REALTIME {
        profile_velocity.write(order.profile_velocity);
        target_velocity.write(order.velocity);
        target_torque.write(order.torque);
    }
    void tell() noexcept TAPPET_REALTIME {
        state_.write(state, motion_.state());
        follows_.write(follows, motion_.follows());
        lags_.write(lags, motion_.lags());
        limited_.write(limited, motion_.is_limited());
    }
    /// The last motion started by a command, with its arguments: a command with other arguments was replaced.
    struct Begun {
        std::uint32_t number = 0;
        std::array<double, 3> with{};
    };
    bool takes(Begun& begun, const DriveMotion::Asked& asked, std::array<double, 3> with) noexcept
        TAPPET_REALTIME {
        if (asked) begun = {motion_.number(), with};
        return asked.has_value();
    }
    /// Done only when this motion itself was completed: the axis may stand because of a halt or another one.
    [[nodiscard]] CommandProgress progress_of(const Begun& begun, std::array<double, 3> with) const noexcept
        TAPPET_REALTIME {
        if (with != begun.with) return CommandProgress::failed;
        if (motion_.reached() == begun.number) return CommandProgress::done;
        return motion_.number() == begun.number ? CommandProgress::executing : CommandProgress::failed;
    }

    DriveMotion motion_{};
    Time led_at_{}; ///< time stamp of the set point that it follows
    bool begins_ = false, is_led_ = false;
    std::int64_t follows_in_ = 0; ///< as a mode
    Begun home_{}, move_to_{}, superimpose_{}, halt_{};
    Changed<AxisMode> state_{};
    Changed<bool> follows_{}, lags_{}, limited_{};
};

} // namespace tappet::canopen
