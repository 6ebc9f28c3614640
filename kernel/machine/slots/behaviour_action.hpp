// Actions that a browser or a task requests from a behaviour (thesis fig. 5.9 and 5.19).
#pragma once

#include "kernel/machine/slots/behaviour_unit.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tappet {

enum class BehaviourAction : std::uint8_t {
    start,      ///< a program runs; a machine becomes active and automatic
    stop,       ///< a program ends; a machine enters its final state
    pause,      ///< at the present statement or state
    step,       ///< one statement or condition of a paused behaviour
    reset,      ///< a program returns to its beginning; a machine goes from the final to the initial state
    deactivate, ///< a machine runs its exits and becomes inactive
    reactive,   ///< a machine reacts to events and requests only
    request     ///< a machine takes the transition to a state, if its guard holds
};

inline constexpr std::array<std::string_view, 8> behaviour_actions{
    "start", "stop", "pause", "step", "reset", "deactivate", "reactive", "request"};

/// Carries out the action in the engine that runs the behaviour. `state`: of a request. Returns false when
/// the behaviour cannot do that in its present status, or when its component is stopped or stopping, where
/// nothing may begin. Real-time.
bool act(BehaviourUnit& unit, UnitPart& part, BehaviourAction action, StateIndex state, Time now) noexcept
    TAPPET_REALTIME;

} // namespace tappet
