// Walks a program's tables; each branch of it is a line of the header's list.
#include "kernel/program/interpreter.hpp"

#include "kernel/program/value_access.hpp"

namespace tappet {

namespace {

// Offsets that an instruction does not use point nowhere, and its primitive does not look.
ActionResult execute(const ProgramTables& tables, ProgramContext& context, std::size_t first,
                     std::size_t count) noexcept TAPPET_REALTIME {
    const Instruction* in = tables.instructions.data() + first;
    const Instruction* const end = in + count;
    std::byte* const data = context.data;
    while (in < end) {
        const ActionResult result = in->run(context, *in, data + in->to, data + in->a, data + in->b);
        if (result == ActionResult::skip)
            in += in->size;
        else if (result != ActionResult::done)
            return result;
        ++in;
    }
    return ActionResult::done;
}

/// Of a node that has been entered.
Time due(const ProgramContext& context, const ArcRow& arc) noexcept TAPPET_REALTIME {
    const Duration after = load_value<Duration>(context.data + arc.after);
    const Time entered = context.position.entered_at;
    return after >= never - entered ? never : entered + after;
}

ConditionResult is_open(const ProgramTables& tables, ProgramContext& context, const ArcRow& arc) noexcept
    TAPPET_REALTIME {
    if (arc.after != no_data && context.now < due(context, arc)) return ConditionResult::no;
    return arc.condition == no_condition ? ConditionResult::yes
                                         : test_condition(tables, context, arc.condition);
}

enum class Way : std::uint8_t { on, waits, failed };

/// Asks the node's arcs; `on`: the position is where the first open one leads. Before the action is done
/// those without a condition alone: the time-outs.
Way follow(const ProgramTables& tables, ProgramContext& context, const NodeRow& node) noexcept
    TAPPET_REALTIME {
    const ArcRow* arc = tables.arcs.data() + node.first_arc;
    for (const ArcRow* const end = arc + node.arcs; arc != end; ++arc) {
        if (!context.position.acted && (arc->condition != no_condition || arc->after == no_data)) continue;
        const ConditionResult open = is_open(tables, context, *arc);
        if (open == ConditionResult::no) continue;
        if (open == ConditionResult::failed || arc->to == no_node) return Way::failed;
        context.position = {.node = arc->to};
        return Way::on;
    }
    if (node.repeats) context.position.acted = false;
    return Way::waits;
}

/// Executes the node's action; `on`: its arcs are to be asked.
Way act(const ProgramTables& tables, ProgramContext& context, const NodeRow& node) noexcept TAPPET_REALTIME {
    ProgramPosition& position = context.position;
    if (!position.entered) position.entered = true, position.entered_at = context.now;
    const ActionResult result = execute(tables, context, node.first, node.count);
    if (result == ActionResult::failed) return Way::failed;
    if (result == ActionResult::again) return Way::on;
    position.acted = true;
    return node.yields ? Way::waits : Way::on;
}

} // namespace

ConditionResult test_condition(const ProgramTables& tables, ProgramContext& context,
                               ConditionIndex condition) noexcept TAPPET_REALTIME {
    if (condition == no_condition) return ConditionResult::yes;
    const ConditionRow& row = tables.conditions[condition];
    if (execute(tables, context, row.first, row.count) != ActionResult::done) return ConditionResult::failed;
    return load_value<bool>(context.data + row.result) ? ConditionResult::yes : ConditionResult::no;
}

ProgramReturn run_program(const ProgramTables& tables, ProgramContext& context,
                          std::uint32_t& statements) noexcept TAPPET_REALTIME {
    ProgramPosition& position = context.position;
    while (position.node != end_node) {
        const NodeRow& node = tables.nodes[position.node];
        Way way = Way::on;
        if (!position.acted) {
            if (statements == 0) return ProgramReturn::left_over;
            --statements;
            way = act(tables, context, node);
        }
        if (way == Way::on) way = follow(tables, context, node);
        if (way == Way::waits) return ProgramReturn::waits;
        if (way == Way::failed) {
            if (node.on_error == no_node) return ProgramReturn::failed;
            position = {.node = node.on_error};
        }
    }
    position = {};
    return ProgramReturn::ended;
}

Time program_wakes(const ProgramTables& tables, const ProgramContext& context) noexcept TAPPET_REALTIME {
    const ProgramPosition& position = context.position;
    if (position.node >= tables.nodes.size() || !position.entered) return never;
    const NodeRow& node = tables.nodes[position.node];
    Time earliest = never;
    for (std::size_t i = 0; i < node.arcs; ++i) {
        const ArcRow& arc = tables.arcs[node.first_arc + i];
        if (arc.after == no_data) continue;
        const Time at = due(context, arc);
        if (at < earliest) earliest = at;
    }
    return earliest;
}

} // namespace tappet
