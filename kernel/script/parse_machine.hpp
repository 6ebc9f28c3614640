// State machines: their variables, parameters, functions and child machines, and the checks of a whole one.
#pragma once

#include "kernel/script/parse_state.hpp"
#include "kernel/statechart/check.hpp"

namespace tappet::script_detail {

/// Variables of whole types, and the arguments of their instances.
class Parameters {
public:
    constexpr Parameters(Basis& basis, Expressions& expressions) : basis_{basis}, expressions_{expressions} {}

    /// Parses "name" or "name = value" of a variable of a whole type.
    constexpr void parse_variable(TypeId type, VariableKind kind) {
        const Token name = text_.need_name("the name");
        if (!text_.ok()) return;
        if (kind == VariableKind::constant) {
            text_.need(Sign::assign, "\"=\" and the constant's value");
            return scope_.declare(name, fixed_symbol(expressions_.parse_constant(type, "a constant")));
        }
        Operand value;
        const Token where = text_.token();
        const bool given = text_.take(Sign::assign);
        if (given) value = expressions_.parse_constant(type, "the first value of a variable");
        DataOffset at = 0;
        std::byte* const bytes = out_.add_variable(type->size, at);
        if (!text_.ok()) return;
        if (given && value.literal) {
            if (!encode(value, type, bytes))
                return static_cast<void>(values_.fail_type(where, value.type, type_name(type), ""));
        } else if (given) {
            std::copy_n(out_.constant_bytes(value.at), type->size, bytes);
        }
        if (out_.variables.used < max_script_nodes)
            required_.put(out_.variables.used, kind == VariableKind::parameter && !given);
        out_.add(out_.variables, VariableRow{out_.keep({name.text}), type, at, kind}, "variables");
        scope_.declare(name, Symbol{.operand = at_place(type, at)});
    }
    /// Parses "(1, 2)" or "(first = 1, second = 2)" for the parameters of a type.
    constexpr ArgumentList parse_arguments(const Token& at, TypeIndex type) {
        const auto variables = out_.types[type].tables.variables;
        std::array<bool, 64> given{};
        ArgumentList list{static_cast<std::uint16_t>(arguments_used_)};
        if (text_.take(Sign::open_round)) {
            while (text_.ok() && !text_.is(Sign::close_round)) {
                const std::size_t variable = parse_argument(type, list.count);
                if (!text_.ok()) return list;
                if (variable < given.size()) given[variable] = true;
                ++list.count;
                text_.need_comma();
            }
            text_.need(Sign::close_round, "\")\"");
        }
        const auto base = static_cast<std::size_t>(variables.data() - out_.variables.room.data());
        for (std::size_t i = 0; text_.ok() && i < variables.size() && i < given.size(); ++i)
            if (!given[i] && base + i < max_script_nodes && required_.has(base + i))
                text_.fail(at, {"the parameter \"", variables[i].name, "\" of \"", out_.types[type].name,
                                "\" has no default; give it an argument"});
        return list;
    }
    /// Writes arguments into the initial data of an instance.
    constexpr void write(ArgumentList list, const ProgramTables& tables, std::span<std::byte> image) const {
        for (const Argument& each : std::span{arguments_}.subspan(list.first, list.count)) {
            const VariableRow& variable = tables.variables[each.variable];
            static_cast<void>(encode(each.value, variable.type, image.data() + variable.at));
        }
    }
    constexpr void forget(ArgumentList list) noexcept { arguments_used_ = list.first; }

private:
    /// Parses the argument `number`; returns the variable that it is for.
    constexpr std::size_t parse_argument(TypeIndex type, std::size_t number) {
        const auto variables = out_.types[type].tables.variables;
        const Token name = text_.token();
        const std::size_t variable = find_parameter(variables, number);
        if (text_.ok() && variable == variables.size())
            text_.fail(name, {"found more arguments than \"", out_.types[type].name, "\" has parameters"});
        if (!text_.ok()) return 0;
        const TypeId wanted = variables[variable].type;
        const Token where = text_.token();
        const Operand value = expressions_.parse_known(wanted, "an argument of a state machine");
        if (text_.ok() && !value.literal)
            text_.fail(where, {"an argument of a state machine is a number, a time, a boolean, a text or the "
                               "name of a value"});
        std::byte bytes[sizeof(ScriptText)] = {};
        if (text_.ok() && (wanted->size > sizeof bytes || !encode(value, wanted, bytes)))
            values_.fail_type(where, value.type, type_name(wanted), " as an argument");
        if (arguments_used_ == arguments_.size()) text_.fail_limit("arguments of state machines");
        if (text_.ok()) arguments_[arguments_used_++] = {static_cast<std::uint16_t>(variable), value};
        return variable;
    }
    /// Reads "name =", if it is there; returns the parameter of that name, or the one with the number.
    constexpr std::size_t find_parameter(std::span<const VariableRow> variables, std::size_t number) {
        const Token name = text_.token();
        const Reader::Place before = text_.here();
        const bool named = text_.take(Sign::name) && text_.take(Sign::assign);
        if (!named) text_.go_to(before);
        for (std::size_t i = 0; i < variables.size(); ++i)
            if (variables[i].kind == VariableKind::parameter &&
                (named ? variables[i].name == name.text : number-- == 0))
                return i;
        if (named) {
            Nearest nearest{name.text};
            for (const VariableRow& each : variables)
                if (each.kind == VariableKind::parameter) nearest.consider(each.name);
            text_.fail_unknown(name, "parameter", nearest, " of the type");
        }
        return variables.size();
    }
    /// A scalar or text for a parameter.
    struct Argument {
        std::uint16_t variable = 0;
        Operand value{};
    };

    Basis& basis_;
    Reader& text_ = basis_.text;
    Emitter& out_ = basis_.out;
    Values& values_ = basis_.values;
    Scope& scope_ = basis_.scope;
    Expressions& expressions_;
    std::array<Argument, 48> arguments_{};
    std::size_t arguments_used_ = 0;
    NodeSet required_{}; // parameters without a default, numbered across all types
};

class Machines {
public:
    constexpr Machines(Basis& basis, Parameters& parameters, Statements& statements, States& states)
        : basis_{basis}, parameters_{parameters}, statements_{statements}, states_{states} {}

    /// Parses "StateMachine name { ... }".
    constexpr void parse() {
        text_.advance();
        name_ = text_.need_name("the name of the type of state machine");
        if (find_type(name_.text) != none)
            text_.fail(name_, {"\"", quoted(name_.text), "\" is there twice; rename one"});
        text_.need(Sign::open_brace, "\"{\"");
        if (!text_.ok()) return;
        out_.begin_type();
        states_.begin_machine();
        const std::size_t functions = scope_.functions().size();
        const Scope::Mark outer = scope_.open();
        const std::string_view name = out_.keep({name_.text});
        while (text_.ok() && !text_.is(Sign::close_brace)) parse_member();
        text_.need(Sign::close_brace, "\"}\"");
        scope_.close(outer);
        scope_.forget_functions(functions);
        if (text_.ok() && out_.states.count() == 0)
            return text_.fail(name_, {"state machine \"", quoted(name_.text),
                                      "\" has no state; give it an initial and a final one"});
        states_.resolve_names();
        BehaviourType* const type = out_.end_type(name);
        if (type == nullptr) return;
        type->machine = {.name = name,
                         .states = out_.states.view(),
                         .transitions = out_.transitions.view(),
                         .component = peers_.driven(),
                         .programs = &type->tables,
                         .captures = out_.captures.view()};
        check(type->machine);
    }
    /// Parses the type of a machine that is defined before.
    constexpr TypeIndex parse_type(std::string_view wanted, std::string_view before) {
        const Token name = text_.need_name(wanted);
        const TypeIndex type = text_.ok() ? find_type(name.text) : none;
        if (type == none) text_.fail_unknown(name, "state machine type", out_.types.view(), before);
        return type;
    }
    /// The name of the last machine, where it is defined.
    [[nodiscard]] constexpr const Token& name() const noexcept { return name_; }

private:
    [[nodiscard]] constexpr TypeIndex find_type(std::string_view name) const noexcept {
        for (std::size_t i = 0; i < out_.types.used; ++i)
            if (out_.types[i].name == name && !out_.types[i].is_program()) return static_cast<TypeIndex>(i);
        return none;
    }
    constexpr void parse_member() {
        scope_.begin_program(); // names visible to functions in a guard or an initial value
        switch (text_.token().sign) {
        case Sign::semicolon: return text_.advance();
        case Sign::k_param: return parse_variables(VariableKind::parameter);
        case Sign::k_var: return parse_variables(VariableKind::variable);
        case Sign::k_const: return parse_variables(VariableKind::constant);
        case Sign::k_function: return statements_.parse_function_definition(true);
        case Sign::k_SubStateMachine: return parse_child();
        case Sign::k_initial:
        case Sign::k_final:
        case Sign::k_state: return states_.parse();
        default: return text_.fail_expected("a state, param, var, const, function or SubStateMachine");
        }
    }
    constexpr void parse_variables(VariableKind kind) {
        text_.advance();
        const TypeId type = peers_.parse_type();
        do parameters_.parse_variable(type, kind);
        while (text_.ok() && text_.take(Sign::comma));
        text_.skip(Sign::semicolon);
    }
    constexpr void parse_child() {
        text_.advance();
        Child child;
        child.type = parse_type("the type of the child machine", " before this one");
        const Token name = text_.need_name("the name of the child machine");
        if (!text_.ok()) return;
        child.parent = static_cast<TypeIndex>(out_.types.used);
        child.number = behaviours_.count_children(child.parent);
        child.arguments = parameters_.parse_arguments(name, child.type);
        child.name = out_.keep({name.text});
        behaviours_.add(child);
        scope_.declare(name, fixed_symbol(SymbolKind::machine, behaviours_.children().size() - 1));
        text_.skip(Sign::semicolon);
    }
    constexpr void check(const StateMachineTable& machine) {
        if (const Sentence fault = statechart::check_limits(machine); !fault.empty())
            return text_.fail(name_, {fault.view()});
        const StateHierarchy names{machine};
        statechart::Checker checker{names};
        const Sentence fault = checker.check();
        if (fault.empty()) return;
        Token at = name_;
        if (checker.line() != 0) at.line = checker.line(), at.column = checker.column();
        text_.fail(at, {fault.view()});
    }

    Basis& basis_;
    Reader& text_ = basis_.text;
    Emitter& out_ = basis_.out;
    Scope& scope_ = basis_.scope;
    Peers& peers_ = basis_.peers;
    Behaviours& behaviours_ = basis_.behaviours;
    Parameters& parameters_;
    Statements& statements_;
    States& states_;
    Token name_{};
};

} // namespace tappet::script_detail
