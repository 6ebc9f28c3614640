// Nodes and arcs while they are made: where the arcs that still hang go, and whether a loop may run without
// waiting.
#pragma once

#include "kernel/script/compiler_calls.hpp"
#include "kernel/script/compiler_parts.hpp"

namespace tappet::script_detail {

/// Arcs that wait for their target, each naming the one before it in its `to`; none: empty.
using Chain = std::uint16_t;
inline constexpr Chain no_chain = 0xffff;
/// In place of a target: the catch of the innermost try, which is not there yet.
inline constexpr NodeIndex to_catch = 0xfffd;
inline constexpr std::size_t max_script_nodes = 16384; ///< of one type
/// A program that never waits executes at most so many statements, loops counted.
inline constexpr std::uint64_t max_atomic_statements = 1000;

class NodeSet {
public:
    constexpr void put(std::size_t i, bool value) noexcept {
        const std::uint64_t bit = std::uint64_t{1} << (i % 64);
        words_[i / 64] = value ? words_[i / 64] | bit : words_[i / 64] & ~bit;
    }
    [[nodiscard]] constexpr bool has(std::size_t i) const noexcept {
        return (words_[i / 64] >> (i % 64) & 1) != 0;
    }

private:
    std::array<std::uint64_t, max_script_nodes / 64> words_{};
};

class Flow : protected Expressions {
protected:
    using Expressions::Expressions;

    /// Before a node's instructions.
    constexpr void begin_action() noexcept {
        region_used_[static_cast<std::size_t>(Region::scratch)] = 0;
        first_instruction_ = instruction_count();
    }
    /// After them: the node; all arcs that hang lead to it.
    constexpr NodeIndex end_action(const Token& at) {
        if (nodes_.count() == max_script_nodes) fail_limit("nodes");
        const NodeIndex node =
            add(nodes_,
                NodeRow{.first = first_instruction_,
                        .count = static_cast<std::uint16_t>(instruction_count() - first_instruction_),
                        .first_arc = static_cast<std::uint16_t>(arcs_.count()),
                        .on_error = in_try_ ? to_catch : no_node,
                        .line = at.line,
                        .column = at.column},
                "nodes");
        if (!ok()) return 0;
        waits_.put(node, false);
        lead(pending_, node);
        ++cost_;
        return node;
    }
    /// A way out of the node made last; it hangs on what is returned.
    constexpr Chain add_arc(NodeIndex node, ConditionIndex condition = no_condition,
                            DataOffset after = no_data) {
        if (!ok()) return no_chain;
        const Chain arc = add(arcs_, ArcRow{condition, no_chain, after}, "arcs");
        if (ok()) ++nodes_[node].arcs;
        return ok() ? arc : no_chain;
    }
    constexpr void lead(Chain& chain, NodeIndex to) {
        while (ok() && chain != no_chain) {
            ArcRow& arc = arcs_[chain];
            chain = arc.to;
            arc.to = to;
        }
        chain = no_chain;
    }
    constexpr void join(Chain& chain, Chain other) {
        if (!ok() || other == no_chain) return;
        if (chain == no_chain) {
            chain = other;
            return;
        }
        Chain last = other;
        while (arcs_[last].to != no_chain) last = arcs_[last].to;
        arcs_[last].to = chain;
        chain = other;
    }
    /// A node without anything but a way on.
    constexpr Chain pass(const Token& at) {
        begin_action();
        return add_arc(end_action(at));
    }
    /// The condition whose instructions begin at `first`.
    constexpr ConditionIndex make_condition(const Token& at, std::uint16_t first, const Operand& value) {
        if (!ok() || (value.literal && value.integer != 0)) return no_condition;
        const Operand ready = as(at, value, script_bool, " as a condition");
        return add(conditions_,
                   ConditionRow{first, static_cast<std::uint16_t>(instruction_count() - first), ready.at},
                   "conditions");
    }

    /// Whether one can come from `head` back to it without waiting. Nodes are in the order of the text, so
    /// the only arcs that lead back are those of loops, and inner loops were looked at before.
    constexpr bool is_free_loop(NodeIndex head) {
        for (std::size_t n = head; n < nodes_.count(); ++n) reached_.put(n, n == head);
        for (std::size_t n = head; ok() && n < nodes_.count(); ++n) {
            if (!reached_.has(n) || waits_.has(n)) continue;
            const NodeRow& node = nodes_[n];
            for (std::size_t a = 0; a <= node.arcs; ++a) {
                const NodeIndex to = a < node.arcs ? arcs_[node.first_arc + a].to : node.on_error;
                if (to == head) return true;
                if (to > n && to < nodes_.count()) reached_.put(to, true);
            }
        }
        return false;
    }
    /// After a loop. `rounds`: how often it runs at most; 0: nobody knows.
    constexpr void check_loop(const Token& at, NodeIndex head, std::uint64_t cost_before,
                              std::uint64_t rounds) {
        if (!ok() || !is_free_loop(head)) return;
        if (rounds == 0) {
            if (reach_.statements_per_step == 0)
                return fail(at, {"this loop can run without waiting; put yield or wait(...) into it, or "
                                 "count with \"for\" "
                                 "between constants, or let its row say at_most(n)"});
            may_wait_ = true;
            return;
        }
        const std::uint64_t inside = cost_ - cost_before;
        cost_ = cost_before +
                (rounds > max_atomic_statements ? max_atomic_statements + 1 : inside * (rounds + 1));
        cost_ = std::min<std::uint64_t>(cost_, 1'000'000'000);
        if (cost_ <= max_atomic_statements) return;
        if (reach_.statements_per_step == 0)
            return fail(at,
                        {"this loop executes more than ", digits(max_atomic_statements),
                         " statements without waiting; put yield into it, or let its row say at_most(n)"});
        may_wait_ = true;
    }

    constexpr ProgramIndex begin_program(std::initializer_list<std::string_view> name) {
        const ProgramIndex number =
            add(programs_, ProgramRow{.name = keep(name), .first = static_cast<NodeIndex>(nodes_.count())},
                "programs");
        pending_ = no_chain;
        may_wait_ = in_try_ = false;
        cost_ = 0;
        program_symbols_ = symbols_used_;
        return number;
    }
    /// The number, or none of a program without statements.
    constexpr ProgramIndex end_program(ProgramIndex number, Chain returns) {
        if (!ok()) return no_program;
        ProgramRow& row = programs_[number];
        if (row.first == nodes_.count()) {
            names_used_ -= row.name.size();
            --programs_.used;
            return no_program;
        }
        lead(pending_, end_node);
        lead(returns, end_node);
        row.last = static_cast<NodeIndex>(nodes_.count());
        row.may_wait = may_wait_;
        return number;
    }

    Chain pending_ = no_chain; // of the statement before
    bool in_try_ = false;
    bool may_wait_ = false;
    std::uint64_t cost_ = 0; // statements that the program may execute without waiting, at most
    std::uint16_t first_instruction_ = 0;
    std::uint32_t timers_ = 0; // nodes and transitions of the type that wait for time
    NodeSet waits_{};
    NodeSet reached_{};
};

} // namespace tappet::script_detail
