// State machines: states with their programs, transitions, and the checks of a complete machine.
#pragma once

#include "kernel/script/compiler_beside.hpp"
#include "kernel/script/compiler_children.hpp"
#include "kernel/statechart/check.hpp"

namespace tappet::script_detail {

class Machines : protected Statements {
protected:
    using Statements::Statements;

    constexpr void parse_machine() {
        advance();
        machine_name_ = need_name("the name of the type of state machine");
        if (find_machine_type(machine_name_.text) != none)
            fail(machine_name_, {"\"", quoted(machine_name_.text), "\" is there twice; rename one"});
        need(Sign::open_brace, "\"{\"");
        if (!ok()) return;
        begin_type();
        const std::size_t symbols = symbols_used_, scope = scope_, functions = functions_used_;
        scope_ = symbols_used_;
        unresolved_used_ = 0;
        command_scope_ = 0;
        state_heads_ = {};
        const std::string_view name = keep({machine_name_.text});
        while (ok() && !is(Sign::close_brace)) parse_member();
        need(Sign::close_brace, "\"}\"");
        symbols_used_ = symbols;
        scope_ = scope;
        functions_used_ = functions;
        resolve_names();
        BehaviourType type;
        type.name = name;
        end_type(type);
    }
    constexpr void end_type(const BehaviourType& made_type) {
        if (!ok()) return;
        const std::uint16_t number = add(types_, made_type, "types");
        if (!ok()) return;
        BehaviourType& type = types_.room[number];
        lay_out(type.tables);
        if (states_.count() == 0) return;
        type.machine.name = type.name;
        type.machine.states = states_.view();
        type.machine.transitions = transitions_.view();
        type.machine.component = reach_.components[0].type->tag;
        type.machine.programs = &type.tables;
        type.machine.captures = captures_.view();
        check_machine(type.machine);
    }
    [[nodiscard]] constexpr TypeIndex find_machine_type(std::string_view name) const noexcept {
        for (std::size_t i = 0; i < types_.used; ++i)
            if (types_.room[i].name == name && !types_.room[i].is_program()) return static_cast<TypeIndex>(i);
        return none;
    }
    /// Parses the type of a machine that is defined before.
    constexpr TypeIndex parse_machine_type(std::string_view wanted, std::string_view before) {
        const Token name = need_name(wanted);
        const TypeIndex type = ok() ? find_machine_type(name.text) : none;
        if (ok() && type == none) {
            Nearest nearest{name.text};
            for (std::size_t i = 0; i < types_.used; ++i) nearest.consider(types_.room[i].name);
            fail_unknown(name, "state machine type", nearest, before);
        }
        return type;
    }

    /// Parses "name" or "name = value" of a variable of a whole type.
    constexpr void parse_variable_of(TypeId type, VariableKind kind) {
        const Token name = need_name("the name");
        if (!ok()) return;
        Symbol symbol;
        if (kind == VariableKind::constant) {
            need(Sign::assign, "\"=\" and the constant's value");
            symbol.kind = SymbolKind::value;
            symbol.fixed = true;
            symbol.operand = known_value(type, "a constant");
            return declare(name, symbol);
        }
        Operand value;
        const Token where = token_;
        const bool given = take(Sign::assign);
        if (given) value = known_value(type, "the first value of a variable");
        DataOffset at = 0;
        std::byte* const bytes = add_variable(type->size, at);
        if (!ok()) return;
        if (given && value.literal) {
            if (!encode(value, type, bytes)) return fail_type(where, value.type, type_name(type), "");
        } else if (given) {
            std::copy_n(constant_bytes(value.at), type->size, bytes);
        }
        if (variables_.used < max_script_nodes)
            required_.put(variables_.used, kind == VariableKind::parameter && !given);
        add(variables_, VariableRow{keep({name.text}), type, at, kind}, "variables");
        symbol.kind = SymbolKind::variable;
        symbol.operand = at_place(type, at);
        declare(name, symbol);
    }

    /// Parses "(1, 2)" or "(first = 1, second = 2)" for the parameters of a type; returns how many.
    constexpr std::uint16_t parse_machine_arguments(const Token& at, TypeIndex type) {
        const auto variables = types_.room[type].tables.variables;
        std::array<bool, 64> given{};
        std::uint16_t count = 0;
        const auto parameter_at = [&](std::size_t wanted) {
            for (std::size_t i = 0; i < variables.size(); ++i)
                if (variables[i].kind == VariableKind::parameter && wanted-- == 0) return i;
            return variables.size();
        };
        if (take(Sign::open_round)) {
            while (ok() && !is(Sign::close_round)) {
                const Token name = token_;
                std::size_t variable = parameter_at(count);
                const Place before = here();
                if (is(Sign::name)) {
                    advance();
                    if (take(Sign::assign)) {
                        for (variable = 0; variable < variables.size(); ++variable)
                            if (variables[variable].name == name.text &&
                                variables[variable].kind == VariableKind::parameter)
                                break;
                        if (variable == variables.size()) {
                            Nearest nearest{name.text};
                            for (const VariableRow& each : variables)
                                if (each.kind == VariableKind::parameter) nearest.consider(each.name);
                            fail_unknown(name, "parameter", nearest, " of the type");
                        }
                    } else {
                        go_to(before);
                    }
                }
                if (ok() && variable == variables.size())
                    fail(name, {"found more arguments than \"", types_.room[type].name, "\" has parameters"});
                if (!ok()) return 0;
                const TypeId wanted = variables[variable].type;
                const Token where = token_;
                const Operand value = parse_known(wanted, "an argument of a state machine");
                if (!ok()) return 0;
                if (!value.literal) {
                    fail(where,
                         {"an argument of a state machine is a number, a time, a boolean, a text or the "
                          "name of a value"});
                    return 0;
                }
                std::byte bytes[sizeof(ScriptText)] = {};
                if (wanted->size > sizeof bytes || !encode(value, wanted, bytes)) {
                    fail_type(where, value.type, type_name(wanted), " as an argument");
                    return 0;
                }
                if (arguments_used_ == arguments_.size()) {
                    fail_limit("arguments of state machines");
                    return 0;
                }
                arguments_[arguments_used_++] = {type, static_cast<std::uint16_t>(variable), value};
                if (variable < given.size()) given[variable] = true;
                ++count;
                if (!is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
            }
            need(Sign::close_round, "\")\"");
        }
        const auto base = static_cast<std::size_t>(variables.data() - variables_.room.data());
        for (std::size_t i = 0; ok() && i < variables.size() && i < given.size(); ++i)
            if (!given[i] && base + i < max_script_nodes && required_.has(base + i))
                fail(at, {"the parameter \"", variables[i].name, "\" of \"", types_.room[type].name,
                          "\" has no default; give it an argument"});
        return count;
    }

private:
    constexpr void parse_member() {
        const Token at = token_;
        program_symbols_ = symbols_used_; // names visible to functions in a guard or an initial value
        switch (at.sign) {
        case Sign::semicolon: advance(); return;
        case Sign::k_param: advance(); return parse_variable(VariableKind::parameter);
        case Sign::k_var: advance(); return parse_variable(VariableKind::variable);
        case Sign::k_const: advance(); return parse_variable(VariableKind::constant);
        case Sign::k_function: return parse_function_definition(true);
        case Sign::k_SubStateMachine: advance(); return parse_child();
        case Sign::k_initial:
        case Sign::k_final:
        case Sign::k_state: return parse_state({}, {});
        default: return fail_expected("a state, param, var, const, function or SubStateMachine");
        }
    }
    constexpr void parse_variable(VariableKind kind) {
        const TypeId type = parse_type();
        do parse_variable_of(type, kind);
        while (ok() && take(Sign::comma));
        static_cast<void>(take(Sign::semicolon));
    }
    constexpr void parse_child() {
        const TypeIndex type = parse_machine_type("the type of the child machine", " before this one");
        const Token name = need_name("the name of the child machine");
        if (!ok()) return;
        Child child;
        child.parent = static_cast<TypeIndex>(types_.used);
        child.type = type;
        for (std::size_t i = 0; i < children_used_; ++i)
            if (children_[i].parent == child.parent) ++child.number;
        child.first_argument = static_cast<std::uint16_t>(arguments_used_);
        child.arguments = parse_machine_arguments(name, type);
        child.name = keep({name.text});
        if (children_used_ == children_.size()) return fail_limit("child machines");
        Symbol symbol;
        symbol.kind = SymbolKind::machine;
        symbol.fixed = true;
        symbol.number = static_cast<std::uint16_t>(children_used_);
        children_[children_used_++] = child;
        declare(name, symbol);
        static_cast<void>(take(Sign::semicolon));
    }

    // ---- states

    constexpr void parse_state(std::string_view parent, std::string_view region) {
        if (!enter()) return;
        const std::uint16_t outer_scope = state_scope_;
        StateRow row;
        row.line = token_.line;
        row.column = token_.column;
        row.parent = parent;
        row.region = region;
        for (;;) {
            if (take(Sign::k_initial))
                row.initial = true;
            else if (take(Sign::k_final))
                row.final = true;
            else
                break;
        }
        need(Sign::k_state, "\"state\"");
        const Token name = need_name("the name of the state");
        if (ok() && find_state_row(name.text, name.hash) != nullptr)
            fail(name, {"state \"", quoted(name.text), "\" is there twice; rename one"});
        if (states_.count() == max_states) fail_limit("states in one machine");
        if (!ok()) return;
        row.name = keep({name.text});
        if (is(Sign::k_in)) {
            advance();
            const Token outer = need_name("the name of the state around this one");
            if (ok() && !parent.empty())
                fail(outer, {"this state is inside of \"", parent, "\" already; leave out \"in\""});
            row.parent = outer.text;
            if (take(Sign::k_region)) {
                const Token named = need_name("the name of the region");
                row.region = ok() ? keep({named.text}) : std::string_view{};
            }
        }
        const std::uint16_t number = add(states_, row, "states");
        if (!ok()) return;
        std::uint16_t& head = state_heads_[name.hash % state_heads_.size()];
        state_next_[number] = head;
        head = static_cast<std::uint16_t>(number + 1);
        // When a state names its enclosing state, its depth is not known yet.
        state_outer_[number] = row.parent == parent ? outer_scope : alone;
        state_scope_ = run_scope(number);
        if (need(Sign::open_brace, "\"{\"")) parse_state_body(number);
        state_scope_ = outer_scope;
        leave();
    }
    /// Programs of a machine that may run at the same time: the run programs of a state and of its enclosing
    /// states, those of different regions, and the current program, whose scope is 0. Sibling states of one
    /// region are never active together and share a scope: that of the first.
    [[nodiscard]] constexpr std::uint16_t run_scope(std::uint16_t number) const noexcept {
        std::uint16_t first = number;
        if (state_outer_[number] != alone)
            for (first = 0; state_outer_[first] != state_outer_[number] ||
                            states_[first].region != states_[number].region;)
                ++first;
        return static_cast<std::uint16_t>(first + 1);
    }
    constexpr void parse_state_body(std::uint16_t number) {
        std::array<Place, 8> preconditions{};
        std::size_t asked = 0;
        const std::string_view name = states_[number].name;
        while (ok() && !is(Sign::close_brace)) {
            const Token at = token_;
            switch (at.sign) {
            case Sign::semicolon: advance(); break;
            case Sign::k_entry: parse_state_program(number, &StateRow::entry); break;
            case Sign::k_run: parse_state_program(number, &StateRow::run); break;
            case Sign::k_exit: parse_state_program(number, &StateRow::exit); break;
            case Sign::k_handle: parse_state_program(number, &StateRow::handle); break;
            case Sign::k_precondition:
                advance();
                if (asked == preconditions.size()) fail_limit("preconditions of one state");
                if (!is(Sign::open_round)) fail_expected("\"(\" and the precondition");
                if (!ok()) break;
                preconditions[asked++] = here();
                begin_action();
                static_cast<void>(parse_condition());
                instructions_.used = instructions_.base + first_instruction_; // made once, with all of them
                break;
            case Sign::k_transitions: parse_transitions(number); break;
            case Sign::k_transition:
                advance();
                parse_transition(at, number, true);
                break;
            case Sign::k_initial:
            case Sign::k_final:
            case Sign::k_state: parse_state(name, {}); break;
            case Sign::k_region: {
                advance();
                const Token region = need_name("the name of the region");
                const std::string_view kept = ok() ? keep({region.text}) : std::string_view{};
                need(Sign::open_brace, "\"{\"");
                while (ok() && !is(Sign::close_brace)) parse_state(name, kept);
                need(Sign::close_brace, "\"}\"");
                break;
            }
            default:
                fail_expected(
                    "entry, run, exit, handle, transitions, transition, precondition or a state inside");
                break;
            }
        }
        if (asked != 0 && ok()) make_preconditions(number, std::span{preconditions}.first(asked));
        need(Sign::close_brace, "\"}\"");
    }
    constexpr void make_preconditions(std::uint16_t number, std::span<const Place> places) {
        const Place after = here();
        begin_action();
        const std::uint16_t first = first_instruction_;
        Operand all;
        Token at = places[0].token;
        for (std::size_t i = 0; ok() && i < places.size(); ++i) {
            go_to(places[i]);
            at = token_;
            const Operand one = as(at, parse_condition(), script_bool, "");
            if (!ok()) return;
            if (i == 0) {
                all = one;
                continue;
            }
            const OperatorMatch both = find_binary(Operator::both, script_bool, script_bool);
            Instruction in = both.instruction;
            in.a = all.at;
            in.b = one.at;
            in.to = scratch(1);
            emit(in);
            all = at_place(script_bool, in.to);
        }
        const ConditionIndex condition = make_condition(at, first, all);
        if (ok()) states_[number].precondition = ConditionRef{condition};
        go_to(after);
    }
    constexpr void parse_state_program(std::uint16_t number, ProgramRef StateRow::* part) {
        const Token at = token_;
        advance();
        if (!(states_[number].*part).empty())
            return fail(
                at, {"state \"", states_[number].name, "\" has \"", at.text, "\" twice; put both into one"});
        need(Sign::open_brace, "\"{\"");
        command_scope_ = part == &StateRow::run ? state_scope_ : std::uint16_t{0};
        const ProgramIndex program = parse_program({states_[number].name, ".", at.text});
        command_scope_ = 0;
        need(Sign::close_brace, "\"}\"");
        if (ok() && program != no_program) states_[number].*part = ProgramRef{program};
    }

    // ---- transitions

    constexpr void parse_transitions(std::uint16_t state);
    /// Parses after "transition", or an item of "transitions".
    constexpr void parse_transition(const Token& at, std::uint16_t state, bool may_hear);
    constexpr ProgramRef parse_branch_program(std::string_view state, std::string_view label);
    /// Parses "select State", "select history(State)", "select deep history(State)", "because" and a reason.
    constexpr bool parse_select(TransitionRow& row, std::uint16_t number, bool otherwise);
    constexpr void parse_event(TransitionRow& row);
    [[nodiscard]] constexpr bool is_event(std::string_view text, std::uint16_t component,
                                          std::string_view name) const noexcept {
        if (component == 0) return text == name;
        const std::string_view peer = reach_.components[component].name;
        return text.size() == peer.size() + 1 + name.size() && text.starts_with(peer) &&
               text.ends_with(name) && text[peer.size()] == '.';
    }
    /// Stores arguments in variables, before the guard is evaluated.
    constexpr void parse_captures(TransitionRow& row, const Token& event, std::span<const TypeId> types);

    // ---- when all states are known

    constexpr const StateRow* find_state_row(std::string_view name, std::uint32_t hash) const noexcept {
        for (std::uint16_t i = state_heads_[hash % state_heads_.size()]; i != 0; i = state_next_[i - 1])
            if (states_[i - 1].name == name) return &states_[i - 1];
        return nullptr;
    }
    constexpr const StateRow* find_state_row(std::string_view name) const noexcept {
        return find_state_row(name, hash_of(name));
    }
    /// Replaces names of states by copies that outlive the text.
    constexpr void resolve_names() {
        if (ok() && states_.count() == 0)
            return fail(machine_name_, {"state machine \"", quoted(machine_name_.text),
                                        "\" has no state; give it an initial and a final one"});
        for (std::size_t i = 0; ok() && i < states_.count(); ++i) {
            StateRow& row = states_[i];
            if (row.parent.empty()) continue;
            Token at;
            at.text = row.parent;
            at.line = row.line;
            at.column = row.column;
            row.parent = resolved(at);
        }
        for (std::size_t i = 0; ok() && i < unresolved_used_; ++i) {
            Token at;
            TransitionRow& row = transitions_[unresolved_[i].transition];
            std::string_view& name = unresolved_[i].otherwise ? row.otherwise_to : row.to;
            at.text = name;
            at.line = unresolved_[i].line;
            at.column = unresolved_[i].column;
            name = resolved(at);
        }
        for (std::size_t i = 0; ok() && unresolved_used_ == unresolved_.size() && i < transitions_.count();
             ++i) {
            TransitionRow& row = transitions_[i];
            Token at;
            at.line = row.line;
            at.column = row.column;
            at.text = row.to;
            if (!row.to.empty()) row.to = resolved(at);
            at.text = row.otherwise_to;
            if (!row.otherwise_to.empty()) row.otherwise_to = resolved(at);
        }
    }
    constexpr std::string_view resolved(const Token& name) {
        if (const StateRow* const row = find_state_row(name.text); row != nullptr) return row->name;
        Nearest nearest{name.text};
        for (const StateRow& each : states_.view()) nearest.consider(each.name);
        fail_unknown(name, "state", nearest, "");
        return {};
    }
    constexpr void check_machine(const StateMachineTable& machine) {
        if (const Sentence fault = statechart::check_limits(machine); !fault.empty())
            return fail(machine_name_, {fault.view()});
        const StateHierarchy names{machine};
        statechart::Checker checker{names};
        const Sentence fault = checker.check();
        if (fault.empty()) return;
        Token at = machine_name_;
        if (checker.line() != 0) at.line = checker.line(), at.column = checker.column();
        fail(at, {fault.view()});
    }

    struct Unresolved {
        std::uint16_t transition = 0;
        bool otherwise = false;
        std::uint16_t line = 0;
        std::uint16_t column = 0;
    };

public:
    [[nodiscard]] constexpr Token machine_name_token() const noexcept { return machine_name_; }

private:
    Token machine_name_{};
    static constexpr std::uint16_t alone = 0xffff;
    std::uint16_t state_scope_ = 0;                       // of the run program of the current state
    std::array<std::uint16_t, max_states> state_outer_{}; // scope of the enclosing state
    std::array<Unresolved, 192> unresolved_{};
    std::size_t unresolved_used_ = 0;
    std::array<std::uint16_t, 64> state_heads_{}; // by the hash of the name: 1 + the last such state's number
    std::array<std::uint16_t, max_states> state_next_{};
    NodeSet required_{}; // parameters without a default, numbered across all types
};

} // namespace tappet::script_detail
