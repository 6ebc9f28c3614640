// Native code of one node of a constant table: each instruction is a constant, so its primitive is called
// directly and folds into its place. What is executed is what the interpreter executes.
#pragma once

#include "kernel/program/code.hpp"
#include "kernel/program/primitives_value.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace tappet {

/// Where native code finds its table: a constant with static storage, and the number of a type in it. A
/// variable rather than a type, so that symbols carry its name and nothing of its rows.
constexpr const ProgramTables& tables_of(const ProgramTables& tables, std::size_t) noexcept { return tables; }

namespace native {

/// Why a node does not lead on: a ProgramReturn, or its action was not done yet.
enum class Halt : std::uint8_t { ended, waits, left_over, failed, again };
static_assert(static_cast<int>(Halt::failed) == static_cast<int>(ProgramReturn::failed));

/// What a node answers: the node to go on with, or why not in the upper half. One number, so that a way out
/// of a node is one move and one jump.
using Next = std::uint32_t;
inline constexpr int halt_bit = 16;
inline constexpr Next halted = Next{1} << halt_bit;
constexpr Next halts_at(NodeIndex node, Halt why) noexcept TAPPET_REALTIME {
    return static_cast<Next>(why) << halt_bit | node;
}

/// What a run of one program keeps in registers.
struct Run {
    std::byte* data;
    std::int64_t statements; ///< that it may still execute; below 0: it may not
    bool fresh;              ///< the node was entered in this run, not in an earlier one
    bool counted = true;     ///< statements may not suffice
};

template <const auto& source, std::size_t type> struct NodeCode {
    static constexpr const ProgramTables& tables = tables_of(source, type);
    static constexpr DataLayout layout = tables.layout;
    static constexpr std::size_t scratch_bytes = std::max<std::size_t>(
        data_alignment, layout.size > layout.arguments ? std::size_t{layout.size} - layout.arguments : 0u);

    // Constants are read where the compiler knows them, scratch lies in the node's own frame.
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

    // `next` is the first instruction that is not left out. Few functions: a compiler spends most of its time
    // on their number.
    template <std::size_t number, std::size_t i>
    [[gnu::always_inline]] static bool goes_on(ProgramContext& context, std::byte* data, std::byte* scratch,
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
        static_cast<void>((goes_on<first + i, i>(context, data, scratch, next, result) && ...));
        return result;
    }

    template <ConditionIndex number>
    [[gnu::always_inline]] static ConditionResult condition(ProgramContext& context, std::byte* data,
                                                            std::byte* scratch) noexcept TAPPET_REALTIME {
        constexpr ConditionRow row = tables.conditions[number];
        if (instructions<row.first>(std::make_index_sequence<row.count>{}, context, data, scratch) !=
            ActionResult::done) [[unlikely]]
            return ConditionResult::failed;
        return *read<row.result>(data, scratch) != std::byte{0} ? ConditionResult::yes : ConditionResult::no;
    }

    static constexpr bool is_open(const ArcRow& arc) {
        return arc.condition == no_condition && arc.after == no_data;
    }
    static constexpr bool is_timed(const NodeRow& row) {
        for (std::size_t i = 0; i < row.arcs; ++i)
            if (tables.arcs[row.first_arc + i].after != no_data) return true;
        return false;
    }
    // It may be that no arc is open, or that they are asked in a later step than the action was done; or the
    // time at which it was entered matters.
    static constexpr bool stands(const NodeRow& row) {
        bool open = false;
        for (std::size_t i = 0; i < row.arcs; ++i) open = open || is_open(tables.arcs[row.first_arc + i]);
        return !open || row.repeats || row.yields || is_timed(row);
    }

    // It acts on nothing but the program's own data, at once.
    static constexpr bool is_private(const Instruction& in) {
        const bool is_silent =
            in.run == &primitive::skip_if || in.run == &primitive::skip_unless || in.run == &primitive::fail;
        return in.facet == nullptr && in.link == 0xffff && (in.to != no_data || is_silent);
    }
    // A later step goes on after its entry: of a node that does not stand, because it could not act yet.
    static constexpr bool is_resumed(NodeIndex node) {
        for (const ProgramRow& program : tables.programs)
            if (node >= program.first && node < program.last && !program.may_wait) return false;
        const NodeRow& row = tables.nodes[node];
        return stands(row) || !std::ranges::all_of(tables.instructions.subspan(row.first, row.count),
                                                   [](const Instruction& in) { return is_private(in); });
    }
    template <bool has_stood, bool is_resumed>
    [[gnu::always_inline]] static void leaves_node(ProgramContext& context, Run& run) noexcept
        TAPPET_REALTIME {
        if constexpr (has_stood)
            context.position.acted = context.position.entered = false;
        else if constexpr (is_resumed)
            if (!run.fresh) context.position.entered = false;
        if constexpr (is_resumed) run.fresh = true;
    }
    template <bool has_stood, bool is_resumed>
    [[gnu::always_inline]] static Next failed(ProgramContext& context, Run& run, NodeIndex number,
                                              NodeIndex on_error) noexcept TAPPET_REALTIME {
        if (on_error == no_node) return halts_at(number, Halt::failed);
        leaves_node<has_stood, is_resumed>(context, run);
        return on_error;
    }

    // Answers whether the arc was taken or the program failed; then `next` is set.
    template <NodeIndex number, std::size_t arc>
    [[gnu::always_inline]] static bool takes(ProgramContext& context, Run& run, std::byte* scratch,
                                             Next& next) noexcept TAPPET_REALTIME {
        constexpr ArcRow row = tables.arcs[arc];
        constexpr NodeRow from = tables.nodes[number];
        constexpr bool has_stood = stands(from), is_left = is_resumed(number);
        if constexpr (row.after != no_data) {
            static_assert(row.after < layout.arguments, "a time-out outlives the step");
            Duration after{};
            std::memcpy(&after, read<row.after>(run.data, scratch), sizeof after);
            if (context.now - context.position.entered_at < after) return false;
        }
        if constexpr (row.condition != no_condition) {
            const ConditionResult result = condition<row.condition>(context, run.data, scratch);
            if (result == ConditionResult::no) return false;
            if (result == ConditionResult::failed) [[unlikely]] {
                next = failed<has_stood, is_left>(context, run, number, from.on_error);
                return true;
            }
        }
        if constexpr (row.to == no_node) {
            next = failed<has_stood, is_left>(context, run, number, from.on_error);
        } else {
            leaves_node<has_stood, is_left>(context, run);
            next = row.to;
        }
        return true;
    }
    // While the action could not act yet.
    template <NodeIndex number, std::size_t arc>
    [[gnu::always_inline]] static bool times_out(ProgramContext& context, Run& run, std::byte* scratch,
                                                 Next& next) noexcept TAPPET_REALTIME {
        if constexpr (tables.arcs[arc].condition == no_condition && tables.arcs[arc].after != no_data)
            return takes<number, arc>(context, run, scratch, next);
        else
            return false;
    }
    template <NodeIndex number, std::size_t first, std::size_t... i>
    [[gnu::always_inline]] static bool time_outs(std::index_sequence<i...>, ProgramContext& context, Run& run,
                                                 std::byte* scratch, Next& next) noexcept TAPPET_REALTIME {
        return (times_out<number, first + i>(context, run, scratch, next) || ...);
    }
    template <NodeIndex number, std::size_t first, std::size_t... i>
    [[gnu::always_inline]] static bool arcs(std::index_sequence<i...>, ProgramContext& context, Run& run,
                                            std::byte* scratch, Next& next) noexcept TAPPET_REALTIME {
        return (takes<number, first + i>(context, run, scratch, next) || ...);
    }

    template <NodeIndex number>
    [[gnu::always_inline]] static Next node(ProgramContext& context, Run& run) noexcept TAPPET_REALTIME {
        constexpr NodeRow row = tables.nodes[number];
        constexpr bool has_stood = stands(row);
        alignas(data_alignment) std::byte scratch[scratch_bytes];
        if (!has_stood || !context.position.acted) {
            if (--run.statements < 0 && run.counted) [[unlikely]]
                return halts_at(number, Halt::left_over);
            if constexpr (has_stood) {
                if (run.fresh) context.position.entered_at = context.now;
                context.position.entered = true;
                run.fresh = false;
            }
            const ActionResult result =
                instructions<row.first>(std::make_index_sequence<row.count>{}, context, run.data, scratch);
            if (result == ActionResult::failed) [[unlikely]]
                return failed<has_stood, is_resumed(number)>(context, run, number, row.on_error);
            if (result != ActionResult::done) [[unlikely]] {
                Next next = end_node;
                if constexpr (is_timed(row))
                    if (time_outs<number, row.first_arc>(std::make_index_sequence<row.arcs>{}, context, run,
                                                         scratch, next))
                        return next;
                return halts_at(number, Halt::again);
            }
            if constexpr (has_stood) context.position.acted = true;
            if constexpr (row.yields) return halts_at(number, Halt::waits);
        }
        Next next = end_node;
        if (arcs<number, row.first_arc>(std::make_index_sequence<row.arcs>{}, context, run, scratch, next))
            return next;
        if constexpr (row.repeats) context.position.acted = false;
        return halts_at(number, Halt::waits);
    }

    // What the position is when the program returns without having ended.
    [[gnu::always_inline]] static ProgramReturn halts(ProgramContext& context, Run& run, Next next) noexcept
        TAPPET_REALTIME {
        const auto why = static_cast<Halt>(next >> halt_bit);
        ProgramPosition& position = context.position;
        position.node = static_cast<NodeIndex>(next);
        if (why == Halt::again) {
            if (run.fresh) position.entered_at = context.now;
            position.entered = true;
            position.acted = false;
            return ProgramReturn::waits;
        }
        if (why == Halt::left_over) {
            run.statements = 0;
            if (run.fresh) position.acted = position.entered = false;
        }
        return static_cast<ProgramReturn>(why);
    }
};

} // namespace native

} // namespace tappet
