// The result of compiling a script: the types of its programs and state machines as flat tables, and their
// instances. The same for a script compiled with the firmware and for a loaded one.
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
    /// The orders of native code, whose instructions are not kept; else empty.
    std::span<const ProgramOrder> orders{};

    [[nodiscard]] constexpr bool is_program() const noexcept { return machine.states.empty(); }
    /// Returns the number of parameters; they precede all other variables.
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
    InstanceIndex first_child = no_instance; ///< its children are contiguous
    std::uint16_t children = 0;
    bool on_command = false;            ///< a program with parameters: it starts on command
    std::span<const std::byte> image{}; ///< its initial data, including its arguments
};

/// Returns the number of instances that are programs.
constexpr std::size_t count_programs(std::span<const BehaviourType> types,
                                     std::span<const BehaviourInstance> instances) noexcept {
    std::size_t count = 0;
    for (const BehaviourInstance& each : instances)
        if (types[each.type].is_program()) ++count;
    return count;
}

/// A compiled script; a view, its rows must outlive it. A parent precedes its children.
struct ScriptUnit {
    std::string_view name{}; ///< the script's file name
    std::span<const BehaviourType> types{};
    std::span<const BehaviourInstance> instances{};
    std::span<const Reachable> reach{};
    std::uint16_t command_slots = 0; ///< LinkRows with needs_slot, over all instances
};

} // namespace tappet
