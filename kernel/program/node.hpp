// The execution of a program's node (thesis 5.1.3), written once. `Node` gives access to its table: in memory
// (interpreter.cpp), where it is read; or in constants (native.hpp), which the compiler folds.
//
// clang-format off
//   action        executes its instructions in order, once. That is one statement.
//   again         an instruction could not act yet: the program waits, the next step executes it again;
//                 until then, only time-outs (arcs without a condition) are evaluated.
//   arcs          are evaluated in order after the action, and in each later step without it; the first open
//                 one is followed. An arc is open when its time since node entry has passed and its condition
//                 holds.
//   none open     the program waits.
//   yields        the program waits after the action although an arc is open.
//   failed        an instruction or a condition failed, or the arc leads to no_node: the program continues at
//                 the node of on_error; without one, it has failed there.
//   left over     the statements are used up: the program stops before the next action.
// clang-format on
#pragma once

#include "kernel/program/code.hpp"
#include "kernel/program/value_access.hpp"

namespace tappet {

/// Result of a node: the next node, or the reason to stop in the upper half. One number, so that leaving a
/// node takes one move and one jump.
using NextNode = std::uint32_t;
inline constexpr int halt_bit = 16;
inline constexpr NextNode halted = NextNode{1} << halt_bit;
static_assert(static_cast<int>(ProgramReturn::ended) == 0,
              "a program that ended leads to end_node, which does not halt");
inline constexpr NextNode leads_nowhere = 0xffffffff;
constexpr NextNode halts_at(NodeIndex node, ProgramReturn why) noexcept TAPPET_REALTIME {
    return static_cast<NextNode>(why) << halt_bit | node;
}

/// Values that a run of one program keeps in registers.
struct ProgramRun {
    std::byte* data = nullptr;
    std::int64_t left = 0; ///< statements that it may still execute
    /// The program waits here: the position holds when the node was entered and whether its action is done.
    /// The entry time is not stored for a node that continues at once.
    bool stands = false;
    bool counted = true; ///< statements may run out
};

/// Stores the position of a program that returns at `next`.
inline ProgramReturn returns_at(NextNode next, ProgramContext& context, bool stands) noexcept
    TAPPET_REALTIME {
    ProgramPosition& position = context.position;
    position.node = static_cast<NodeIndex>(next);
    if (!stands) position.acted = position.entered = false;
    return static_cast<ProgramReturn>(next >> halt_bit);
}

namespace node_order {

[[gnu::always_inline]] inline void stands_here(ProgramContext& context, ProgramRun& run) noexcept
    TAPPET_REALTIME {
    if (!run.stands) context.position.entered_at = context.now;
    context.position.entered = run.stands = true;
}
template <class Node>
[[gnu::always_inline]] inline NextNode leads_to(Node node, NodeIndex to, ProgramContext& context,
                                                ProgramRun& run) noexcept TAPPET_REALTIME {
    if (node.may_stand() && run.stands)
        context.position.acted = context.position.entered = run.stands = false;
    return to;
}
template <class Node>
[[gnu::always_inline]] inline NextNode fails(Node node, ProgramContext& context, ProgramRun& run) noexcept
    TAPPET_REALTIME {
    const NodeIndex on_error = node.row().on_error;
    return on_error == no_node ? halts_at(node.number(), ProgramReturn::failed)
                               : leads_to(node, on_error, context, run);
}
[[gnu::always_inline]] inline NextNode waits(NodeIndex at, bool has_acted, ProgramContext& context,
                                             ProgramRun& run) noexcept TAPPET_REALTIME {
    stands_here(context, run);
    context.position.acted = has_acted;
    return halts_at(at, ProgramReturn::waits);
}
inline Time due(Duration after, Time entered) noexcept TAPPET_REALTIME {
    return after >= never - entered ? never : entered + after;
}

/// Returns the target of an arc; leads_nowhere: it is not open.
template <class Node, class Arc>
[[gnu::always_inline]] inline NextNode follows(Node node, Arc arc, bool has_acted, ProgramContext& context,
                                               ProgramRun& run) noexcept TAPPET_REALTIME {
    const ArcRow& row = arc.row();
    if (!has_acted && (row.condition != no_condition || row.after == no_data)) return leads_nowhere;
    if (row.after != no_data) {
        stands_here(context, run);
        if (context.now < due(arc.after(run), context.position.entered_at)) return leads_nowhere;
    }
    const ConditionResult result = arc.evaluate(context, run);
    if (result == ConditionResult::no) return leads_nowhere;
    const bool leads = result == ConditionResult::yes && row.to != no_node;
    return leads ? leads_to(node, row.to, context, run) : fails(node, context, run);
}

/// Executes a node, or resumes it when the program waits there. A node without may_stand() continues or fails
/// at once.
template <class Node>
[[gnu::always_inline]] inline NextNode execute(Node node, ProgramContext& context, ProgramRun& run) noexcept
    TAPPET_REALTIME {
    const NodeRow& row = node.row();
    bool has_acted = true;
    if (!node.may_stand() || !run.stands || !context.position.acted) {
        if (--run.left < 0 && run.counted) [[unlikely]] {
            run.left = 0;
            return halts_at(node.number(), ProgramReturn::left_over);
        }
        const ActionResult result = node.act(context, run);
        if (result == ActionResult::failed) [[unlikely]]
            return fails(node, context, run);
        has_acted = result == ActionResult::done;
        if (row.yields && has_acted) return waits(node.number(), true, context, run);
    }
    const NextNode next = node.asks_arcs(has_acted, context, run);
    if (next != leads_nowhere) [[likely]]
        return next;
    return waits(node.number(), has_acted, context, run);
}

} // namespace node_order

} // namespace tappet
