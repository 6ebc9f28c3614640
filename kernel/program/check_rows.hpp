// Checks of a program that is spelled in C++: its names mean nodes, each node is reached and left, and its
// functions belong to one component.
#pragma once

#include "kernel/program/rows.hpp"

namespace tappet {

namespace detail {

constexpr Sentence unknown_node(const ProgramSpelling& program, std::string_view name) {
    Nearest nearest{name};
    for (const ProgramNodeRow& node : program.nodes) nearest.consider(node.name);
    Sentence text{"there is no node \"", name, "\"; "};
    if (nearest.best().empty()) return text.add("name one of the program's nodes, or add this one");
    return text.add("did you mean \"").add(nearest.best()).add("\"?");
}

constexpr std::array<bool, max_program_nodes> reached_nodes(const ProgramTables& tables) {
    std::array<bool, max_program_nodes> reached{};
    const std::size_t count = tables.nodes.size();
    reached[0] = true;
    bool more = true;
    for (std::size_t round = 0; round < count && more; ++round) {
        more = false;
        const auto reach = [&](NodeIndex to) {
            if (to >= count || reached[to]) return;
            reached[to] = more = true;
        };
        for (std::size_t n = 0; n < count; ++n) {
            if (!reached[n]) continue;
            const NodeRow& row = tables.nodes[n];
            reach(row.on_error);
            for (const ArcRow& arc : tables.arcs.subspan(row.first_arc, row.arcs)) reach(arc.to);
        }
    }
    return reached;
}

} // namespace detail

/// Empty: the program is good. Otherwise what is wrong, where, and the cure.
constexpr Sentence check(const ProgramSpelling& program) {
    const Sentence where{"program \"", program.name, "\": "};
    for (std::size_t n = 0; n < program.nodes.size(); ++n) {
        const ProgramNodeRow& node = program.nodes[n];
        if (node.name.empty())
            return Sentence{where, "node ", n + 1, " has no name; the empty one is the program's end"};
        for (std::size_t other = 0; other < n; ++other)
            if (program.nodes[other].name == node.name)
                return Sentence{where, "there are two nodes \"", node.name,
                                "\"; give each a name of its own"};
        if (node.component != nullptr && node.component != program.component)
            return Sentence{where,
                            "the action of node \"",
                            node.name,
                            "\" is a function of ",
                            node.component->name,
                            "; the program runs on ",
                            program.component->name};
        if (node.handles_error && program.find(node.on_error) == no_node)
            return Sentence{where, "node \"", node.name,
                            "\": ", detail::unknown_node(program, node.on_error)};
    }
    for (std::size_t a = 0; a < program.arcs.size(); ++a) {
        const ProgramArcRow& arc = program.arcs[a];
        const Sentence who{where, "arc ", a + 1, " (\"", arc.from, "\" to \"", arc.to, "\"): "};
        if (program.find(arc.from) == no_node || arc.from == program_end)
            return Sentence{who, detail::unknown_node(program, arc.from)};
        if (program.find(arc.to) == no_node) return Sentence{who, detail::unknown_node(program, arc.to)};
        if (arc.component != nullptr && arc.component != program.component)
            return Sentence{who, "its condition is a function of ", arc.component->name,
                            "; the program runs on ", program.component->name};
        if (arc.after < Duration::zero()) return Sentence{who, "its time-out is negative; give a duration"};
    }
    const auto reached = detail::reached_nodes(program.tables);
    for (std::size_t n = 0; n < program.nodes.size(); ++n) {
        const std::string_view name = program.nodes[n].name;
        if (!reached[n])
            return Sentence{where, "no arc leads to node \"", name, "\"; add one, or leave the node out"};
        if (program.tables.nodes[n].arcs == 0)
            return Sentence{where, "no arc leads out of node \"", name,
                            "\"; add one, to program_end if it is the last"};
        for (std::size_t a = 0; a + 1 < program.tables.nodes[n].arcs; ++a) {
            const ArcRow& arc = program.tables.arcs[program.tables.nodes[n].first_arc + a];
            if (arc.condition == no_condition && arc.after == no_data)
                return Sentence{where, "node \"",
                                name,  "\": arc ",
                                a + 1, " of it is always open, those after it are never asked; put it last"};
        }
    }
    return {};
}
template <std::size_t N, std::size_t A>
constexpr Sentence check(const ProgramTable<N, A>& table) {
    return check(table.spelling());
}

} // namespace tappet
