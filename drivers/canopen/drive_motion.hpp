// A CiA 402 drive as an axis: its modes of operation, the handshakes of each, and the states that PLCopen
// gives to an axis.
#pragma once

#include "drivers/canopen/set_point_gate.hpp"
#include "kernel/motion/axis_mode.hpp"
#include "kernel/motion/trajectory.hpp"

#include <cstdint>
#include <expected>

namespace tappet::canopen {

/// Real-time; one step each cycle. A command is refused when PLCopen's diagram has none from the present
/// state.
class DriveMotion {
public:
    using AxisMode = motion::AxisMode;
    using AxisCommand = motion::AxisCommand;
    using Asked = std::expected<void, motion::Refused>;

    /// Where it is, before the drive was heard: one that still follows positions is sent to no other.
    void begin_at(double place) noexcept TAPPET_REALTIME { gate_.begin_at(place); }
    /// Slower than this it stands.
    void set_standing(double velocity) noexcept TAPPET_REALTIME { gate_.set_standing(velocity); }

    [[nodiscard]] AxisMode state() const noexcept TAPPET_REALTIME { return axis_; }
    /// It was told to come to rest, and has.
    [[nodiscard]] bool stands() const noexcept TAPPET_REALTIME { return gate_.stands(); }
    /// In a cyclic mode: the drive follows its set points.
    [[nodiscard]] bool follows() const noexcept TAPPET_REALTIME {
        return axis_ == AxisMode::synchronized_motion && leads_cyclic() && says(Status::acknowledged);
    }
    /// It says that it lags behind its set point by more than it may.
    [[nodiscard]] bool lags() const noexcept TAPPET_REALTIME {
        return says(Status::error) &&
               (gate_.leads(OperationMode::profile_position) || gate_.leads(OperationMode::cyclic_position));
    }
    /// Its own limits hold it: a limit switch, a torque that is not enough.
    [[nodiscard]] bool is_limited() const noexcept TAPPET_REALTIME {
        return seen_.heard && says(Status::internal_limit);
    }
    /// A superimposed motion is under way.
    [[nodiscard]] bool superimposes() const noexcept TAPPET_REALTIME {
        return gate_.leads(OperationMode::cyclic_position) && gate_.superimposes();
    }

    /// Each motion and each halt has a number. A failure and the end of power take the next one, too.
    [[nodiscard]] std::uint32_t number() const noexcept TAPPET_REALTIME { return number_; }
    /// The last one that came to its own end.
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
    /// MC_Reset: of one fault.
    void reset() noexcept TAPPET_REALTIME {
        if (axis_ != AxisMode::error_stop) return;
        resets_ = true;
        control_.acknowledge();
    }
    /// MC_Home, as the drive's own objects describe it.
    Asked home() noexcept TAPPET_REALTIME { return begin(AxisCommand::home, OperationMode::homing, 0); }
    /// MC_MoveAbsolute. A new one takes the place of one that is under way.
    Asked move_to(double position, double velocity) noexcept TAPPET_REALTIME {
        return begin(AxisCommand::move, OperationMode::profile_position, position, velocity);
    }
    /// MC_MoveVelocity.
    Asked move_at(double velocity) noexcept TAPPET_REALTIME {
        return begin(AxisCommand::move_on, OperationMode::profile_velocity, velocity);
    }
    /// MC_MoveSuperimposed: adds `distance` to the positions that it follows, which go on. From standstill it
    /// is a MC_MoveRelative. Refused in the other modes: there the drive makes the motion, and adds none to
    /// it.
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
    /// Its set points come each cycle from now on, by follow(). Into cyclic position it comes to a stand
    /// first. Refused while it follows positions with a superimposed distance: whether the new ones have it
    /// in them nobody knows. It halts first.
    Asked synchronize(OperationMode cyclic) noexcept TAPPET_REALTIME {
        if (cyclic < OperationMode::cyclic_position) return std::unexpected(wrong_state);
        if (cyclic == OperationMode::cyclic_position && gate_.leads(cyclic) && gate_.has_offset())
            return std::unexpected(wrong_state);
        return begin(AxisCommand::synchronize, cyclic, 0);
    }
    /// Of the quantity of the mode that it is in. Dropped: what is no number, and positions before follows().
    void follow(double set_point) noexcept TAPPET_REALTIME {
        if (axis_ == AxisMode::synchronized_motion && motion::is_number(set_point)) gate_.follow(set_point);
    }
    /// MC_Halt: comes to rest, and takes a new motion meanwhile.
    Asked halt() noexcept TAPPET_REALTIME { return rest(AxisCommand::halt); }
    /// MC_Stop: comes to rest, and takes none before release(), also when it was without power meanwhile.
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

    /// Where the drive's automaton shall go. Power comes back only to a drive that was seen without it: what
    /// it says until then may be older than what took the power away.
    [[nodiscard]] DriveGoal goal() const noexcept TAPPET_REALTIME {
        if (!wants_power_) return DriveGoal::off;
        return axis_ == AxisMode::error_stop || !off_seen_ ? DriveGoal::quick_stop : DriveGoal::enabled;
    }
    /// What the drive's own state makes of the axis.
    void judge(DriveState drive) noexcept TAPPET_REALTIME {
        const bool faulty =
            !seen_.heard || drive == DriveState::fault || drive == DriveState::fault_reaction_active;
        const bool enabled = seen_.heard && drive == DriveState::operation_enabled;
        if (axis_ == AxisMode::error_stop) {
            if (faulty || !resets_) return;
            axis_ = AxisMode::disabled; // from where power leads on
            resets_ = false;
        }
        if (faulty && (axis_ != AxisMode::disabled || wants_power_ || seen_.heard)) return fail();
        if (axis_ == AxisMode::disabled) {
            if (wants_power_ && off_seen_ && enabled && steady_cycles_ >= enable_cycles_)
                static_cast<void>(ask(AxisCommand::power_on));
            return;
        }
        if (!enabled) fail(); // it took its power away itself: a quick stop, a limit switch, an open relay
    }
    /// A word of a few cycles ago may still take the power away: the drive has it for good when "enable" was
    /// sent without a break for as long as the drive took to follow the first one.
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
    /// What the drive has done makes of the axis.
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
    bool adds_ = false;     ///< that of number_ is a superimposed one
    bool off_seen_ = false; ///< the drive was seen without power since that was last asked for
};

} // namespace tappet::canopen
