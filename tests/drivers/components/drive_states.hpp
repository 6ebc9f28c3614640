// The statusword of a drive in each state, by CiA 402-2.
#pragma once

#include "drivers/canopen/cia402.hpp"

#include <array>

namespace tappet::canopen {

inline constexpr std::array every_state{DriveState::not_ready,
                                        DriveState::switch_on_disabled,
                                        DriveState::ready_to_switch_on,
                                        DriveState::switched_on,
                                        DriveState::operation_enabled,
                                        DriveState::quick_stop_active,
                                        DriveState::fault_reaction_active,
                                        DriveState::fault};

/// The bits that belong to the state.
constexpr unsigned mask_of(DriveState state) {
    return state == DriveState::ready_to_switch_on || state == DriveState::switched_on ||
                   state == DriveState::operation_enabled || state == DriveState::quick_stop_active
               ? 0x6F
               : 0x4F;
}
/// The statusword of a state; bits that do not belong to the state are set by `noise`.
constexpr std::uint16_t statusword(DriveState state, std::uint16_t noise = 0) {
    constexpr std::array<std::uint16_t, 8> patterns{0x00, 0x40, 0x21, 0x23, 0x27, 0x07, 0x0F, 0x08};
    return static_cast<std::uint16_t>(patterns[static_cast<std::size_t>(state)] | (noise & ~mask_of(state)));
}

} // namespace tappet::canopen
