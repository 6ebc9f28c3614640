// Status of a state machine: plain data without pointers, for observers in other activities and processes.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/statechart/hierarchy.hpp"

namespace tappet {

enum class StateOutcome : std::uint8_t {
    taken,   ///< a transition was taken; it may need more steps, see under_way()
    ignored, ///< inactive, no transition for it here, no guard held, or the request is not valid now
    queued,  ///< called from a program or guard, or other events wait: it is handled in order
    lost,    ///< no room to queue it; counted
};

/// The status of thesis fig. 5.19.
enum class MachineStatus : std::uint8_t {
    inactive, ///< reacts to nothing
    active,   ///< reactive mode: events and requests only
    running,  ///< automatic mode
    paused,   ///< executes only single steps; events are queued
    stopped,  ///< in the final state
    error     ///< a program failed; only a request for the final state and a deactivation are served
};

constexpr std::string_view to_text(MachineStatus status) noexcept {
    switch (status) {
    case MachineStatus::inactive: return "inactive";
    case MachineStatus::active: return "active";
    case MachineStatus::running: return "running";
    case MachineStatus::paused: return "paused";
    case MachineStatus::stopped: return "stopped";
    case MachineStatus::error: return "error";
    }
    return "?";
}

/// Progress of an active state's run program in this round of run, conditions and handle.
enum class RunPhase : std::uint8_t {
    fresh,     ///< not started
    under_way, ///< started, continues in this step
    waits,     ///< started, continues in the next step
    ran,       ///< ended; its conditions are evaluated next
    asked,     ///< no condition held; its handle program is next
    done,      ///< runs again in the next step
    held       ///< entered again in the step in which it ran; runs in the next step
};

struct ActiveState {
    StateIndex state = no_state;
    RunPhase run = RunPhase::fresh;
    ProgramPosition position{}; ///< of its run program
    Time entered_at{};
};

/// The kind of the current program.
enum class StatePart : std::uint8_t {
    none,
    entry,
    exit,
    run,
    handle,
    then,
    otherwise,
    guard,
    capture,
    child
};

constexpr std::string_view to_text(StatePart part) noexcept {
    switch (part) {
    case StatePart::none: return "nothing";
    case StatePart::entry: return "entry";
    case StatePart::exit: return "exit";
    case StatePart::run: return "run";
    case StatePart::handle: return "handle";
    case StatePart::then: return "transition program";
    case StatePart::otherwise: return "else program";
    case StatePart::guard: return "guard";
    case StatePart::capture: return "arguments";
    case StatePart::child: return "child machine";
    }
    return "?";
}

/// The place of a fault in a machine.
struct StateMachineFault {
    StatePart part = StatePart::none;
    StateIndex state = no_state;                ///< of the program, or the source of the transition
    TransitionIndex transition = no_transition; ///< of a transition's part
    NodeIndex node = end_node;                  ///< the node that failed; end_node: not inside a program
    std::uint64_t number = 0;                   ///< number of errors, this one included
    Time at{};
};

struct StateMachineStatus {
    StateIndex active = no_state; ///< the active leaf, of the first region of each composite
    TransitionIndex last_transition = 0;
    TransitionIndex reason = 0; ///< the last transition that gave one, see reason()
    std::uint64_t transitions = 0;
    std::uint64_t lost_events = 0;
    std::uint64_t deferred_events = 0; ///< events that waited for a program or for their turn
    Time reason_at{};
    /// The active states, each before those inside it, regions in their order. A state is listed from before
    /// its entry program until after its exit program.
    Bounded<ActiveState, max_active_states> states;
    StateMachineFault fault;
};

} // namespace tappet
