// Checks of a program that is spelled in C++: its names mean nodes, each node is reached and left, and its
// functions belong to one component.
#pragma once

#include "kernel/program/rows.hpp"

namespace tappet {

namespace detail {

template <std::size_t N, std::size_t A>
constexpr Sentence unknown_node(const ProgramTable<N, A>& table, std::string_view name) {
    Nearest nearest{name};
    for (const ProgramNodeRow& node : table.spelled_nodes) nearest.consider(node.name);
    Sentence text{"there is no node \"", name, "\"; "};
    if (nearest.best().empty()) return text.add("name one of the program's nodes, or add this one");
    return text.add("did you mean \"").add(nearest.best()).add("\"?");
}

template <std::size_t N, std::size_t A>
constexpr std::array<bool, N> reached_nodes(const ProgramTable<N, A>& table) {
    std::array<bool, N> reached{};
    reached[0] = true;
    // Each round reaches one more node, or none is left.
    for (std::size_t round = 0; round < N; ++round)
        for (std::size_t n = 0; n < N; ++n) {
            if (!reached[n]) continue;
            const NodeRow& row = table.nodes[n];
            if (row.on_error < N) reached[row.on_error] = true;
            for (std::size_t a = 0; a < row.arcs; ++a)
                if (table.arcs[row.first_arc + a].to < N) reached[table.arcs[row.first_arc + a].to] = true;
        }
    return reached;
}

} // namespace detail

/// Empty: the program is good. Otherwise what is wrong, where, and the cure.
template <std::size_t N, std::size_t A>
constexpr Sentence check(const ProgramTable<N, A>& table) {
    const Sentence where{"program \"", table.name, "\": "};
    for (std::size_t n = 0; n < N; ++n) {
        const ProgramNodeRow& node = table.spelled_nodes[n];
        if (node.name.empty())
            return Sentence{where, "node ", n + 1, " has no name; the empty one is the program's end"};
        for (std::size_t other = 0; other < n; ++other)
            if (table.spelled_nodes[other].name == node.name)
                return Sentence{where, "there are two nodes \"", node.name,
                                "\"; give each a name of its own"};
        if (node.component != nullptr && node.component != table.component)
            return Sentence{where,
                            "the action of node \"",
                            node.name,
                            "\" is a function of ",
                            node.component->name,
                            "; the program runs on ",
                            table.component->name};
        if (node.handles_error && table.find(node.on_error) == no_node)
            return Sentence{where, "node \"", node.name, "\": ", detail::unknown_node(table, node.on_error)};
    }
    for (std::size_t a = 0; a < A; ++a) {
        const ProgramArcRow& arc = table.spelled_arcs[a];
        const Sentence who{where, "arc ", a + 1, " (\"", arc.from, "\" to \"", arc.to, "\"): "};
        if (table.find(arc.from) == no_node || arc.from == program_end)
            return Sentence{who, detail::unknown_node(table, arc.from)};
        if (table.find(arc.to) == no_node) return Sentence{who, detail::unknown_node(table, arc.to)};
        if (arc.component != nullptr && arc.component != table.component)
            return Sentence{who, "its condition is a function of ", arc.component->name,
                            "; the program runs on ", table.component->name};
        if (arc.after < Duration::zero()) return Sentence{who, "its time-out is negative; give a duration"};
    }
    const auto reached = detail::reached_nodes(table);
    for (std::size_t n = 0; n < N; ++n) {
        const std::string_view name = table.spelled_nodes[n].name;
        if (!reached[n])
            return Sentence{where, "no arc leads to node \"", name, "\"; add one, or leave the node out"};
        if (table.nodes[n].arcs == 0)
            return Sentence{where, "no arc leads out of node \"", name,
                            "\"; add one, to program_end if it is the last"};
        for (std::size_t a = 0; a + 1 < table.nodes[n].arcs; ++a) {
            const ArcRow& arc = table.arcs[table.nodes[n].first_arc + a];
            if (arc.condition == no_condition && arc.after == no_data)
                return Sentence{where, "node \"",
                                name,  "\": arc ",
                                a + 1, " of it is always open, those behind it are never asked; put it last"};
        }
    }
    return {};
}

} // namespace tappet
