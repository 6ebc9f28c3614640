// A whole script: types, programs, and their instances.
#pragma once

#include "kernel/script/compiler_transitions.hpp"

namespace tappet::script_detail {

class Compiler : Machines {
public:
    using Machines::Machines;

    constexpr void compile() {
        advance();
        if (reach_.components.empty()) fail(token_, {"there is no component that the script could drive"});
        while (ok() && !is(Sign::end)) {
            switch (token_.sign) {
            case Sign::semicolon: advance(); break;
            case Sign::k_StateMachine: parse_machine(); break;
            case Sign::k_RootStateMachine: parse_root(); break;
            case Sign::k_program: parse_named_program(); break;
            case Sign::k_function: parse_function_definition(false); break;
            default: parse_bare_program(); break;
            }
        }
        if (ok() && types_.used == 0)
            fail(token_, {"the script is empty; give it a program or a StateMachine"});
        if (ok() && count_programs(types_.room, instances_.view()) == instances_.used) add_implied_root();
        finish();
        note_sizes();
    }
    /// Compiles statements, or one expression, whose value is the result.
    constexpr void compile_line() {
        is_line_ = true;
        advance();
        if (reach_.components.empty()) fail(token_, {"there is no component that the line could name"});
        if (is(Sign::end)) fail(token_, {"the line is empty; write an expression or a statement"});
        if (begins_statement(token_.sign))
            make_program(token_, file_, true, nullptr);
        else
            make_expression();
        finish();
        note_sizes();
    }

private:
    static constexpr bool begins_statement(Sign sign) noexcept {
        switch (sign) {
        case Sign::open_brace:
        case Sign::semicolon:
        case Sign::k_do:
        case Sign::k_set:
        case Sign::k_var:
        case Sign::k_const:
        case Sign::k_if:
        case Sign::k_while:
        case Sign::k_for:
        case Sign::k_try:
        case Sign::k_wait:
        case Sign::k_yield:
        case Sign::k_return:
        case Sign::k_break:
        case Sign::k_continue: return true;
        default: return false;
        }
    }
    constexpr void make_expression() {
        looks_only_ = true;
        begin_type();
        BehaviourType type;
        type.name = keep({file_});
        const ProgramIndex program = begin_program({file_});
        begin_action();
        const Token at = token_;
        const Operand value = reckoned(at, parse_expression());
        static_cast<void>(take(Sign::semicolon));
        if (ok() && !is(Sign::end))
            fail(token_, {"found \"", quoted(token_.text),
                          "\" after the expression; a line is one expression, or statements that begin with "
                          "do, set, var, if, wait ..."});
        if (!ok()) return;
        DataOffset result = no_data;
        static_cast<void>(add_variable(value.type->size, result));
        store(at, value, value.type, result, "");
        add(variables_, VariableRow{keep({"value"}), value.type, result, VariableKind::result}, "variables");
        pending_ = add_arc(end_action(at));
        static_cast<void>(end_program(program, no_chain));
        end_type(type);
        add_program_instance(false);
    }
    constexpr void add_program_instance(bool on_command) {
        if (!ok()) return;
        BehaviourInstance instance;
        instance.name = types_.room[types_.used - 1].name;
        instance.type = static_cast<TypeIndex>(types_.used - 1);
        instance.on_command = on_command;
        instance.image = types_.room[instance.type].tables.image;
        add(instances_, instance, "instances");
    }
    /// "program name { ... }": one instance of its own type. "program [type] name(type parameter, ...)
    /// { ... }" waits for its task's command and, with a type, returns a result.
    constexpr void parse_named_program() {
        advance();
        Token name = need_word("the name of the program, or the type of its result");
        TypeId result = nullptr;
        if (ok() && is(Sign::name)) {
            result = find_type(name.text);
            if (result == nullptr) fail(name, {"found \"", quoted(name.text), "\", expected a type"});
            name = token_;
            advance();
        }
        if (ok() && name.sign != Sign::name)
            fail(name, {"found \"", quoted(name.text), "\", expected the name of the program"});
        make_program(name, name.text, false, result);
        need(Sign::close_brace, "\"}\"");
    }
    constexpr void parse_program_parameters() {
        while (ok() && !is(Sign::close_round)) {
            const TypeId type = parse_type();
            if (ok()) parse_variable_of(type, VariableKind::parameter);
            if (!is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
        }
        need(Sign::close_round, "\")\"");
    }
    /// Statements alone are one program, named after the file.
    constexpr void parse_bare_program() {
        if (is(Sign::broken) || types_.used != 0)
            return fail_expected("StateMachine, RootStateMachine, program or function");
        std::string_view name = file_.substr(file_.rfind('/') + 1);
        name = name.substr(0, name.find('.'));
        make_program(token_, name, true, nullptr);
    }
    constexpr void make_program(const Token& at, std::string_view name, bool to_the_end, TypeId result) {
        if (!ok()) return;
        begin_type();
        BehaviourType type;
        type.name = keep({name});
        const std::size_t symbols = symbols_used_;
        const bool on_command = !to_the_end && take(Sign::open_round);
        if (on_command) parse_program_parameters();
        Frame frame{.result = result};
        if (result != nullptr) {
            if (!on_command)
                return fail(at, {"nothing asks \"", quoted(name),
                                 "\" for its result; give it a list of parameters, which may be empty"});
            static_cast<void>(add_variable(result->size, frame.slot));
            add(variables_, VariableRow{keep({"return"}), result, frame.slot, VariableKind::result},
                "variables");
        }
        if (!to_the_end) need(Sign::open_brace, "\"{\"");
        exports_variables_ = true;
        const ProgramIndex program = parse_program({name}, to_the_end, frame);
        exports_variables_ = false;
        symbols_used_ = symbols;
        if (ok() && program == no_program) return fail(at, {"the program has no statement"});
        end_type(type);
        if (ok()) check_instance_name(at, types_.room[types_.used - 1].name);
        add_program_instance(on_command);
    }
    constexpr void check_instance_name(const Token& at, std::string_view name) {
        for (std::size_t i = 0; i < instances_.used; ++i)
            if (instances_.room[i].name == name)
                return fail(at, {"\"", quoted(name), "\" is there twice; rename one"});
    }
    /// "RootStateMachine Type name(arguments)"
    constexpr void parse_root() {
        advance();
        const TypeIndex type = parse_machine_type("the type of the state machine", " before this line");
        const Token name = need_name("the name of the state machine");
        if (!ok()) return;
        check_instance_name(name, name.text);
        const auto first = static_cast<std::uint16_t>(arguments_used_);
        const std::uint16_t count = parse_machine_arguments(name, type);
        add_root(name, keep({name.text}), type, first, count);
        arguments_used_ = first;
        static_cast<void>(take(Sign::semicolon));
    }
    /// Without RootStateMachine, the last type of state machine gets one instance.
    constexpr void add_implied_root() {
        std::size_t last = types_.used;
        while (last != 0 && types_.room[last - 1].is_program()) --last;
        if (last == 0) return;
        const auto type = static_cast<TypeIndex>(last - 1);
        Token at = machine_name_token();
        static_cast<void>(parse_machine_arguments(at, type));
        add_root(at, types_.room[type].name, type, 0, 0);
    }
    constexpr void add_root(const Token& at, std::string_view name, TypeIndex type, std::uint16_t first,
                            std::uint16_t count) {
        if (!ok()) return;
        std::uint32_t i = instances_.used;
        add_instance(name, type, no_instance, first, count);
        for (; ok() && i < instances_.used; ++i) {
            std::uint32_t depth = 1;
            for (InstanceIndex outer = instances_.room[i].parent; outer != no_instance;
                 outer = instances_.room[outer].parent)
                ++depth;
            if (depth > reach_.depth)
                return fail(at, {"child machines are nested deeper than ", digits(reach_.depth),
                                 " levels, which its row allows"});
            for (std::size_t c = 0; ok() && c < children_used_; ++c) {
                const Child& child = children_[c];
                if (child.parent != instances_.room[i].type) continue;
                if (instances_.room[i].children++ == 0)
                    instances_.room[i].first_child = static_cast<InstanceIndex>(instances_.used);
                add_instance(keep({instances_.room[i].name, ".", child.name}), child.type,
                             static_cast<InstanceIndex>(i), child.first_argument, child.arguments);
            }
        }
    }
    constexpr void add_instance(std::string_view name, TypeIndex type, InstanceIndex parent,
                                std::uint16_t first, std::uint16_t count) {
        if (!ok()) return;
        BehaviourInstance instance;
        instance.name = name;
        instance.type = type;
        instance.parent = parent;
        const ProgramTables& tables = types_.room[type].tables;
        instance.image = tables.image;
        if (count != 0) {
            image_base_ = aligned(image_base_, data_alignment);
            const std::size_t size = tables.image.size();
            if (room_.image.size() < image_base_ || room_.image.size() - image_base_ < size)
                return fail_room("bytes of initial data");
            const auto own = room_.image.subspan(image_base_, size);
            std::copy_n(tables.image.data(), size, own.data());
            for (std::size_t i = first; i < std::size_t{first} + count; ++i) {
                const VariableRow& variable = tables.variables[arguments_[i].variable];
                static_cast<void>(encode(arguments_[i].value, variable.type, own.data() + variable.at));
            }
            instance.image = own;
            image_base_ += static_cast<std::uint32_t>(size);
        }
        add(instances_, instance, "instances");
    }
    /// Sums up what all instances need at run time, and checks that the slot has it.
    constexpr void finish() {
        if (!ok()) return;
        ScriptSizes& s = outcome_.sizes;
        for (std::size_t i = 0; i < instances_.used; ++i) {
            const BehaviourType& type = types_.room[instances_.room[i].type];
            s.data += aligned(type.tables.layout.size, data_alignment);
            for (const LinkRow& row : type.tables.links) s.command_slots += row.needs_slot ? 1 : 0;
            for (const TransitionRow& row : type.machine.transitions) s.timers += row.timed ? 1 : 0;
            for (const NodeRow& node : type.tables.nodes)
                for (std::size_t a = 0; a < node.arcs; ++a)
                    if (type.tables.arcs[node.first_arc + a].after != no_data) {
                        ++s.timers;
                        break;
                    }
        }
        if (s.command_slots > reach_.command_slots)
            return fail(token_, {"the script sends ", digits(s.command_slots),
                                 " commands and its slot has room for ", digits(reach_.command_slots),
                                 "; send fewer or give its row more command_slots(...)"});
        if (s.timers > reach_.timers)
            return fail(token_, {"the script waits for time at ", digits(s.timers),
                                 " places and its slot has room for ", digits(reach_.timers),
                                 "; wait at fewer or give its row more timers(...)"});
        if (room_.reach.size() < reach_.components.size()) return fail_room("components");
        // They may be stored there already.
        if (room_.reach.data() != reach_.components.data())
            std::copy_n(reach_.components.data(), reach_.components.size(), room_.reach.data());
        ScriptUnit& unit = outcome_.unit;
        unit.name = keep({file_});
        unit.types = room_.types.first(types_.used);
        unit.instances = room_.instances.first(instances_.used);
        unit.reach = room_.reach.first(reach_.components.size());
        unit.command_slots = static_cast<std::uint16_t>(s.command_slots);
        if (!ok()) unit = {};
    }
};

} // namespace tappet::script_detail
