// Statements: each becomes one node or a few. Programs, functions and variables, which consist of them.
#pragma once

#include "kernel/script/parse_call.hpp"

namespace tappet::script_detail {

/// Frame of a program, or of a function that is expanded in it.
struct Frame {
    TypeId result = nullptr;
    DataOffset slot = no_data; ///< of the result
    Chain exits = no_chain;
    bool is_function = false;
};
/// Exits of a condition.
struct Branch {
    NodeIndex node = 0;
    Chain otherwise = no_chain; ///< if it does not hold
};
/// A loop from its condition to its end.
struct Loop {
    Loop* outer = nullptr;
    std::uint64_t cost = 0; ///< of the statements before it
    Branch head{};
    Chain breaks = no_chain;
    Chain continues = no_chain;
};

class Actions;

class Statements {
public:
    /// Actions contain statements, those of a function, and the reverse.
    constexpr Statements(Basis& basis, Expressions& expressions, Calls& calls, Actions& actions)
        : basis_{basis}, expressions_{expressions}, calls_{calls}, actions_{actions} {}

    /// Parses "{ ... }" or one statement.
    constexpr void parse() {
        if (!text_.enter()) return;
        parse_by_word(text_.token());
        text_.skip(Sign::semicolon);
        text_.leave();
    }
    /// Parses the statements of a program, up to a closing brace that belongs to its owner, or to the end.
    /// `exports`: its outermost variables are properties (thesis 5.1.6).
    constexpr ProgramIndex parse_program(std::initializer_list<std::string_view> name,
                                         bool to_the_end = false, Frame frame = {}, bool exports = false) {
        const ProgramIndex number = flow_.begin_program(name);
        frame_ = &frame;
        loop_ = nullptr;
        exports_variables_ = exports;
        const Scope::Mark outer = scope_.open();
        parse_until(to_the_end ? Sign::end : Sign::close_brace);
        scope_.close(outer);
        exports_variables_ = false;
        frame_ = nullptr;
        if (text_.ok() && frame.result != nullptr && (flow_.pending != no_chain || frame.exits == no_chain))
            text_.fail({"found the end of a program that gives a result; end each way through it with "
                        "\"return\" and a value"});
        return flow_.end_program(number, frame.exits);
    }

    // ---- variables

    /// Parses variables after "var"; returns the first value of the last one.
    constexpr Operand parse_variables(const Token& at) {
        const TypeId type = parse_type_or_auto();
        Operand value;
        do {
            const Token name = text_.need_name("the name of the variable");
            if (!text_.ok()) return {};
            if (type == nullptr && !text_.is(Sign::assign))
                text_.fail_expected("\"=\" and a value, of which auto takes the type");
            value = parse_variable(at, name, type);
        } while (text_.ok() && text_.take(Sign::comma));
        return value;
    }

    // ---- functions

    /// "function [type] name (type name, ...) { ... }"
    constexpr void parse_function_definition(bool of_type) {
        text_.advance();
        Function function;
        Token name = text_.need_word("the function's name, or the type of its result");
        if (text_.is(Sign::name)) {
            if (name.text != "void") {
                function.result = peers_.find_type(name.text);
                if (text_.ok() && function.result == nullptr)
                    text_.fail(name, {"found \"", quoted(name.text), "\", expected a type"});
            }
            name = text_.need_name("the function's name");
        }
        if (!text_.need(Sign::open_round, "\"(\" and the parameters")) return;
        function.name = name.text;
        function.parameters = text_.here();
        function.symbols = of_type ? none : static_cast<std::uint16_t>(scope_.mark().used + 1);
        while (text_.has_more(Sign::close_round)) {
            peers_.parse_type();
            text_.need_name("the name of a parameter");
            text_.need_comma();
        }
        if (!text_.need(Sign::close_round, "\")\"")) return;
        if (!text_.need(Sign::open_brace, "\"{\"")) return;
        skip_body(function);
        scope_.declare(name, function);
    }
    /// Returns the function with statements that is called next; null: none is.
    [[nodiscard]] constexpr Function* next_function() {
        if (!text_.is(Sign::name)) return nullptr;
        const Symbol* const symbol = scope_.find(text_.token());
        if (symbol == nullptr || symbol->kind != SymbolKind::function) return nullptr;
        Function& function = scope_.functions()[symbol->number];
        return function.is_value ? nullptr : &function;
    }
    /// Expands the function's statements here; returns its result, which it must have if a value is wanted.
    constexpr Operand expand(Function& function, bool wants_value) {
        const Token name = text_.token();
        text_.advance();
        if (wants_value && function.result == nullptr)
            return values_.fail(
                name, {"function \"", function.name, "\" returns nothing; give it the type of a result"});
        flow_.begin_action();
        const Calls::Expansion expansion = calls_.begin_expansion(name, function, true);
        if (!text_.ok()) return {};
        if (flow_.has_instructions()) flow_.end_statement(name);
        Frame frame{.result = function.result, .is_function = true};
        if (function.result != nullptr) frame.slot = out_.place_in(Region::arguments, function.result->size);
        Frame* const outer_frame = frame_;
        Loop* const outer_loop = loop_;
        frame_ = &frame;
        loop_ = nullptr;
        parse_until(Sign::close_brace);
        text_.need(Sign::close_brace, "\"}\"");
        frame_ = outer_frame;
        loop_ = outer_loop;
        flow_.join(flow_.pending, frame.exits);
        calls_.end_expansion(function, expansion);
        flow_.begin_action();
        return text_.ok() ? at_place(function.result, frame.slot) : Operand{};
    }

private:
    constexpr void parse_by_word(Token at);
    constexpr void parse_until(Sign closing) {
        while (text_.has_more(closing)) parse();
    }
    constexpr void parse_block() {
        text_.advance();
        const Scope::Mark outer = scope_.open();
        parse_until(Sign::close_brace);
        text_.need(Sign::close_brace, "\"}\"");
        scope_.close(outer);
    }
    /// Null: auto, or a fault.
    constexpr TypeId parse_type_or_auto() {
        if (text_.token().text != "auto" || !text_.is(Sign::name)) return peers_.parse_type();
        text_.advance();
        return nullptr;
    }
    constexpr void parse_constants() {
        const TypeId type = parse_type_or_auto();
        do {
            const Token name = text_.need_name("the name of the variable");
            if (!text_.ok()) return;
            text_.need(Sign::assign, "\"=\" and a value");
            scope_.declare(name, fixed_symbol(expressions_.parse_constant(type, "a constant")));
        } while (text_.ok() && text_.take(Sign::comma));
    }
    /// Parses "= value", if it is there, and declares the variable; returns the value. Without a `type`, the
    /// variable has that of the value.
    constexpr Operand parse_variable(const Token& at, const Token& name, TypeId type) {
        flow_.begin_action();
        const bool given = text_.take(Sign::assign);
        const Token where = text_.token();
        Operand value;
        if (given) {
            if (Function* const function = next_function(); function != nullptr)
                value = expand(*function, true);
            else
                value = type == nullptr ? values_.reckoned(where, expressions_.parse())
                                        : expressions_.parse(type);
            if (type == nullptr) type = value.type;
        }
        if (!text_.ok()) return {};
        const DataOffset place = exports_variables_ && text_.depth() == 1
                                     ? out_.add_variable(name.text, type, VariableKind::variable)
                                     : out_.place_in(Region::arguments, type->size);
        if (given) {
            values_.store(where, value, type, place, "");
        } else {
            DataOffset zero = no_data;
            static_cast<void>(out_.add_constant(type->size, zero));
            values_.copy(type, zero, place);
        }
        flow_.end_statement(at);
        scope_.declare(name, Symbol{.operand = at_place(type, place)});
        return value;
    }
    /// Skips the body of a function; notes whether it is one return.
    constexpr void skip_body(Function& function) {
        function.is_value =
            text_.take(Sign::k_return) && !text_.is(Sign::semicolon) && !text_.is(Sign::close_brace);
        for (std::size_t depth = 1, statements = 0; text_.ok() && depth != 0; text_.advance()) {
            if (text_.is(Sign::end) || text_.is(Sign::broken))
                text_.fail_expected("\"}\" at the end of the function");
            if (text_.is(Sign::open_brace)) ++depth;
            if (text_.is(Sign::close_brace)) --depth;
            if (text_.is(Sign::semicolon))
                ++statements;
            else if (statements > 0 && depth != 0)
                function.is_value = false;
        }
    }
    constexpr void parse_return(const Token& at) {
        flow_.begin_action();
        if (frame_ == nullptr) return text_.fail(at, {"found \"return\" outside of a program"});
        if (frame_->result != nullptr) {
            const Token where = text_.token();
            values_.store(where, expressions_.parse(frame_->result), frame_->result, frame_->slot,
                          frame_->is_function ? " as the function returns" : " as the program returns");
        } else if (!text_.is(Sign::semicolon) && text_.has_more(Sign::close_brace)) {
            return text_.fail({"found a value, but the ", frame_->is_function ? "function" : "program",
                               " returns nothing"});
        }
        flow_.join(frame_->exits, flow_.add_arc(flow_.end_action(at)));
        flow_.pending = no_chain;
    }

    // ---- branches and loops

    constexpr void parse_if(const Token& at) {
        Branch branch = parse_branch(at);
        text_.skip(Sign::k_then);
        parse();
        if (!text_.take(Sign::k_else)) return flow_.join(flow_.pending, branch.otherwise);
        const Chain after = flow_.pending;
        flow_.pending = branch.otherwise;
        parse();
        flow_.join(flow_.pending, after);
    }
    constexpr void parse_while(const Token& at) {
        Loop loop;
        begin_loop(at, loop);
        parse();
        flow_.join(flow_.pending, loop.continues);
        end_loop(at, loop, 0);
    }
    constexpr void parse_for(const Token& at) {
        const Scope::Mark outer = scope_.open();
        text_.need(Sign::open_round, "\"(\"");
        const bool has_counter = text_.is(Sign::k_var);
        Operand first;
        if (!text_.is(Sign::semicolon)) first = parse_step();
        text_.skip(Sign::semicolon);
        const auto own = scope_.symbols().subspan(outer.used);
        Symbol* const counter = has_counter && text_.ok() && own.size() == 1 ? own.data() : nullptr;
        const std::uint64_t rounds =
            counter != nullptr && counter->operand.type == script_int && first.literal
                ? count_rounds(*counter, first.integer)
                : 0;
        Loop loop;
        begin_loop(at, loop);
        text_.need(Sign::semicolon, "\";\" and the step of the loop");
        const Reader::Place step = text_.here();
        for (std::size_t depth = 0; text_.ok() && (depth != 0 || !text_.is(Sign::close_round));
             text_.advance()) {
            if (text_.is(Sign::end) || text_.is(Sign::broken))
                text_.fail_expected("\")\" after the step of the loop");
            if (text_.is(Sign::open_round)) ++depth;
            if (text_.is(Sign::close_round)) --depth;
        }
        text_.need(Sign::close_round, "\")\"");
        if (rounds != 0) counter->fixed = true;
        parse();
        if (rounds != 0) counter->fixed = false;
        flow_.join(flow_.pending, loop.continues);
        const Reader::Place after = text_.here();
        text_.go_to(step);
        if (!text_.is(Sign::close_round)) parse_step();
        if (text_.ok() && !text_.is(Sign::close_round))
            text_.fail_expected("\")\" after the step of the loop");
        text_.go_to(after);
        end_loop(at, loop, rounds);
        scope_.close(outer);
    }
    /// Parses after "break" or "continue", which is `at`.
    constexpr void parse_jump(const Token& at) {
        if (loop_ == nullptr) return text_.fail(at, {"found \"", at.text, "\" outside of a loop"});
        const Chain arc = flow_.pass(at);
        flow_.join(at.sign == Sign::k_break ? loop_->breaks : loop_->continues, arc);
    }
    constexpr void parse_try() {
        const auto first = static_cast<NodeIndex>(out_.nodes.count());
        const bool outer = flow_.in_try;
        flow_.in_try = true;
        parse();
        flow_.in_try = outer;
        if (!text_.need(Sign::k_catch, "\"catch\" and what is done when an action failed")) return;
        const Token at = text_.token();
        const auto last = static_cast<NodeIndex>(out_.nodes.count());
        const Chain after = flow_.pending;
        flow_.pending = no_chain;
        if (text_.ok() && first == last)
            return text_.fail(at, {"there is nothing in this try that could fail"});
        flow_.pending = flow_.pass(at); // target of failures, whatever the catch contains
        for (NodeIndex n = first; text_.ok() && n < last; ++n)
            if (out_.nodes[n].on_error == to_catch) out_.nodes[n].on_error = last;
        parse();
        flow_.join(flow_.pending, after);
    }
    /// Creates a branching node, whose exit if the condition holds is `pending`.
    constexpr Branch parse_branch(const Token& at) {
        flow_.begin_action();
        Branch branch{flow_.end_action(at)};
        const std::uint16_t first = out_.instruction_count();
        const Token where = text_.token();
        const Operand value = expressions_.parse_condition();
        const ConditionIndex condition = flow_.add_condition(where, first, value);
        flow_.pending = flow_.add_arc(branch.node, condition);
        if (condition != no_condition) branch.otherwise = flow_.add_arc(branch.node);
        return branch;
    }
    constexpr void begin_loop(const Token& at, Loop& loop) {
        loop.outer = loop_;
        loop_ = &loop;
        loop.cost = flow_.cost();
        loop.head = parse_branch(at);
    }
    constexpr void end_loop(const Token& at, const Loop& loop, std::uint64_t rounds) {
        flow_.lead(flow_.pending, loop.head.node);
        flow_.check_loop(at, loop.head.node, loop.cost, rounds);
        flow_.pending = loop.head.otherwise;
        flow_.join(flow_.pending, loop.breaks);
        loop_ = loop.outer;
    }
    /// Parses a statement in the brackets of a for: var, set, do, or an assignment without "set". Returns the
    /// first value of a variable.
    constexpr Operand parse_step();
    /// Returns the number of iterations of "i < c; i = i + d"; 0: not of that form. Only reads ahead.
    constexpr std::uint64_t count_rounds(const Symbol& counter, std::int64_t from) {
        if (!text_.ok()) return 0;
        const Reader::Place before = text_.here();
        const auto take_counter = [&] {
            const bool is_counter = text_.is(Sign::name) && text_.token().text == counter.name;
            if (is_counter) text_.advance();
            return is_counter;
        };
        const auto known_int = [&](std::int64_t& into) {
            const bool negative = text_.take(Sign::minus);
            const Symbol* const named = text_.is(Sign::name) ? scope_.find(text_.token()) : nullptr;
            const bool is_known = text_.is(Sign::integer) || (named != nullptr && named->operand.literal &&
                                                              named->operand.type == script_int);
            if (!is_known) return false;
            into = text_.is(Sign::integer) ? text_.token().integer : named->operand.integer;
            if (negative) into = -into;
            text_.advance();
            return true;
        };
        std::uint64_t rounds = 0;
        std::int64_t to = 0, by = 0;
        if (take_counter()) {
            const Sign how = text_.token().sign;
            text_.advance();
            bool down = false;
            if (known_int(to) && text_.take(Sign::semicolon) && (text_.take(Sign::k_set), take_counter()) &&
                text_.take(Sign::assign) && take_counter() &&
                (text_.take(Sign::plus) || (down = text_.take(Sign::minus))) && known_int(by) &&
                text_.is(Sign::close_round))
                rounds = rounds_between(how, from, to, down ? -by : by);
        }
        text_.go_to(before);
        return rounds;
    }
    static constexpr std::uint64_t rounds_between(Sign how, std::int64_t from, std::int64_t to,
                                                  std::int64_t by) noexcept {
        constexpr std::int64_t large = std::int64_t{1} << 40;
        if (by == 0 || from > large || from < -large || to > large || to < -large || by > large ||
            by < -large)
            return 0;
        const bool up = by > 0;
        const std::int64_t distance = up ? to - from : from - to, size = up ? by : -by;
        const bool fits = how == (up ? Sign::less : Sign::greater) ||
                          how == (up ? Sign::at_most : Sign::at_least) ||
                          (how == Sign::unequal && distance >= 0 && distance % size == 0);
        if (!fits) return 0;
        return distance < 0 ? 1 : static_cast<std::uint64_t>(distance / size) + 1;
    }

    Basis& basis_;
    Reader& text_ = basis_.text;
    Emitter& out_ = basis_.out;
    Values& values_ = basis_.values;
    Scope& scope_ = basis_.scope;
    Peers& peers_ = basis_.peers;
    Flow& flow_ = basis_.flow;
    Expressions& expressions_;
    Calls& calls_;
    Actions& actions_;
    Frame* frame_ = nullptr;
    Loop* loop_ = nullptr; // the innermost one of the program or function
    bool exports_variables_ = false;
};

} // namespace tappet::script_detail
