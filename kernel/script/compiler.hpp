// A whole script: types, programs, and their instances.
#pragma once

#include "kernel/script/parse_machine.hpp"

namespace tappet::script_detail {

class Compiler {
public:
    constexpr Compiler(std::string_view text, std::string_view file, const Reach& reach,
                       const ScriptRoom& room, ScriptOutcome& outcome)
        : outcome_{outcome}, basis_{text, file, reach, room, outcome} {}

    constexpr void compile() {
        text_.advance();
        if (basis_.reach.components.empty())
            text_.fail({"there is no component that the script could drive"});
        while (text_.has_more(Sign::end)) {
            switch (text_.token().sign) {
            case Sign::semicolon: text_.advance(); break;
            case Sign::k_StateMachine: machines_.parse(); break;
            case Sign::k_RootStateMachine: parse_root(); break;
            case Sign::k_program: parse_named_program(); break;
            case Sign::k_function: statements_.parse_function_definition(false); break;
            default: parse_bare_program(); break;
            }
        }
        if (text_.ok() && out_.types.used == 0)
            text_.fail({"the script is empty; give it a program or a StateMachine"});
        if (text_.ok() && count_programs(out_.types.room, out_.instances.view()) == out_.instances.used)
            add_implied_root();
        finish();
    }
    /// Compiles statements, or one expression, whose value is the result.
    constexpr void compile_line() {
        calls_.set_purpose(Purpose::line);
        text_.advance();
        if (basis_.reach.components.empty()) text_.fail({"there is no component that the line could name"});
        if (text_.is(Sign::end)) text_.fail({"the line is empty; write an expression or a statement"});
        if (begins_statement(text_.token().sign))
            parse_program(text_.token(), text_.file(), true, nullptr);
        else
            parse_expression();
        finish();
    }

private:
    static constexpr bool begins_statement(Sign sign) noexcept {
        constexpr Sign signs[] = {Sign::open_brace, Sign::semicolon, Sign::k_do,      Sign::k_set,
                                  Sign::k_var,      Sign::k_const,   Sign::k_if,      Sign::k_while,
                                  Sign::k_for,      Sign::k_try,     Sign::k_wait,    Sign::k_yield,
                                  Sign::k_return,   Sign::k_break,   Sign::k_continue};
        return std::ranges::find(signs, sign) != std::end(signs);
    }

    // ---- programs

    constexpr void parse_expression() {
        calls_.set_purpose(Purpose::line_expression);
        out_.begin_type();
        const std::string_view name = out_.keep({text_.file()});
        const ProgramIndex program = flow_.begin_program({text_.file()});
        flow_.begin_action();
        const Token at = text_.token();
        const Operand value = values_.reckoned(at, expressions_.parse());
        text_.skip(Sign::semicolon);
        if (text_.ok() && !text_.is(Sign::end))
            text_.fail({"found \"", quoted(text_.token().text),
                        "\" after the expression; a line is one expression, or statements that begin with "
                        "do, set, var, if, wait ..."});
        if (!text_.ok()) return;
        const DataOffset result = out_.add_variable("value", value.type, VariableKind::result);
        values_.store(at, value, value.type, result, "");
        flow_.end_statement(at);
        static_cast<void>(flow_.end_program(program, no_chain));
        end_program_type(at, name, false);
    }
    /// Ends the type of a program and adds its instance.
    constexpr void end_program_type(const Token& at, std::string_view name, bool on_command) {
        const BehaviourType* const type = out_.end_type(name);
        check_instance_name(at, name);
        if (!text_.ok()) return;
        out_.add(out_.instances,
                 BehaviourInstance{.name = name,
                                   .type = static_cast<TypeIndex>(out_.types.used - 1),
                                   .on_command = on_command,
                                   .image = type->tables.image},
                 "instances");
    }
    /// "program name { ... }": one instance of its own type. "program [type] name(type parameter, ...)
    /// { ... }" waits for its task's command and, with a type, returns a result.
    constexpr void parse_named_program() {
        text_.advance();
        Token name = text_.need_word("the name of the program, or the type of its result");
        TypeId result = nullptr;
        if (text_.ok() && text_.is(Sign::name)) {
            result = peers_.find_type(name.text);
            if (result == nullptr) text_.fail(name, {"found \"", quoted(name.text), "\", expected a type"});
            name = text_.token();
            text_.advance();
        }
        if (text_.ok() && name.sign != Sign::name)
            text_.fail(name, {"found \"", quoted(name.text), "\", expected the name of the program"});
        parse_program(name, name.text, false, result);
        text_.need(Sign::close_brace, "\"}\"");
    }
    constexpr void parse_parameters() {
        while (text_.ok() && !text_.is(Sign::close_round)) {
            const TypeId type = peers_.parse_type();
            if (text_.ok()) parameters_.parse_variable(type, VariableKind::parameter);
            text_.need_comma();
        }
        text_.need(Sign::close_round, "\")\"");
    }
    /// Statements alone are one program, named after the file.
    constexpr void parse_bare_program() {
        if (text_.is(Sign::broken) || out_.types.used != 0)
            return text_.fail_expected("StateMachine, RootStateMachine, program or function");
        std::string_view name = text_.file().substr(text_.file().rfind('/') + 1);
        name = name.substr(0, name.find('.'));
        parse_program(text_.token(), name, true, nullptr);
    }
    constexpr void parse_program(Token at, std::string_view name, bool to_the_end, TypeId result) {
        if (!text_.ok()) return;
        out_.begin_type();
        const std::string_view kept = out_.keep({name});
        const Scope::Mark outer = scope_.mark();
        const bool on_command = !to_the_end && text_.take(Sign::open_round);
        if (on_command) parse_parameters();
        Frame frame{.result = result};
        if (result != nullptr) {
            if (!on_command)
                return text_.fail(at,
                                  {"nothing asks \"", quoted(name),
                                   "\" for its result; give it a list of parameters, which may be empty"});
            frame.slot = out_.add_variable("return", result, VariableKind::result);
        }
        if (!to_the_end) text_.need(Sign::open_brace, "\"{\"");
        const ProgramIndex program = statements_.parse_program({name}, to_the_end, frame, true);
        scope_.close(outer);
        if (text_.ok() && program == no_program)
            return text_.fail(to_the_end ? text_.token() : at, {"the program has no statement"});
        end_program_type(at, kept, on_command);
    }
    constexpr void check_instance_name(const Token& at, std::string_view name) {
        for (const BehaviourInstance& each : out_.instances.view())
            if (each.name == name)
                return text_.fail(at, {"\"", quoted(name), "\" is there twice; rename one"});
    }

    // ---- instances of state machines

    /// "RootStateMachine Type name(arguments)"
    constexpr void parse_root() {
        text_.advance();
        const TypeIndex type = machines_.parse_type("the type of the state machine", " before this line");
        const Token name = text_.need_name("the name of the state machine");
        if (!text_.ok()) return;
        check_instance_name(name, name.text);
        const ArgumentList arguments = parameters_.parse_arguments(name, type);
        add_root(name, out_.keep({name.text}), type, arguments);
        parameters_.forget(arguments);
        text_.skip(Sign::semicolon);
    }
    /// Without RootStateMachine, the last type of state machine gets one instance.
    constexpr void add_implied_root() {
        std::size_t last = out_.types.used;
        while (last != 0 && out_.types[last - 1].is_program()) --last;
        if (last == 0) return;
        const auto type = static_cast<TypeIndex>(last - 1);
        const Token at = machines_.name();
        static_cast<void>(parameters_.parse_arguments(at, type));
        add_root(at, out_.types[type].name, type, {});
    }
    constexpr void add_root(const Token& at, std::string_view name, TypeIndex type, ArgumentList arguments) {
        if (!text_.ok()) return;
        std::uint32_t i = out_.instances.used;
        add_instance(name, type, no_instance, arguments);
        for (; text_.ok() && i < out_.instances.used; ++i) {
            BehaviourInstance& instance = out_.instances[i];
            std::uint32_t depth = 1;
            for (InstanceIndex outer = instance.parent; outer != no_instance;
                 outer = out_.instances[outer].parent)
                ++depth;
            if (depth > basis_.reach.depth)
                return text_.fail(at, {"child machines are nested deeper than ",
                                       text_.digits(basis_.reach.depth), " levels, which its row allows"});
            for (const Child& child : behaviours_.children()) {
                if (!text_.ok() || child.parent != instance.type) continue;
                if (instance.children++ == 0)
                    instance.first_child = static_cast<InstanceIndex>(out_.instances.used);
                add_instance(out_.keep({instance.name, ".", child.name}), child.type,
                             static_cast<InstanceIndex>(i), child.arguments);
            }
        }
    }
    constexpr void add_instance(std::string_view name, TypeIndex type, InstanceIndex parent,
                                ArgumentList arguments) {
        if (!text_.ok()) return;
        const ProgramTables& tables = out_.types[type].tables;
        BehaviourInstance instance{.name = name, .type = type, .parent = parent, .image = tables.image};
        if (arguments.count != 0) {
            const auto own = out_.add_image(tables.image.size());
            if (!text_.ok()) return;
            std::copy_n(tables.image.data(), own.size(), own.data());
            parameters_.write(arguments, tables, own);
            instance.image = own;
        }
        out_.add(out_.instances, instance, "instances");
    }

    // ---- the result

    constexpr void finish() {
        if (text_.ok()) count_needs();
        if (text_.ok() && out_.reach.room.size() < basis_.reach.components.size())
            text_.fail_room("components");
        if (text_.ok()) {
            // They may be stored there already.
            if (out_.reach.room.data() != basis_.reach.components.data())
                std::copy_n(basis_.reach.components.data(), basis_.reach.components.size(),
                            out_.reach.room.data());
            const ScriptUnit unit{.name = out_.keep({text_.file()}),
                                  .types = out_.types.view(),
                                  .instances = out_.instances.view(),
                                  .reach = out_.reach.room.first(basis_.reach.components.size()),
                                  .command_slots = static_cast<std::uint16_t>(outcome_.sizes.command_slots)};
            if (text_.ok()) outcome_.unit = unit;
        }
        out_.count_rows(outcome_.sizes);
        outcome_.sizes.reach = static_cast<std::uint32_t>(basis_.reach.components.size());
    }
    /// Sums up what all instances need at run time, and checks that the slot has it.
    constexpr void count_needs() {
        ScriptSizes& s = outcome_.sizes;
        for (const BehaviourInstance& each : out_.instances.view()) {
            const BehaviourType& type = out_.types[each.type];
            s.data += aligned(type.tables.layout.size, data_alignment);
            for (const LinkRow& row : type.tables.links) s.command_slots += row.needs_slot ? 1 : 0;
            for (const TransitionRow& row : type.machine.transitions) s.timers += row.timed ? 1 : 0;
            for (const NodeRow& node : type.tables.nodes)
                for (const ArcRow& arc : type.tables.arcs.subspan(node.first_arc, node.arcs))
                    if (arc.after != no_data) {
                        ++s.timers;
                        break;
                    }
        }
        if (s.command_slots > basis_.reach.command_slots)
            return text_.fail({"the script sends ", text_.digits(s.command_slots),
                               " commands and its slot has room for ",
                               text_.digits(basis_.reach.command_slots),
                               "; send fewer or give its row more command_slots(...)"});
        if (s.timers > basis_.reach.timers)
            text_.fail({"the script waits for time at ", text_.digits(s.timers),
                        " places and its slot has room for ", text_.digits(basis_.reach.timers),
                        "; wait at fewer or give its row more timers(...)"});
    }

    ScriptOutcome& outcome_;
    Basis basis_;
    Reader& text_ = basis_.text;
    Emitter& out_ = basis_.out;
    Values& values_ = basis_.values;
    Scope& scope_ = basis_.scope;
    Peers& peers_ = basis_.peers;
    Behaviours& behaviours_ = basis_.behaviours;
    Flow& flow_ = basis_.flow;
    Expressions expressions_{basis_, calls_};
    Calls calls_{basis_, expressions_};
    Statements statements_{basis_, expressions_, calls_, actions_};
    Actions actions_{basis_, expressions_, calls_, statements_};
    Parameters parameters_{basis_, expressions_};
    States states_{basis_, expressions_, statements_};
    Machines machines_{basis_, parameters_, statements_, states_};
};

} // namespace tappet::script_detail
