// Statements that act or wait: assignments, calls, commands, waits.
#pragma once

#include "kernel/script/parse_statement.hpp"

namespace tappet::script_detail {

class Actions {
public:
    constexpr Actions(Basis& basis, Expressions& expressions, Calls& calls, Statements& statements)
        : basis_{basis}, expressions_{expressions}, calls_{calls}, statements_{statements} {}

    /// Parses an assignment after "set".
    constexpr void parse_set(const Token& at) {
        const Token name = text_.need_word("the name of a variable, output or property");
        if (!text_.ok()) return;
        flow_.begin_action();
        if (const Symbol* const symbol = scope_.find(name); symbol != nullptr) {
            if (symbol->kind == SymbolKind::machine) return parse_set_in_machine(at, symbol->number);
            if (symbol->assignable()) return parse_set_place(at, symbol->operand);
            return text_.fail(name, {"\"", symbol->name, "\" cannot be assigned: it is ",
                                     symbol->kind == SymbolKind::function ? "a function"
                                     : symbol->kind == SymbolKind::variable
                                         ? "the counter of a loop between constants"
                                         : "a constant or an argument"});
        }
        const FacetPlace place = parse_facet_place(name);
        if (!text_.ok()) return;
        text_.need(Sign::assign, "\"=\"");
        const Token where = text_.token();
        const Operand value = values_.as(where, parse_assigned(place.action.type), place.action.type, "");
        peers_.act(place.action, place.facet, no_data, value.at);
        flow_.end_statement(at);
    }
    /// Parses after "do".
    constexpr void parse_do(const Token& at) {
        if (Function* const function = statements_.next_function(); function != nullptr) {
            static_cast<void>(statements_.expand(*function, false));
            return;
        }
        Token name = text_.need_word("what to do: a method, command, operation, event or function");
        if (!text_.ok()) return;
        flow_.begin_action();
        if (const Symbol* const symbol = scope_.find(name); symbol != nullptr) {
            if (symbol->kind != SymbolKind::machine)
                return text_.fail(name, {"\"", symbol->name, "\" is ",
                                         symbol->kind == SymbolKind::function
                                             ? "a function of one value; use the value"
                                             : "a variable; write \"set\" to assign it"});
            if (behaviours_.parse_machine_command(symbol->number)) flow_.end_statement(at);
            return;
        }
        const PeerFacet facet = peers_.parse_facet(name, "the name of a method, command, operation or event");
        if (facet) return parse_action(at, name, facet);
        if (!text_.ok()) return;
        if (const InstanceIndex program = behaviours_.find_program(name.text); program != no_instance)
            return parse_program_command(at, name, program);
        if (!text_.is(Sign::dot)) return expressions_.fail_unknown(name, nullptr);
        Nearest nearest{name.text};
        peers_.consider_components(nearest);
        scope_.consider_all(nearest);
        text_.fail_unknown(name, "component", nearest, "");
    }
    constexpr void parse_wait(const Token& at) {
        flow_.begin_action();
        const Token where = text_.token();
        const Operand value = expressions_.parse();
        if (!text_.ok()) return;
        if (script_type(value.type) == script_bool) {
            // Evaluated again in each step, so its instructions belong to the arc and not to the node.
            const ConditionIndex condition = flow_.add_condition(where, flow_.first_instruction(), value);
            const NodeIndex node = flow_.end_wait(at, false);
            if (text_.ok()) out_.nodes[node].count = 0;
            flow_.pending = flow_.add_arc(node, condition);
            return parse_timeout(node);
        }
        if (script_type(value.type) != script_duration)
            return static_cast<void>(values_.fail_type(where, value.type, "a condition or a duration", ""));
        DataOffset time = no_data; // kept while the program waits
        if (value.literal) {
            time = values_.constant(where, value, script_duration, "").at;
        } else {
            time = out_.place_in(Region::arguments, sizeof(Duration));
            values_.store(where, value, script_duration, time, "");
        }
        const NodeIndex node = flow_.end_wait(at, value.literal && value.integer > 0);
        flow_.pending = flow_.add_arc(node, no_condition, time);
    }
    constexpr void parse_yield(const Token& at) {
        flow_.begin_action();
        const NodeIndex node = flow_.end_wait(at, true);
        if (text_.ok()) out_.nodes[node].yields = true;
        flow_.pending = flow_.add_arc(node);
    }

private:
    // ---- assignments

    /// An assignable output or property.
    struct FacetPlace {
        PeerFacet facet{};
        FacetAction action{};
    };
    /// Parses after the first word of its name.
    constexpr FacetPlace parse_facet_place(Token name) {
        FacetPlace place{peers_.parse_facet(name, "the name of an output or property")};
        if (!place.facet) {
            expressions_.fail_unknown(name, nullptr);
            return place;
        }
        const Facet& facet = *place.facet;
        place.action = find_write(facet);
        if (!place.action)
            text_.fail(name, {"\"", quoted(facet.name), "\" is ", to_text(facet.kind),
                              ", which cannot be assigned; outputs, properties and variables can"});
        else if (facet.kind != FacetKind::property && place.facet.component != 0)
            peers_.fail_foreign(name, place.facet, "writes it");
        else
            peers_.check_near(name, place.facet, to_text(facet.kind));
        return place;
    }
    /// Parses a variable or a part of one after its name.
    constexpr void parse_set_place(const Token& at, Operand place) {
        while (text_.ok() && (text_.is(Sign::dot) || text_.is(Sign::open_square))) {
            if (text_.is(Sign::dot)) {
                place = expressions_.parse_part(place);
                continue;
            }
            const Expressions::Index index = expressions_.parse_index(place.type);
            if (!text_.ok()) return;
            const TypeId element = place.type->element;
            if (index.is_known) {
                place = at_place(element, moved(place.at, index.number * element->size));
                continue;
            }
            Instruction in = element_write(place.type);
            if (in.run == nullptr)
                return text_.fail(at, {"elements of a ", type_name(place.type), " cannot be written"});
            if (!text_.need(Sign::assign, "\"=\" after an index that is not constant")) return;
            in.to = place.at;
            in.a = expressions_.parse_as(element).at;
            in.b = index.at;
            out_.emit(in);
            return flow_.end_statement(at);
        }
        if (!text_.need(Sign::assign, "\"=\"")) return;
        const Token where = text_.token();
        values_.store(where, parse_assigned(place.type), place.type, place.at, "");
        flow_.end_statement(at);
    }
    constexpr void parse_set_in_machine(const Token& at, std::uint16_t child) {
        Instruction in;
        const VariableRow* const variable = behaviours_.parse_machine_variable(child, in);
        if (variable == nullptr || !text_.need(Sign::assign, "\"=\"")) return;
        in.a = expressions_.parse_as(variable->type).at;
        out_.emit(in);
        flow_.end_statement(at);
    }
    constexpr Operand parse_assigned(TypeId type) {
        Function* const function = statements_.next_function();
        if (function == nullptr) return expressions_.parse(type);
        if (flow_.has_instructions())
            text_.fail(
                {"function \"", function->name, "\" has statements; put its result into a variable first"});
        return statements_.expand(*function, true);
    }

    // ---- calls

    constexpr void parse_action(const Token& at, const Token& name, PeerFacet named) {
        const Facet& facet = *named;
        switch (facet.kind) {
        case FacetKind::method: {
            peers_.check_call(name, named);
            const FacetAction action = do_method(facet);
            const DataOffset packed = calls_.scratch_for(facet.method->argument_bytes);
            calls_.parse_arguments(facet.type->elements, packed);
            peers_.act(action, named, calls_.scratch_for(facet.method->result_bytes), packed);
            break;
        }
        case FacetKind::operation:
        case FacetKind::event: {
            if (facet.kind == FacetKind::operation)
                peers_.check_call(name, named);
            else if (named.component != 0)
                return peers_.fail_foreign(name, named, "emits it");
            const DataOffset packed = calls_.scratch_for(facet.type->size);
            calls_.parse_arguments(facet.type->elements, packed);
            peers_.act(facet.kind == FacetKind::event ? emit_event(facet) : call_operation(facet), named,
                       no_data, packed);
            break;
        }
        case FacetKind::command: return parse_command(at, name, named);
        case FacetKind::buffer_output:
        case FacetKind::output: {
            const bool is_buffer = facet.kind == FacetKind::buffer_output;
            if (named.component != 0) return peers_.fail_foreign(name, named, "writes it");
            text_.need(Sign::dot, is_buffer ? "\".push(value)\"" : "\".write(value)\"");
            const Token part = text_.need_word("push or write");
            if (text_.ok() && part.text != (is_buffer ? "push" : "write"))
                return text_.fail(
                    part, {"found \"", quoted(part.text), "\", expected ", is_buffer ? "push" : "write"});
            if (!text_.ok()) return;
            const DataOffset value = out_.scratch(facet.type->size);
            calls_.parse_arguments({&facet.type, 1}, value);
            peers_.act(find_write(facet), named, no_data, value);
            break;
        }
        default:
            return text_.fail(name,
                              {"\"", quoted(facet.name), "\" is ", to_text(facet.kind),
                               ", which cannot be executed; methods, commands, operations and events can"});
        }
        flow_.end_statement(at);
    }

    // ---- waits and commands

    /// Parses "timeout 5s": the node fails when no other arc was open until then.
    constexpr void parse_timeout(NodeIndex node) {
        if (!text_.take(Sign::k_timeout)) return;
        const Token where = text_.token();
        const Operand value = expressions_.parse_known(script_duration, "a time-out");
        if (!text_.ok()) return;
        if (value.type != script_duration)
            return static_cast<void>(values_.fail_type(where, value.type, "a duration such as 5s", ""));
        const DataOffset time = values_.constant(where, value, script_duration, "").at;
        const Chain arc = flow_.add_arc(node, no_condition, time);
        if (text_.ok()) out_.arcs[arc].to = no_node; // the target of on_error
    }
    /// Ends the node that begins a command; its exit opens when `ended` finds that the command has ended.
    /// `always`: not in the same step. Parses a time-out.
    constexpr void wait_for_end(const Token& at, bool always, const Instruction& ended) {
        const NodeIndex node = flow_.end_wait(at, always);
        const std::uint16_t first = out_.instruction_count();
        const Operand has_ended = at_place(script_bool, out_.emit_to_scratch(ended, 1));
        flow_.pending = flow_.add_arc(node, flow_.add_condition(at, first, has_ended));
        parse_timeout(node);
    }
    /// Starts own commands in this step; sends those of others. The exit opens when the command is done
    /// (thesis 5.1.5); a separate node fetches its results.
    constexpr void parse_command(const Token& at, const Token& name, PeerFacet facet) {
        const CommandOperations& command = *facet->command;
        const bool is_own = facet.component == 0;
        peers_.check_operation(name, facet);
        const DataOffset packed =
            is_own ? out_.place_in(Region::arguments, std::max<std::size_t>(command.value_bytes(), 1))
                   : calls_.scratch_for(command.argument_bytes);
        std::array<ResultPlace, 8> results{};
        std::size_t result_count = 0, input_at = 0, input = 0;
        if (!text_.need(Sign::open_round, "\"(\" and the arguments")) return;
        const auto all = facet->type->elements;
        for (std::size_t i = 0; text_.ok() && i < all.size(); ++i) {
            if (i != 0) text_.need_comma();
            if (input < command.arguments->elements.size() && command.arguments->elements[input] == all[i]) {
                calls_.parse_argument(all[i], moved(packed, input_at), i, all.size());
                input_at += all[i]->size;
                ++input;
                continue;
            }
            const ResultPlace place = parse_result_place();
            if (text_.ok() && result_count == results.size())
                return text_.fail_limit("results of one command");
            if (text_.ok()) results[result_count++] = place;
        }
        calls_.end_arguments(all.size());
        if (!text_.ok()) return;
        const std::uint16_t slot = peers_.link(facet, !is_own);
        Instruction in = (is_own ? begin_command(*facet) : send_command(*facet)).instruction;
        in.link = slot;
        (is_own ? in.to : in.a) = packed;
        out_.emit(in);
        in = (is_own ? command_progress(*facet) : command_ended(*facet)).instruction;
        in.link = slot;
        if (is_own) in.a = packed;
        wait_for_end(at, !is_own, in);
        if (result_count == 0 || !text_.ok()) return;
        flow_.begin_action();
        DataOffset from = moved(packed, command.argument_bytes);
        if (!is_own) {
            in = command_results(*facet).instruction;
            in.link = slot;
            from = out_.emit_to_scratch(in, command.result_bytes);
        }
        for (std::size_t i = 0; text_.ok() && i < result_count; ++i) {
            const TypeId type = command.results->elements[i];
            store_result(at, results[i], type, from);
            from = moved(from, type->size);
        }
        flow_.end_statement(at);
    }
    /// Starts a program with its parameters and waits for its end; or a word that controls it.
    constexpr void parse_program_command(const Token& at, const Token& name, InstanceIndex program) {
        if (text_.is(Sign::dot)) {
            behaviours_.parse_program_command(program);
            return flow_.end_statement(at);
        }
        const BehaviourInstance& commanded = out_.instances[program];
        const auto variables = out_.types[commanded.type].tables.variables;
        const std::size_t parameters = out_.types[commanded.type].parameters();
        if (!commanded.on_command)
            return text_.fail(name, {"program \"", commanded.name,
                                     "\" runs by itself; give it a list of parameters, which may "
                                     "be empty, to command it"});
        std::size_t bytes = 0;
        for (const VariableRow& each : variables.first(parameters)) bytes += each.type->size;
        const DataOffset packed = calls_.scratch_for(bytes);
        if (!text_.need(Sign::open_round, "\"(\" and the arguments")) return;
        const VariableRow* result = nullptr;
        for (const VariableRow& each : variables)
            if (each.kind == VariableKind::result) result = &each;
        const std::size_t all = parameters + (result != nullptr ? 1 : 0);
        std::size_t input_at = 0;
        ResultPlace place;
        for (std::size_t i = 0; text_.ok() && i < all; ++i) {
            if (i != 0) text_.need_comma();
            if (i == parameters) {
                place = parse_result_place();
                break;
            }
            calls_.parse_argument(variables[i].type, moved(packed, input_at), i, all);
            input_at += variables[i].type->size;
        }
        calls_.end_arguments(all);
        if (!text_.ok()) return;
        Instruction in = behaviours_.instruction(&primitive::begin_program, program);
        in.a = packed;
        out_.emit(in);
        wait_for_end(at, true, behaviours_.instruction(&primitive::program_ended, program));
        if (result == nullptr || !text_.ok()) return;
        flow_.begin_action();
        in = behaviours_.instruction(&primitive::program_result, program);
        const TypeId type = result->type;
        store_result(at, place, type, out_.emit_to_scratch(in, type->size));
        flow_.end_statement(at);
    }
    /// Target of a command's result.
    struct ResultPlace {
        const Symbol* variable = nullptr; ///< null: a facet
        FacetPlace facet{};
    };
    constexpr ResultPlace parse_result_place() {
        const Token result = text_.need_word("the variable or property that receives this result");
        ResultPlace place{text_.ok() ? scope_.find(result) : nullptr};
        if (text_.ok() && place.variable == nullptr)
            place.facet = parse_facet_place(result);
        else if (text_.ok() && !place.variable->assignable())
            text_.fail(result,
                       {"\"", quoted(result.text),
                        "\" cannot be assigned; a result of a command needs a variable or a property"});
        return place;
    }
    constexpr void store_result(const Token& at, const ResultPlace& to, TypeId type, DataOffset from) {
        const Operand value = values_.reckoned(at, at_place(type, from));
        if (to.variable != nullptr)
            return values_.store(at, value, to.variable->operand.type, to.variable->operand.at,
                                 " as a result");
        const FacetAction& action = to.facet.action;
        peers_.act(action, to.facet.facet, no_data, values_.as(at, value, action.type, " as a result").at);
    }

    Basis& basis_;
    Reader& text_ = basis_.text;
    Emitter& out_ = basis_.out;
    Values& values_ = basis_.values;
    Scope& scope_ = basis_.scope;
    Peers& peers_ = basis_.peers;
    Behaviours& behaviours_ = basis_.behaviours;
    Flow& flow_ = basis_.flow;
    Expressions& expressions_;
    Calls& calls_;
    Statements& statements_;
};

constexpr void Statements::parse_by_word(Token at) {
    switch (at.sign) {
    case Sign::open_brace: return parse_block();
    case Sign::semicolon: return text_.advance();
    case Sign::k_do: text_.advance(); return actions_.parse_do(at);
    case Sign::k_set: text_.advance(); return actions_.parse_set(at);
    case Sign::k_var: text_.advance(); return static_cast<void>(parse_variables(at));
    case Sign::k_const: text_.advance(); return parse_constants();
    case Sign::k_if: text_.advance(); return parse_if(at);
    case Sign::k_while: text_.advance(); return parse_while(at);
    case Sign::k_for: text_.advance(); return parse_for(at);
    case Sign::k_try: text_.advance(); return parse_try();
    case Sign::k_wait: text_.advance(); return actions_.parse_wait(at);
    case Sign::k_return: text_.advance(); return parse_return(at);
    case Sign::k_yield: text_.advance(); return actions_.parse_yield(at);
    case Sign::k_break:
    case Sign::k_continue: text_.advance(); return parse_jump(at);
    default:
        text_.fail_expected("a statement: do, set, var, if, while, for, wait, yield, return, try or a block");
    }
}

constexpr Operand Statements::parse_step() {
    const Token at = text_.token();
    if (text_.take(Sign::k_var)) return parse_variables(at);
    if (text_.is(Sign::name) || text_.take(Sign::k_set))
        actions_.parse_set(at);
    else if (text_.take(Sign::k_do))
        actions_.parse_do(at);
    else
        text_.fail_expected("var, set, do or an assignment");
    return {};
}

} // namespace tappet::script_detail
