// How a program uses the other programs of its script (thesis 5.1.6): it commands them with their parameters
// and waits for their end, as with a component's commands.
#pragma once

#include "kernel/program/execution.hpp"
#include "kernel/program/value_access.hpp"

namespace tappet {

enum class ProgramCommand : std::uint8_t { start, stop, pause };
enum class ProgramQuestion : std::uint8_t { is_running, is_paused, in_error };

namespace primitive {

/// Returns the program with the instruction's number, `rows`; null: none has it.
inline ProgramExecution* program_of(ProgramContext& context, const Instruction& in) noexcept TAPPET_REALTIME {
    return in.rows < context.beside.count ? context.beside.first + in.rows : nullptr;
}
/// Starts a program from its beginning, with the parameters `a`. A program that is running rejects it, which
/// fails the action. Clears the program's error.
inline ActionResult begin_program(ProgramContext& context, const Instruction& in, std::byte*,
                                  const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    ProgramExecution* const program = program_of(context, in);
    if (program == nullptr || program->is_at_work()) return ActionResult::failed;
    program->give(a);
    static_cast<void>(program->stop());
    return program->start() ? ActionResult::done : ActionResult::failed;
}
/// `to`: a bool, whether it has ended; a program that failed or was stopped fails the condition.
inline ActionResult program_ended(ProgramContext& context, const Instruction& in, std::byte* to,
                                  const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    const ProgramExecution* const program = program_of(context, in);
    if (program == nullptr) return ActionResult::failed;
    store_value(to, program->has_ended());
    return program->has_ended() || program->is_at_work() ? ActionResult::done : ActionResult::failed;
}
/// `to`: its result.
inline ActionResult program_result(ProgramContext& context, const Instruction& in, std::byte* to,
                                   const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    const ProgramExecution* const program = program_of(context, in);
    if (program == nullptr) return ActionResult::failed;
    program->take_result(to);
    return ActionResult::done;
}
/// Executes the command `inner`; a command that is not valid now changes nothing.
inline ActionResult control_program(ProgramContext& context, const Instruction& in, std::byte*,
                                    const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    ProgramExecution* const program = program_of(context, in);
    if (program == nullptr) return ActionResult::failed;
    switch (static_cast<ProgramCommand>(in.inner)) {
    case ProgramCommand::start: static_cast<void>(program->start()); break;
    case ProgramCommand::stop: static_cast<void>(program->stop()); break;
    case ProgramCommand::pause: static_cast<void>(program->pause()); break;
    }
    return ActionResult::done;
}
/// `to`: a bool, the answer to the question `inner`.
inline ActionResult ask_program(ProgramContext& context, const Instruction& in, std::byte* to,
                                const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    const ProgramExecution* const program = program_of(context, in);
    if (program == nullptr) return ActionResult::failed;
    ProgramStatus wanted = ProgramStatus::running;
    switch (static_cast<ProgramQuestion>(in.inner)) {
    case ProgramQuestion::is_running: break;
    case ProgramQuestion::is_paused: wanted = ProgramStatus::paused; break;
    case ProgramQuestion::in_error: wanted = ProgramStatus::error; break;
    }
    store_value(to, program->status() == wanted);
    return ActionResult::done;
}

} // namespace primitive

} // namespace tappet
