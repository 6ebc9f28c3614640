// A line of the script language that somebody typed, as whoever hands it on meets the component that executes
// it: without that component nothing of it is in a firmware.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/component/command.hpp"
#include "kernel/component/role.hpp"
#include "kernel/program/table.hpp"

#include <span>
#include <string_view>

namespace tappet {

/// What became of a line.
struct LineEnd {
    CommandState state = CommandState::ready; ///< executing, done or failed
    Sentence why{};                           ///< of one that is not done
    /// Of one that is done its value, or its variables: each stands in `data`. Both stay until it is let go.
    std::span<const VariableRow> values{};
    const std::byte* data = nullptr;
};

/// Why a line was not begun.
enum class LineRefusal : std::uint8_t {
    none,
    wrong,  ///< it does not compile, or asks for more than a line may have
    denied, ///< whoever asks has not the role
    not_now ///< another one is at work, or what it needs does not run
};

/// In the activity of what sees the machine; not real-time.
struct LineFunctions {
    /// Begins a line for somebody of this role. An answer that is not empty says why not.
    Sentence (*begin)(void* self, std::string_view line, Role role, LineRefusal& refusal) = nullptr;
    /// Null: it is at work.
    const LineEnd* (*end)(void* self) = nullptr;
    /// Whoever began it has seen its end, or wants it no longer: then it is broken off.
    void (*let_go)(void* self) = nullptr;
    /// not_now: none is at work. denied: it belongs to somebody of a higher role.
    LineRefusal (*break_off)(void* self, Role role) = nullptr;
};

} // namespace tappet
