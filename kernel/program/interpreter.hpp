// The loaded form of programs: their tables are interpreted. node.hpp defines what a node does.
#pragma once

#include "kernel/program/code.hpp"

namespace tappet {

/// See ProgramCode. Real-time; one call through a pointer for each instruction.
ProgramReturn run_program(const ProgramTables& tables, ProgramContext& context,
                          std::uint32_t& statements) noexcept TAPPET_REALTIME;
ConditionResult test_condition(const ProgramTables& tables, ProgramContext& context,
                               ConditionIndex condition) noexcept TAPPET_REALTIME;
Time program_wakes(const ProgramTables& tables, const ProgramContext& context) noexcept TAPPET_REALTIME;

/// Returns the code for the programs of these tables, interpreted in memory; the tables must outlive it.
constexpr ProgramCode interpreted(const ProgramTables& tables) noexcept {
    return {&tables, &run_program, &test_condition, &program_wakes};
}

/// Returns where a program that failed at `node` continues when errors are skipped (thesis 5.1.3): the target
/// of its last arc without a time-out; this is after a statement, and out of a loop.
constexpr NodeIndex past_failure(const ProgramTables& tables, NodeIndex node) noexcept TAPPET_REALTIME {
    const NodeRow& row = tables.nodes[node];
    NodeIndex to = end_node;
    for (std::size_t i = 0; i < row.arcs; ++i) {
        const ArcRow& arc = tables.arcs[row.first_arc + i];
        if (arc.after == no_data && arc.to != no_node) to = arc.to;
    }
    return to;
}

} // namespace tappet
