// A CiA 402 drive at the other end of the wires, as far as its automaton matters to a plant.
#pragma once

#include "drivers/canopen/cia402.hpp"

#include <cstdint>

namespace tappet::canopen {

/// It has no fault, and leaves quick stop by being switched on anew.
class SimulatedDrive {
public:
    /// Each controlword leads to its state; the answer is the statusword of that.
    std::uint16_t follow(std::int64_t word) noexcept {
        const bool was_switched_on = status_ == switched_on || status_ == enabled;
        if (word == controlword::enable_operation && was_switched_on)
            status_ = enabled;
        else if (word == controlword::switch_on && (was_switched_on || status_ == ready))
            status_ = switched_on;
        else
            status_ = word == controlword::shutdown ? ready : disabled;
        return status_;
    }
    [[nodiscard]] bool is_enabled() const noexcept { return status_ == enabled; }

private:
    static constexpr std::uint16_t disabled = 0x40, ready = 0x21, switched_on = 0x23, enabled = 0x27;
    static_assert(drive_state(disabled) == DriveState::switch_on_disabled &&
                  drive_state(ready) == DriveState::ready_to_switch_on &&
                  drive_state(switched_on) == DriveState::switched_on &&
                  drive_state(enabled) == DriveState::operation_enabled);
    std::uint16_t status_ = disabled;
};

} // namespace tappet::canopen
