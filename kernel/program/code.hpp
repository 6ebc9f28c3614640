// Interface to execute the programs of one table, in either of two forms: native code made of a constant
// table, or the table itself, read in memory.
#pragma once

#include "kernel/program/context.hpp"

namespace tappet {

/// Why a program returned.
enum class ProgramReturn : std::uint8_t {
    ended,     ///< position.node is end_node
    waits,     ///< no arc is open: continue in the next step
    left_over, ///< the statements are used up: continue in the next step at the latest
    failed     ///< position.node is the node whose action or condition failed
};

/// A guard or precondition that fails counts as false and as a failure.
enum class ConditionResult : std::uint8_t { no, yes, failed };

struct ProgramCode {
    /// Null when a machine has C++ programs only.
    const ProgramTables* tables = nullptr;
    /// Executes from context.position, at most `statements` statements; subtracts those executed. Real-time.
    ProgramReturn (*run)(const ProgramTables&, ProgramContext&, std::uint32_t& statements) noexcept
        TAPPET_REALTIME = nullptr;
    ConditionResult (*test)(const ProgramTables&, ProgramContext&, ConditionIndex) noexcept
        TAPPET_REALTIME = nullptr;
    /// Returns when a program that waits at context.position needs a step without an event: its earliest
    /// time-out, or `never`.
    Time (*wakes)(const ProgramTables&, const ProgramContext&) noexcept TAPPET_REALTIME = nullptr;
};

/// The status of a program (thesis 5.1.2).
enum class ProgramStatus : std::uint8_t { ready, running, paused, stopped, error };

constexpr std::string_view to_text(ProgramStatus status) noexcept {
    switch (status) {
    case ProgramStatus::ready: return "ready";
    case ProgramStatus::running: return "running";
    case ProgramStatus::paused: return "paused";
    case ProgramStatus::stopped: return "stopped";
    case ProgramStatus::error: return "error";
    }
    return "?";
}

} // namespace tappet
