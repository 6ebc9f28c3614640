// Native code made of a constant table: its nodes in pieces, each a function. The table itself is not needed.
#pragma once

#include "kernel/program/interpreter.hpp"
#include "kernel/program/native_node.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace tappet {

namespace native {

/// Most nodes in one function. A program goes to another piece by number; within a piece it falls through or
/// jumps.
inline constexpr std::size_t piece_nodes = 16;

template <const auto& source, std::size_t type> struct Code : NodeCode<source, type> {
    using Nodes = NodeCode<source, type>;
    static constexpr const ProgramTables& tables = Nodes::tables;

    // ---- pieces of code: a short program, or a part of a longer one

    struct Piece {
        NodeIndex first = 0;
        NodeIndex end = 0;
    };
    // A piece begins at the first node of each program, and after a full piece.
    static constexpr auto begins_piece = [] {
        std::array<bool, tables.nodes.size() + 1> begins{};
        begins[0] = true;
        for (const ProgramRow& program : tables.programs)
            if (program.first < tables.nodes.size()) begins[program.first] = true;
        for (std::size_t node = 0, first = 0; node < tables.nodes.size(); ++node) {
            begins[node] = begins[node] || node - first == piece_nodes;
            if (begins[node]) first = node;
        }
        return begins;
    }();
    static constexpr std::size_t piece_count = [] {
        std::size_t count = 0;
        for (std::size_t node = 0; node < tables.nodes.size(); ++node) count += begins_piece[node];
        return count;
    }();
    static constexpr std::array<Piece, piece_count> pieces = [] {
        std::array<Piece, piece_count> all{};
        for (std::size_t node = 0, used = 0; node < tables.nodes.size(); ++node) {
            if (begins_piece[node]) all[used++].first = static_cast<NodeIndex>(node);
            all[used - 1].end = static_cast<NodeIndex>(node + 1);
        }
        return all;
    }();
    // Its nodes lead only forward: each node is checked once. Not constexpr, because g++ would then evaluate
    // it at run time, at each turn of a loop.
    static consteval bool is_straight(const Piece& piece) {
        const auto is_back = [&piece](NodeIndex from, NodeIndex to) {
            return to <= from && to >= piece.first;
        };
        for (NodeIndex node = piece.first; node < piece.end; ++node) {
            const NodeRow& row = tables.nodes[node];
            if (is_back(node, row.on_error)) return false;
            for (const ArcRow& arc : tables.arcs.subspan(row.first_arc, row.arcs))
                if (is_back(node, arc.to)) return false;
        }
        return true;
    }
    static consteval bool is_whole(const ProgramRow& program) {
        return std::size_t{program.last} - program.first <= piece_nodes &&
               is_straight({program.first, program.last});
    }

    // Executes from the node `next` until the program leaves the piece. Each node checks whether it is
    // `next`; the compiler knows this after the node before it.
    template <std::size_t first, std::size_t... i>
    [[gnu::always_inline]] static NextNode pass(std::index_sequence<i...>, ProgramContext& context,
                                                ProgramRun& run, NextNode next) noexcept TAPPET_REALTIME {
        constexpr std::size_t end = first + sizeof...(i);
        do
            ((next = next == first + i ? Nodes::template node<static_cast<NodeIndex>(first + i)>(context, run)
                                       : next),
             ...);
        while (!is_straight({first, end}) && next >= first && next < end);
        return next;
    }
    template <std::size_t first, std::size_t end>
    static NextNode piece(ProgramContext& context, ProgramRun& shared, NextNode next) noexcept
        TAPPET_REALTIME {
        ProgramRun run = shared; // in registers
        next = pass<first>(std::make_index_sequence<end - first>{}, context, run, next);
        shared = run;
        return next;
    }

    // Finds the piece of a node by binary search: no table of functions is needed.
    template <std::size_t low, std::size_t high>
    [[gnu::always_inline]] static NextNode go_to(ProgramContext& context, ProgramRun& run,
                                                 NextNode next) noexcept TAPPET_REALTIME {
        if constexpr (high - low <= 1) {
            return piece<pieces[low].first, pieces[low].end>(context, run, next);
        } else {
            constexpr std::size_t middle = (low + high) / 2;
            return next < pieces[middle].first ? go_to<low, middle>(context, run, next)
                                               : go_to<middle, high>(context, run, next);
        }
    }
    static NextNode goes_on_at(ProgramContext& context, ProgramRun& run, NextNode next) noexcept
        TAPPET_REALTIME {
        if constexpr (piece_count != 0)
            while (next < tables.nodes.size()) next = go_to<0, piece_count>(context, run, next);
        return next;
    }

    // ---- facts about a program or a condition before it runs

    template <class Is>
    static constexpr bool any_instruction(std::size_t first, std::size_t count, const Is& is) {
        return std::ranges::any_of(tables.instructions.subspan(first, count), is);
    }
    template <class Is> static constexpr bool any_instruction(const ProgramRow& program, const Is& is) {
        for (std::size_t n = program.first; n < program.last && n < tables.nodes.size(); ++n) {
            const NodeRow& row = tables.nodes[n];
            if (any_instruction(row.first, row.count, is)) return true;
            for (std::size_t i = 0; i < row.arcs; ++i)
                if (const ConditionIndex c = tables.arcs[row.first_arc + i].condition; c != no_condition)
                    if (any_instruction(tables.conditions[c].first, tables.conditions[c].count, is))
                        return true;
        }
        return false;
    }
    static constexpr bool is_public(const Instruction& in) { return !Nodes::is_private(in); }
    static constexpr bool asks_position(const Instruction& in) { return in.run == &primitive::elapsed; }

    static constexpr std::uint32_t unbounded = 0xffffffff;
    struct Facts {
        bool is_private = false;              ///< calls nothing that could call back
        bool asks_for_position = false;       ///< reads the context's position
        std::uint32_t statements = unbounded; ///< upper bound
    };
    static constexpr auto facts = []() consteval {
        std::array<Facts, tables.programs.size() + 1> all{};
        for (std::size_t i = 0; i < tables.programs.size(); ++i) {
            const ProgramRow& row = tables.programs[i];
            all[i].is_private = !any_instruction(row, is_public);
            all[i].asks_for_position = any_instruction(row, asks_position);
            if (row.first == end_node)
                all[i].statements = 0;
            else if (is_whole(row))
                all[i].statements = row.last - row.first;
        }
        return all;
    }();

    /// Runs a program from its beginning until it ends or stops. The shortest are inlined where they are
    /// called.
    template <ProgramIndex number>
    [[gnu::always_inline]] static NextNode program(ProgramContext& context, ProgramRun& run) noexcept
        TAPPET_REALTIME {
        constexpr ProgramRow row = tables.programs[number];
        if constexpr (facts[number].asks_for_position) context.position.entered = false;
        if constexpr (row.first == end_node)
            return end_node;
        else if constexpr (!is_whole(row))
            return goes_on_at(context, run, row.first);
        else if constexpr (row.last <= row.first + 2u)
            return pass<row.first>(std::make_index_sequence<row.last - row.first>{}, context, run, row.first);
        else
            return piece<row.first, row.last>(context, run, row.first);
    }

    template <ConditionIndex first, ConditionIndex end>
    static ConditionResult tests(ProgramContext& context, ConditionIndex number) noexcept TAPPET_REALTIME {
        if constexpr (first + 1 == end) {
            alignas(data_alignment) std::byte scratch[Nodes::scratch_bytes];
            return Nodes::template condition<first>(context, context.data, scratch);
        } else {
            constexpr auto middle = static_cast<ConditionIndex>((first + end) / 2);
            return number < middle ? tests<first, middle>(context, number)
                                   : tests<middle, end>(context, number);
        }
    }

    static ProgramReturn run(const ProgramTables&, ProgramContext& context,
                             std::uint32_t& statements) noexcept TAPPET_REALTIME {
        ProgramRun run{context.data, statements, context.position.entered};
        const NextNode next = goes_on_at(context, run, context.position.node);
        statements = static_cast<std::uint32_t>(run.left);
        if (next >= halted) return returns_at(next, context, run.stands);
        context.position = {};
        return ProgramReturn::ended;
    }

    static ConditionResult test(const ProgramTables&, ProgramContext& context, ConditionIndex number) noexcept
        TAPPET_REALTIME {
        if constexpr (tables.conditions.empty())
            return ConditionResult::yes;
        else
            return number == no_condition
                       ? ConditionResult::yes
                       : tests<0, static_cast<ConditionIndex>(tables.conditions.size())>(context, number);
    }
};

} // namespace native

/// The parts of a table that native code still reads: everything but instructions and conditions.
constexpr ProgramTables without_code(ProgramTables tables) noexcept {
    tables.instructions = {};
    tables.conditions = {};
    return tables;
}

template <const auto& source, std::size_t type = 0>
inline constexpr ProgramTables native_tables = without_code(tables_of(source, type));

/// The programs of a constant table as native code. `source` is a variable at namespace scope: ProgramTables,
/// or a ScriptUnit with the number of a type. Real-time; same behaviour as the interpreter, step by step.
template <const auto& source, std::size_t type = 0>
inline constexpr ProgramCode native_code{&native_tables<source, type>, &native::Code<source, type>::run,
                                         &native::Code<source, type>::test, &program_wakes};

} // namespace tappet
