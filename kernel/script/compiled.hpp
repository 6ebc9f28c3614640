// A script compiled with the firmware: text and reach are constants, and so is the compiled unit.
// tappet_script() generates the source:
//
//     inline constexpr tappet::ScriptSource weft_source{"weft.osd", "StateMachine Weft { ... }"};
//     inline constexpr auto weft_reach = tappet::script_reach<WeftInsertion>("weft");
//     inline constexpr const tappet::ScriptUnit& weft_script =
//         tappet::compiled_script<weft_source, weft_reach>;
#pragma once

#include "kernel/base/source_text.hpp"
#include "kernel/script/compile.hpp"

namespace tappet {

using ScriptSource = SourceText;

/// A component in reach of a script, by type and name.
template <class T>
constexpr Reachable reachable(std::string_view name, bool same_activity = true) noexcept {
    return {name, &component_type<T>, same_activity};
}

/// A reach that owns its list; the first is the component that the script drives.
template <std::size_t N>
struct ScriptReach {
    std::array<Reachable, N> components{};
    std::uint32_t statements_per_step = 0;

    [[nodiscard]] constexpr Reach view() const noexcept {
        Reach reach;
        reach.components = components;
        reach.statements_per_step = statements_per_step;
        return reach;
    }
};
template <class... R>
constexpr ScriptReach<sizeof...(R)> script_reach(const R&... each) noexcept {
    return {{each...}};
}

namespace script_detail {

struct Measured {
    Sentence fault{};
    bool out_of_room = false;
    ScriptSizes sizes{};
};

/// Twice the usual need: in a constant expression empty rows cost compile time too.
constexpr ScriptSizes measuring_room(std::uint32_t nodes, std::size_t components) noexcept {
    ScriptSizes most = script_sizes_for(nodes, 1024 + 4 * nodes, static_cast<std::uint32_t>(components));
    most.instructions = 4 * nodes;
    most.conditions = most.programs = most.transitions = nodes / 2 + 16;
    most.variables = most.links = most.captures = nodes / 8 + 32;
    most.states = nodes / 3 + 8;
    most.names = 10 * nodes + 512;
    return most;
}
/// A script in a room larger than needed.
template <ScriptSizes room>
struct DraftScript {
    ScriptBuffer<room> rows{};
    ScriptOutcome outcome{};

    // A machine's own constants may be called `source` or `peers`; parameters would shadow them.
    constexpr DraftScript(const ScriptSource& script_read, const Reach& script_peers)
        : outcome{compile_into(script_read.text, script_read.name, script_peers, rows.room())} {}
};
template <const auto& Source, const auto& Peers, std::uint32_t nodes>
inline constexpr DraftScript<measuring_room(nodes, Peers.components.size())> draft{Source, Peers.view()};

/// Enlarges the room until the script fits, or is too large for any.
template <const auto& Source, const auto& Peers, std::uint32_t nodes>
consteval std::uint32_t nodes_for() {
    if constexpr (draft<Source, Peers, nodes>.outcome.out_of_room && nodes < max_script_nodes)
        return nodes_for<Source, Peers, 2 * nodes>();
    else
        return nodes;
}
template <const auto& Source, const auto& Peers>
inline constexpr const auto& fitting_draft =
    draft<Source, Peers,
          nodes_for<Source, Peers, static_cast<std::uint32_t>(Source.text.size() / 36 + 32)>()>;

template <const auto& Source, const auto& Peers>
inline constexpr Measured measured = [] {
    const ScriptOutcome& outcome = fitting_draft<Source, Peers>.outcome;
    return Measured{outcome.fault, outcome.out_of_room, outcome.good() ? outcome.sizes : ScriptSizes{}};
}();

/// A script in exactly its room: the rows of the draft, with adjusted pointers. The text is read once.
template <ScriptSizes sizes>
struct StoredScript {
    ScriptBuffer<sizes> rows{};
    ScriptUnit unit{};

    template <ScriptSizes room>
    constexpr explicit StoredScript(const DraftScript<room>& script_read) : unit{script_read.outcome.unit} {
        const ScriptBuffer<room>& from = script_read.rows;
        for_each_table(
            [](const auto& rows_read, auto& to) {
                for (std::size_t i = 0; i < to.size(); ++i) to[i] = rows_read[i];
            },
            from, rows);

        const auto names = [&](std::string_view& name) {
            if (name.empty())
                name = {};
            else
                name = {rows.names.data() + (name.data() - from.names.data()), name.size()};
        };
        const auto leads = [](const auto& rows_read, auto& to, auto& view) {
            if (view.empty())
                view = {};
            else
                view = {to.data() + (view.data() - rows_read.data()), view.size()};
        };
        for (ProgramRow& row : rows.programs) names(row.name);
        for (VariableRow& row : rows.variables) names(row.name);
        for (StateRow& row : rows.states) names(row.name), names(row.parent), names(row.region);
        for (TransitionRow& row : rows.transitions) {
            names(row.from), names(row.to), names(row.event);
            names(row.because), names(row.otherwise_to), names(row.refusal.text);
        }
        for (BehaviourType& type : rows.types) {
            ProgramTables& tables = type.tables;
            leads(from.instructions, rows.instructions, tables.instructions);
            leads(from.conditions, rows.conditions, tables.conditions);
            leads(from.nodes, rows.nodes, tables.nodes);
            leads(from.arcs, rows.arcs, tables.arcs);
            leads(from.programs, rows.programs, tables.programs);
            leads(from.variables, rows.variables, tables.variables);
            leads(from.links, rows.links, tables.links);
            leads(from.image, rows.image, tables.image);
            names(type.name), names(type.machine.name);
            leads(from.states, rows.states, type.machine.states);
            leads(from.transitions, rows.transitions, type.machine.transitions);
            leads(from.captures, rows.captures, type.machine.captures);
            if (type.machine.programs != nullptr) type.machine.programs = &tables;
        }
        for (BehaviourInstance& instance : rows.instances) {
            names(instance.name);
            leads(from.image, rows.image, instance.image);
        }
        names(unit.name);
        leads(from.types, rows.types, unit.types);
        leads(from.instances, rows.instances, unit.instances);
        leads(from.reach, rows.reach, unit.reach);
    }
};

template <const auto& Source, const auto& Peers>
inline constexpr StoredScript<measured<Source, Peers>.sizes> stored{fitting_draft<Source, Peers>};

/// Not defined: a compiler that prints no message objects prints the sentence as the argument of this name.
template <text sentence>
struct script_fault;
template <>
struct script_fault<text<0>{}> {};

template <const auto& Source, const auto& Peers>
struct CheckedScript {
    static constexpr const Sentence& fault = measured<Source, Peers>.fault;
#if defined(__clang__)
    static constexpr bool accepted = fault.empty();
    static_assert(accepted, fault);
#else
    static_assert(sizeof(script_fault<text<fault.size()>{fault.view()}>) != 0);
#endif
    static constexpr const ScriptUnit& unit = stored<Source, Peers>.unit;
};

} // namespace script_detail

/// The unit of a constant script; a fault in it is an error of the C++ build that states the script's line.
/// `Source` is a ScriptSource and `Peers` a ScriptReach, constexpr variables at namespace scope.
template <const auto& Source, const auto& Peers>
inline constexpr const ScriptUnit& compiled_script = script_detail::CheckedScript<Source, Peers>::unit;

/// The fault of a constant script as a value, without stopping the build.
template <const auto& Source, const auto& Peers>
inline constexpr const Sentence& script_fault_of = script_detail::measured<Source, Peers>.fault;

} // namespace tappet
