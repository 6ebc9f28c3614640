// Programs beside: how the programs of a script use those defined before them.
#pragma once

#include "kernel/program/beside.hpp"
#include "kernel/script/compiler_actions.hpp"

namespace tappet::script_detail {

struct ProgramWord {
    std::string_view name;
    ProgramCommand command;
};
inline constexpr ProgramWord program_commands[] = {
    {"start", ProgramCommand::start}, {"stop", ProgramCommand::stop}, {"pause", ProgramCommand::pause}};
struct ProgramAsk {
    std::string_view name;
    ProgramQuestion question;
};
inline constexpr ProgramAsk program_questions[] = {{"isRunning", ProgramQuestion::is_running},
                                                   {"isPaused", ProgramQuestion::is_paused},
                                                   {"inError", ProgramQuestion::in_error}};

constexpr Instruction Expressions::program_instruction(Primitive run, InstanceIndex program) {
    const std::size_t number = count_programs(types_.room, instances_.room.first(program));
    if (number > 0xff) fail_limit("programs before one that is commanded");
    return {.run = run, .rows = static_cast<std::uint8_t>(number)};
}

template <class Words>
constexpr std::uint8_t Expressions::parse_program_word(const Words& words, std::string_view wanted) {
    need(Sign::dot, "a dot");
    const Token word = need_word(wanted);
    if (!ok()) return 0;
    Nearest nearest{word.text};
    for (std::size_t i = 0; i < std::size(words); ++i) {
        nearest.consider(words[i].name);
        if (words[i].name != word.text) continue;
        need(Sign::open_round, "\"(\"");
        need(Sign::close_round, "\")\"");
        return static_cast<std::uint8_t>(i);
    }
    fail_unknown(word, "word", nearest, " of programs");
    return 0;
}

constexpr Operand Expressions::parse_program_value(InstanceIndex program) {
    const std::uint8_t asked = parse_program_word(program_questions, "isRunning, isPaused or inError");
    Instruction in = program_instruction(&primitive::ask_program, program);
    in.inner = static_cast<std::uint8_t>(program_questions[asked].question);
    in.to = scratch(1);
    emit(in);
    return made(script_bool, in.to);
}

constexpr void Statements::parse_program_command(const Token& at, const Token& name, InstanceIndex program) {
    if (is(Sign::dot)) {
        const std::uint8_t what = parse_program_word(program_commands, "start, stop or pause");
        Instruction in = program_instruction(&primitive::control_program, program);
        in.inner = static_cast<std::uint8_t>(program_commands[what].command);
        emit(in);
        pending_ = add_arc(end_action(at));
        return;
    }
    const BehaviourInstance& commanded = instances_.room[program];
    const auto variables = types_.room[commanded.type].tables.variables;
    const std::size_t parameters = types_.room[commanded.type].parameters();
    if (!commanded.on_command)
        return fail(name, {"program \"", commanded.name,
                           "\" runs by itself; give it a list of parameters, which may "
                           "be empty, to command it"});
    std::size_t bytes = 0;
    for (const VariableRow& each : variables.first(parameters)) bytes += each.type->size;
    const DataOffset packed = bytes != 0 ? scratch(bytes) : no_data;
    if (!need(Sign::open_round, "\"(\" and the arguments")) return;
    const VariableRow* result = nullptr;
    for (const VariableRow& each : variables)
        if (each.kind == VariableKind::result) result = &each;
    const std::size_t all = parameters + (result != nullptr ? 1 : 0);
    std::size_t input_at = 0;
    ResultPlace place;
    for (std::size_t i = 0; ok() && i < all; ++i) {
        if (i != 0 && !is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
        if (i == parameters) {
            place = parse_result_place();
            break;
        }
        parse_argument(variables[i].type, moved(packed, input_at), i, all);
        input_at += variables[i].type->size;
    }
    end_arguments(all);
    if (!ok()) return;
    Instruction in = program_instruction(&primitive::begin_program, program);
    in.a = packed;
    emit(in);
    const NodeIndex node = end_action(at);
    if (ok()) waits_.put(node, true);
    may_wait_ = true;
    const std::uint16_t first = instruction_count();
    in = program_instruction(&primitive::program_ended, program);
    in.to = scratch(1);
    emit(in);
    pending_ = add_arc(node, make_condition(at, first, at_place(script_bool, in.to)));
    parse_timeout(node);
    if (result == nullptr || !ok()) return;
    begin_action();
    in = program_instruction(&primitive::program_result, program);
    in.to = scratch(result->type->size);
    emit(in);
    store_result(at, place, result->type, in.to);
    pending_ = add_arc(end_action(at));
}

} // namespace tappet::script_detail
