// Checks that rows of a state machine point into its programs: verifies tables compiled elsewhere.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/statechart/table.hpp"

namespace tappet {

namespace statechart {

constexpr bool exists(const StateMachineTable& table, const ProgramRef& program) noexcept {
    return program.program == no_program ||
           (table.programs != nullptr && program.program < table.programs->programs.size());
}
constexpr bool exists(const StateMachineTable& table, const ConditionRef& condition) noexcept {
    return condition.condition == no_condition ||
           (table.programs != nullptr && condition.condition < table.programs->conditions.size());
}
constexpr bool exists(const StateMachineTable& table, const CaptureRow& row) noexcept {
    if (table.programs == nullptr) return false;
    const ProgramTables& programs = *table.programs;
    return row.first + std::size_t{row.count} <= programs.instructions.size() &&
           row.raw >= programs.layout.constants && row.raw + std::size_t{row.size} <= programs.layout.size;
}

} // namespace statechart

/// Returns empty when every program, condition and capture that a row names exists.
constexpr Sentence check_references(const StateMachineTable& table) {
    using statechart::exists;
    for (const StateRow& row : table.states)
        for (const bool good : {exists(table, row.precondition), exists(table, row.entry),
                                exists(table, row.exit), exists(table, row.run), exists(table, row.handle)})
            if (!good) return Sentence{"state \"", row.name, "\" names a program that does not exist"};
    for (std::size_t i = 0; i < table.transitions.size(); ++i) {
        const TransitionRow& row = table.transitions[i];
        if (!exists(table, row.guard) || !exists(table, row.then) || !exists(table, row.otherwise) ||
            row.first_capture + std::size_t{row.captures} > table.captures.size())
            return Sentence{"transition ", i + 1, " names a program or a capture that does not exist"};
    }
    for (std::size_t i = 0; i < table.captures.size(); ++i)
        if (!exists(table, table.captures[i])) return Sentence{"capture ", i + 1, " leads out of the data"};
    return {};
}

} // namespace tappet
