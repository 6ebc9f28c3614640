// Statements: each becomes a node, or a few.
#pragma once

#include "kernel/script/compiler_flow.hpp"

namespace tappet::script_detail {

class Statements : protected Flow {
protected:
    using Flow::Flow;

    /// "{ ... }" or one statement.
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
        case Sign::k_yield: {
            advance();
            begin_action();
            const NodeIndex node = end_action(at);
            if (ok()) nodes_[node].yields = true, waits_.put(node, true);
            may_wait_ = true;
            pending_ = add_arc(node);
            break;
        }
        case Sign::k_break:
        case Sign::k_continue: {
            advance();
            if (loop_ == nullptr) {
                fail(at, {"found \"", at.text, "\" outside of a loop"});
                break;
            }
            const Chain arc = pass(at);
            join(at.sign == Sign::k_break ? loop_->breaks : loop_->continues, arc);
            break;
        }
        default:
            fail_expected("a statement: do, set, var, if, while, for, wait, yield, return, try or a block");
            break;
        }
        static_cast<void>(take(Sign::semicolon));
        leave();
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
    /// The statements of a program, up to the closing brace that is not theirs.
    constexpr ProgramIndex parse_program(std::initializer_list<std::string_view> name,
                                         bool to_the_end = false) {
        const ProgramIndex number = begin_program(name);
        Frame frame;
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
        if (functions_used_ == functions_.size()) fail_room("functions");
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
    /// Of the program, or of the function that is expanded in it.
    struct Frame {
        TypeId result = nullptr;
        DataOffset slot = no_data;
        Chain exits = no_chain;
        bool is_function = false;
    };

    /// Whether properties of the program: its outermost variables (thesis 5.1.6).
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
                    result = expand(*function, type);
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
    /// A constant's value: a literal, or bytes among the constants.
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
    /// The function with statements that is called next, if one is.
    constexpr Function* statement_function() {
        if (!is(Sign::name)) return nullptr;
        const Symbol* const symbol = find_symbol(token_);
        if (symbol == nullptr || symbol->kind != SymbolKind::function || functions_[symbol->number].is_value)
            return nullptr;
        return &functions_[symbol->number];
    }
    /// The function's statements, here; answers where its result is.
    constexpr DataOffset expand(Function& function, TypeId wanted) {
        const Token name = token_;
        advance();
        if (wanted != nullptr && function.result == nullptr) {
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

    constexpr void parse_set(const Token& at) {
        const Token name = need_word("the name of a variable, output or property");
        if (!ok()) return;
        begin_action();
        if (Symbol* const symbol = find_symbol(name); symbol != nullptr) {
            if (symbol->kind == SymbolKind::machine) return parse_set_in_machine(at, symbol->number);
            if (symbol->fixed || symbol->kind != SymbolKind::variable)
                return fail(name, {"\"", symbol->name, "\" is not to be assigned: it is ",
                                   symbol->kind == SymbolKind::function ? "a function"
                                   : symbol->kind == SymbolKind::variable
                                       ? "the counter of a loop between constants"
                                       : "a constant or an argument"});
            return parse_set_place(at, symbol->operand);
        }
        std::uint16_t component = 0;
        Token facet_name = name;
        if (is(Sign::dot) && find_component(name.text) != none) {
            component = find_component(name.text);
            advance();
            facet_name = need_word("the name of an output or property");
        } else if (find_facet(std::uint16_t{0}, name.text) == none) {
            return fail_unknown_value(name, nullptr);
        }
        const std::uint16_t number = ok() ? parse_facet(component, facet_name) : none;
        if (number == none) return;
        const Facet& facet = facet_of(component, number);
        const FacetAction action = find_write(facet);
        if (!action)
            return fail(facet_name, {"\"", quoted(facet.name), "\" is ", to_text(facet.kind),
                                     ", which is not to be assigned; outputs, properties and variables are"});
        if (facet.kind != FacetKind::property && component != 0)
            return fail(facet_name, {"\"", quoted(facet.name), "\" is an output of \"",
                                     reach_.components[component].name, "\", which alone writes it"});
        check_near(facet_name, component, to_text(facet.kind));
        need(Sign::assign, "\"=\"");
        const Token where = token_;
        Operand value = assigned_value(action.type);
        value = as(where, value, action.type, "");
        act(action, component, number, no_data, value.at);
        pending_ = add_arc(end_action(at));
    }
    /// A variable or a part of one.
    constexpr void parse_set_place(const Token& at, Operand place) {
        while (ok() && (is(Sign::dot) || is(Sign::open_square))) {
            if (is(Sign::dot)) {
                place = take_part(place);
                continue;
            }
            const Index index = parse_index(place.type);
            if (!ok()) return;
            const TypeId element = place.type->element;
            if (index.is_known) {
                place = at_place(element, moved(place.at, index.number * element->size));
                continue;
            }
            Instruction in = element_write(place.type);
            if (in.run == nullptr)
                return fail(at, {"elements of a ", type_name(place.type), " cannot be written"});
            if (!is(Sign::assign)) return fail_expected("\"=\" behind an index that is not constant");
            advance();
            const Token where = token_;
            const Operand value = as(where, parse_expression(element), element, "");
            in.to = place.at;
            in.a = value.at;
            in.b = index.at;
            emit(in);
            pending_ = add_arc(end_action(at));
            return;
        }
        if (!need(Sign::assign, "\"=\"")) return;
        const Token where = token_;
        const Operand value = assigned_value(place.type);
        store(where, value, place.type, place.at, "");
        pending_ = add_arc(end_action(at));
    }
    constexpr Operand assigned_value(TypeId type) {
        Function* const function = statement_function();
        if (function == nullptr) return parse_expression(type);
        if (instruction_count() != first_instruction_)
            fail(token_,
                 {"function \"", function->name, "\" has statements; put its result into a variable first"});
        const TypeId result = function->result;
        const DataOffset slot = expand(*function, type);
        begin_action();
        return ok() ? at_place(result, slot) : Operand{};
    }

    // ---- what takes a way of its own

    constexpr void parse_if(const Token& at) {
        Chain otherwise = no_chain;
        parse_branch(at, otherwise);
        static_cast<void>(take(Sign::k_then));
        parse_statement();
        if (!take(Sign::k_else)) return join(pending_, otherwise);
        const Chain behind = pending_;
        pending_ = otherwise;
        parse_statement();
        join(pending_, behind);
    }
    /// A node that asks: `pending_` is the way when it is so, `otherwise` when it is not.
    constexpr NodeIndex parse_branch(const Token& at, Chain& otherwise) {
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
    constexpr void parse_while(const Token& at) {
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
    constexpr void parse_for(const Token& at) {
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
                ? count_rounds(*counter, last_value_.whole)
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
            if (is(Sign::end) || is(Sign::broken)) fail_expected("\")\" behind the step of the loop");
            if (is(Sign::open_round)) ++depth;
            if (is(Sign::close_round)) --depth;
        }
        need(Sign::close_round, "\")\"");
        if (rounds != 0) counter->fixed = true;
        parse_statement();
        if (rounds != 0) counter->fixed = false;
        join(pending_, loop.continues);
        const Place behind = here();
        go_to(step);
        if (!is(Sign::close_round)) parse_step_statement();
        if (ok() && !is(Sign::close_round)) fail_expected("\")\" behind the step of the loop");
        go_to(behind);
        lead(pending_, head);
        check_loop(at, head, cost, rounds);
        pending_ = otherwise;
        join(pending_, loop.breaks);
        loop_ = outer;
        symbols_used_ = symbols;
        scope_ = scope;
    }
    /// In the brackets of a for: var, set, do, or an assignment without "set".
    constexpr void parse_step_statement() {
        const Token at = token_;
        if (is(Sign::name)) return parse_set(at);
        if (take(Sign::k_var)) return parse_local(at, false);
        if (take(Sign::k_set)) return parse_set(at);
        if (take(Sign::k_do)) return parse_do(at);
        fail_expected("var, set, do or an assignment");
    }
    /// How often "i < c; i = i + d" lets a loop run; 0: it is not of that form. Reads ahead only.
    constexpr std::uint64_t count_rounds(const Symbol& counter, std::int64_t from) {
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
            into = is(Sign::integer) ? token_.whole : named->operand.whole;
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

    constexpr void parse_try() {
        const NodeIndex first = static_cast<NodeIndex>(nodes_.count());
        const std::uint16_t first_arc = static_cast<std::uint16_t>(arcs_.count());
        const bool outer = in_try_;
        in_try_ = true;
        parse_statement();
        in_try_ = outer;
        if (!need(Sign::k_catch, "\"catch\" and what is done when an action failed")) return;
        const Token at = token_;
        const auto last = static_cast<NodeIndex>(nodes_.count());
        const auto last_arc = static_cast<std::uint16_t>(arcs_.count());
        const Chain behind = pending_;
        pending_ = no_chain;
        if (ok() && first == last) return fail(at, {"there is nothing in this try that could fail"});
        pending_ = pass(at); // where failures lead, whatever the catch holds
        for (NodeIndex n = first; ok() && n < last; ++n)
            if (nodes_[n].on_error == to_catch) nodes_[n].on_error = last;
        for (std::uint16_t a = first_arc; ok() && a < last_arc; ++a)
            if (arcs_[a].to == to_catch) arcs_[a].to = last;
        parse_statement();
        join(pending_, behind);
    }
    constexpr void parse_wait(const Token& at) {
        begin_action();
        const Token where = token_;
        const Operand value = parse_expression();
        may_wait_ = true;
        if (!ok()) return;
        if (script_type(value.type) == script_bool) {
            // Asked in each step anew, so its instructions are those of the arc and not of the node.
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
        if (ok()) waits_.put(node, value.literal && value.whole > 0);
        ++timers_;
        pending_ = add_arc(node, no_condition, time);
    }
    /// Where a time stays while the program waits.
    constexpr DataOffset persistent_time(const Token& at, const Operand& value) {
        if (value.literal) return constant(at, value, script_duration, "").at;
        const DataOffset to = place_in(Region::arguments, sizeof(Duration));
        store(at, value, script_duration, to, "");
        return to;
    }
    /// "timeout 5s": the node fails when nothing else was open until then.
    constexpr void parse_timeout(NodeIndex node) {
        if (!take(Sign::k_timeout)) return;
        const Token where = token_;
        const Operand value = parse_known(script_duration, "a time-out");
        if (!ok()) return;
        if (value.type != script_duration) return fail_type(where, value.type, "a duration such as 5s", "");
        const DataOffset time = constant(where, value, script_duration, "").at;
        const Chain arc = add_arc(node, no_condition, time);
        if (ok()) arcs_[arc].to = in_try_ ? to_catch : no_node;
        ++timers_;
    }
    constexpr void parse_return(const Token& at) {
        begin_action();
        if (frame_ == nullptr) return fail(at, {"found \"return\" outside of a program"});
        if (frame_->is_function && frame_->result != nullptr) {
            const Token where = token_;
            store(where, parse_expression(frame_->result), frame_->result, frame_->slot,
                  " as the function returns");
        } else if (!is(Sign::semicolon) && !is(Sign::close_brace) && !is(Sign::end)) {
            return fail(token_, {"found a value, but ", frame_->is_function ? "the function" : "a program",
                                 " returns nothing"});
        }
        join(frame_->exits, add_arc(end_action(at)));
        pending_ = no_chain;
    }

    // ---- actions

    constexpr void parse_do(const Token& at) {
        if (Function* const function = statement_function(); function != nullptr) {
            static_cast<void>(expand(*function, nullptr));
            return;
        }
        const Token name = need_word("what to do: a method, command, operation, event or function");
        if (!ok()) return;
        begin_action();
        if (Symbol* const symbol = find_symbol(name); symbol != nullptr) {
            if (symbol->kind == SymbolKind::machine) return parse_machine_command(at, symbol->number);
            return fail(name,
                        {"\"", symbol->name, "\" is ",
                         symbol->kind == SymbolKind::function ? "a function of one value; use the value"
                                                              : "a variable; write \"set\" to assign it"});
        }
        std::uint16_t component = 0;
        Token facet_name = name;
        if (is(Sign::dot) && find_component(name.text) != none) {
            component = find_component(name.text);
            advance();
            facet_name = need_word("the name of a method, command, operation or event");
        } else if (find_facet(std::uint16_t{0}, name.text) == none) {
            return fail_unknown_action(name);
        }
        const std::uint16_t number = ok() ? parse_facet(component, facet_name) : none;
        if (number != none) parse_action(at, facet_name, component, number);
    }
    constexpr void fail_unknown_action(const Token& name) {
        if (is(Sign::dot)) {
            Nearest nearest{name.text};
            for (const Reachable& each : reach_.components) nearest.consider(each.name);
            for (std::size_t i = 0; i < symbols_used_; ++i) nearest.consider(symbols_[i].name);
            return fail_unknown(name, "component", nearest, "");
        }
        fail_unknown_value(name, nullptr);
    }
    constexpr void parse_action(const Token& at, const Token& name, std::uint16_t component,
                                std::uint16_t number) {
        const Facet& facet = facet_of(component, number);
        switch (facet.kind) {
        case FacetKind::method: {
            check_call(name, component, facet);
            const FacetAction action = do_method(facet);
            const DataOffset packed =
                facet.method->argument_bytes != 0 ? scratch(facet.method->argument_bytes) : no_data;
            parse_arguments(facet.type->elements, packed);
            act(action, component, number,
                facet.method->result_bytes != 0 ? scratch(facet.method->result_bytes) : no_data, packed);
            break;
        }
        case FacetKind::operation:
        case FacetKind::event: {
            if (facet.kind == FacetKind::operation)
                check_call(name, component, facet);
            else if (component != 0)
                return fail(name, {"\"", quoted(facet.name), "\" is an event of \"",
                                   reach_.components[component].name, "\", which alone emits it"});
            const DataOffset packed = facet.type->size != 0 ? scratch(facet.type->size) : no_data;
            parse_arguments(facet.type->elements, packed);
            act(facet.kind == FacetKind::event ? emit_event(facet) : call_operation(facet), component, number,
                no_data, packed);
            break;
        }
        case FacetKind::command: return parse_command(at, name, component, number);
        case FacetKind::buffer_output:
        case FacetKind::output: {
            const bool is_buffer = facet.kind == FacetKind::buffer_output;
            if (component != 0)
                return fail(name, {"\"", quoted(facet.name), "\" is an output of \"",
                                   reach_.components[component].name, "\", which alone writes it"});
            need(Sign::dot, is_buffer ? "\".push(value)\"" : "\".write(value)\"");
            const Token part = need_word("push or write");
            if (ok() && part.text != (is_buffer ? "push" : "write"))
                return fail(part,
                            {"found \"", quoted(part.text), "\", expected ", is_buffer ? "push" : "write"});
            if (!ok()) return;
            const DataOffset value = scratch(facet.type->size);
            parse_arguments({&facet.type, 1}, value);
            act(find_write(facet), component, number, no_data, value);
            break;
        }
        default:
            return fail(name, {"\"", quoted(facet.name), "\" is ", to_text(facet.kind),
                               ", which is not to be done; methods, commands, operations and events are"});
        }
        pending_ = add_arc(end_action(at));
    }
    /// Own commands begin here and now; those of others are sent. The way on opens when the command is done
    /// (thesis 5.1.5); its results are fetched by a node of their own.
    constexpr void parse_command(const Token& at, const Token& name, std::uint16_t component,
                                 std::uint16_t number) {
        const Facet& facet = facet_of(component, number);
        const CommandOperations& command = *facet.command;
        const bool is_own = component == 0;
        check_reach(name, component, facet.name, reach_.operations, "operations");
        const DataOffset packed =
            is_own ? place_in(Region::arguments, std::max<std::size_t>(command.value_bytes(), 1))
                   : scratch(std::max<std::size_t>(command.argument_bytes, 1));
        std::array<Operand, 8> results{};
        std::size_t result_count = 0, input_at = 0, input = 0;
        if (!need(Sign::open_round, "\"(\" and the arguments")) return;
        const auto all = facet.type->elements;
        for (std::size_t i = 0; ok() && i < all.size(); ++i) {
            if (i != 0 && !is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
            if (input < command.arguments->elements.size() && command.arguments->elements[input] == all[i]) {
                parse_argument(all[i], moved(packed, input_at), i, all.size());
                input_at += all[i]->size;
                ++input;
                continue;
            }
            const Token result = need_name("the variable that receives this result");
            const Symbol* const symbol = ok() ? find_symbol(result) : nullptr;
            if (ok() && (symbol == nullptr || symbol->fixed || symbol->kind != SymbolKind::variable))
                return fail(result, {"\"", quoted(result.text),
                                     "\" is no variable; a result of a command needs one"});
            if (ok() && result_count == results.size()) return fail_room("results of one command");
            if (ok()) results[result_count++] = symbol->operand;
        }
        end_arguments(all.size());
        if (!ok()) return;
        const std::uint16_t slot = link(component, number, !is_own);
        Instruction in = (is_own ? begin_command(facet) : send_command(facet)).instruction;
        in.link = slot;
        (is_own ? in.to : in.a) = packed;
        emit(in);
        const NodeIndex node = end_action(at);
        if (ok()) waits_.put(node, !is_own);
        may_wait_ = true;
        const std::uint16_t first = instruction_count();
        in = (is_own ? command_progress(facet) : command_ended(facet)).instruction;
        in.link = slot;
        in.to = scratch(1);
        if (is_own) in.a = packed;
        emit(in);
        pending_ = add_arc(node, make_condition(at, first, at_place(script_bool, in.to)));
        parse_timeout(node);
        if (result_count == 0 || !ok()) return;
        begin_action();
        DataOffset from = moved(packed, command.argument_bytes);
        if (!is_own) {
            Instruction fetch = command_results(facet).instruction;
            fetch.link = slot;
            fetch.to = from = scratch(command.result_bytes);
            emit(fetch);
        }
        for (std::size_t i = 0; ok() && i < result_count; ++i) {
            const TypeId type = command.results->elements[i];
            const Operand value = reckoned(at, at_place(type, from));
            store(at, value, results[i].type, results[i].at, " as a result");
            from = moved(from, type->size);
        }
        pending_ = add_arc(end_action(at));
    }

    // ---- child machines

    constexpr void parse_machine_command(const Token& at, std::uint16_t child);
    constexpr void parse_set_in_machine(const Token& at, std::uint16_t child);

    Loop* loop_ = nullptr;
    Frame* frame_ = nullptr;
    Operand last_value_{};
};

} // namespace tappet::script_detail
