// Statements with their own flow: branches, loops, waits, and handling of failed actions.
#pragma once

#include "kernel/script/compiler_statements.hpp"

namespace tappet::script_detail {

constexpr void Statements::parse_if(const Token& at) {
    Chain otherwise = no_chain;
    parse_branch(at, otherwise);
    static_cast<void>(take(Sign::k_then));
    parse_statement();
    if (!take(Sign::k_else)) return join(pending_, otherwise);
    const Chain after = pending_;
    pending_ = otherwise;
    parse_statement();
    join(pending_, after);
}

constexpr NodeIndex Statements::parse_branch(const Token& at, Chain& otherwise) {
    begin_action();
    const NodeIndex node = end_action(at);
    const std::uint16_t first = instruction_count();
    const Token where = token_;
    const Operand value = parse_condition();
    const ConditionIndex condition = make_condition(where, first, value);
    pending_ = add_arc(node, condition);
    if (condition != no_condition) otherwise = add_arc(node);
    return node;
}

constexpr void Statements::parse_while(const Token& at) {
    Loop loop;
    Loop* const outer = loop_;
    loop_ = &loop;
    const std::uint64_t cost = cost_;
    Chain otherwise = no_chain;
    const NodeIndex head = parse_branch(at, otherwise);
    parse_statement();
    join(pending_, loop.continues);
    lead(pending_, head);
    check_loop(at, head, cost, 0);
    pending_ = otherwise;
    join(pending_, loop.breaks);
    loop_ = outer;
}

constexpr void Statements::parse_for(const Token& at) {
    const std::size_t symbols = symbols_used_, scope = scope_;
    scope_ = symbols_used_;
    need(Sign::open_round, "\"(\"");
    const bool has_counter = is(Sign::k_var);
    last_value_ = {};
    if (!is(Sign::semicolon)) parse_step_statement();
    if (is(Sign::semicolon)) advance();
    Symbol* const counter =
        has_counter && ok() && symbols_used_ == symbols + 1 ? &symbols_[symbols] : nullptr;
    const std::uint64_t rounds =
        counter != nullptr && counter->operand.type == script_int && last_value_.literal
            ? count_rounds(*counter, last_value_.integer)
            : 0;
    Loop loop;
    Loop* const outer = loop_;
    loop_ = &loop;
    const std::uint64_t cost = cost_;
    Chain otherwise = no_chain;
    const NodeIndex head = parse_branch(at, otherwise);
    need(Sign::semicolon, "\";\" and the step of the loop");
    const Place step = here();
    for (std::size_t depth = 0; ok() && (depth != 0 || !is(Sign::close_round)); advance()) {
        if (is(Sign::end) || is(Sign::broken)) fail_expected("\")\" after the step of the loop");
        if (is(Sign::open_round)) ++depth;
        if (is(Sign::close_round)) --depth;
    }
    need(Sign::close_round, "\")\"");
    if (rounds != 0) counter->fixed = true;
    parse_statement();
    if (rounds != 0) counter->fixed = false;
    join(pending_, loop.continues);
    const Place after = here();
    go_to(step);
    if (!is(Sign::close_round)) parse_step_statement();
    if (ok() && !is(Sign::close_round)) fail_expected("\")\" after the step of the loop");
    go_to(after);
    lead(pending_, head);
    check_loop(at, head, cost, rounds);
    pending_ = otherwise;
    join(pending_, loop.breaks);
    loop_ = outer;
    symbols_used_ = symbols;
    scope_ = scope;
}

constexpr void Statements::parse_step_statement() {
    const Token at = token_;
    if (is(Sign::name)) return parse_set(at);
    if (take(Sign::k_var)) return parse_local(at, false);
    if (take(Sign::k_set)) return parse_set(at);
    if (take(Sign::k_do)) return parse_do(at);
    fail_expected("var, set, do or an assignment");
}

constexpr std::uint64_t Statements::count_rounds(const Symbol& counter, std::int64_t from) {
    if (!ok()) return 0;
    const Place before = here();
    const std::uint32_t instructions = instructions_.used;
    const auto is_counter = [&] { return is(Sign::name) && token_.text == counter.name; };
    const auto known_int = [&](std::int64_t& into) {
        const bool negative = take(Sign::minus);
        const Symbol* const named = is(Sign::name) ? find_symbol(token_) : nullptr;
        const bool is_known = is(Sign::integer) || (named != nullptr && named->operand.literal &&
                                                    named->operand.type == script_int);
        if (!is_known) return false;
        into = is(Sign::integer) ? token_.integer : named->operand.integer;
        if (negative) into = -into;
        advance();
        return true;
    };
    std::uint64_t rounds = 0;
    std::int64_t to = 0, by = 0;
    if (is_counter()) {
        advance();
        const Sign how = token_.sign;
        advance();
        if (known_int(to) && take(Sign::semicolon)) {
            static_cast<void>(take(Sign::k_set));
            if (is_counter()) {
                advance();
                if (take(Sign::assign) && is_counter()) {
                    advance();
                    const bool down = is(Sign::minus);
                    if ((take(Sign::plus) || take(Sign::minus)) && known_int(by) && is(Sign::close_round))
                        rounds = rounds_between(how, from, to, down ? -by : by);
                }
            }
        }
    }
    instructions_.used = instructions;
    go_to(before);
    return rounds;
}

constexpr std::uint64_t Statements::rounds_between(Sign how, std::int64_t from, std::int64_t to,
                                                   std::int64_t by) noexcept {
    constexpr std::int64_t large = std::int64_t{1} << 40;
    if (by == 0 || from > large || from < -large || to > large || to < -large || by > large || by < -large)
        return 0;
    const bool up = by > 0;
    const std::int64_t distance = up ? to - from : from - to, size = up ? by : -by;
    const bool fits = how == (up ? Sign::less : Sign::greater) ||
                      how == (up ? Sign::at_most : Sign::at_least) ||
                      (how == Sign::unequal && distance >= 0 && distance % size == 0);
    if (!fits) return 0;
    return distance < 0 ? 1 : static_cast<std::uint64_t>(distance / size) + 1;
}

constexpr void Statements::parse_try() {
    const NodeIndex first = static_cast<NodeIndex>(nodes_.count());
    const bool outer = in_try_;
    in_try_ = true;
    parse_statement();
    in_try_ = outer;
    if (!need(Sign::k_catch, "\"catch\" and what is done when an action failed")) return;
    const Token at = token_;
    const auto last = static_cast<NodeIndex>(nodes_.count());
    const Chain after = pending_;
    pending_ = no_chain;
    if (ok() && first == last) return fail(at, {"there is nothing in this try that could fail"});
    pending_ = pass(at); // target of failures, whatever the catch contains
    for (NodeIndex n = first; ok() && n < last; ++n)
        if (nodes_[n].on_error == to_catch) nodes_[n].on_error = last;
    parse_statement();
    join(pending_, after);
}

constexpr void Statements::parse_wait(const Token& at) {
    begin_action();
    const Token where = token_;
    const Operand value = parse_expression();
    may_wait_ = true;
    if (!ok()) return;
    if (script_type(value.type) == script_bool) {
        // Evaluated again in each step, so its instructions belong to the arc and not to the node.
        const std::uint16_t first = first_instruction_;
        const ConditionIndex condition = make_condition(where, first, value);
        first_instruction_ = instruction_count();
        const NodeIndex node = end_action(at);
        if (ok()) nodes_[node].first = first, nodes_[node].count = 0;
        pending_ = add_arc(node, condition);
        parse_timeout(node);
        return;
    }
    if (script_type(value.type) != script_duration)
        return fail_type(where, value.type, "a condition or a duration", "");
    const DataOffset time = persistent_time(where, value);
    const NodeIndex node = end_action(at);
    if (ok()) waits_.put(node, value.literal && value.integer > 0);
    ++timers_;
    pending_ = add_arc(node, no_condition, time);
}

constexpr DataOffset Statements::persistent_time(const Token& at, const Operand& value) {
    if (value.literal) return constant(at, value, script_duration, "").at;
    const DataOffset to = place_in(Region::arguments, sizeof(Duration));
    store(at, value, script_duration, to, "");
    return to;
}

constexpr void Statements::parse_timeout(NodeIndex node) {
    if (!take(Sign::k_timeout)) return;
    const Token where = token_;
    const Operand value = parse_known(script_duration, "a time-out");
    if (!ok()) return;
    if (value.type != script_duration) return fail_type(where, value.type, "a duration such as 5s", "");
    const DataOffset time = constant(where, value, script_duration, "").at;
    const Chain arc = add_arc(node, no_condition, time);
    if (ok()) arcs_[arc].to = no_node; // the target of on_error
    ++timers_;
}

} // namespace tappet::script_detail
