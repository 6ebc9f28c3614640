// Decides, as the only place, which set points a CiA 402 drive gets: those of a motion only while the drive
// shows that motion's mode, otherwise those of rest.
#pragma once

#include "drivers/canopen/cia402.hpp"
#include "kernel/motion/profile.hpp"
#include "kernel/motion/refused.hpp"

#include <cstdint>

namespace tappet::canopen {

/// Values of object 6060h.
enum class OperationMode : std::int8_t {
    none = 0,
    profile_position = 1,
    profile_velocity = 3,
    profile_torque = 4,
    homing = 6,
    cyclic_position = 8, ///< the machine provides a set point each cycle
    cyclic_velocity = 9,
    cyclic_torque = 10,
};

/// Feedback from the drive, in the units of its signals.
struct DriveFeedback {
    bool heard = false; ///< false: the values are stale
    std::uint16_t statusword = 0;
    std::int64_t mode = 0; ///< 6061h, modes of operation display
    double position = 0, velocity = 0;
    Duration passed{}; ///< time since the previous step, for superimposed motions
};
/// Orders to the drive, which takes them as a whole: the objects are sent together, or latched by one SYNC.
struct DriveOrder {
    std::uint16_t controlword = 0;
    std::int64_t mode = 0;       ///< 6060h
    double position = 0;         ///< 607Ah
    double profile_velocity = 0; ///< 6081h, of a motion to a position
    double velocity = 0;         ///< 60FFh
    double torque = 0;           ///< 6071h
};

/// Real-time; one step each cycle. An order of rest is safe in each mode, even in one without the halt bit:
/// velocity and torque are 0, the position is the actual one (in cyclic position: the last set point), there
/// is no start bit, and the halt bit is set. The axis rests in profile position, where each drive supports
/// the halt bit. A new mode is ordered only when the drive shows the previous one, so its display is never
/// the echo of an older order, whatever the round-trip time of the frames.
class SetPointGate {
public:
    static constexpr OperationMode rest_mode = OperationMode::profile_position;
    /// Cycles that it must be slow at rest before it counts as standing: its velocity may only cross zero.
    static constexpr int settling_cycles = DriveControl::low_cycles;
    /// A drive that shows no mode, or starts no homing, for so many cycles is lost.
    static constexpr int patience_cycles = 3000;
    /// Most cycles that a hand-over between velocity and torque continues with the old set point. At rest:
    /// most cycles that the set-point bit stays set without an acknowledgement.
    static constexpr int hand_over_cycles = 250;

    enum class Progress : std::uint8_t { under_way, done, failed };

    void begin_at(double place) noexcept TAPPET_REALTIME { order_.position = place; }
    void set_standing(double velocity) noexcept TAPPET_REALTIME { standing_ = velocity; }

    /// Ends the motion.
    void rest() noexcept TAPPET_REALTIME {
        rests_ = true;
        leads_ = false;
    }
    /// Requests a motion; `target` is the first set point: a position, a velocity or a torque.
    void lead(OperationMode mode, double target, double profile_velocity = 0) noexcept TAPPET_REALTIME {
        leads_ = leads_ && mode == asked_;
        const bool is_place = mode == OperationMode::cyclic_position;
        if (leads_ && is_place) return; // it continues to follow positions
        rests_ = false;
        is_new_ = true;
        began_ = false;
        start_cycles_ = 0;
        stands_first_ = is_place; // whatever was active before, and however far it was
        asked_ = mode;
        target_ = target;
        profile_velocity_ = profile_velocity;
        offset_ = {};
    }
    /// Sets the next set point of a cyclic mode. Positions count only once the drive shows the mode and
    /// reports that it follows: until then it stands, and would jump to an outdated position.
    void follow(double set_point) noexcept TAPPET_REALTIME {
        if (rests_ || asked_ < OperationMode::cyclic_position) return;
        if (asked_ == OperationMode::cyclic_position && (!leads_ || is_new_)) return;
        target_ = set_point;
        is_new_ = false;
    }
    /// Adds a motion to the followed positions.
    void superimpose(const motion::Profile& offset) noexcept TAPPET_REALTIME {
        offset_ = offset;
        offset_age_ = {};
    }
    /// Returns true when a superimposed motion is active, or has left a distance.
    [[nodiscard]] bool has_offset() const noexcept TAPPET_REALTIME {
        return superimposes() || offset().position != 0;
    }
    [[nodiscard]] motion::AxisState offset() const noexcept TAPPET_REALTIME {
        return offset_.at(offset_age_);
    }

    /// Returns true when it was told to come to rest and stands.
    [[nodiscard]] bool stands() const noexcept TAPPET_REALTIME { return rests_ && is_still(); }
    /// Returns true when the drive shows the motion's mode and receives its set points.
    [[nodiscard]] bool leads(OperationMode mode) const noexcept TAPPET_REALTIME {
        return leads_ && asked_ == mode;
    }
    [[nodiscard]] bool superimposes() const noexcept TAPPET_REALTIME {
        return to_seconds(offset_age_) < offset_.duration_s();
    }
    /// Returns the progress of a motion to a position, or of a homing.
    [[nodiscard]] Progress progress() const noexcept TAPPET_REALTIME { return progress_; }
    /// Returns true when the drive has not followed its orders for longer than permitted.
    [[nodiscard]] bool is_lost() const noexcept TAPPET_REALTIME { return waits_ > patience_cycles; }

    /// Computes the orders of a cycle. `word`: the controlword for the drive's automaton. Only
    /// enable_operation permits a motion.
    [[nodiscard]] const DriveOrder& step(const DriveFeedback& seen, std::uint16_t word) noexcept
        TAPPET_REALTIME {
        const OperationMode shown = shown_by(seen);
        const DriveState state = drive_state(seen.statusword);
        const bool enabled = seen.heard && state == DriveState::operation_enabled;
        order_.controlword = word;
        leads_ = false;
        progress_ = Progress::under_way;
        if (!enabled || word != controlword::enable_operation) {
            without_power(seen, shown, enabled);
        } else {
            waits_ = shown == ordered_ ? 0 : waits_ + 1;
            if (shown == ordered_) order_mode(next_mode());
            leads_ = !rests_ && !stands_first_ && shown == ordered_ && ordered_ == asked_;
            if (leads_)
                move(seen);
            else if (hands_over(shown))
                hand_over(shown);
            else
                hold(seen, shown);
            if (shown == OperationMode::profile_position && ordered_ == shown) shake_hands(seen);
        }
        order_.mode = static_cast<std::int64_t>(ordered_);
        return order_;
    }

    /// Bits of the statusword whose meaning depends on the mode.
    struct status {
        static constexpr unsigned target_reached = 0x0400, internal_limit = 0x0800;
        static constexpr unsigned acknowledged = 0x1000; ///< pp: set point; hm: attained; cyclic: follows
        static constexpr unsigned error = 0x2000;        ///< hm: homing error; pp, csp: following error
    };

private:
    struct order_bit {
        static constexpr unsigned new_set_point = 0x10; ///< hm: homing operation start
        static constexpr unsigned at_once = 0x20;       ///< a new set point replaces the previous one
        static constexpr unsigned halt = 0x100;
    };
    /// Handshake of a set point in pp: the bit rises, is acknowledged, falls, and the acknowledgement falls.
    /// A halt or a new position waits for its end, because the drive sees no edge in a bit that rises again
    /// too soon.
    enum class HandShake : std::uint8_t { over, raised, lowered };

    [[nodiscard]] static OperationMode shown_by(const DriveFeedback& seen) noexcept TAPPET_REALTIME {
        return seen.mode < 0 || seen.mode > 10 ? OperationMode::none : static_cast<OperationMode>(seen.mode);
    }
    [[nodiscard]] bool is_still() const noexcept TAPPET_REALTIME { return slow_cycles_ > settling_cycles; }

    /// Ends any motion when power is lost.
    void without_power(const DriveFeedback& seen, OperationMode shown, bool enabled) noexcept
        TAPPET_REALTIME {
        const bool may_follow = enabled && (shown == OperationMode::cyclic_position ||
                                            ordered_ == OperationMode::cyclic_position);
        if (seen.heard && !may_follow) order_.position = seen.position;
        order_.velocity = order_.torque = order_.profile_velocity = 0;
        rests_ = true;
        is_released_ = false;
        hand_shake_ = HandShake::over;
        slow_cycles_ = 0;
        if (!may_follow) ordered_ = rest_mode;
        if (order_.controlword != controlword::enable_operation) {
            waits_ = 0;
            return;
        }
        order_.controlword |= order_bit::halt;
        if (shown != OperationMode::cyclic_position) return;
        // It would move to its position of some cycles ago, regardless of the halt bit.
        order_.controlword = controlword::switch_on;
        ++waits_;
    }
    /// Returns the mode to order next, once the drive shows the previous one.
    [[nodiscard]] OperationMode next_mode() const noexcept TAPPET_REALTIME {
        if (rests_) return rest_mode;
        // Cyclic position starts only at standstill: only there is the position of some cycles ago still
        // true.
        if (asked_ == OperationMode::cyclic_position && (ordered_ != asked_ || stands_first_) &&
            !(ordered_ == rest_mode && is_still()))
            return rest_mode;
        return asked_;
    }
    void order_mode(OperationMode mode) noexcept TAPPET_REALTIME {
        if (mode == ordered_) return;
        ordered_ = mode;
        stands_first_ = false; // at the change to or from rest
        hand_shake_ = HandShake::over;
        slow_cycles_ = 0;
    }
    /// Returns whether it changes between velocity and torque: different objects, without a halt bit.
    [[nodiscard]] bool hands_over(OperationMode shown) const noexcept TAPPET_REALTIME {
        return !rests_ && ordered_ == asked_ && asked_ >= OperationMode::cyclic_velocity &&
               shown >= OperationMode::cyclic_velocity && waits_ <= hand_over_cycles;
    }
    void hand_over(OperationMode shown) noexcept TAPPET_REALTIME {
        (shown == OperationMode::cyclic_velocity ? order_.torque : order_.velocity) = target_;
    }
    void hold(const DriveFeedback& seen, OperationMode shown) noexcept TAPPET_REALTIME {
        order_.controlword |= order_bit::halt;
        order_.velocity = order_.torque = 0;
        is_released_ = false;
        const bool is_cyclic =
            shown == OperationMode::cyclic_position || ordered_ == OperationMode::cyclic_position;
        const bool is_quiet = hand_shake_ == HandShake::over;
        if (!is_cyclic && is_quiet) order_.position = seen.position;
        // While the drive shows another mode, it has not yet received the order of rest.
        const bool is_slow = seen.velocity <= standing_ && -seen.velocity <= standing_;
        slow_cycles_ = is_slow && is_quiet && shown == ordered_ ? slow_cycles_ + 1 : 0;
        if (slow_cycles_ > settling_cycles) slow_cycles_ = settling_cycles + 1;
    }
    void move(const DriveFeedback& seen) noexcept TAPPET_REALTIME {
        slow_cycles_ = 0;
        order_.velocity = order_.torque = 0;
        switch (asked_) {
        case OperationMode::profile_position:
            if (hand_shake_ == HandShake::over && !is_new_ && (seen.statusword & status::target_reached) != 0)
                progress_ = Progress::done;
            break;
        case OperationMode::homing: home(seen); break;
        case OperationMode::cyclic_position:
            if (is_new_) target_ = order_.position; // where it stands
            offset_age_ += seen.passed;
            // The sum of two numbers may overflow.
            if (const double sum = target_ + offset().position; motion::is_number(sum)) order_.position = sum;
            break;
        case OperationMode::profile_velocity:
        case OperationMode::cyclic_velocity: order_.velocity = target_; break;
        case OperationMode::cyclic_torque: order_.torque = target_; break;
        case OperationMode::profile_torque:
        case OperationMode::none: break;
        }
        // Positions start when the drive reports that it follows; their source starts from its position then.
        if (asked_ != OperationMode::profile_position &&
            (asked_ != OperationMode::cyclic_position || (seen.statusword & status::acknowledged) != 0))
            is_new_ = false;
    }
    /// Runs a homing. The drive's bits may be from an earlier homing: they count only after they were seen
    /// clear since this one was requested. It starts late enough that they belong to this mode, even if they
    /// are sent apart from it.
    void home(const DriveFeedback& seen) noexcept TAPPET_REALTIME {
        const bool attained = (seen.statusword & status::acknowledged) != 0;
        const bool failed = (seen.statusword & status::error) != 0;
        if (start_cycles_ <= patience_cycles) ++start_cycles_;
        if (start_cycles_ <= settling_cycles) {
            order_.controlword |= order_bit::halt;
            return;
        }
        order_.controlword |= order_bit::new_set_point;
        began_ |= !attained && !failed;
        if (!began_)
            waits_ = start_cycles_;
        else if (failed)
            progress_ = Progress::failed;
        else if (attained && (seen.statusword & status::target_reached) != 0)
            progress_ = Progress::done;
    }
    /// Runs the handshake. The halt bit falls together with the edge of the new position, never before,
    /// because the drive would then continue to the old position.
    void shake_hands(const DriveFeedback& seen) noexcept TAPPET_REALTIME {
        const bool acknowledged = (seen.statusword & status::acknowledged) != 0;
        switch (hand_shake_) {
        case HandShake::over:
            if (!leads_ || !is_new_ || acknowledged) break;
            order_.position = target_;
            order_.profile_velocity = profile_velocity_;
            is_new_ = false;
            is_released_ = true;
            hand_shake_ = HandShake::raised;
            raised_cycles_ = 0;
            break;
        case HandShake::raised:
            if (acknowledged || (!leads_ && ++raised_cycles_ > hand_over_cycles))
                hand_shake_ = HandShake::lowered;
            break;
        case HandShake::lowered:
            if (!acknowledged) hand_shake_ = HandShake::over;
            break;
        }
        if (hand_shake_ == HandShake::raised)
            order_.controlword |= order_bit::new_set_point | order_bit::at_once;
        if (!is_released_) order_.controlword |= order_bit::halt;
    }

    DriveOrder order_{};
    OperationMode ordered_ = rest_mode, asked_ = rest_mode;
    HandShake hand_shake_ = HandShake::over;
    Progress progress_ = Progress::under_way;
    double target_ = 0, profile_velocity_ = 0, standing_ = 1e-3;
    motion::Profile offset_{};
    Duration offset_age_{};
    bool rests_ = true, leads_ = false;
    bool stands_first_ = false; ///< must come to a stand before it follows positions
    bool is_new_ = false;       ///< its target has not been sent
    bool is_released_ = false;  ///< in pp: the halt bit fell with a new position
    bool began_ = false;        ///< the homing has started
    int slow_cycles_ = 0, waits_ = 0, start_cycles_ = 0, raised_cycles_ = 0;
};

} // namespace tappet::canopen
