// A positioning drive at the other end of the wires: the CiA 402 automaton, its modes of operation with their
// handshakes, a motor with inertia, and injection of every fault.
#pragma once

#include "drivers/canopen/drive_motion.hpp"
#include "drivers/canopen/simulated_drive.hpp"

#include <algorithm>

namespace tappet::canopen {

/// Real-time. Units are those of the signals; times are in seconds.
class SimulatedServo {
public:
    struct Limits {
        double velocity = 100, acceleration = 1000, quick = 5000, torque_to_acceleration = 1;
    };
    /// Injected faults, until they are cleared.
    struct Faults {
        bool ignores_set_points = false;    ///< no acknowledgement in pp
        bool keeps_acknowledgement = false; ///< in pp, although the set-point bit fell
        bool fails_homing = false;
        bool ignores_homing = false; ///< starts no homing
        bool refuses_mode = false;   ///< 6061h does not change
        bool is_blocked = false;     ///< the motor does not turn
        bool is_at_limit = false;
        bool is_remote = true;
        bool knows_no_halt_in_cyclic = false; ///< CiA 402 leaves the bit open in csp, csv and cst
        bool remembers_home = false; ///< hm: shows the bits of the previous homing until a new one starts
        int mode_steps = 0;          ///< steps until it accepts a new mode
    };

    SimulatedServo() noexcept TAPPET_REALTIME : SimulatedServo{Limits{}} {}
    explicit SimulatedServo(const Limits& limits) noexcept TAPPET_REALTIME : limits_{limits} {}

    Faults faults{};
    /// Causes a fault. Returns false when there is one already.
    bool trip() noexcept TAPPET_REALTIME { return drive_.trip(); }
    /// Opens the relay of its power; or starts a quick stop of its own.
    void lose_power() noexcept TAPPET_REALTIME { drive_.control(controlword::disable_voltage); }
    void stop_quickly() noexcept TAPPET_REALTIME { drive_.control(controlword::quick_stop); }
    /// Turns the shaft from outside, by hand or by its load.
    void turn_shaft(double by) noexcept TAPPET_REALTIME { position_ += by; }
    /// Sets the position of its home switch.
    void set_home(double position) noexcept TAPPET_REALTIME { home_ = position; }

    /// Turns the motor by hand; returns false when it has power.
    bool turn(double by) noexcept TAPPET_REALTIME {
        if (drive_.power() != SimulatedDrive::Power::off) return false;
        position_ += by;
        return true;
    }

    [[nodiscard]] double position() const noexcept TAPPET_REALTIME { return position_ - zero_; }
    [[nodiscard]] double velocity() const noexcept TAPPET_REALTIME { return velocity_; }
    [[nodiscard]] std::int64_t mode() const noexcept TAPPET_REALTIME {
        return static_cast<std::int64_t>(mode_);
    }
    [[nodiscard]] DriveState state() const noexcept TAPPET_REALTIME { return drive_.state(); }
    /// Returns the number of set points taken in pp.
    [[nodiscard]] int set_points() const noexcept TAPPET_REALTIME { return set_points_; }
    /// Returns the number of completed homings.
    [[nodiscard]] int homings() const noexcept TAPPET_REALTIME { return homings_; }

    [[nodiscard]] std::uint16_t statusword() const noexcept TAPPET_REALTIME {
        unsigned word = drive_.statusword() | 0x0010u;
        if (faults.is_remote) word |= 0x0200u;
        if (reached_) word |= 0x0400u;
        if (faults.is_at_limit) word |= 0x0800u;
        if (bit_12_) word |= 0x1000u;
        if (bit_13_) word |= 0x2000u;
        return static_cast<std::uint16_t>(word);
    }

    /// Takes the orders of a frame.
    void take(const DriveOrder& order) noexcept TAPPET_REALTIME {
        drive_.control(order.controlword);
        const bool rises = (order.controlword & ~word_ & 0x10u) != 0;
        word_ = order.controlword;
        order_ = order;
        if (const auto wanted = static_cast<OperationMode>(order.mode); wanted != next_mode_) {
            next_mode_ = wanted;
            mode_steps_ = faults.mode_steps;
        }
        if (mode_steps_ <= 0) take_mode();
        if (!drive_.is_enabled()) return;
        if (mode_ == OperationMode::profile_position) {
            if (rises && !bit_12_ && !faults.ignores_set_points) {
                target_ = order.position;
                reached_ = false;
                bit_12_ = true;
                ++set_points_;
            }
            if ((word_ & 0x10u) == 0 && !faults.keeps_acknowledgement) bit_12_ = false;
        }
        if (mode_ == OperationMode::homing && rises && !faults.ignores_homing) {
            homes_ = true;
            bit_12_ = bit_13_ = reached_ = false;
        }
    }
    void step(double dt) noexcept TAPPET_REALTIME {
        if (mode_steps_ > 0 && --mode_steps_ == 0) take_mode();
        drive_.settle(velocity_ == 0);
        switch (drive_.power()) {
        case SimulatedDrive::Power::off: velocity_ = 0; break; // its brake closes
        case SimulatedDrive::Power::stop: approach(0, limits_.quick, dt); break;
        case SimulatedDrive::Power::follow: follow(dt); break;
        }
        if (!drive_.is_enabled()) bit_12_ = bit_13_ = homes_ = false;
        if (faults.is_blocked) velocity_ = 0;
        position_ += velocity_ * dt;
    }

private:
    void take_mode() noexcept TAPPET_REALTIME {
        if (next_mode_ == mode_ || faults.refuses_mode) return;
        mode_ = next_mode_;
        bit_12_ = bit_13_ = reached_ = homes_ = false;
        if (mode_ == OperationMode::homing && faults.remembers_home && homings_ > 0)
            bit_12_ = reached_ = true;
        target_ = position();
    }
    void approach(double velocity, double acceleration, double dt) noexcept TAPPET_REALTIME {
        const double wanted = std::clamp(velocity, -limits_.velocity, limits_.velocity);
        const double most = acceleration * dt;
        velocity_ += std::clamp(wanted - velocity_, -most, most);
    }
    /// Moves to a position and stops there. Returns true when it stands there.
    bool go(double place, double at_most, double dt) noexcept TAPPET_REALTIME {
        const double left = place - position();
        const double size = left < 0 ? -left : left;
        if (size <= limits_.acceleration * dt * dt &&
            (velocity_ < 0 ? -velocity_ : velocity_) <= limits_.acceleration * dt) {
            velocity_ = left / dt; // the last part of the way
            if (size == 0) return true;
            return false;
        }
        // The highest velocity from which it can still stop: v^2 = 2 a s, by Newton's method.
        double v = at_most;
        for (int i = 0; i < 20; ++i) v = 0.5 * (v + 2 * 0.9 * limits_.acceleration * size / v);
        v = std::min(v, at_most);
        approach(left < 0 ? -v : v, limits_.acceleration, dt);
        return false;
    }
    void follow(double dt) noexcept TAPPET_REALTIME {
        const bool is_cyclic = mode_ >= OperationMode::cyclic_position;
        if ((word_ & 0x100u) != 0 && !(is_cyclic && faults.knows_no_halt_in_cyclic)) {
            approach(0, limits_.acceleration, dt);
            reached_ = velocity_ == 0;
            if (is_cyclic) bit_12_ = false;
            return;
        }
        const double profile = order_.profile_velocity > 0 ? order_.profile_velocity : limits_.velocity;
        switch (mode_) {
        case OperationMode::none: approach(0, limits_.acceleration, dt); break;
        case OperationMode::profile_position:
            if (set_points_ > 0) reached_ = go(target_, profile, dt);
            bit_13_ = faults.is_blocked && !reached_;
            break;
        case OperationMode::profile_velocity:
            approach(order_.velocity, limits_.acceleration, dt);
            reached_ = velocity_ == order_.velocity;
            bit_12_ = velocity_ == 0;
            break;
        case OperationMode::homing:
            if (!homes_) break;
            if (faults.fails_homing) {
                bit_13_ = true;
                approach(0, limits_.acceleration, dt);
                reached_ = velocity_ == 0;
            } else if (go(home_ - zero_, 0.2 * limits_.velocity, dt)) {
                zero_ = position_;
                bit_12_ = reached_ = true;
                homes_ = false;
                ++homings_;
            }
            break;
        case OperationMode::cyclic_position:
            velocity_ = std::clamp((order_.position - position()) / dt, -limits_.velocity, limits_.velocity);
            bit_12_ = true;
            bit_13_ = faults.is_blocked;
            break;
        case OperationMode::cyclic_velocity:
            approach(order_.velocity, limits_.acceleration, dt);
            bit_12_ = true;
            break;
        case OperationMode::profile_torque:
        case OperationMode::cyclic_torque:
            velocity_ = std::clamp(velocity_ + order_.torque * limits_.torque_to_acceleration * dt,
                                   -limits_.velocity, limits_.velocity);
            bit_12_ = true;
            break;
        }
    }

    Limits limits_;
    SimulatedDrive drive_{};
    DriveOrder order_{};
    std::uint16_t word_ = 0;
    OperationMode mode_ = OperationMode::none, next_mode_ = OperationMode::none;
    double position_ = 0, velocity_ = 0, target_ = 0, zero_ = 0, home_ = 0;
    bool reached_ = false, bit_12_ = false, bit_13_ = false, homes_ = false;
    int set_points_ = 0, homings_ = 0, mode_steps_ = 0;
};

} // namespace tappet::canopen
