// The compiler of scripts (thesis 5.1.4, 5.2.4): text in, flat tables out. The same code runs in a constant
// expression for a script compiled with the firmware, and on the target for a loaded script. grammar.md
// defines the language.
#pragma once

#include "kernel/script/compiler.hpp"
#include "kernel/script/room.hpp"

namespace tappet {

/// Compiles `text` against the names in `reach` and stores the result in `room`, whose previous content is
/// overwritten. `name` is the file's name, for messages. The unit refers to the room, to the names in `reach`
/// and to the facets of its types, not to `text`.
///
/// Not real-time, but bounded: no heap, no recursion deeper than script_max_depth, and at most
/// script_work(text.size()) tokens read, whatever the text, on script_stack_bytes of stack.
constexpr ScriptOutcome compile_into(std::string_view text, std::string_view name, const Reach& reach,
                                     const ScriptRoom& room) {
    ScriptOutcome outcome;
    script_detail::Compiler compiler{text, name, reach, room, outcome};
    compiler.compile();
    return outcome;
}

/// Compiles one line that a user typed: statements, or an expression; the value of an expression is the
/// result of the unit's only program. An expression changes nothing. `name`: of the line in messages.
constexpr ScriptOutcome compile_line_into(std::string_view text, std::string_view name, const Reach& reach,
                                          const ScriptRoom& room) {
    ScriptOutcome outcome;
    script_detail::Compiler compiler{text, name, reach, room, outcome};
    compiler.compile_line();
    return outcome;
}

} // namespace tappet
