// What executing a node of a program means (thesis 5.1.3), written once. `Node` says where its table lies: in
// memory, interpreter.cpp, where it is read; or in constants, native.hpp, which the compiler folds.
//
// clang-format off
//   action        its instructions in order, once. That is one statement.
//   again         an instruction could not act yet: the program waits, the next step executes the action once more;
//                 of the arcs only time-outs, those without a condition, are asked until then.
//   arcs          asked in their order after the action, and in each later step without it; the first open one is
//                 followed. An arc is open when its time has passed since the node was entered and its condition holds.
//   none open     the program waits.
//   yields        the program waits after the action although an arc is open.
//   failed        of an instruction or a condition, or the arc leads to no_node: on to the node of on_error, or the
//                 program has failed there.
//   left over     the statements are used up: the program stands before the next action.
// clang-format on
#pragma once

#include "kernel/program/code.hpp"
#include "kernel/program/value_access.hpp"

namespace tappet {

/// What a node answers: the node to go on with, or why not in the upper half. One number, so that a way out
/// of a node is one move and one jump.
using NextNode = std::uint32_t;
inline constexpr int halt_bit = 16;
inline constexpr NextNode halted = NextNode{1} << halt_bit;
static_assert(static_cast<int>(ProgramReturn::ended) == 0,
              "a program that ended leads to end_node, which does not halt");
inline constexpr NextNode leads_nowhere = 0xffffffff;
constexpr NextNode halts_at(NodeIndex node, ProgramReturn why) noexcept TAPPET_REALTIME {
    return static_cast<NextNode>(why) << halt_bit | node;
}

/// What a run of one program keeps in registers.
struct ProgramRun {
    std::byte* data = nullptr;
    std::int64_t left = 0; ///< statements that it may still execute
    /// The position says when the node was entered, and whether its action is done: it waits there. Nobody
    /// notes when a node is entered that leads on at once.
    bool stands = false;
    bool counted = true; ///< statements may not suffice
};

/// What the position is when the program returns there.
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

/// Where an arc leads; leads_nowhere: it is not open.
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

/// Executes a node, or goes on where the program waits at it. A node that may_stand() not leads on, or fails,
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
