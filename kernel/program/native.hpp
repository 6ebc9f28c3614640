// Native code made of a constant table: its nodes in pages, each page a switch. Only the table is gone.
#pragma once

#include "kernel/program/native_node.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

namespace tappet {

namespace native {

/// Nodes in one function at most. A program goes from page to page by its number; within one it falls or
/// jumps.
inline constexpr std::size_t page_nodes = 32;

template <const auto& source, std::size_t type> struct Code : NodeCode<source, type> {
    using Node = NodeCode<source, type>;
    static constexpr const ProgramTables& tables = Node::tables;

    // ---- pieces of code: a short program that only leads on, or a page of a longer one

    struct Piece {
        NodeIndex first = 0;
        NodeIndex end = 0;
    };
    // Where a piece begins: at the first node of each program, and wherever a page is full.
    static constexpr std::array<bool, tables.nodes.size() + 1> begins_piece = [] {
        std::array<bool, tables.nodes.size() + 1> begins{};
        begins[0] = true;
        for (const ProgramRow& program : tables.programs)
            if (program.first < tables.nodes.size()) begins[program.first] = true;
        for (std::size_t node = 0, first = 0; node < tables.nodes.size(); ++node) {
            begins[node] = begins[node] || node - first == page_nodes;
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
    // Its nodes lead on and never back: a node is asked for once.
    static constexpr bool is_straight(const Piece& piece) {
        constexpr std::size_t most = 8;
        if (piece.end > piece.first + most) return false;
        for (NodeIndex node = piece.first; node < piece.end; ++node) {
            const NodeRow& row = tables.nodes[node];
            if (row.on_error <= node && row.on_error >= piece.first) return false;
            for (std::size_t i = 0; i < row.arcs; ++i) {
                const NodeIndex to = tables.arcs[row.first_arc + i].to;
                if (to <= node && to >= piece.first) return false;
            }
        }
        return true;
    }
    static constexpr bool is_whole(const Piece& piece, const ProgramRow& program) {
        return piece.first == program.first && piece.end == program.last && is_straight(piece);
    }

    template <std::size_t number, std::size_t end>
    [[gnu::always_inline]] static void passes([[maybe_unused]] ProgramContext& context,
                                              [[maybe_unused]] Run& run, [[maybe_unused]] Next& next) noexcept
        TAPPET_REALTIME {
        if constexpr (number < end)
            if (next == number) next = Node::template node<static_cast<NodeIndex>(number)>(context, run);
    }
    template <std::size_t first, std::size_t end, std::size_t... i>
    [[gnu::always_inline]] static Next straight(std::index_sequence<i...>, ProgramContext& context, Run& run,
                                                Next next) noexcept TAPPET_REALTIME {
        (passes<first + i, end>(context, run, next), ...);
        return next;
    }

    // From the node `next` on until the program leaves the page. Each node asks whether it is meant, which
    // the compiler knows after the one before it.
    template <std::size_t first, std::size_t end>
    [[gnu::always_inline]] static Next page(ProgramContext& context, Run& run, Next next) noexcept
        TAPPET_REALTIME {
#define TAPPET_NODE(number)                                                                                  \
    [[fallthrough]];                                                                                         \
    case number: passes<first + number, end>(context, run, next)
#define TAPPET_FOUR_NODES(number)                                                                            \
    TAPPET_NODE(number);                                                                                     \
    TAPPET_NODE(number + 1);                                                                                 \
    TAPPET_NODE(number + 2);                                                                                 \
    TAPPET_NODE(number + 3)
        do {
            switch (next - first) {
            default:
                break;
                TAPPET_FOUR_NODES(0);
                TAPPET_FOUR_NODES(4);
                TAPPET_FOUR_NODES(8);
                TAPPET_FOUR_NODES(12);
                TAPPET_FOUR_NODES(16);
                TAPPET_FOUR_NODES(20);
                TAPPET_FOUR_NODES(24);
                TAPPET_FOUR_NODES(28);
            }
        } while (next >= first && next < end);
#undef TAPPET_FOUR_NODES
#undef TAPPET_NODE
        return next;
    }

    template <std::size_t first, std::size_t end>
    static Next piece(ProgramContext& context, Run& shared, Next next) noexcept TAPPET_REALTIME {
        Run run{shared.data, shared.statements, shared.fresh}; // in registers
        if constexpr (is_straight({first, end}))
            next = straight<first, end>(std::make_index_sequence<end - first>{}, context, run, next);
        else
            next = page<first, end>(context, run, next);
        shared.statements = run.statements;
        shared.fresh = run.fresh;
        return next;
    }

    // The piece of a node, by halving: no table of functions is left.
    template <std::size_t low, std::size_t high>
    [[gnu::always_inline]] static Next goes_to(ProgramContext& context, Run& run, Next next) noexcept
        TAPPET_REALTIME {
        if constexpr (high - low <= 1) {
            return piece<pieces[low].first, pieces[low].end>(context, run, next);
        } else {
            constexpr std::size_t middle = (low + high) / 2;
            return next < pieces[middle].first ? goes_to<low, middle>(context, run, next)
                                               : goes_to<middle, high>(context, run, next);
        }
    }
    static Next goes_on_at(ProgramContext& context, Run& run, Next next) noexcept TAPPET_REALTIME {
        if constexpr (piece_count != 0)
            while (next < tables.nodes.size()) next = goes_to<0, piece_count>(context, run, next);
        return next;
    }

    // ---- what is known of a program or a condition before it runs

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
    static constexpr bool is_public(const Instruction& in) { return !Node::is_private(in); }
    static constexpr bool asks_position(const Instruction& in) { return in.run == &primitive::elapsed; }

    static constexpr std::uint32_t unbounded = 0xffffffff;
    struct Facts {
        bool is_private = false;              ///< nobody is called who could call back
        bool asks_for_position = false;       ///< the context's
        std::uint32_t statements = unbounded; ///< at most so many
    };
    static constexpr auto facts = [] {
        std::array<Facts, tables.programs.size() + 1> all{};
        for (std::size_t i = 0; i < tables.programs.size(); ++i) {
            const ProgramRow& row = tables.programs[i];
            all[i].is_private = !any_instruction(row, is_public);
            all[i].asks_for_position = row.may_wait || any_instruction(row, asks_position);
            if (row.first == end_node)
                all[i].statements = 0;
            else if (is_whole({row.first, row.last}, row))
                all[i].statements = row.last - row.first;
        }
        return all;
    }();
    static constexpr bool is_private_condition(ConditionIndex number) {
        return number == no_condition ||
               !any_instruction(tables.conditions[number].first, tables.conditions[number].count, is_public);
    }

    /// A program from its beginning, until it ends or halts. The shortest stand where they are called.
    template <ProgramIndex number>
    [[gnu::always_inline]] static Next program(ProgramContext& context, Run& run) noexcept TAPPET_REALTIME {
        constexpr ProgramRow row = tables.programs[number];
        run.fresh = true;
        if constexpr (facts[number].asks_for_position)
            context.position.acted = context.position.entered = false;
        if constexpr (row.first == end_node) {
            return end_node;
        } else if constexpr (!is_whole({row.first, row.last}, row)) {
            return goes_on_at(context, run, row.first);
        } else if constexpr (row.last <= row.first + 2u) {
            return straight<row.first, row.last>(std::make_index_sequence<row.last - row.first>{}, context,
                                                 run, row.first);
        } else {
            return piece<row.first, row.last>(context, run, row.first);
        }
    }

    template <ConditionIndex first, ConditionIndex end>
    static ConditionResult tests(ProgramContext& context, ConditionIndex number) noexcept TAPPET_REALTIME {
        if constexpr (first + 1 == end) {
            alignas(data_alignment) std::byte scratch[Node::scratch_bytes];
            return Node::template condition<first>(context, context.data, scratch);
        } else {
            constexpr auto middle = static_cast<ConditionIndex>((first + end) / 2);
            return number < middle ? tests<first, middle>(context, number)
                                   : tests<middle, end>(context, number);
        }
    }

    // The earliest time-out among the arcs of the node at which the program waits.
    template <std::size_t arc>
    [[gnu::always_inline]] static void due(const ProgramContext& context, Time& earliest) noexcept
        TAPPET_REALTIME {
        constexpr ArcRow row = tables.arcs[arc];
        if constexpr (row.after != no_data) {
            Duration after{};
            std::memcpy(&after, Node::template read<row.after>(context.data, nullptr), sizeof after);
            const Time entered = context.position.entered_at;
            const Time at = after >= never - entered ? never : entered + after;
            if (at < earliest) earliest = at;
        }
    }

    static constexpr std::size_t timed_nodes =
        static_cast<std::size_t>(std::ranges::count_if(tables.nodes, Node::is_timed));
    static constexpr auto timed = [] {
        std::array<NodeIndex, timed_nodes> numbers{};
        for (std::size_t node = 0, used = 0; node < tables.nodes.size(); ++node)
            if (Node::is_timed(tables.nodes[node])) numbers[used++] = static_cast<NodeIndex>(node);
        return numbers;
    }();
    template <std::size_t first, std::size_t... i>
    [[gnu::always_inline]] static Time earliest(std::index_sequence<i...>,
                                                const ProgramContext& context) noexcept TAPPET_REALTIME {
        Time at = never;
        (due<first + i>(context, at), ...);
        return at;
    }
    template <std::size_t i>
    [[gnu::always_inline]] static bool wakes_at(const ProgramContext& context, Time& at) noexcept
        TAPPET_REALTIME {
        if (context.position.node != timed[i]) return false;
        constexpr NodeRow row = tables.nodes[timed[i]];
        at = earliest<row.first_arc>(std::make_index_sequence<row.arcs>{}, context);
        return true;
    }
    template <std::size_t... i>
    [[gnu::always_inline]] static Time wakes_at(std::index_sequence<i...>,
                                                const ProgramContext& context) noexcept TAPPET_REALTIME {
        Time at = never;
        static_cast<void>((wakes_at<i>(context, at) || ...));
        return at;
    }

    static Time wakes(const ProgramTables&, const ProgramContext& context) noexcept TAPPET_REALTIME {
        return context.position.entered ? wakes_at(std::make_index_sequence<timed_nodes>{}, context) : never;
    }

    static ProgramReturn run(const ProgramTables&, ProgramContext& context,
                             std::uint32_t& statements) noexcept TAPPET_REALTIME {
        Run run{context.data, statements, !context.position.entered};
        Next next = context.position.node;
        next = goes_on_at(context, run, next);
        ProgramReturn answer = ProgramReturn::ended;
        if (next >= halted)
            answer = Node::halts(context, run, next);
        else
            context.position = {};
        statements = static_cast<std::uint32_t>(run.statements);
        return answer;
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

/// What of a table its native code leaves to be read: everything but instructions and conditions.
constexpr ProgramTables without_code(ProgramTables tables) noexcept {
    tables.instructions = {};
    tables.conditions = {};
    return tables;
}

template <const auto& source, std::size_t type = 0>
inline constexpr ProgramTables native_tables = without_code(tables_of(source, type));

/// The programs of a constant table as native code. `source` is a variable at namespace scope: ProgramTables,
/// or a ScriptUnit with the number of a type. Real-time; equal, step for step, to the interpreter.
template <const auto& source, std::size_t type = 0>
inline constexpr ProgramCode native_code{&native_tables<source, type>, &native::Code<source, type>::run,
                                         &native::Code<source, type>::test,
                                         &native::Code<source, type>::wakes};

} // namespace tappet
