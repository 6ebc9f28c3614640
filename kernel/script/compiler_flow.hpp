// Nodes and arcs under construction: targets of open arcs, and whether a loop may run without waiting.
#pragma once

#include "kernel/script/compiler_calls.hpp"
#include "kernel/script/compiler_parts.hpp"

namespace tappet::script_detail {

/// Arcs without a target yet, each naming the one before it in its `to`; none: empty.
using Chain = std::uint16_t;
inline constexpr Chain no_chain = 0xffff;
/// Stands for the catch of the innermost try, which does not exist yet.
inline constexpr NodeIndex to_catch = 0xfffd;
inline constexpr std::size_t max_script_nodes = 16384; ///< of one type
/// Most statements of a program that never waits, loops counted.
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

    /// Call before a node's instructions.
    constexpr void begin_action() noexcept {
        region_used_[static_cast<std::size_t>(Region::scratch)] = 0;
        first_instruction_ = instruction_count();
    }
    /// Call after them: creates the node; all open arcs lead to it.
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
    /// Adds an exit to the last node; the arc stays open in the returned chain.
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
    /// Adds a node with only an exit.
    constexpr Chain pass(const Token& at) {
        begin_action();
        return add_arc(end_action(at));
    }
    /// Creates the condition whose instructions begin at `first`.
    constexpr ConditionIndex make_condition(const Token& at, std::uint16_t first, const Operand& value) {
        if (!ok() || (value.literal && value.integer != 0)) return no_condition;
        const Operand ready = as(at, value, script_bool, " as a condition");
        return add(conditions_,
                   ConditionRow{first, static_cast<std::uint16_t>(instruction_count() - first), ready.at},
                   "conditions");
    }

    /// Returns whether `head` can be reached from itself without waiting. Nodes are in text order, so only
    /// arcs of loops lead back, and inner loops were checked before.
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
    /// Call after a loop. `rounds`: upper bound of its iterations; 0: unknown.
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
    /// Returns its number, or none for a program without statements.
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

    Chain pending_ = no_chain; // of the preceding statement
    bool in_try_ = false;
    bool may_wait_ = false;
    std::uint64_t cost_ = 0; // most statements that the program may execute without waiting
    std::uint16_t first_instruction_ = 0;
    std::uint32_t timers_ = 0; // nodes and transitions of the type that wait for time
    NodeSet waits_{};
    NodeSet reached_{};
};

} // namespace tappet::script_detail
