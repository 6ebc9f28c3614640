// A CiA 402 drive as an axis: its modes of operation, the handshakes of each, and the states that PLCopen
// gives to an axis.
#pragma once

#include "drivers/canopen/cia402.hpp"
#include "kernel/motion/axis_mode.hpp"

#include <expected>

namespace tappet::canopen {

/// By its number in object 6060h.
enum class OperationMode : std::int8_t {
    none = 0,
    profile_position = 1,
    profile_velocity = 3,
    homing = 6,
    cyclic_position = 8, ///< the set points are ours, one each cycle
    cyclic_velocity = 9,
    cyclic_torque = 10,
};

/// What the drive says; units are those of its signals.
struct DriveFeedback {
    bool heard = false; ///< false: its values are old
    std::uint16_t statusword = 0;
    std::int64_t mode = 0; ///< 6061h, modes of operation display
    double position = 0, velocity = 0;
};
/// What it is told.
struct DriveOrder {
    std::uint16_t controlword = 0;
    std::int64_t mode = 0; ///< 6060h
    double position = 0, velocity = 0, torque = 0;
};

/// Real-time; one step each cycle. A command is refused when PLCopen's diagram has none from the present
/// state.
class DriveMotion {
public:
    using AxisMode = motion::AxisMode;
    using AxisCommand = motion::AxisCommand;
    using Asked = std::expected<void, motion::Refused>;

    /// Slower than this it stands.
    void set_standing(double velocity) noexcept TAPPET_REALTIME { standing_ = velocity; }

    [[nodiscard]] AxisMode state() const noexcept TAPPET_REALTIME { return axis_; }
    /// It was told to come to rest, and has.
    [[nodiscard]] bool stands() const noexcept TAPPET_REALTIME { return stands_; }
    /// In a cyclic mode: the drive follows its set points.
    [[nodiscard]] bool follows() const noexcept TAPPET_REALTIME { return follows_; }
    /// It says that it lags behind its set point by more than it may.
    [[nodiscard]] bool lags() const noexcept TAPPET_REALTIME { return lags_; }
    /// Its own limits hold it: a limit switch, a torque that is not enough.
    [[nodiscard]] bool is_limited() const noexcept TAPPET_REALTIME { return limited_; }

    /// MC_Power.
    void power(bool on) noexcept TAPPET_REALTIME {
        wants_power_ = on;
        control_.want(on ? DriveGoal::enabled : DriveGoal::off);
        if (!on) static_cast<void>(ask(AxisCommand::power_off));
    }
    /// MC_Reset: of one fault.
    void reset() noexcept TAPPET_REALTIME {
        if (axis_ != AxisMode::error_stop) return;
        resets_ = true;
        control_.want(wants_power_ ? DriveGoal::enabled : DriveGoal::off);
        control_.acknowledge();
    }
    /// MC_Home, as the drive's own objects describe it.
    Asked home() noexcept TAPPET_REALTIME { return begin(AxisCommand::home, OperationMode::homing); }
    /// MC_MoveAbsolute. A new one takes the place of one that is under way.
    Asked move_to(double position, double velocity) noexcept TAPPET_REALTIME {
        const Asked asked = begin(AxisCommand::move, OperationMode::profile_position);
        if (asked) order_.position = position, order_.velocity = velocity;
        return asked;
    }
    /// MC_MoveVelocity.
    Asked move_at(double velocity) noexcept TAPPET_REALTIME {
        const Asked asked = begin(AxisCommand::move_on, OperationMode::profile_velocity);
        if (asked) order_.velocity = velocity;
        return asked;
    }
    /// Its set points come each cycle from now on, by follow().
    Asked synchronize(OperationMode cyclic) noexcept TAPPET_REALTIME {
        if (cyclic < OperationMode::cyclic_position) return std::unexpected(wrong_state);
        const Asked asked = begin(AxisCommand::synchronize, cyclic);
        if (asked) order_.position = seen_.position, order_.velocity = order_.torque = 0;
        return asked;
    }
    /// Of the quantity of the mode that it is in.
    void follow(double set_point) noexcept TAPPET_REALTIME {
        if (axis_ != AxisMode::synchronized_motion || set_point != set_point) return;
        switch (wanted_) {
        case OperationMode::cyclic_position: order_.position = set_point; break;
        case OperationMode::cyclic_velocity: order_.velocity = set_point; break;
        case OperationMode::cyclic_torque: order_.torque = set_point; break;
        default: break;
        }
    }
    /// MC_Halt: comes to rest, and takes a new motion meanwhile.
    Asked halt() noexcept TAPPET_REALTIME { return rest(AxisCommand::halt); }
    /// MC_Stop: comes to rest, and takes none before release().
    Asked stop() noexcept TAPPET_REALTIME {
        is_held_ = true;
        return rest(AxisCommand::stop);
    }
    void release() noexcept TAPPET_REALTIME { is_held_ = false; }

    [[nodiscard]] DriveOrder step(const DriveFeedback& seen) noexcept TAPPET_REALTIME {
        seen_ = seen;
        const DriveState drive = drive_state(seen.statusword);
        judge(drive);
        order_.mode = static_cast<std::int64_t>(wanted_);
        order_.controlword =
            seen.heard ? control_.controlword(seen.statusword) : controlword::disable_voltage;
        const bool enabled = seen.heard && drive == DriveState::operation_enabled;
        follows_ = lags_ = stands_ = false;
        limited_ = seen.heard && (seen.statusword & status::internal_limit) != 0;
        if (enabled && order_.controlword == controlword::enable_operation && axis_ != AxisMode::disabled)
            lead();
        return order_;
    }

private:
    /// Bits of the statusword that mean something of their own in each mode.
    struct status {
        static constexpr unsigned target_reached = 0x0400, internal_limit = 0x0800;
        static constexpr unsigned acknowledged = 0x1000; ///< pp: set point; hm: attained; cyclic: follows
        static constexpr unsigned error = 0x2000;        ///< hm: homing error; pp, csp: following error
    };
    struct order_bit {
        static constexpr unsigned new_set_point = 0x10; ///< hm: homing operation start
        static constexpr unsigned at_once = 0x20;       ///< a new set point ends the one before
        static constexpr unsigned halt = 0x100;
    };
    /// Of a set point in pp: the bit rises, is acknowledged, falls, and the acknowledgement falls; three
    /// cycles at least. Only then "target reached" speaks of the new one.
    enum class HandShake : std::uint8_t { to_raise, raised, lowered, over };
    /// So long a drive may take to show that it began: what it says before is of the motion before.
    static constexpr int settling_cycles = DriveControl::low_cycles;
    static constexpr motion::Refused wrong_state{motion::Refusal::wrong_state};

    Asked ask(AxisCommand command) noexcept TAPPET_REALTIME {
        const auto next = motion::after(axis_, command);
        if (!next) return std::unexpected(next.error());
        axis_ = *next;
        return {};
    }
    Asked begin(AxisCommand command, OperationMode mode) noexcept TAPPET_REALTIME {
        const Asked asked = ask(command);
        if (!asked) return asked;
        wanted_ = mode;
        halts_ = false;
        hand_shake_ = HandShake::to_raise;
        cycles_ = 0;
        began_ = false;
        return asked;
    }
    Asked rest(AxisCommand command) noexcept TAPPET_REALTIME {
        const Asked asked = ask(command);
        if (asked) halts_ = true, cycles_ = 0;
        return asked;
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
            if (wants_power_ && enabled) {
                static_cast<void>(ask(AxisCommand::power_on));
                halts_ = true; // nothing from before goes on
            }
            return;
        }
        if (!enabled) fail(); // it took its power away itself: a quick stop, a limit switch, an open relay
    }
    void fail() noexcept TAPPET_REALTIME {
        static_cast<void>(ask(AxisCommand::error));
        control_.want(DriveGoal::quick_stop);
        resets_ = false;
        order_.velocity = order_.torque = 0;
    }

    void lead() noexcept TAPPET_REALTIME {
        ++cycles_;
        // The halt bit stays at rest: a drive whose bit falls goes on with the set point that it has.
        if (halts_) order_.controlword |= order_bit::halt;
        if (axis_ == AxisMode::standstill || axis_ == AxisMode::stopping || halts_) {
            const bool slow = seen_.velocity < standing_ && -seen_.velocity < standing_;
            stands_ = slow && cycles_ > settling_cycles;
            if (axis_ == AxisMode::discrete_motion && stands_) static_cast<void>(ask(AxisCommand::done));
            if (axis_ == AxisMode::stopping && stands_ && !is_held_)
                static_cast<void>(ask(AxisCommand::done));
            return;
        }
        if (seen_.mode != static_cast<std::int64_t>(wanted_)) return; // 6061h: it is not there yet
        const auto says = [&](unsigned bit) { return (seen_.statusword & bit) != 0; };
        switch (wanted_) {
        case OperationMode::profile_position:
            lags_ = says(status::error);
            if (hand_over(says(status::acknowledged)) && says(status::target_reached)) finish();
            break;
        case OperationMode::homing:
            order_.controlword |= order_bit::new_set_point;
            began_ |= !says(status::target_reached) && !says(status::acknowledged);
            if (!began_ && cycles_ <= settling_cycles) break;
            if (says(status::error)) return fail();
            if (says(status::acknowledged) && says(status::target_reached)) finish();
            break;
        case OperationMode::cyclic_position: lags_ = says(status::error); [[fallthrough]];
        case OperationMode::cyclic_velocity:
        case OperationMode::cyclic_torque: follows_ = says(status::acknowledged); break;
        case OperationMode::profile_velocity:
        case OperationMode::none: break;
        }
    }
    /// True when the drive has the set point.
    bool hand_over(bool acknowledged) noexcept TAPPET_REALTIME {
        switch (hand_shake_) {
        case HandShake::to_raise:
            if (acknowledged) break; // of the one before
            hand_shake_ = HandShake::raised;
            [[fallthrough]];
        case HandShake::raised:
            if (!acknowledged) {
                order_.controlword |= order_bit::new_set_point | order_bit::at_once;
                break;
            }
            hand_shake_ = HandShake::lowered;
            break;
        case HandShake::lowered:
            if (!acknowledged) hand_shake_ = HandShake::over;
            break;
        case HandShake::over: return true;
        }
        return false;
    }
    void finish() noexcept TAPPET_REALTIME {
        static_cast<void>(ask(AxisCommand::done));
        halts_ = true;
        cycles_ = 0;
    }

    DriveControl control_{};
    AxisMode axis_ = AxisMode::disabled;
    OperationMode wanted_ = OperationMode::profile_position;
    DriveFeedback seen_{};
    DriveOrder order_{};
    HandShake hand_shake_ = HandShake::over;
    bool wants_power_ = false, resets_ = false, halts_ = true, is_held_ = false, began_ = false;
    bool follows_ = false, lags_ = false, limited_ = false, stands_ = false;
    int cycles_ = 0;
    double standing_ = 1e-3;
};

} // namespace tappet::canopen
