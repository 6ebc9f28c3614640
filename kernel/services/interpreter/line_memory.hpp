// The memory of one line: its rows, and the program made of them.
#pragma once

#include "kernel/machine/slots/memory.hpp"
#include "kernel/services/engine_call.hpp"

namespace tappet::interpreter {

/// A line is one program of a few statements.
inline constexpr ScriptSizes line_sizes{.instructions = 128,
                                        .conditions = 16,
                                        .nodes = 24,
                                        .arcs = 48,
                                        .programs = 1,
                                        .variables = 8,
                                        .links = 16,
                                        .image = 1024,
                                        .types = 1,
                                        .instances = 1,
                                        .names = 256,
                                        .data = 2048,
                                        .command_slots = 4};

/// Returns the bytes of one program that hears no events; the same sums as in BehaviourUnit::place.
constexpr std::size_t program_bytes(const ScriptSizes& sizes) noexcept {
    tappet::detail::UnitLayout layout;
    layout.take<UnitPart>(1);
    layout.take<StateMachineExecution>(1);
    layout.take<ProgramExecution>(1);
    layout.take<ResolvedView>(1);
    layout.take(sizes.data, data_alignment);
    layout.take<ProgramLink>(sizes.links);
    layout.take<CommandSlot>(sizes.command_slots);
    layout.take(sizes.command_slots * slot_command_bytes, data_alignment);
    return layout.used();
}

/// A line in its memory, and the call to the engine that runs it.
struct Bank {
    ScriptBuffer<line_sizes> rows{};
    BehaviourUnit unit{};
    alignas(unit_alignment) std::array<std::byte, program_bytes(line_sizes)> memory{};
    EngineCall call{};
    const Engine* engine = nullptr; ///< of the activity that runs it
    std::size_t home = nowhere;     ///< a component of that activity
    bool has_begun = false;
    Role role = Role::engineer; ///< of the line's author

    /// Whether no engine refers to it any more, and none of its commands is in progress.
    [[nodiscard]] bool is_free() const noexcept { return call.is_over() && unit.is_quiet(); }
    [[nodiscard]] const ProgramExecution& program() const noexcept { return *unit.parts()[0].program; }
};

/// Returns the lowest role that may execute the instruction, by its action on a component.
Role role_of(const Instruction& instruction) noexcept;
/// Returns why a request from there may not execute the instruction; empty: it may.
Sentence check_origin(const Instruction& instruction, std::string_view facet, Origin origin) noexcept;
/// Says where and why the program of a line failed.
Sentence describe_fault(const Bank& bank, std::span<const Reachable> reach);

} // namespace tappet::interpreter
