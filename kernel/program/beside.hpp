// What a program does with the others of its script (thesis 5.1.6): they are commanded with their parameters
// and followed to their end, as a component's commands are.
#pragma once

#include "kernel/program/execution.hpp"
#include "kernel/program/value_access.hpp"

namespace tappet {

enum class ProgramCommand : std::uint8_t { start, stop, pause };
enum class ProgramQuestion : std::uint8_t { is_running, is_paused, in_error };

namespace primitive {

/// Null: there is none of the instruction's number, `rows`.
inline ProgramExecution* program_of(ProgramContext& context, const Instruction& in) noexcept TAPPET_REALTIME {
    return in.rows < context.beside.count ? context.beside.first + in.rows : nullptr;
}
/// From its beginning, with the parameters `a`; one that is at work rejects it, which fails the action. An
/// error of it is over.
inline ActionResult begin_program(ProgramContext& context, const Instruction& in, std::byte*,
                                  const std::byte* a, const std::byte*) noexcept TAPPET_REALTIME {
    ProgramExecution* const program = program_of(context, in);
    if (program == nullptr || program->is_at_work()) return ActionResult::failed;
    program->give(a);
    static_cast<void>(program->stop());
    return program->start() ? ActionResult::done : ActionResult::failed;
}
/// `to`: a boolean, whether it has come to its end; one that failed or was stopped fails the condition.
inline ActionResult program_ended(ProgramContext& context, const Instruction& in, std::byte* to,
                                  const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    const ProgramExecution* const program = program_of(context, in);
    if (program == nullptr) return ActionResult::failed;
    store_value(to, program->has_ended());
    return program->has_ended() || program->is_at_work() ? ActionResult::done : ActionResult::failed;
}
/// `to`: what it returned.
inline ActionResult program_result(ProgramContext& context, const Instruction& in, std::byte* to,
                                   const std::byte*, const std::byte*) noexcept TAPPET_REALTIME {
    const ProgramExecution* const program = program_of(context, in);
    if (program == nullptr) return ActionResult::failed;
    program->take_result(to);
    return ActionResult::done;
}
/// `inner` says what; what makes no sense now changes nothing.
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
/// `to`: a boolean, what `inner` asks.
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
