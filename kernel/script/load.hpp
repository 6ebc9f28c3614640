// The compiler of scripts as the firmware has it: one function, so that its code is there once and small.
#pragma once

#include "kernel/script/room.hpp"

namespace tappet {

/// compile_into() of compile.hpp, for whoever loads scripts while the machine runs. Not real-time, bounded;
/// on script_stack_bytes of stack.
ScriptOutcome compile_loaded(std::string_view text, std::string_view name, const Reach& reach,
                             const ScriptRoom& room);
/// compile_line_into(), likewise.
ScriptOutcome compile_line(std::string_view text, std::string_view name, const Reach& reach,
                           const ScriptRoom& room);

} // namespace tappet
