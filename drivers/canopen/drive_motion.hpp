// A CiA 402 drive as an axis: its modes of operation, their handshakes, and PLCopen's axis states.
#pragma once

#include "drivers/canopen/set_point_gate.hpp"
#include "kernel/motion/axis_mode.hpp"
#include "kernel/motion/trajectory.hpp"

#include <cstdint>
#include <expected>

namespace tappet::canopen {

/// Real-time; one step each cycle. A command without a transition in PLCopen's state diagram is refused.
class DriveMotion {
public:
    using AxisMode = motion::AxisMode;
    using AxisCommand = motion::AxisCommand;
    using Asked = std::expected<void, motion::Refused>;

    /// Sets the position to send until the drive was heard: one that still follows positions must not move.
    void begin_at(double place) noexcept TAPPET_REALTIME { gate_.begin_at(place); }
    /// Sets the velocity below which the axis stands.
    void set_standing(double velocity) noexcept TAPPET_REALTIME { gate_.set_standing(velocity); }

    [[nodiscard]] AxisMode state() const noexcept TAPPET_REALTIME { return axis_; }
    /// Returns true when the axis was told to come to rest and stands.
    [[nodiscard]] bool stands() const noexcept TAPPET_REALTIME { return gate_.stands(); }
    /// Returns true when the drive follows its set points in a cyclic mode.
    [[nodiscard]] bool follows() const noexcept TAPPET_REALTIME {
        return axis_ == AxisMode::synchronized_motion && leads_cyclic() && says(Status::acknowledged);
    }
    /// Returns true when the drive reports a following error.
    [[nodiscard]] bool lags() const noexcept TAPPET_REALTIME {
        return says(Status::error) &&
               (gate_.leads(OperationMode::profile_position) || gate_.leads(OperationMode::cyclic_position));
    }
    /// Returns true when the drive's own limits hold it: a limit switch, insufficient torque.
    [[nodiscard]] bool is_limited() const noexcept TAPPET_REALTIME {
        return seen_.heard && says(Status::internal_limit);
    }
    /// Returns true while a superimposed motion is active.
    [[nodiscard]] bool superimposes() const noexcept TAPPET_REALTIME {
        return gate_.leads(OperationMode::cyclic_position) && gate_.superimposes();
    }

    /// Returns the number of the last motion or halt. A failure and the end of power take a number, too.
    [[nodiscard]] std::uint32_t number() const noexcept TAPPET_REALTIME { return number_; }
    /// Returns the number of the last motion that was completed.
    [[nodiscard]] std::uint32_t reached() const noexcept TAPPET_REALTIME { return reached_; }

    /// MC_Power.
    void power(bool on) noexcept TAPPET_REALTIME {
        wants_power_ = on;
        if (on) return;
        count_motion();
        off_seen_ = false;
        gate_.rest();
        static_cast<void>(ask(AxisCommand::power_off));
    }
    /// MC_Reset: resets one fault.
    void reset() noexcept TAPPET_REALTIME {
        if (axis_ != AxisMode::error_stop) return;
        resets_ = true;
        control_.acknowledge();
    }
    /// MC_Home, as configured in the drive's own objects.
    Asked home() noexcept TAPPET_REALTIME { return begin(AxisCommand::home, OperationMode::homing, 0); }
    /// MC_MoveAbsolute. A new one replaces an active one.
    Asked move_to(double position, double velocity) noexcept TAPPET_REALTIME {
        return begin(AxisCommand::move, OperationMode::profile_position, position, velocity);
    }
    /// MC_MoveVelocity.
    Asked move_at(double velocity) noexcept TAPPET_REALTIME {
        return begin(AxisCommand::move_on, OperationMode::profile_velocity, velocity);
    }
    /// MC_MoveSuperimposed: adds `distance` to the positions that it follows, which continue. From standstill
    /// it is a MC_MoveRelative. Refused in other modes, because there the drive makes the motion and cannot
    /// add to it.
    Asked superimpose(double distance, double velocity, double acceleration) noexcept TAPPET_REALTIME {
        const bool stands = axis_ == AxisMode::standstill;
        if (!stands && (!follows() || !gate_.leads(OperationMode::cyclic_position)))
            return std::unexpected(wrong_state);
        const motion::AxisState from = stands ? motion::AxisState{} : gate_.offset();
        const auto planned = motion::trapezoid(from, from.position + distance, {velocity, acceleration});
        if (!planned) return std::unexpected(planned.error());
        if (stands) return move_to(seen_.position + distance, velocity);
        const Asked asked = ask(AxisCommand::superimpose);
        if (!asked) return asked;
        count_motion(true);
        gate_.superimpose(*planned);
        return asked;
    }
    /// Starts a cyclic mode: follow() provides a set point each cycle. Before cyclic position it comes to a
    /// stand first. Refused while it follows positions with a superimposed distance, because the new
    /// positions may or may not include it; halt first.
    Asked synchronize(OperationMode cyclic) noexcept TAPPET_REALTIME {
        if (cyclic < OperationMode::cyclic_position) return std::unexpected(wrong_state);
        if (cyclic == OperationMode::cyclic_position && gate_.leads(cyclic) && gate_.has_offset())
            return std::unexpected(wrong_state);
        return begin(AxisCommand::synchronize, cyclic, 0);
    }
    /// Sets the next set point in the unit of the present mode. Drops values that are not numbers, and
    /// positions before follows().
    void follow(double set_point) noexcept TAPPET_REALTIME {
        if (axis_ == AxisMode::synchronized_motion && motion::is_number(set_point)) gate_.follow(set_point);
    }
    /// MC_Halt: comes to rest; accepts a new motion in the meantime.
    Asked halt() noexcept TAPPET_REALTIME { return rest(AxisCommand::halt); }
    /// MC_Stop: comes to rest; accepts no motion before release(), even after a loss of power.
    Asked stop() noexcept TAPPET_REALTIME {
        const Asked asked = rest(AxisCommand::stop);
        if (asked) is_held_ = true;
        return asked;
    }
    void release() noexcept TAPPET_REALTIME { is_held_ = false; }

    [[nodiscard]] DriveOrder step(const DriveFeedback& seen) noexcept TAPPET_REALTIME {
        seen_ = seen;
        seen_.heard &= motion::is_number(seen.position) && motion::is_number(seen.velocity);
        const DriveState drive = drive_state(seen.statusword);
        if (seen_.heard && drive != DriveState::switched_on && drive != DriveState::operation_enabled)
            off_seen_ = true;
        judge(drive);
        control_.want(goal());
        const DriveOrder& order = gate_.step(seen_, seen_.heard ? control_.controlword(seen.statusword)
                                                                : controlword::disable_voltage);
        count_power(drive, order.controlword);
        go_on();
        return order;
    }

private:
    using Status = SetPointGate::status;
    using Progress = SetPointGate::Progress;
    static constexpr motion::Refused wrong_state{motion::Refusal::wrong_state};

    [[nodiscard]] bool says(unsigned bit) const noexcept TAPPET_REALTIME {
        return (seen_.statusword & bit) != 0;
    }
    [[nodiscard]] bool leads_cyclic() const noexcept TAPPET_REALTIME {
        return gate_.leads(OperationMode::cyclic_position) || gate_.leads(OperationMode::cyclic_velocity) ||
               gate_.leads(OperationMode::cyclic_torque);
    }
    Asked ask(AxisCommand command) noexcept TAPPET_REALTIME {
        const auto next = motion::after(axis_, command);
        if (!next) return std::unexpected(next.error());
        axis_ = *next;
        return {};
    }
    void count_motion(bool is_superimposed = false) noexcept TAPPET_REALTIME {
        ++number_;
        adds_ = is_superimposed;
    }
    Asked begin(AxisCommand command, OperationMode mode, double target, double profile_velocity = 1) noexcept
        TAPPET_REALTIME {
        if (!motion::is_number(target) || !motion::is_number(profile_velocity))
            return std::unexpected(motion::Refused{motion::Refusal::not_a_number});
        if (profile_velocity <= 0)
            return std::unexpected(motion::Refused{motion::Refusal::limit_not_positive});
        if (is_held_) return std::unexpected(wrong_state);
        const Asked asked = ask(command);
        if (!asked) return asked;
        count_motion();
        gate_.lead(mode, target, profile_velocity);
        return asked;
    }
    Asked rest(AxisCommand command) noexcept TAPPET_REALTIME {
        const Asked asked = ask(command);
        if (!asked) return asked;
        count_motion();
        gate_.rest();
        return asked;
    }

    /// Returns the goal for the drive's automaton. Power is given again only to a drive that was seen without
    /// it: until then its status may be older than the removal of power.
    [[nodiscard]] DriveGoal goal() const noexcept TAPPET_REALTIME {
        if (!wants_power_) return DriveGoal::off;
        return axis_ == AxisMode::error_stop || !off_seen_ ? DriveGoal::quick_stop : DriveGoal::enabled;
    }
    /// Derives the axis state from the drive's state.
    void judge(DriveState drive) noexcept TAPPET_REALTIME {
        const bool faulty =
            !seen_.heard || drive == DriveState::fault || drive == DriveState::fault_reaction_active;
        const bool enabled = seen_.heard && drive == DriveState::operation_enabled;
        if (axis_ == AxisMode::error_stop) {
            if (faulty || !resets_) return;
            axis_ = AxisMode::disabled; // the state in which power can be given
            resets_ = false;
        }
        if (faulty && (axis_ != AxisMode::disabled || wants_power_ || seen_.heard)) return fail();
        if (axis_ == AxisMode::disabled) {
            if (wants_power_ && off_seen_ && enabled && steady_cycles_ >= enable_cycles_)
                static_cast<void>(ask(AxisCommand::power_on));
            return;
        }
        if (!enabled) fail(); // it removed its power itself: a quick stop, a limit switch, an open relay
    }
    /// Counts how long the power is ordered. An order from a few cycles ago may still remove it: power is
    /// certain once "enable" was sent without a break for as long as the drive took to follow the first one.
    void count_power(DriveState drive, unsigned word) noexcept TAPPET_REALTIME {
        if (control_.goal() != DriveGoal::enabled) {
            enable_cycles_ = steady_cycles_ = 0;
            return;
        }
        const bool enables = (word & 0xFFu) == controlword::enable_operation;
        steady_cycles_ = enables ? steady_cycles_ + (steady_cycles_ < enable_cycles_ + 1) : 0;
        if (drive != DriveState::operation_enabled && (enables || enable_cycles_ > 0) &&
            enable_cycles_ < SetPointGate::patience_cycles)
            ++enable_cycles_;
    }
    void fail() noexcept TAPPET_REALTIME {
        static_cast<void>(ask(AxisCommand::error));
        count_motion();
        gate_.rest();
        off_seen_ = resets_ = false;
    }
    /// Updates the axis state from the drive's progress.
    void go_on() noexcept TAPPET_REALTIME {
        if (gate_.is_lost() || gate_.progress() == Progress::failed) return fail();
        if (gate_.progress() == Progress::done) {
            static_cast<void>(ask(AxisCommand::done));
            reached_ = number_;
            gate_.rest();
        } else if (gate_.stands() &&
                   (axis_ == AxisMode::discrete_motion || (axis_ == AxisMode::stopping && !is_held_))) {
            static_cast<void>(ask(AxisCommand::done));
        }
        if (adds_ ? !superimposes() : gate_.stands() && axis_ == AxisMode::standstill) reached_ = number_;
    }

    DriveControl control_{};
    SetPointGate gate_{};
    AxisMode axis_ = AxisMode::disabled;
    DriveFeedback seen_{};
    bool wants_power_ = false, resets_ = false, is_held_ = false;
    int enable_cycles_ = 0, steady_cycles_ = 0;
    std::uint32_t number_ = 0, reached_ = 0;
    bool adds_ = false;     ///< motion number_ is a superimposed one
    bool off_seen_ = false; ///< the drive was seen without power since the last request for its removal
};

} // namespace tappet::canopen
