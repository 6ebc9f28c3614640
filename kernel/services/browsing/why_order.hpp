// The question why a state machine is not in a state, on its way to the engine that runs it.
#pragma once

#include "kernel/machine/instance/instance.hpp"

namespace tappet::browsing {

struct WhyOrder {
    static constexpr std::size_t most = 8; ///< transitions that are evaluated for one answer

    BehaviourUnit* unit = nullptr;
    BehaviourSlot* slot = nullptr; ///< holds the unit; null: the unit is a row's own
    std::uint32_t placed = 0;      ///< of the unit: another script in the same memory has other states
    const Engine* engine = nullptr;
    std::size_t row = 0;
    std::size_t part = 0;
    StateIndex wanted = no_state;
    StateIndex leaf = no_state; ///< the active state at the time of the request
    MachineStatus status{};     ///< at that time, too
    Bounded<TransitionIndex, most> transitions{};
    std::array<StateMachineExecution::Look, most> looks{};
    bool done = false;

    /// Whether the unit still holds the behaviour that was found in it.
    [[nodiscard]] bool holds() const noexcept TAPPET_REALTIME {
        return (slot == nullptr || slot->active() == unit) && unit->placed() == placed;
    }
};

} // namespace tappet::browsing
