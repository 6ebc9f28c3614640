// Calls and reads in expressions: functions of the script, facets of components, child machines.
#pragma once

#include "kernel/script/compiler_expressions.hpp"

namespace tappet::script_detail {

constexpr Operand Expressions::call_value(const Token& name, Function& function) {
    if (!function.is_value) {
        fail(name, {"function \"", function.name, "\" has statements; call it by \"set x = ", function.name,
                    "(...)\" or \"do\" alone, or make one return of it"});
        return {};
    }
    const Expansion expansion = begin_expansion(name, function);
    if (!ok()) return {};
    advance(); // return
    const Token at = token_;
    Operand value = parse_expression(function.result);
    if (function.result != nullptr && ok() && !value.literal)
        value = as(at, value, function.result, " as the function returns");
    end_expansion(function, expansion);
    return value;
}

constexpr Expressions::Expansion Expressions::begin_expansion(const Token& name, Function& function,
                                                              bool keeps) {
    Expansion expansion;
    if (function.expanding)
        fail(name, {"function \"", function.name, "\" calls itself; recursion has no bound, write a loop"});
    if (!enter()) return expansion;
    if (!need(Sign::open_round, "\"(\" and the arguments")) return expansion;
    expansion.symbols = symbols_used_;
    expansion.scope = scope_;
    expansion.hidden_begin = hidden_begin_;
    expansion.hidden_end = hidden_end_;
    Place parameters{function.lexer, function.token};
    while (ok()) { // alternates between the caller's text and the function's
        const Place call = here();
        go_to(parameters);
        if (is(Sign::close_round)) {
            advance();
            need(Sign::open_brace, "\"{\"");
            parameters = here();
            go_to(call);
            break;
        }
        const TypeId type = parse_type();
        const Token parameter = need_name("the name of a parameter");
        static_cast<void>(take(Sign::comma));
        parameters = here();
        go_to(call);
        const Token at = token_;
        if (is(Sign::close_round) && ok()) {
            fail(token_, {"an argument is missing: \"", quoted(parameter.text), "\" of ", function.name});
            break;
        }
        Operand value = parse_expression(type);
        if (!value.literal && ok()) {
            const DataOffset to = keeps ? place_in(Region::arguments, type->size) : scratch(type->size);
            store(at, value, type, to, " as an argument");
            value = at_place(type, to);
        } else if (ok()) {
            const Operand placed = as(at, value, type, " as an argument");
            if (value.type != type && type->kind != ValueKind::real)
                value = placed;
            else if (type == script_double)
                value = literal_of(script_double, 0, value.real);
        }
        Symbol symbol;
        symbol.kind = SymbolKind::value;
        symbol.fixed = true;
        symbol.operand = value;
        symbol.name = parameter.text; // visible after all arguments are read: until then without its hash
        if (symbols_used_ == symbols_.size())
            fail_limit("names in sight at one place");
        else
            symbols_[symbols_used_++] = symbol;
        if (!is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
    }
    need(Sign::close_round, "\")\" after the arguments");
    expansion.after = here();
    if (!ok()) return expansion;
    for (std::size_t i = expansion.symbols; i < symbols_used_; ++i) {
        const std::uint32_t hash = hash_of(symbols_[i].name);
        symbols_[i].hash = hash != 0 ? hash : 1;
    }
    hidden_begin_ = function.symbols == none ? program_symbols_ : function.symbols;
    hidden_end_ = expansion.symbols;
    scope_ = expansion.symbols;
    function.expanding = true;
    go_to(parameters);
    return expansion;
}

constexpr void Expressions::end_expansion(Function& function, const Expansion& expansion) {
    function.expanding = false;
    leave();
    symbols_used_ = expansion.symbols;
    scope_ = expansion.scope;
    hidden_begin_ = expansion.hidden_begin;
    hidden_end_ = expansion.hidden_end;
    go_to(expansion.after);
}

constexpr void Expressions::parse_arguments(std::span<const TypeId> types, DataOffset to) {
    if (!need(Sign::open_round, "\"(\" and the arguments")) return;
    std::size_t at = 0;
    for (std::size_t i = 0; ok() && i < types.size(); ++i) {
        if (i != 0 && !is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
        parse_argument(types[i], moved(to, at), i, types.size());
        at += types[i]->size;
    }
    end_arguments(types.size());
}

constexpr void Expressions::parse_argument(TypeId type, DataOffset to, std::size_t number,
                                           std::size_t count) {
    if (!ok()) return;
    const Token at = token_;
    if (is(Sign::close_round))
        return fail(at, {"found ", digits(number), " arguments, expected ", digits(count)});
    store(at, parse_expression(type), type, to, " as an argument");
}

constexpr void Expressions::end_arguments(std::size_t count) {
    if (!ok() || take(Sign::close_round)) return;
    if (is(Sign::comma)) return fail(token_, {"found more arguments, expected ", digits(count)});
    fail_expected("\")\"");
}

constexpr void Expressions::act(const FacetAction& action, std::uint16_t component, std::uint16_t facet,
                                DataOffset to, DataOffset a) {
    if (!ok()) return;
    Instruction in = action.instruction;
    in.to = to;
    in.a = a;
    in.link = link(component, facet, false);
    emit(in);
}

constexpr void Expressions::check_call(const Token& at, std::uint16_t component, const Facet& facet) {
    check_reach(at, component, facet.name, reach_.operations, "operations");
    if (ok() && !facet.any_thread && !is_near(component))
        fail(at, {"\"", quoted(facet.name), "\" of \"", reach_.components[component].name,
                  "\" is called in its own activity only; make it any_thread, or send a command"});
    if (ok() && facet.may_block)
        fail(at, {"\"", quoted(facet.name), "\" of \"", reach_.components[component].name,
                  "\" may block, and a script's statements do not; make it a command"});
}

constexpr Operand Expressions::read_method(const Token& name, std::uint16_t component, std::uint16_t number) {
    const Facet& facet = facet_of(component, number);
    check_call(name, component, facet);
    if (ok() && looks_only_ && !facet.method->is_const)
        fail(name, {"\"", quoted(facet.name), "\" may change \"", reach_.components[component].name,
                    "\", and an expression changes nothing; write \"do\" before it, or make the method "
                    "const"});
    const FacetAction action = call_method(facet);
    if (ok() && action.type == nullptr)
        fail(name, {"\"", quoted(facet.name), "\" returns nothing; write \"do\" and no value"});
    if (!ok()) return {};
    const DataOffset packed =
        facet.method->argument_bytes != 0 ? scratch(facet.method->argument_bytes) : no_data;
    parse_arguments(facet.type->elements, packed);
    if (!ok()) return {};
    const DataOffset to = scratch(action.type->size);
    act(action, component, number, to, packed);
    return made(action.type, to);
}

constexpr Operand Expressions::read_value(const Token& name, std::uint16_t component, std::uint16_t number) {
    const Facet& facet = facet_of(component, number);
    check_near(name, component, to_text(facet.kind));
    if (ok() && is(Sign::dot) && facet.kind != FacetKind::property) {
        const Place before = here();
        advance();
        const std::string_view part = token_.text;
        const FacetAction asked = part == "valid"   ? input_valid(facet)
                                  : part == "fresh" ? input_fresh(facet)
                                  : part == "age"   ? port_age(facet)
                                                    : FacetAction{};
        if (part == "value") {
            advance();
        } else if (asked) {
            advance();
            return read_by(asked, component, number);
        } else {
            go_to(before);
        }
    }
    return read_by(is_line_ ? find_look(facet) : find_read(facet), component, number);
}

constexpr Operand Expressions::read_buffer(const Token& name, std::uint16_t component, std::uint16_t number) {
    const Facet& facet = facet_of(component, number);
    check_near(name, component, "a buffer");
    if (!need(Sign::dot, "\".empty\" or \".pop()\" of the buffer")) return {};
    const Token part = need_word("empty or pop");
    if (part.text == "empty") return read_by(buffer_empty(facet), component, number);
    if (part.text != "pop")
        fail(part, {"a buffered input has empty and pop(), not \"", quoted(part.text), "\""});
    if (is_line_) fail_foreign(part, component, facet, "reads it");
    need(Sign::open_round, "\"(\"");
    need(Sign::close_round, "\")\"");
    return read_by(pop_buffer(facet), component, number);
}

constexpr Operand Expressions::push_value(const Token& name, std::uint16_t component, std::uint16_t number) {
    const Facet& facet = facet_of(component, number);
    check_near(name, component, "a buffer");
    if (is_line_) fail_foreign(name, component, facet, "writes it");
    need(Sign::dot, "\".push(value)\" of the buffer");
    const Token part = need_word("push");
    if (ok() && part.text != "push")
        fail(part, {"a buffered output has push(value), not \"", quoted(part.text), "\""});
    if (!ok()) return {};
    const DataOffset value = scratch(facet.type->size), to = scratch(1);
    parse_arguments({&facet.type, 1}, value);
    act(push_buffer(facet), component, number, to, value);
    return made(script_bool, to);
}

constexpr Operand Expressions::read_facet(const Token& name, std::uint16_t component, std::uint16_t number) {
    const Facet& facet = facet_of(component, number);
    switch (facet.kind) {
    case FacetKind::method: return read_method(name, component, number);
    case FacetKind::property:
    case FacetKind::output:
    case FacetKind::input: return read_value(name, component, number);
    case FacetKind::buffer_input: return read_buffer(name, component, number);
    case FacetKind::buffer_output: return push_value(name, component, number);
    case FacetKind::command:
        fail(name,
             {"\"", quoted(facet.name), "\" is a command, which takes time; write \"do\" and no value"});
        return {};
    default:
        fail(name, {"\"", quoted(facet.name), "\" is ", to_text(facet.kind), ", which has no value"});
        return {};
    }
}

constexpr Operand Expressions::read_by(const FacetAction& action, std::uint16_t component,
                                       std::uint16_t facet) {
    if (!ok() || action.type == nullptr) return {};
    const DataOffset to = scratch(action.type->size);
    act(action, component, facet, to, no_data);
    return made(action.type, to);
}

constexpr std::uint16_t Expressions::parse_child_state(const Child& child) {
    const Token name = token_;
    if (!is(Sign::text) && !token_.is_word()) {
        fail_expected("the name of a state");
        return 0;
    }
    advance();
    const auto states = types_.room[child.type].machine.states;
    for (std::size_t i = 0; i < states.size(); ++i)
        if (states[i].name == name.text) return static_cast<std::uint16_t>(i);
    Nearest nearest{name.text};
    for (const StateRow& each : states) nearest.consider(each.name);
    fail_unknown(name, "state", nearest, " of the child machine");
    return 0;
}

constexpr const VariableRow* Expressions::child_variable(const Child& child, const Token& word) {
    const auto variables = types_.room[child.type].tables.variables;
    for (const VariableRow& each : variables)
        if (each.name == word.text) return &each;
    Nearest nearest{word.text};
    for (const VariableRow& each : variables) nearest.consider(each.name);
    fail_unknown(word, "variable", nearest, " of the child machine");
    return nullptr;
}

} // namespace tappet::script_detail
