// Access to a typed line of the script language, for components that pass it on to the one that executes it:
// without that component no code of it is in a firmware.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/component/command.hpp"
#include "kernel/component/role.hpp"
#include "kernel/program/table.hpp"

#include <span>
#include <string_view>

namespace tappet {

/// The end of a line.
struct LineEnd {
    CommandState state = CommandState::ready; ///< executing, done or failed
    Sentence why{};                           ///< the reason, if it is not done
    /// The value of a line that is done, or its variables: each is in `data`. Both stay valid until let_go().
    std::span<const VariableRow> values{};
    const std::byte* data = nullptr;
};

/// The reason why a line was not begun.
enum class LineRefusal : std::uint8_t {
    none,
    wrong,  ///< it does not compile, or needs more than a line may have
    denied, ///< the user does not have the right
    not_now ///< another line runs, or what it needs does not run
};

/// In the activity of the component that sees the machine; not real-time.
struct LineFunctions {
    /// Begins a line for a user with these rights. An answer that is not empty says why it was not begun.
    Sentence (*begin)(void* self, std::string_view line, Rights rights, LineRefusal& refusal) = nullptr;
    /// Returns the end of the line; null: it still runs.
    const LineEnd* (*end)(void* self) = nullptr;
    /// Releases the line: its user has seen its end, or abandons it; then it is broken off.
    void (*let_go)(void* self) = nullptr;
    /// Breaks off the line. not_now: none runs. denied: it belongs to a user of a higher role.
    LineRefusal (*break_off)(void* self, Role role) = nullptr;
};

} // namespace tappet
