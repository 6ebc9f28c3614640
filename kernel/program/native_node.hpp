// Native code of one node of a constant table: each instruction is a constant, so its primitive is called
// directly and folds into its place.
#pragma once

#include "kernel/program/node.hpp"
#include "kernel/program/primitives_value.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace tappet {

/// Gives native code its table: a constant with static storage, and the number of a type in it. A variable
/// rather than a type, so that symbols contain its name and not its rows.
constexpr const ProgramTables& tables_of(const ProgramTables& tables, std::size_t) noexcept { return tables; }

namespace native {

template <const auto& source, std::size_t type> struct NodeCode {
    static constexpr const ProgramTables& tables = tables_of(source, type);
    static constexpr DataLayout layout = tables.layout;
    static constexpr std::size_t scratch_bytes = std::max<std::size_t>(
        data_alignment, layout.size > layout.arguments ? std::size_t{layout.size} - layout.arguments : 0u);

    // Reads constants at compile time; scratch is in the node's own frame.
    template <DataOffset at>
    [[gnu::always_inline]] static const std::byte* read(const std::byte* data,
                                                        const std::byte* scratch) noexcept TAPPET_REALTIME {
        if constexpr (at == no_data)
            return nullptr;
        else if constexpr (at < layout.constants)
            return tables.image.data() + at;
        else
            return at < layout.arguments ? data + at : scratch + (at - layout.arguments);
    }
    template <DataOffset at>
    [[gnu::always_inline]] static std::byte* write(std::byte* data, std::byte* scratch) noexcept
        TAPPET_REALTIME {
        static_assert(at >= layout.constants, "nothing is written over a constant");
        if constexpr (at == no_data)
            return nullptr;
        else
            return at < layout.arguments ? data + at : scratch + (at - layout.arguments);
    }

    // One by one: an array of all would stay in the program for the few primitives that are not inlined.
    template <std::size_t number> static constexpr Instruction instruction_of = tables.instructions[number];

    // `next` is the first instruction that is not skipped. Few functions: compile time depends mostly on
    // their number.
    template <std::size_t number, std::size_t i>
    [[gnu::always_inline]] static bool run_one(ProgramContext& context, std::byte* data, std::byte* scratch,
                                               std::size_t& next, ActionResult& result) noexcept
        TAPPET_REALTIME {
        if (next > i) return true;
        constexpr const Instruction& in = instruction_of<number>;
        constexpr Primitive primitive = in.run;
        result = primitive(context, in, write<in.to>(data, scratch), read<in.a>(data, scratch),
                           read<in.b>(data, scratch));
        if (result == ActionResult::done) return true;
        if (result != ActionResult::skip) return false;
        constexpr std::size_t after = i + 1 + in.size;
        next = after;
        result = ActionResult::done;
        return true;
    }
    template <std::size_t first, std::size_t... i>
    [[gnu::always_inline]] static ActionResult
    instructions(std::index_sequence<i...>, ProgramContext& context, [[maybe_unused]] std::byte* data,
                 [[maybe_unused]] std::byte* scratch) noexcept TAPPET_REALTIME {
        [[maybe_unused]] std::size_t next = 0;
        ActionResult result = ActionResult::done;
        static_cast<void>((run_one<first + i, i>(context, data, scratch, next, result) && ...));
        return result;
    }

    template <ConditionIndex number>
    [[gnu::always_inline]] static ConditionResult condition(ProgramContext& context, std::byte* data,
                                                            std::byte* scratch) noexcept TAPPET_REALTIME {
        if constexpr (number == no_condition) {
            return ConditionResult::yes;
        } else {
            constexpr ConditionRow row = tables.conditions[number];
            if (instructions<row.first>(std::make_index_sequence<row.count>{}, context, data, scratch) !=
                ActionResult::done) [[unlikely]]
                return ConditionResult::failed;
            return load_value<bool>(read<row.result>(data, scratch)) ? ConditionResult::yes
                                                                     : ConditionResult::no;
        }
    }

    // Returns whether it acts only on the program's own data, immediately.
    static constexpr bool is_private(const Instruction& in) {
        const bool is_silent =
            in.run == &primitive::skip_if || in.run == &primitive::skip_unless || in.run == &primitive::fail;
        return in.facet == nullptr && in.link == 0xffff && (in.to != no_data || is_silent);
    }
    // Returns whether a program may wait there, or read when the node was entered.
    static consteval bool stands(const NodeRow& row) {
        bool open = false, timed = false, waits = row.yields;
        for (std::size_t i = row.first_arc; i < std::size_t{row.first_arc} + row.arcs; ++i) {
            const ArcRow& arc = tables.arcs[i];
            open = open || (arc.condition == no_condition && arc.after == no_data);
            timed = timed || arc.after != no_data;
        }
        for (std::size_t i = row.first; i < std::size_t{row.first} + row.count; ++i)
            waits = waits || !is_private(tables.instructions[i]);
        return waits || timed || !open;
    }
    template <std::size_t index> struct Arc {
        std::byte* scratch;
        static constexpr ArcRow arc = tables.arcs[index];
        static constexpr const ArcRow& row() noexcept TAPPET_REALTIME { return arc; }
        [[gnu::always_inline]] Duration after(const ProgramRun& run) const noexcept TAPPET_REALTIME {
            static_assert(arc.after == no_data || arc.after < layout.arguments,
                          "a time-out outlives the step");
            if constexpr (arc.after == no_data)
                return {};
            else
                return load_value<Duration>(read<arc.after>(run.data, scratch));
        }
        [[gnu::always_inline]] ConditionResult evaluate(ProgramContext& context,
                                                        const ProgramRun& run) const noexcept
            TAPPET_REALTIME {
            return condition<arc.condition>(context, run.data, scratch);
        }
    };
    template <NodeIndex index> struct Node {
        std::byte* scratch;
        static constexpr NodeRow node = tables.nodes[index];
        static constexpr const NodeRow& row() noexcept TAPPET_REALTIME { return node; }
        static constexpr NodeIndex number() noexcept TAPPET_REALTIME { return index; }
        static constexpr bool stands_here = stands(node);
        static constexpr bool may_stand() noexcept TAPPET_REALTIME { return stands_here; }
        [[gnu::always_inline]] ActionResult act(ProgramContext& context, const ProgramRun& run) const noexcept
            TAPPET_REALTIME {
            return instructions<node.first>(std::make_index_sequence<node.count>{}, context, run.data,
                                            scratch);
        }
        template <std::size_t i = 0>
        [[gnu::always_inline]] NextNode asks_arcs([[maybe_unused]] bool has_acted,
                                                  [[maybe_unused]] ProgramContext& context,
                                                  [[maybe_unused]] ProgramRun& run) const noexcept
            TAPPET_REALTIME {
            if constexpr (i == node.arcs) {
                return leads_nowhere;
            } else {
                const NextNode next =
                    node_order::follows(*this, Arc<node.first_arc + i>{scratch}, has_acted, context, run);
                return next != leads_nowhere ? next : asks_arcs<i + 1>(has_acted, context, run);
            }
        }
    };
    template <NodeIndex number>
    [[gnu::always_inline]] static NextNode node(ProgramContext& context, ProgramRun& run) noexcept
        TAPPET_REALTIME {
        alignas(data_alignment) std::byte scratch[scratch_bytes];
        return node_order::execute(Node<number>{scratch}, context, run);
    }
};

} // namespace native

} // namespace tappet
