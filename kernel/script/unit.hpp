// What a script is compiled to: the types of its programs and state machines as flat tables, and the
// instances of them that it asks for. The same for a script compiled with the firmware and for one that is
// loaded.
#pragma once

#include "kernel/program/table.hpp"
#include "kernel/script/reach.hpp"
#include "kernel/statechart/table.hpp"

namespace tappet {

using TypeIndex = std::uint16_t;
using InstanceIndex = std::uint16_t;
inline constexpr InstanceIndex no_instance = 0xffff;

/// A StateMachine or a program of the script. All numbers in its tables count within the type.
struct BehaviourType {
    std::string_view name{};
    ProgramTables tables{};
    StateMachineTable machine{}; ///< without states: a program alone, tables.programs[0]

    [[nodiscard]] constexpr bool is_program() const noexcept { return machine.states.empty(); }
    /// How many it has; they stand before all other variables.
    [[nodiscard]] constexpr std::size_t parameters() const noexcept {
        std::size_t count = 0;
        for (const VariableRow& row : tables.variables) count += row.kind == VariableKind::parameter ? 1 : 0;
        return count;
    }
};

/// RootStateMachine, SubStateMachine or program: one set of data of a type (thesis listings 5.5, 5.6).
struct BehaviourInstance {
    std::string_view name{}; ///< "cycle", a child "cycle.left"
    TypeIndex type = 0;
    InstanceIndex parent = no_instance;
    InstanceIndex first_child = no_instance; ///< its children stand side by side
    std::uint16_t children = 0;
    bool on_command = false;            ///< a program with parameters: it starts when it is told to
    std::span<const std::byte> image{}; ///< its data at the beginning, its arguments in place
};

/// How many of the instances are programs.
constexpr std::size_t count_programs(std::span<const BehaviourType> types,
                                     std::span<const BehaviourInstance> instances) noexcept {
    std::size_t count = 0;
    for (const BehaviourInstance& each : instances)
        if (types[each.type].is_program()) ++count;
    return count;
}

/// A compiled script; a view, the rows live elsewhere. A parent stands before its children.
struct ScriptUnit {
    std::string_view name{}; ///< the script's file name
    std::span<const BehaviourType> types{};
    std::span<const BehaviourInstance> instances{};
    std::span<const Reachable> reach{};
    std::uint16_t command_slots = 0; ///< LinkRows with needs_slot, over all instances
};

} // namespace tappet
