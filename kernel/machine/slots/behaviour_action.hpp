// What a behaviour is told to do from outside (thesis fig. 5.9 and 5.19), by a browser or by its task.
#pragma once

#include "kernel/machine/slots/behaviour_unit.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tappet {

enum class BehaviourAction : std::uint8_t {
    start,      ///< a program runs, a machine is activated and goes automatically
    stop,       ///< a program ends, a machine goes to its final state
    pause,      ///< where it stands
    step,       ///< one statement or question of what is paused
    reset,      ///< a program to its beginning, a machine from the final to the initial state
    deactivate, ///< a machine runs its exits and is inactive
    reactive,   ///< a machine hears events and requests only
    request     ///< a machine takes the transition to a state, if its guard holds
};

inline constexpr std::array<std::string_view, 8> behaviour_actions{
    "start", "stop", "pause", "step", "reset", "deactivate", "reactive", "request"};

/// In the engine that runs it. `state`: of a request. False: it does not do that in its present status, or
/// its component stands or comes to its end, where nothing begins.
bool act(BehaviourUnit& unit, UnitPart& part, BehaviourAction action, StateIndex state, Time now) noexcept
    TAPPET_REALTIME;

} // namespace tappet
