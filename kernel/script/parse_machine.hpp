// State machines: their variables, functions, child machines and states, and the checks of a complete one.
#pragma once

#include "kernel/script/parse_parameter.hpp"
#include "kernel/script/parse_state.hpp"
#include "kernel/statechart/check.hpp"

namespace tappet::script_detail {

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
        static_cast<void>(text_.take(Sign::semicolon));
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
        static_cast<void>(text_.take(Sign::semicolon));
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
