// Storage of a compiled script and its sizes: measured for a script in the firmware, a stated capacity for a
// loaded one.
#pragma once

#include "kernel/script/unit.hpp"

#include <array>

#include <cstddef>

namespace tappet {

/// Most stack that a compilation uses of its thread, for any text.
inline constexpr std::size_t script_stack_bytes = 160 * 1024;

/// Numbers of rows over all types of a script, and what its instances need at run time.
struct ScriptSizes {
    std::uint32_t instructions = 0;
    std::uint32_t conditions = 0;
    std::uint32_t nodes = 0;
    std::uint32_t arcs = 0;
    std::uint32_t programs = 0;
    std::uint32_t variables = 0;
    std::uint32_t links = 0;
    std::uint32_t image = 0; ///< bytes of initial data
    std::uint32_t states = 0;
    std::uint32_t transitions = 0;
    std::uint32_t captures = 0;
    std::uint32_t types = 0;
    std::uint32_t instances = 0;
    std::uint32_t names = 0; ///< characters
    std::uint32_t reach = 0; ///< components
    // Not in the room, but needed by the script's runner, over all instances.
    std::uint32_t data = 0; ///< bytes, each instance's aligned to data_alignment
    std::uint32_t command_slots = 0;
    std::uint32_t timers = 0; ///< nodes and transitions that wait for time

    friend constexpr bool operator==(const ScriptSizes&, const ScriptSizes&) = default;
};

/// Returns sizes for a script of so many nodes and bytes of data, for machines of usual proportions.
constexpr ScriptSizes script_sizes_for(std::uint32_t nodes, std::uint32_t data_bytes,
                                       std::uint32_t components) noexcept {
    ScriptSizes s;
    s.nodes = nodes;
    s.instructions = 6 * nodes;
    s.conditions = s.programs = s.transitions = nodes;
    s.arcs = 2 * nodes;
    s.variables = s.links = s.captures = nodes / 2 + 8;
    s.states = nodes / 2 + 4;
    s.image = data_bytes;
    s.types = nodes / 32 + 4;
    s.instances = nodes / 32 + 4;
    s.names = 24 * nodes + 256;
    s.reach = components;
    s.data = data_bytes;
    return s;
}

/// Calls visit(of.table..) for each table of a script: with its size, room, rows, or several of these.
template <class Visit, class... Of>
constexpr void for_each_table(const Visit& visit, Of&... of) {
    visit(of.instructions...);
    visit(of.conditions...);
    visit(of.nodes...);
    visit(of.arcs...);
    visit(of.programs...);
    visit(of.variables...);
    visit(of.links...);
    visit(of.image...);
    visit(of.states...);
    visit(of.transitions...);
    visit(of.captures...);
    visit(of.types...);
    visit(of.instances...);
    visit(of.names...);
    visit(of.reach...);
}

/// The storage that compile_into() fills. The spans must outlive the unit.
struct ScriptRoom {
    std::span<Instruction> instructions{};
    std::span<ConditionRow> conditions{};
    std::span<NodeRow> nodes{};
    std::span<ArcRow> arcs{};
    std::span<ProgramRow> programs{};
    std::span<VariableRow> variables{};
    std::span<LinkRow> links{};
    std::span<std::byte> image{};
    std::span<StateRow> states{};
    std::span<TransitionRow> transitions{};
    std::span<CaptureRow> captures{};
    std::span<BehaviourType> types{};
    std::span<BehaviourInstance> instances{};
    std::span<char> names{};
    std::span<Reachable> reach{};
};

template <ScriptSizes sizes>
struct ScriptBuffer {
    std::array<Instruction, sizes.instructions> instructions{};
    std::array<ConditionRow, sizes.conditions> conditions{};
    std::array<NodeRow, sizes.nodes> nodes{};
    std::array<ArcRow, sizes.arcs> arcs{};
    std::array<ProgramRow, sizes.programs> programs{};
    std::array<VariableRow, sizes.variables> variables{};
    std::array<LinkRow, sizes.links> links{};
    alignas(data_alignment) std::array<std::byte, sizes.image> image{};
    std::array<StateRow, sizes.states> states{};
    std::array<TransitionRow, sizes.transitions> transitions{};
    std::array<CaptureRow, sizes.captures> captures{};
    std::array<BehaviourType, sizes.types> types{};
    std::array<BehaviourInstance, sizes.instances> instances{};
    std::array<char, sizes.names> names{};
    std::array<Reachable, sizes.reach> reach{};

    [[nodiscard]] constexpr ScriptRoom room() noexcept {
        ScriptRoom room;
        for_each_table([](auto& rows, auto& span) { span = rows; }, *this, room);
        return room;
    }
};

/// Result of a compilation: a unit, or the reason why there is none.
struct ScriptOutcome {
    Sentence fault{};       ///< "weft.osd:12:5: ..."; empty: the unit is good
    std::uint16_t line = 0; ///< of the fault
    std::uint16_t column = 0;
    bool out_of_room = false; ///< the script may be good, but the room is too small for it
    ScriptSizes sizes{};      ///< the room used; with a fault, used until then
    ScriptUnit unit{};

    [[nodiscard]] constexpr bool good() const noexcept { return fault.empty(); }
};

} // namespace tappet
