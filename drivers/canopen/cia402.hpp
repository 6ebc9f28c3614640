// The controller's side of a CiA 402 drive: decodes the statusword, and computes the controlword that leads
// to the goal.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet::canopen {

/// States of the drive's finite state automaton (CiA 402-2, statusword 6041h).
enum class DriveState : std::uint8_t {
    not_ready,
    switch_on_disabled,
    ready_to_switch_on,
    switched_on,
    operation_enabled,
    quick_stop_active,
    fault_reaction_active,
    fault,
};

constexpr DriveState drive_state(std::uint16_t statusword) noexcept TAPPET_REALTIME {
    switch (statusword & 0x4Fu) {
    case 0x00: return DriveState::not_ready;
    case 0x40: return DriveState::switch_on_disabled;
    case 0x0F: return DriveState::fault_reaction_active;
    case 0x08: return DriveState::fault;
    default: break;
    }
    switch (statusword & 0x6Fu) {
    case 0x21: return DriveState::ready_to_switch_on;
    case 0x23: return DriveState::switched_on;
    case 0x27: return DriveState::operation_enabled;
    case 0x07: return DriveState::quick_stop_active;
    default: return DriveState::not_ready;
    }
}

/// Commands of the controlword 6040h.
namespace controlword {
inline constexpr std::uint16_t disable_voltage = 0x00;
inline constexpr std::uint16_t quick_stop = 0x02;
inline constexpr std::uint16_t shutdown = 0x06;
inline constexpr std::uint16_t switch_on = 0x07;
inline constexpr std::uint16_t enable_operation = 0x0F;
inline constexpr std::uint16_t fault_reset = 0x80; ///< acts on its rising edge
} // namespace controlword

/// The wanted state of a drive.
enum class DriveGoal : std::uint8_t { off, enabled, quick_stop };

/// Leads a drive to its goal, one controlword per cycle. Each acknowledgement resets one fault. The goal does
/// not change, so a drive whose goal is `enabled` is enabled again after the reset.
class DriveControl {
public:
    void want(DriveGoal goal) noexcept TAPPET_REALTIME { goal_ = goal; }
    [[nodiscard]] DriveGoal goal() const noexcept TAPPET_REALTIME { return goal_; }
    /// Permits the reset of one fault; no effect without a fault. When the fault outlived the last reset, a
    /// new call lowers the bit and raises it again.
    void acknowledge() noexcept TAPPET_REALTIME {
        if (reset_ == Reset::raised) low_cycles_left_ = low_cycles;
        reset_ = Reset::asked;
    }

    [[nodiscard]] std::uint16_t controlword(std::uint16_t statusword) noexcept TAPPET_REALTIME {
        const DriveState state = drive_state(statusword);
        if (state == DriveState::fault) return controlword_in_fault();
        // An acknowledgement during the reaction is for the fault that follows; one that acted before is not.
        if (state != DriveState::fault_reaction_active || reset_ == Reset::raised) reset_ = Reset::none;
        low_cycles_left_ = 0;
        if (goal_ == DriveGoal::off) return controlword::disable_voltage;
        if (goal_ == DriveGoal::quick_stop)
            return state == DriveState::operation_enabled || state == DriveState::quick_stop_active
                       ? controlword::quick_stop
                       : controlword::disable_voltage;
        switch (state) {
        case DriveState::switch_on_disabled: return controlword::shutdown;
        case DriveState::ready_to_switch_on: return controlword::switch_on;
        case DriveState::switched_on:
        case DriveState::operation_enabled: return controlword::enable_operation;
        case DriveState::quick_stop_active: return controlword::disable_voltage;
        default: return controlword::disable_voltage;
        }
    }

    /// Cycles that the reset bit stays low before it rises again: the drive must see it low, although frames
    /// leave only every few cycles and may be lost.
    static constexpr int low_cycles = 20;

private:
    enum class Reset : std::uint8_t { none, asked, raised };

    std::uint16_t controlword_in_fault() noexcept TAPPET_REALTIME {
        if (reset_ == Reset::none) return controlword::disable_voltage;
        if (low_cycles_left_ > 0) {
            --low_cycles_left_;
            return controlword::disable_voltage;
        }
        // The bit stays set until the fault is gone, so that a lost frame does not lose the edge.
        reset_ = Reset::raised;
        return controlword::fault_reset;
    }

    DriveGoal goal_ = DriveGoal::off;
    Reset reset_ = Reset::none;
    int low_cycles_left_ = 0;
};

} // namespace tappet::canopen
