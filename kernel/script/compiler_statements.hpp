// Statements: each becomes one node or a few.
#pragma once

#include "kernel/script/compiler_flow.hpp"

namespace tappet::script_detail {

/// Frame of a program, or of a function that is expanded in it.
struct Frame {
    TypeId result = nullptr;
    DataOffset slot = no_data; ///< of the result
    Chain exits = no_chain;
    bool is_function = false;
};

class Statements : protected Flow {
protected:
    using Flow::Flow;

    /// Parses "{ ... }" or one statement.
    constexpr void parse_statement() {
        if (!enter()) return;
        const Token at = token_;
        switch (at.sign) {
        case Sign::open_brace: parse_block(); break;
        case Sign::semicolon: advance(); break;
        case Sign::k_do:
            advance();
            parse_do(at);
            break;
        case Sign::k_set:
            advance();
            parse_set(at);
            break;
        case Sign::k_var:
            advance();
            parse_local(at, false);
            break;
        case Sign::k_const:
            advance();
            parse_local(at, true);
            break;
        case Sign::k_if:
            advance();
            parse_if(at);
            break;
        case Sign::k_while:
            advance();
            parse_while(at);
            break;
        case Sign::k_for:
            advance();
            parse_for(at);
            break;
        case Sign::k_try:
            advance();
            parse_try();
            break;
        case Sign::k_wait:
            advance();
            parse_wait(at);
            break;
        case Sign::k_return:
            advance();
            parse_return(at);
            break;
        case Sign::k_yield:
            advance();
            parse_yield(at);
            break;
        case Sign::k_break:
        case Sign::k_continue:
            advance();
            parse_jump(at);
            break;
        default:
            fail_expected("a statement: do, set, var, if, while, for, wait, yield, return, try or a block");
            break;
        }
        static_cast<void>(take(Sign::semicolon));
        leave();
    }
    constexpr void parse_yield(const Token& at) {
        begin_action();
        const NodeIndex node = end_action(at);
        if (ok()) nodes_[node].yields = true, waits_.put(node, true);
        may_wait_ = true;
        pending_ = add_arc(node);
    }
    constexpr void parse_jump(const Token& at) {
        if (loop_ == nullptr) {
            fail(at, {"found \"", at.text, "\" outside of a loop"});
            return;
        }
        const Chain arc = pass(at);
        join(at.sign == Sign::k_break ? loop_->breaks : loop_->continues, arc);
    }
    constexpr void parse_block() {
        if (!need(Sign::open_brace, "\"{\"")) return;
        const std::size_t symbols = symbols_used_, scope = scope_;
        scope_ = symbols_used_;
        while (ok() && !is(Sign::close_brace) && !is(Sign::end)) parse_statement();
        need(Sign::close_brace, "\"}\"");
        symbols_used_ = symbols;
        scope_ = scope;
    }
    /// Parses the statements of a program, up to a closing brace that belongs to its owner.
    constexpr ProgramIndex parse_program(std::initializer_list<std::string_view> name,
                                         bool to_the_end = false, Frame frame = {}) {
        const ProgramIndex number = begin_program(name);
        frame_ = &frame;
        loop_ = nullptr;
        const std::size_t symbols = symbols_used_, scope = scope_;
        scope_ = symbols_used_;
        if (to_the_end)
            while (ok() && !is(Sign::end)) parse_statement();
        else
            while (ok() && !is(Sign::close_brace) && !is(Sign::end)) parse_statement();
        symbols_used_ = symbols;
        scope_ = scope;
        frame_ = nullptr;
        if (ok() && frame.result != nullptr && (pending_ != no_chain || frame.exits == no_chain))
            fail(token_, {"found the end of a program that gives a result; end each way through it with "
                          "\"return\" and a value"});
        return end_program(number, frame.exits);
    }
    /// "function [type] name (type name, ...) { ... }"
    constexpr void parse_function_definition(bool of_type) {
        advance();
        Function function;
        Token name = need_word("the function's name, or the type of its result");
        if (is(Sign::name)) {
            if (name.text != "void") {
                function.result = find_type(name.text);
                if (ok() && function.result == nullptr)
                    fail(name, {"found \"", quoted(name.text), "\", expected a type"});
            }
            name = need_name("the function's name");
        }
        if (!need(Sign::open_round, "\"(\" and the parameters")) return;
        const Place parameters = here();
        function.name = name.text;
        function.lexer = parameters.lexer;
        function.token = parameters.token;
        function.symbols = of_type ? none : static_cast<std::uint16_t>(symbols_used_ + 1);
        while (ok() && !is(Sign::close_round) && !is(Sign::end)) {
            parse_type();
            need_name("the name of a parameter");
            if (!is(Sign::close_round) && !need(Sign::comma, "\",\" or \")\"")) return;
        }
        need(Sign::close_round, "\")\"");
        if (!need(Sign::open_brace, "\"{\"")) return;
        function.is_value = is(Sign::k_return);
        std::size_t depth = 1, statements = 0;
        for (bool first = true; ok() && depth != 0; first = false) {
            if (is(Sign::end) || is(Sign::broken)) return fail_expected("\"}\" at the end of the function");
            if (is(Sign::open_brace)) ++depth;
            if (is(Sign::close_brace)) --depth;
            if (first && function.is_value) {
                advance();
                if (is(Sign::semicolon) || is(Sign::close_brace)) function.is_value = false;
                continue;
            }
            if (is(Sign::semicolon))
                ++statements;
            else if (statements > 0 && depth != 0)
                function.is_value = false;
            advance();
        }
        if (functions_used_ == functions_.size()) fail_limit("functions");
        if (!ok()) return;
        Symbol symbol;
        symbol.kind = SymbolKind::function;
        symbol.fixed = true;
        symbol.number = static_cast<std::uint16_t>(functions_used_);
        functions_[functions_used_++] = function;
        declare(name, symbol);
    }

    struct Loop {
        Chain breaks = no_chain;
        Chain continues = no_chain;
    };
    /// Whether the program's outermost variables are properties (thesis 5.1.6).
    bool exports_variables_ = false;

private:
    // ---- variables

    constexpr void parse_local(const Token& at, bool is_constant) {
        const bool is_auto = token_.text == "auto" && is(Sign::name);
        TypeId type = nullptr;
        if (is_auto)
            advance();
        else
            type = parse_type();
        do {
            const Token name = need_name("the name of the variable");
            if (!ok()) return;
            Symbol symbol;
            if (is_constant) {
                need(Sign::assign, "\"=\" and a value");
                symbol.kind = SymbolKind::value;
                symbol.fixed = true;
                symbol.operand = known_value(type, "a constant");
                declare(name, symbol);
                continue;
            }
            if (is_auto && !is(Sign::assign))
                return fail_expected("\"=\" and a value, of which auto takes the type");
            begin_action();
            Operand value;
            const Token where = take(Sign::assign) ? token_ : name;
            const bool given = where.column != name.column || where.line != name.line;
            TypeId given_type = type;
            DataOffset result = no_data;
            if (given) {
                if (Function* const function = statement_function(); function != nullptr) {
                    result = expand(*function, true);
                    begin_action();
                    value = at_place(function->result, result);
                } else {
                    value = is_auto ? reckoned(where, parse_expression()) : parse_expression(type);
                }
                if (is_auto && ok()) given_type = value.type;
            }
            if (!ok()) return;
            const bool is_exported = exports_variables_ && nesting_ == 1;
            symbol.operand = at_place(given_type, no_data);
            if (is_exported) {
                static_cast<void>(add_variable(given_type->size, symbol.operand.at));
                add(variables_,
                    VariableRow{keep({name.text}), given_type, symbol.operand.at, VariableKind::variable},
                    "variables");
            } else {
                symbol.operand.at = place_in(Region::arguments, given_type->size);
            }
            if (given) {
                store(where, value, given_type, symbol.operand.at, "");
            } else {
                Instruction in = copy_instruction(given_type);
                static_cast<void>(add_constant(given_type->size, in.a));
                in.to = symbol.operand.at;
                emit(in);
            }
            last_value_ = value;
            pending_ = add_arc(end_action(at));
            declare(name, symbol);
        } while (ok() && take(Sign::comma));
    }

protected:
    /// Parses a constant's value: a literal, or bytes among the constants.
    constexpr Operand known_value(TypeId type, std::string_view what) {
        const Token at = token_;
        const Operand value = parse_known(type, what);
        if (!ok() || type == nullptr || value.type == type) return value;
        if (!value.literal) {
            fail_type(at, value.type, type_name(type), "");
            return {};
        }
        const Operand placed = as(at, value, type, "");
        return type == script_double ? literal_of(script_double, 0, value.real) : placed;
    }

private:
    /// Returns the function with statements that is called next; null: none is.
    constexpr Function* statement_function() {
        if (!is(Sign::name)) return nullptr;
        const Symbol* const symbol = find_symbol(token_);
        if (symbol == nullptr || symbol->kind != SymbolKind::function || functions_[symbol->number].is_value)
            return nullptr;
        return &functions_[symbol->number];
    }
    /// Expands the function's statements here; returns the offset of its result, which it must have if a
    /// value is wanted. Not by the wanted type: `auto` has none.
    constexpr DataOffset expand(Function& function, bool wants_value) {
        const Token name = token_;
        advance();
        if (wants_value && function.result == nullptr) {
            fail(name, {"function \"", function.name, "\" returns nothing; give it the type of a result"});
            return no_data;
        }
        const Token at = name;
        begin_action();
        const Expansion expansion = begin_expansion(name, function, true);
        if (!ok()) return no_data;
        if (instruction_count() != first_instruction_) pending_ = add_arc(end_action(at));
        Frame frame;
        frame.is_function = true;
        frame.result = function.result;
        if (function.result != nullptr) frame.slot = place_in(Region::arguments, function.result->size);
        Frame* const outer_frame = frame_;
        Loop* const outer_loop = loop_;
        frame_ = &frame;
        loop_ = nullptr;
        while (ok() && !is(Sign::close_brace) && !is(Sign::end)) parse_statement();
        need(Sign::close_brace, "\"}\"");
        frame_ = outer_frame;
        loop_ = outer_loop;
        join(pending_, frame.exits);
        end_expansion(function, expansion);
        return frame.slot;
    }

    constexpr void parse_set(const Token& at);
    /// An assignable output or property, after its first name.
    struct FacetPlace {
        std::uint16_t component = 0, number = none;
        FacetAction action{};
    };
    constexpr FacetPlace parse_facet_place(const Token& name);
    /// Parses a variable or a part of one.
    constexpr void parse_set_place(const Token& at, Operand place);
    constexpr Operand assigned_value(TypeId type);
    /// Target of a command's result.
    struct ResultPlace {
        const Symbol* variable = nullptr; ///< null: a facet
        FacetPlace facet{};
    };
    constexpr ResultPlace parse_result_place();
    constexpr void store_result(const Token& at, const ResultPlace& to, TypeId type, DataOffset from);

    // ---- statements with their own flow

    constexpr void parse_if(const Token& at);
    /// Creates a branching node: `pending_` is the exit if the condition holds, `otherwise` if it does not.
    constexpr NodeIndex parse_branch(const Token& at, Chain& otherwise);
    constexpr void parse_while(const Token& at);
    constexpr void parse_for(const Token& at);
    /// Parses a statement in the brackets of a for: var, set, do, or an assignment without "set".
    constexpr void parse_step_statement();
    /// Returns the number of iterations of "i < c; i = i + d"; 0: not of that form. Only reads ahead.
    constexpr std::uint64_t count_rounds(const Symbol& counter, std::int64_t from);
    static constexpr std::uint64_t rounds_between(Sign how, std::int64_t from, std::int64_t to,
                                                  std::int64_t by) noexcept;

    constexpr void parse_try();
    constexpr void parse_wait(const Token& at);
    /// Returns where a time is kept while the program waits.
    constexpr DataOffset persistent_time(const Token& at, const Operand& value);
    /// Parses "timeout 5s": the node fails when no other arc was open until then.
    constexpr void parse_timeout(NodeIndex node);
    constexpr void parse_return(const Token& at) {
        begin_action();
        if (frame_ == nullptr) return fail(at, {"found \"return\" outside of a program"});
        if (frame_->result != nullptr) {
            const Token where = token_;
            store(where, parse_expression(frame_->result), frame_->result, frame_->slot,
                  frame_->is_function ? " as the function returns" : " as the program returns");
        } else if (!is(Sign::semicolon) && !is(Sign::close_brace) && !is(Sign::end)) {
            return fail(token_, {"found a value, but the ", frame_->is_function ? "function" : "program",
                                 " returns nothing"});
        }
        join(frame_->exits, add_arc(end_action(at)));
        pending_ = no_chain;
    }

    // ---- actions

    constexpr void parse_do(const Token& at);
    constexpr void fail_unknown_action(const Token& name);
    constexpr void parse_action(const Token& at, const Token& name, std::uint16_t component,
                                std::uint16_t number);
    /// Starts own commands in this step; sends those of others. The exit opens when the command is done
    /// (thesis 5.1.5); a separate node fetches its results.
    constexpr void parse_command(const Token& at, const Token& name, std::uint16_t component,
                                 std::uint16_t number);

    // ---- child machines, and programs beside

    constexpr void parse_machine_command(const Token& at, std::uint16_t child);
    /// Starts a program with its parameters and waits for its end; or a word that controls it.
    constexpr void parse_program_command(const Token& at, const Token& name, InstanceIndex program);
    constexpr void parse_set_in_machine(const Token& at, std::uint16_t child);

    Loop* loop_ = nullptr;
    Frame* frame_ = nullptr;
    Operand last_value_{};
};

} // namespace tappet::script_detail
