// Walks a program's tables; each branch of it is a line of the header's list.
#include "kernel/program/interpreter.hpp"

#include "kernel/program/value_access.hpp"

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

enum class Next : std::uint8_t { on, waits, failed };

/// Asks the node's arcs from number `first` on; `on`: the position is where the first open one leads. Before
/// the action is done those without a condition alone: the time-outs.
Next follow(const ProgramTables& tables, ProgramContext& context, const NodeRow& node,
            std::size_t first) noexcept TAPPET_REALTIME {
    const ArcRow* arc = tables.arcs.data() + node.first_arc + first;
    for (std::size_t i = first; i < node.arcs; ++i, ++arc) {
        if (!context.position.acted && (arc->condition != no_condition || arc->after == no_data)) continue;
        const ConditionResult open = is_open(tables, context, *arc);
        if (open == ConditionResult::no) continue;
        if (open == ConditionResult::failed || arc->to == no_node) return Next::failed;
        context.position = {.node = arc->to};
        return Next::on;
    }
    if (node.repeats) context.position.acted = false;
    return Next::waits;
}

/// No node: the program stays where it is.
constexpr NodeIndex stays = end_node - 1;

/// Where a node leads whose action was done just now: its arcs up to the first time-out. no_node: into error;
/// `stays`: so many were `asked` in vain.
[[gnu::always_inline]] inline NodeIndex leads_to(const ProgramTables& tables, ProgramContext& context,
                                                 const NodeRow& node, std::size_t& asked) noexcept
    TAPPET_REALTIME {
    if (node.yields) return stays;
    const ArcRow* arc = tables.arcs.data() + node.first_arc;
    for (; asked < node.arcs && arc->after == no_data; ++asked, ++arc) {
        if (arc->condition == no_condition) return arc->to;
        const ConditionRow& row = tables.conditions[arc->condition];
        if (execute(context, tables.instructions.data() + row.first, row.count) != ActionResult::done)
            [[unlikely]]
            return no_node;
        if (load_value<bool>(context.data + row.result)) return arc->to;
    }
    return stays;
}

/// What follows an action; `on`: the node's arcs are to be asked.
Next after_action(ProgramContext& context, const NodeRow& node, ActionResult result) noexcept
    TAPPET_REALTIME {
    ProgramPosition& position = context.position;
    if (!position.entered) position.entered = true, position.entered_at = context.now;
    if (result == ActionResult::failed) return Next::failed;
    if (result == ActionResult::again) return Next::on;
    position.acted = true;
    return node.yields ? Next::waits : Next::on;
}

} // namespace

ConditionResult test_condition(const ProgramTables& tables, ProgramContext& context,
                               ConditionIndex condition) noexcept TAPPET_REALTIME {
    if (condition == no_condition) return ConditionResult::yes;
    const ConditionRow& row = tables.conditions[condition];
    if (execute(context, tables.instructions.data() + row.first, row.count) != ActionResult::done)
        return ConditionResult::failed;
    return load_value<bool>(context.data + row.result) ? ConditionResult::yes : ConditionResult::no;
}

ProgramReturn run_program(const ProgramTables& tables, ProgramContext& context,
                          std::uint32_t& statements) noexcept TAPPET_REALTIME {
    const Instruction* const instructions = tables.instructions.data();
    const NodeRow* const nodes = tables.nodes.data();
    ProgramPosition& position = context.position;
    // In registers, since each statement waits for them; position.node holds where the program returns.
    NodeIndex at = position.node;
    std::uint32_t left = statements;
    bool acted = position.acted;
    const NodeRow* row = nodes;
    if (at != end_node) row += at;
    while (at != end_node) {
        const NodeRow& node = *row;
        Next next = Next::on;
        if (!acted) {
            if (left == 0) break;
            --left;
            const ActionResult result = execute(context, instructions + node.first, node.count);
            std::size_t asked = 0;
            NodeIndex to = stays;
            if (result == ActionResult::done) [[likely]]
                to = leads_to(tables, context, node, asked);
            // Most nodes lead on at once: nobody will ask when they were entered.
            if (to < stays || to == end_node) [[likely]] {
                position.entered = false;
                // Mostly to the next row: a branch is predicted, a number that was read is waited for.
                if (to == at + 1) [[likely]] {
                    ++at, ++row;
                    asm("" : "+r"(row)); // so that it stays a branch
                    continue;
                }
                at = to;
                if (at != end_node) row = nodes + at;
                continue;
            }
            position.node = at;
            next = after_action(context, node, result);
            if (to == no_node) next = Next::failed;
            if (next == Next::on) next = follow(tables, context, node, asked);
        } else {
            next = follow(tables, context, node, 0);
        }
        if (next == Next::failed && node.on_error != no_node) {
            position = {.node = node.on_error};
            next = Next::on;
        }
        if (next != Next::on) {
            statements = left;
            return next == Next::waits ? ProgramReturn::waits : ProgramReturn::failed;
        }
        at = position.node;
        if (at != end_node) row = nodes + at;
        acted = false;
    }
    statements = left;
    position.node = at;
    if (at != end_node) return ProgramReturn::left_over;
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
