// Executes programs whose tables are in memory.
#include "kernel/program/interpreter.hpp"

#include "kernel/program/node.hpp"

namespace tappet {

namespace {

// Unused offsets of an instruction are invalid; its primitive does not use them.
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
    [[gnu::always_inline]] ConditionResult evaluate(ProgramContext& context, const ProgramRun&) const noexcept
        TAPPET_REALTIME {
        return test(tables, context, arc.condition);
    }
};
struct NodeInMemory {
    const ProgramTables& tables;
    const NodeRow* node;

    [[nodiscard]] const NodeRow& row() const noexcept TAPPET_REALTIME { return *node; }
    [[nodiscard]] NodeIndex number() const noexcept TAPPET_REALTIME {
        return static_cast<NodeIndex>(node - tables.nodes.data());
    }
    static constexpr bool may_stand() noexcept TAPPET_REALTIME { return true; }
    [[gnu::always_inline]] ActionResult act(ProgramContext& context, const ProgramRun&) const noexcept
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

/// The usual statement: it continues over one arc or one of two, and uses no time.
struct StatementInMemory : NodeInMemory {
    [[gnu::always_inline]] static bool is(const ProgramTables& tables, const NodeRow& node) noexcept
        TAPPET_REALTIME {
        const ArcRow* const arc = tables.arcs.data() + node.first_arc;
        const bool is_one = node.arcs == 1, is_two = node.arcs == 2;
        return (is_one || is_two) && !node.yields && arc->after == no_data &&
               (is_one || arc[1].after == no_data);
    }
    [[nodiscard]] NodeRow row() const noexcept TAPPET_REALTIME {
        NodeRow same = *node;
        same.yields = false;
        return same;
    }
    [[gnu::always_inline]] NextNode asks_arcs(bool has_acted, ProgramContext& context,
                                              ProgramRun& run) const noexcept TAPPET_REALTIME {
        const auto follows = [&] [[gnu::always_inline]] (std::size_t number) noexcept TAPPET_REALTIME {
            ArcRow arc = tables.arcs[node->first_arc + number];
            arc.after = no_data;
            return node_order::follows(*this, ArcInMemory{tables, arc}, has_acted, context, run);
        };
        const NextNode next = follows(0);
        return next != leads_nowhere || node->arcs == 1 ? next : follows(1);
    }
};
// A separate function: its variables would push those of the others out of the registers.
[[gnu::noinline]] NextNode executes_any(NodeInMemory node, ProgramContext& context, ProgramRun& run) noexcept
    TAPPET_REALTIME {
    return node_order::execute(node, context, run);
}

[[gnu::always_inline]] inline ProgramReturn run(const ProgramTables& tables, ProgramContext& context,
                                                std::uint32_t& statements) noexcept TAPPET_REALTIME {
    ProgramRun run{context.data, statements, context.position.entered};
    NextNode next = context.position.node;
    const NodeRow* row = next < end_node ? &tables.nodes[next] : nullptr;
    while (next < end_node) {
        const NodeInMemory node{tables, row};
        if (StatementInMemory::is(tables, *row)) [[likely]] {
            next = node_order::execute(StatementInMemory{node}, context, run);
        } else {
            // Member by member, so that `run` stays in registers.
            ProgramRun shared{run.data, run.left, run.stands};
            next = executes_any(node, context, shared);
            run.left = shared.left;
            run.stands = shared.stands;
        }
        // Usually the next row: a branch is predicted, but a loaded number must be waited for.
        if (next == node.number() + 1u) [[likely]] {
            ++row;
            asm("" : "+r"(row)); // so that it stays a branch
        } else if (next < end_node) {
            row = tables.nodes.data() + next;
        }
    }
    statements = static_cast<std::uint32_t>(run.left);
    if (next >= halted) return returns_at(next, context, run.stands);
    context.position = {};
    return ProgramReturn::ended;
}

} // namespace

ConditionResult test_condition(const ProgramTables& tables, ProgramContext& context,
                               ConditionIndex condition) noexcept TAPPET_REALTIME {
    return test(tables, context, condition);
}

ProgramReturn run_program(const ProgramTables& tables, ProgramContext& context,
                          std::uint32_t& statements) noexcept TAPPET_REALTIME {
    for (;;) {
        std::uint32_t piece = statements;
        if (context.limit != nullptr) { // in parts, across all programs of a step
            if (statements % WorkLimit::statements == 0 && context.limit->is_reached()) statements = 0;
            piece = statements == 0 ? 0 : (statements - 1) % WorkLimit::statements + 1;
            context.limit->has_begun = true;
        }
        std::uint32_t left = piece;
        const ProgramReturn why = run(tables, context, left);
        statements -= piece - left;
        if (why != ProgramReturn::left_over || statements == 0) return why;
    }
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
