// Programs whose tables lie in memory.
#include "kernel/program/interpreter.hpp"

#include "kernel/program/node.hpp"

namespace tappet {

namespace {

// Offsets that an instruction does not use point nowhere, and its primitive does not look.
[[gnu::always_inline]] inline ActionResult execute(ProgramContext& context, const Instruction* in,
                                                   std::size_t count) noexcept TAPPET_REALTIME {
    std::byte* const data = context.data;
    const Instruction* const end = in + count;
    while (in < end) {
        const ActionResult result = in->run(context, *in, data + in->to, data + in->a, data + in->b);
        if (result != ActionResult::done) [[unlikely]] {
            if (result != ActionResult::skip) return result;
            in += in->size;
        }
        ++in;
    }
    return ActionResult::done;
}
[[gnu::always_inline]] inline ConditionResult test(const ProgramTables& tables, ProgramContext& context,
                                                   ConditionIndex condition) noexcept TAPPET_REALTIME {
    if (condition == no_condition) return ConditionResult::yes;
    const ConditionRow& row = tables.conditions[condition];
    if (execute(context, tables.instructions.data() + row.first, row.count) != ActionResult::done)
        [[unlikely]]
        return ConditionResult::failed;
    return load_value<bool>(context.data + row.result) ? ConditionResult::yes : ConditionResult::no;
}

struct ArcInMemory {
    const ProgramTables& tables;
    const ArcRow& arc;

    [[nodiscard]] const ArcRow& row() const noexcept TAPPET_REALTIME { return arc; }
    [[nodiscard]] Duration after(const ProgramRun& run) const noexcept TAPPET_REALTIME {
        return load_value<Duration>(run.data + arc.after);
    }
    [[gnu::always_inline]] ConditionResult asks(ProgramContext& context, const ProgramRun&) const noexcept
        TAPPET_REALTIME {
        return test(tables, context, arc.condition);
    }
};
struct NodeInMemory {
    const ProgramTables& tables;
    const NodeRow* node;
    NodeIndex index;

    [[nodiscard]] const NodeRow& row() const noexcept TAPPET_REALTIME { return *node; }
    [[nodiscard]] NodeIndex number() const noexcept TAPPET_REALTIME { return index; }
    static constexpr bool may_stand() noexcept TAPPET_REALTIME { return true; }
    [[gnu::always_inline]] ActionResult acts(ProgramContext& context, const ProgramRun&) const noexcept
        TAPPET_REALTIME {
        return execute(context, tables.instructions.data() + node->first, node->count);
    }
    [[gnu::always_inline]] NextNode asks_arcs(bool has_acted, ProgramContext& context,
                                              ProgramRun& run) const noexcept TAPPET_REALTIME {
        NextNode next = leads_nowhere;
        const ArcRow* arc = tables.arcs.data() + node->first_arc;
        for (const ArcRow* const end = arc + node->arcs; arc != end && next == leads_nowhere; ++arc)
            next = node_order::follows(*this, ArcInMemory{tables, *arc}, has_acted, context, run);
        return next;
    }
};

} // namespace

ConditionResult test_condition(const ProgramTables& tables, ProgramContext& context,
                               ConditionIndex condition) noexcept TAPPET_REALTIME {
    return test(tables, context, condition);
}

ProgramReturn run_program(const ProgramTables& tables, ProgramContext& context,
                          std::uint32_t& statements) noexcept TAPPET_REALTIME {
    NodeIndex at = context.position.node;
    // Statements are counted in pieces of WorkLimit::statements, over all programs of a step.
    const auto next_piece = [&]() noexcept TAPPET_REALTIME -> std::int64_t {
        if (statements % WorkLimit::statements == 0 && context.limit->is_reached()) statements = 0;
        return statements == 0 ? 0 : (statements - 1) % WorkLimit::statements + 1;
    };
    const bool is_limited = context.limit != nullptr;
    std::int64_t piece = is_limited ? next_piece() : std::int64_t{statements};
    ProgramRun run{context.data, piece, context.position.entered};
    const auto account = [&]() noexcept
        TAPPET_REALTIME { statements -= static_cast<std::uint32_t>(piece - run.left); };
    const NodeRow* row = at == end_node ? nullptr : &tables.nodes[at];
    while (at != end_node) {
        const NextNode next = node_order::executes(NodeInMemory{tables, row, at}, context, run);
        // Mostly to the next row: a branch is predicted, a number that was read is waited for.
        if (next == at + 1u) [[likely]] {
            ++at, ++row;
            asm("" : "+r"(row)); // so that it stays a branch
            continue;
        }
        if (next >= halted) {
            account();
            const bool is_left_over = run.left == 0 && next == halts_at(at, ProgramReturn::left_over);
            if (!is_left_over || !is_limited || statements == 0) return returns_at(next, context, run);
            run.left = piece = next_piece();
            continue;
        }
        at = static_cast<NodeIndex>(next);
        row = tables.nodes.data() + at;
    }
    account();
    context.position = {};
    return ProgramReturn::ended;
}

Time program_wakes(const ProgramTables& tables, const ProgramContext& context) noexcept TAPPET_REALTIME {
    const ProgramPosition& position = context.position;
    if (position.node >= tables.nodes.size() || !position.entered) return never;
    const NodeRow& node = tables.nodes[position.node];
    Time earliest = never;
    for (const ArcRow& arc : tables.arcs.subspan(node.first_arc, node.arcs))
        if (arc.after != no_data)
            earliest = std::min(earliest, node_order::due(load_value<Duration>(context.data + arc.after),
                                                          position.entered_at));
    return earliest;
}

} // namespace tappet
