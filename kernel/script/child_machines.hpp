// How a program uses the child machines of its state machine (thesis 5.2.1, 5.2.5): they are peers of their
// parent, which commands them, queries them, and reads and writes their variables.
#pragma once

#include "kernel/program/value_access.hpp"
#include "kernel/statechart/execution.hpp"

namespace tappet {

enum class MachineCommand : std::uint8_t {
    activate,
    deactivate,
    start,
    pause,
    stop,  ///< to the final state
    reset, ///< from the final to the initial state
    step,  ///< of a paused machine: one statement or one transition
    reactive,
    request_state,
    request_state_once ///< and runs its run program once
};
enum class MachineQuestion : std::uint8_t {
    in_state,
    in_error,
    is_active,
    is_running,
    is_paused,
    is_stopped
};

namespace primitive {

/// ProgramContext::machines points to the first of the children's executions; they are contiguous, in the
/// order of their instances. Instruction: rows is the child's number, inner the command or question, size a
/// state.
inline StateMachineExecution& child_of(ProgramContext& context, const Instruction& in) noexcept
    TAPPET_REALTIME {
    return static_cast<StateMachineExecution*>(context.machines)[in.rows];
}
/// A command that is not valid now changes nothing and does not fail; a lost command fails the action.
inline ActionResult command_child(ProgramContext& context, const Instruction& in, std::byte*,
                                  const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    if (context.machines == nullptr) return ActionResult::failed;
    StateMachineExecution& child = child_of(context, in);
    StateOutcome outcome = StateOutcome::taken;
    switch (static_cast<MachineCommand>(in.inner)) {
    case MachineCommand::activate: outcome = child.activate(context.now); break;
    case MachineCommand::deactivate: outcome = child.deactivate(context.now); break;
    case MachineCommand::start: outcome = child.start(context.now); break;
    case MachineCommand::pause: outcome = child.pause(); break;
    case MachineCommand::stop: outcome = child.request_final(context.now); break;
    case MachineCommand::reset: outcome = child.request_initial(context.now); break;
    case MachineCommand::step: static_cast<void>(child.step_once(context.now)); break;
    case MachineCommand::reactive: outcome = child.reactive(); break;
    case MachineCommand::request_state: outcome = child.request_state(in.size, context.now); break;
    case MachineCommand::request_state_once: outcome = child.request_state(in.size, context.now, true); break;
    }
    return outcome == StateOutcome::lost ? ActionResult::failed : ActionResult::done;
}
/// `to`: a bool.
inline ActionResult ask_child(ProgramContext& context, const Instruction& in, std::byte* to, const std::byte*,
                              const std::byte*) noexcept TAPPET_REALTIME {
    if (context.machines == nullptr) return ActionResult::failed;
    const StateMachineExecution& child = child_of(context, in);
    bool answer = false;
    switch (static_cast<MachineQuestion>(in.inner)) {
    case MachineQuestion::in_state: answer = child.is_in(in.size); break;
    case MachineQuestion::in_error: answer = child.in_error(); break;
    case MachineQuestion::is_active: answer = child.is_active(); break;
    case MachineQuestion::is_running: answer = child.machine_status() == MachineStatus::running; break;
    case MachineQuestion::is_paused: answer = child.is_paused(); break;
    case MachineQuestion::is_stopped: answer = child.is_final(); break;
    }
    store_value(to, answer);
    return ActionResult::done;
}
/// Reads a variable of a child, at inner | columns << 8 in its data, `size` bytes.
inline ActionResult read_child(ProgramContext& context, const Instruction& in, std::byte* to,
                               const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    if (context.machines == nullptr) return ActionResult::failed;
    copy_bytes(to, child_of(context, in).data() + (in.inner | in.columns << 8), in.size);
    return ActionResult::done;
}
inline ActionResult write_child(ProgramContext& context, const Instruction& in, std::byte*,
                                const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    if (context.machines == nullptr) return ActionResult::failed;
    copy_bytes(child_of(context, in).data() + (in.inner | in.columns << 8), a, in.size);
    return ActionResult::done;
}

} // namespace primitive

} // namespace tappet
