// Nodes and arcs under construction: targets of open arcs, and whether a loop may run without waiting.
#pragma once

#include "kernel/script/scope.hpp"

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

class Flow {
public:
    constexpr Flow(Reader& text, Emitter& out, Values& values, Scope& scope, const Reach& reach)
        : text_{text},
          out_{out},
          values_{values},
          scope_{scope},
          statements_per_step_{reach.statements_per_step} {}

    Chain pending = no_chain; ///< of the preceding statement
    bool in_try = false;

    // ---- nodes

    /// Call before a node's instructions.
    constexpr void begin_action() noexcept {
        out_.clear_scratch();
        first_instruction_ = out_.instruction_count();
    }
    [[nodiscard]] constexpr std::uint16_t first_instruction() const noexcept { return first_instruction_; }
    [[nodiscard]] constexpr bool has_instructions() const noexcept {
        return out_.instruction_count() != first_instruction_;
    }
    /// Takes the instructions back; they are made again later.
    constexpr void drop_action() noexcept {
        out_.instructions.used = out_.instructions.base + first_instruction_;
    }
    /// Call after them: creates the node; all open arcs lead to it.
    constexpr NodeIndex end_action(const Token& at) {
        if (out_.nodes.count() == max_script_nodes) text_.fail_limit("nodes");
        const NodeIndex node = out_.add(
            out_.nodes,
            NodeRow{.first = first_instruction_,
                    .count = static_cast<std::uint16_t>(out_.instruction_count() - first_instruction_),
                    .first_arc = static_cast<std::uint16_t>(out_.arcs.count()),
                    .on_error = in_try ? to_catch : no_node,
                    .line = at.line,
                    .column = at.column},
            "nodes");
        if (!text_.ok()) return 0;
        waits_.put(node, false);
        lead(pending, node);
        ++cost_;
        return node;
    }
    /// Creates a node with one exit, which stays open.
    constexpr void end_statement(const Token& at) { pending = add_arc(end_action(at)); }
    /// Adds a node without an action; returns its exit.
    constexpr Chain pass(const Token& at) {
        begin_action();
        return add_arc(end_action(at));
    }
    /// Ends the action of a node where the program may wait; `always`: in any case.
    constexpr NodeIndex end_wait(const Token& at, bool always) {
        may_wait_ = true;
        const NodeIndex node = end_action(at);
        if (text_.ok()) waits_.put(node, always);
        return node;
    }

    // ---- arcs

    /// Adds an exit to the last node; the arc stays open in the returned chain.
    constexpr Chain add_arc(NodeIndex node, ConditionIndex condition = no_condition,
                            DataOffset after = no_data) {
        if (!text_.ok()) return no_chain;
        const Chain arc = out_.add(out_.arcs, ArcRow{condition, no_chain, after}, "arcs");
        if (text_.ok()) ++out_.nodes[node].arcs;
        return text_.ok() ? arc : no_chain;
    }
    constexpr void lead(Chain& chain, NodeIndex to) {
        while (text_.ok() && chain != no_chain) {
            ArcRow& arc = out_.arcs[chain];
            chain = arc.to;
            arc.to = to;
        }
        chain = no_chain;
    }
    constexpr void join(Chain& chain, Chain other) {
        if (!text_.ok() || other == no_chain) return;
        if (chain != no_chain) {
            Chain last = other;
            while (out_.arcs[last].to != no_chain) last = out_.arcs[last].to;
            out_.arcs[last].to = chain;
        }
        chain = other;
    }
    /// Creates the condition whose instructions begin at `first`.
    constexpr ConditionIndex add_condition(const Token& at, std::uint16_t first, const Operand& value) {
        if (!text_.ok() || (value.literal && value.integer != 0)) return no_condition;
        const Operand ready = values_.as(at, value, script_bool, " as a condition");
        return out_.add(
            out_.conditions,
            ConditionRow{first, static_cast<std::uint16_t>(out_.instruction_count() - first), ready.at},
            "conditions");
    }

    // ---- loops

    [[nodiscard]] constexpr std::uint64_t cost() const noexcept { return cost_; }
    /// Call after a loop. `rounds`: upper bound of its iterations; 0: unknown.
    constexpr void check_loop(const Token& at, NodeIndex head, std::uint64_t cost_before,
                              std::uint64_t rounds) {
        if (!text_.ok() || !is_free_loop(head)) return;
        if (rounds != 0) {
            const std::uint64_t inside = cost_ - cost_before;
            cost_ = cost_before +
                    (rounds > max_atomic_statements ? max_atomic_statements + 1 : inside * (rounds + 1));
            cost_ = std::min<std::uint64_t>(cost_, 1'000'000'000);
            if (cost_ <= max_atomic_statements) return;
        }
        may_wait_ = true;
        if (statements_per_step_ != 0) return;
        if (rounds == 0)
            return text_.fail(at, {"this loop can run without waiting; put yield or wait(...) into it, or "
                                   "count with \"for\" between constants, or let its row say at_most(n)"});
        text_.fail(at, {"this loop executes more than ", text_.digits(max_atomic_statements),
                        " statements without waiting; put yield into it, or let its row say at_most(n)"});
    }

    // ---- programs

    constexpr ProgramIndex begin_program(std::initializer_list<std::string_view> name) {
        const ProgramIndex number =
            out_.add(out_.programs,
                     ProgramRow{.name = out_.keep(name), .first = static_cast<NodeIndex>(out_.nodes.count())},
                     "programs");
        pending = no_chain;
        may_wait_ = in_try = false;
        cost_ = 0;
        scope_.begin_program();
        return number;
    }
    /// Returns its number, or none for a program without statements.
    constexpr ProgramIndex end_program(ProgramIndex number, Chain returns) {
        if (!text_.ok()) return no_program;
        ProgramRow& row = out_.programs[number];
        if (row.first == out_.nodes.count()) {
            out_.names.used -= static_cast<std::uint32_t>(row.name.size());
            --out_.programs.used;
            return no_program;
        }
        lead(pending, end_node);
        lead(returns, end_node);
        row.last = static_cast<NodeIndex>(out_.nodes.count());
        row.may_wait = may_wait_;
        return number;
    }

private:
    /// Returns whether `head` can be reached from itself without waiting. Nodes are in text order, so only
    /// arcs of loops lead back, and inner loops were checked before.
    constexpr bool is_free_loop(NodeIndex head) {
        for (std::size_t n = head; n < out_.nodes.count(); ++n) reached_.put(n, n == head);
        for (std::size_t n = head; text_.ok() && n < out_.nodes.count(); ++n) {
            if (!reached_.has(n) || waits_.has(n)) continue;
            const NodeRow& node = out_.nodes[n];
            for (std::size_t a = 0; a <= node.arcs; ++a) {
                const NodeIndex to = a < node.arcs ? out_.arcs[node.first_arc + a].to : node.on_error;
                if (to == head) return true;
                if (to > n && to < out_.nodes.count()) reached_.put(to, true);
            }
        }
        return false;
    }

    Reader& text_;
    Emitter& out_;
    Values& values_;
    Scope& scope_;
    std::uint32_t statements_per_step_;
    bool may_wait_ = false;
    std::uint64_t cost_ = 0; // most statements that the program may execute without waiting
    std::uint16_t first_instruction_ = 0;
    NodeSet waits_{};
    NodeSet reached_{};
};

} // namespace tappet::script_detail
