// A CiA 402 drive at the other end of the wires: its automaton with its faults, for plants.
#pragma once

#include "drivers/canopen/cia402.hpp"

#include <cstdint>

namespace tappet::canopen {

/// The numbers at transitions are the standard's. Quick stop option code (605Ah) 2: brake, then switch on
/// disabled. Fault reaction: brake, then fault. Real-time.
class SimulatedDrive {
public:
    /// The effect of the power stage on the motor.
    enum class Power : std::uint8_t { off, follow, stop };

    [[nodiscard]] constexpr DriveState state() const noexcept TAPPET_REALTIME { return state_; }
    [[nodiscard]] constexpr bool is_enabled() const noexcept TAPPET_REALTIME {
        return state_ == DriveState::operation_enabled;
    }
    [[nodiscard]] constexpr Power power() const noexcept TAPPET_REALTIME {
        if (is_enabled()) return Power::follow;
        return state_ == DriveState::quick_stop_active || state_ == DriveState::fault_reaction_active
                   ? Power::stop
                   : Power::off;
    }
    [[nodiscard]] constexpr std::uint16_t statusword() const noexcept TAPPET_REALTIME {
        return word_of(state_);
    }

    /// Takes a controlword.
    constexpr void control(std::uint16_t word) noexcept TAPPET_REALTIME {
        const bool reset = (word & controlword::fault_reset) != 0 && (word_ & controlword::fault_reset) == 0;
        word_ = word;
        const Order order = order_of(word);
        const bool goes_down = order == Order::quick_stop || order == Order::disable_voltage;
        switch (state_) {
        case DriveState::fault:
            if (reset) state_ = DriveState::switch_on_disabled; // 15
            break;
        case DriveState::switch_on_disabled:
            if (order == Order::shutdown) state_ = DriveState::ready_to_switch_on; // 2
            break;
        case DriveState::ready_to_switch_on:
            if (order == Order::switch_on) state_ = DriveState::switched_on;              // 3
            if (order == Order::enable_operation) state_ = DriveState::operation_enabled; // 3 and 4
            if (goes_down) state_ = DriveState::switch_on_disabled;                       // 7
            break;
        case DriveState::switched_on:
            if (order == Order::enable_operation) state_ = DriveState::operation_enabled; // 4
            if (order == Order::shutdown) state_ = DriveState::ready_to_switch_on;        // 6
            if (goes_down) state_ = DriveState::switch_on_disabled;                       // 10
            break;
        case DriveState::operation_enabled:
            if (order == Order::switch_on) state_ = DriveState::switched_on;              // 5
            if (order == Order::shutdown) state_ = DriveState::ready_to_switch_on;        // 8
            if (order == Order::disable_voltage) state_ = DriveState::switch_on_disabled; // 9
            if (order == Order::quick_stop) state_ = DriveState::quick_stop_active;       // 11
            break;
        case DriveState::quick_stop_active:
            if (order == Order::disable_voltage) state_ = DriveState::switch_on_disabled; // 12
            break;
        default: break;
        }
    }
    /// Makes the drive's own transitions, for a motor that stands or not.
    constexpr void settle(bool stands) noexcept TAPPET_REALTIME {
        if (state_ == DriveState::not_ready) state_ = DriveState::switch_on_disabled; // 1
        if (!stands) return;
        if (state_ == DriveState::quick_stop_active) state_ = DriveState::switch_on_disabled; // 12
        if (state_ == DriveState::fault_reaction_active) state_ = DriveState::fault;          // 14
    }
    /// Causes a fault; returns false when there is one already.
    constexpr bool trip() noexcept TAPPET_REALTIME {
        if (state_ == DriveState::fault_reaction_active || state_ == DriveState::fault) return false;
        state_ = DriveState::fault_reaction_active; // 13
        return true;
    }
    /// For simple plants: each controlword leads to its state at once, as if the motor stopped in no time;
    /// returns the resulting statusword.
    constexpr std::uint16_t follow(std::int64_t word) noexcept TAPPET_REALTIME {
        settle(true);
        control(static_cast<std::uint16_t>(word));
        settle(true);
        return statusword();
    }

    [[nodiscard]] static constexpr std::uint16_t word_of(DriveState state) noexcept TAPPET_REALTIME {
        switch (state) {
        case DriveState::not_ready: return 0x00;
        case DriveState::switch_on_disabled: return 0x40;
        case DriveState::ready_to_switch_on: return 0x21;
        case DriveState::switched_on: return 0x23;
        case DriveState::operation_enabled: return 0x27;
        case DriveState::quick_stop_active: return 0x07;
        case DriveState::fault_reaction_active: return 0x0F;
        case DriveState::fault: return 0x08;
        }
        return 0x00;
    }

private:
    enum class Order : std::uint8_t { disable_voltage, quick_stop, shutdown, switch_on, enable_operation };
    /// Bits 0 switch on, 1 enable voltage, 2 quick stop (active low), 3 enable operation.
    static constexpr Order order_of(std::uint16_t word) noexcept TAPPET_REALTIME {
        if ((word & 0x02u) == 0) return Order::disable_voltage;
        if ((word & 0x04u) == 0) return Order::quick_stop;
        if ((word & 0x01u) == 0) return Order::shutdown;
        return (word & 0x08u) == 0 ? Order::switch_on : Order::enable_operation;
    }

    DriveState state_ = DriveState::not_ready;
    std::uint16_t word_ = 0;
};

static_assert(
    [] {
        for (auto state = std::uint8_t{0}; state <= static_cast<std::uint8_t>(DriveState::fault); ++state)
            if (drive_state(SimulatedDrive::word_of(DriveState{state})) != DriveState{state}) return false;
        return true;
    }(),
    "what a drive says is understood by who leads it");

} // namespace tappet::canopen
