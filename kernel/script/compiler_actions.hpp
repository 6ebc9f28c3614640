// Statements that act: assignments, calls, commands.
#pragma once

#include "kernel/script/compiler_statements.hpp"

namespace tappet::script_detail {

constexpr void Statements::parse_set(const Token& at) {
    const Token name = need_word("the name of a variable, output or property");
    if (!ok()) return;
    begin_action();
    if (Symbol* const symbol = find_symbol(name); symbol != nullptr) {
        if (symbol->kind == SymbolKind::machine) return parse_set_in_machine(at, symbol->number);
        if (symbol->fixed || symbol->kind != SymbolKind::variable)
            return fail(name,
                        {"\"", symbol->name, "\" cannot be assigned: it is ",
                         symbol->kind == SymbolKind::function   ? "a function"
                         : symbol->kind == SymbolKind::variable ? "the counter of a loop between constants"
                                                                : "a constant or an argument"});
        return parse_set_place(at, symbol->operand);
    }
    const FacetPlace place = parse_facet_place(name);
    if (!ok()) return;
    need(Sign::assign, "\"=\"");
    const Token where = token_;
    Operand value = assigned_value(place.action.type);
    value = as(where, value, place.action.type, "");
    act(place.action, place.component, place.number, no_data, value.at);
    pending_ = add_arc(end_action(at));
}

constexpr Statements::FacetPlace Statements::parse_facet_place(const Token& name) {
    FacetPlace place;
    Token facet_name = name;
    if (is(Sign::dot) && find_component(name.text) != none) {
        place.component = find_component(name.text);
        advance();
        facet_name = need_word("the name of an output or property");
    } else if (find_facet(std::uint16_t{0}, name.text) == none) {
        fail_unknown_value(name, nullptr);
    }
    place.number = ok() ? parse_facet(place.component, facet_name) : none;
    if (place.number == none) return place;
    const Facet& facet = facet_of(place.component, place.number);
    place.action = find_write(facet);
    if (!place.action)
        fail(facet_name, {"\"", quoted(facet.name), "\" is ", to_text(facet.kind),
                          ", which cannot be assigned; outputs, properties and variables can"});
    else if (facet.kind != FacetKind::property && place.component != 0)
        fail_foreign(facet_name, place.component, facet, "writes it");
    else
        check_near(facet_name, place.component, to_text(facet.kind));
    return place;
}

constexpr void Statements::parse_set_place(const Token& at, Operand place) {
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
        if (!is(Sign::assign)) return fail_expected("\"=\" after an index that is not constant");
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

constexpr Operand Statements::assigned_value(TypeId type) {
    Function* const function = statement_function();
    if (function == nullptr) return parse_expression(type);
    if (instruction_count() != first_instruction_)
        fail(token_,
             {"function \"", function->name, "\" has statements; put its result into a variable first"});
    const TypeId result = function->result;
    const DataOffset slot = expand(*function, true);
    begin_action();
    return ok() ? at_place(result, slot) : Operand{};
}

constexpr void Statements::parse_do(const Token& at) {
    if (Function* const function = statement_function(); function != nullptr) {
        static_cast<void>(expand(*function, false));
        return;
    }
    const Token name = need_word("what to do: a method, command, operation, event or function");
    if (!ok()) return;
    begin_action();
    if (Symbol* const symbol = find_symbol(name); symbol != nullptr) {
        if (symbol->kind == SymbolKind::machine) return parse_machine_command(at, symbol->number);
        return fail(name, {"\"", symbol->name, "\" is ",
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
        if (const InstanceIndex program = find_program(name.text); program != no_instance)
            return parse_program_command(at, name, program);
        return fail_unknown_action(name);
    }
    const std::uint16_t number = ok() ? parse_facet(component, facet_name) : none;
    if (number != none) parse_action(at, facet_name, component, number);
}

constexpr void Statements::fail_unknown_action(const Token& name) {
    if (is(Sign::dot)) {
        Nearest nearest{name.text};
        for (const Reachable& each : reach_.components) nearest.consider(each.name);
        for (std::size_t i = 0; i < symbols_used_; ++i) nearest.consider(symbols_[i].name);
        return fail_unknown(name, "component", nearest, "");
    }
    fail_unknown_value(name, nullptr);
}

constexpr void Statements::parse_action(const Token& at, const Token& name, std::uint16_t component,
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
            return fail_foreign(name, component, facet, "emits it");
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
        if (component != 0) return fail_foreign(name, component, facet, "writes it");
        need(Sign::dot, is_buffer ? "\".push(value)\"" : "\".write(value)\"");
        const Token part = need_word("push or write");
        if (ok() && part.text != (is_buffer ? "push" : "write"))
            return fail(part, {"found \"", quoted(part.text), "\", expected ", is_buffer ? "push" : "write"});
        if (!ok()) return;
        const DataOffset value = scratch(facet.type->size);
        parse_arguments({&facet.type, 1}, value);
        act(find_write(facet), component, number, no_data, value);
        break;
    }
    default:
        return fail(name, {"\"", quoted(facet.name), "\" is ", to_text(facet.kind),
                           ", which cannot be executed; methods, commands, operations and events can"});
    }
    pending_ = add_arc(end_action(at));
}

constexpr void Statements::parse_command(const Token& at, const Token& name, std::uint16_t component,
                                         std::uint16_t number) {
    const Facet& facet = facet_of(component, number);
    const CommandOperations& command = *facet.command;
    const bool is_own = component == 0;
    check_reach(name, component, facet.name, reach_.operations, "operations");
    const DataOffset packed =
        is_own ? place_in(Region::arguments, std::max<std::size_t>(command.value_bytes(), 1))
        : command.argument_bytes != 0 ? scratch(command.argument_bytes)
                                      : no_data;
    std::array<ResultPlace, 8> results{};
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
        const ResultPlace place = parse_result_place();
        if (ok() && result_count == results.size()) return fail_limit("results of one command");
        if (ok()) results[result_count++] = place;
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
    DataOffset from = no_data;
    if (is_own) {
        from = moved(packed, command.argument_bytes);
    } else {
        Instruction fetch = command_results(facet).instruction;
        fetch.link = slot;
        fetch.to = from = scratch(command.result_bytes);
        emit(fetch);
    }
    for (std::size_t i = 0; ok() && i < result_count; ++i) {
        const TypeId type = command.results->elements[i];
        store_result(at, results[i], type, from);
        from = moved(from, type->size);
    }
    pending_ = add_arc(end_action(at));
}

constexpr Statements::ResultPlace Statements::parse_result_place() {
    const Token result = need_word("the variable or property that receives this result");
    ResultPlace place{ok() ? find_symbol(result) : nullptr};
    if (ok() && place.variable == nullptr)
        place.facet = parse_facet_place(result);
    else if (ok() && (place.variable->fixed || place.variable->kind != SymbolKind::variable))
        fail(result, {"\"", quoted(result.text),
                      "\" cannot be assigned; a result of a command needs a variable or a property"});
    return place;
}

constexpr void Statements::store_result(const Token& at, const ResultPlace& to, TypeId type,
                                        DataOffset from) {
    const Operand value = reckoned(at, at_place(type, from));
    if (to.variable != nullptr)
        store(at, value, to.variable->operand.type, to.variable->operand.at, " as a result");
    else
        act(to.facet.action, to.facet.component, to.facet.number, no_data,
            as(at, value, to.facet.action.type, " as a result").at);
}

} // namespace tappet::script_detail
