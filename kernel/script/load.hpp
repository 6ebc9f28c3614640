// The script compiler of a firmware: one function, so that its code exists once and is small.
#pragma once

#include "kernel/script/room.hpp"

namespace tappet {

/// compile_into() of compile.hpp, for loading scripts while the machine runs. Not real-time, bounded; uses
/// script_stack_bytes of stack.
ScriptOutcome compile_loaded(std::string_view text, std::string_view name, const Reach& reach,
                             const ScriptRoom& room);
/// compile_line_into(), with the same limits.
ScriptOutcome compile_line(std::string_view text, std::string_view name, const Reach& reach,
                           const ScriptRoom& room);

} // namespace tappet
