// Child machines in a script: how their parent's programs use them.
#pragma once

#include "kernel/script/child_machines.hpp"
#include "kernel/script/compiler_actions.hpp"
#include "kernel/script/compiler_loops.hpp"

namespace tappet::script_detail {

struct MachineWord {
    std::string_view name;
    MachineCommand command;
};
inline constexpr MachineWord machine_commands[] = {{"activate", MachineCommand::activate},
                                                   {"deactivate", MachineCommand::deactivate},
                                                   {"start", MachineCommand::start},
                                                   {"automatic", MachineCommand::start},
                                                   {"pause", MachineCommand::pause},
                                                   {"stop", MachineCommand::stop},
                                                   {"reset", MachineCommand::reset},
                                                   {"step", MachineCommand::step},
                                                   {"reactive", MachineCommand::reactive},
                                                   {"requestState", MachineCommand::request_state},
                                                   {"requestStateRun", MachineCommand::request_state_once}};
struct MachineAsk {
    std::string_view name;
    MachineQuestion question;
};
inline constexpr MachineAsk machine_questions[] = {
    {"inState", MachineQuestion::in_state},   {"inError", MachineQuestion::in_error},
    {"isActive", MachineQuestion::is_active}, {"isRunning", MachineQuestion::is_running},
    {"isPaused", MachineQuestion::is_paused}, {"isStopped", MachineQuestion::is_stopped}};

constexpr Operand Expressions::parse_machine_value(std::uint16_t number) {
    const Child& child = children_[number];
    need(Sign::dot, "a dot and what is asked of the child machine");
    const Token word = need_word("a variable of the child machine, inState or inError");
    if (!ok()) return {};
    Instruction in;
    in.rows = static_cast<std::uint8_t>(child.number);
    for (const MachineAsk& each : machine_questions) {
        if (each.name != word.text) continue;
        need(Sign::open_round, "\"(\"");
        if (each.question == MachineQuestion::in_state) in.size = parse_child_state(child);
        need(Sign::close_round, "\")\"");
        in.run = &primitive::ask_child;
        in.inner = static_cast<std::uint8_t>(each.question);
        in.to = scratch(1);
        emit(in);
        return made(script_bool, in.to);
    }
    const VariableRow* const variable = child_variable(child, word);
    if (variable == nullptr) return {};
    in.run = &primitive::read_child;
    set_child_place(in, *variable);
    in.to = scratch(variable->type->size);
    emit(in);
    return made(variable->type, in.to);
}

constexpr void Statements::parse_machine_command(const Token& at, std::uint16_t number) {
    const Child& child = children_[number];
    need(Sign::dot, "a dot and a command of the child machine");
    const Token word = need_word("activate, start, pause, stop, reset, deactivate, requestState or step");
    if (!ok()) return;
    Instruction in;
    in.run = &primitive::command_child;
    in.rows = static_cast<std::uint8_t>(child.number);
    for (const MachineWord& each : machine_commands) {
        if (each.name != word.text) continue;
        need(Sign::open_round, "\"(\"");
        if (each.command >= MachineCommand::request_state) in.size = parse_child_state(child);
        need(Sign::close_round, "\")\"");
        in.inner = static_cast<std::uint8_t>(each.command);
        emit(in);
        pending_ = add_arc(end_action(at));
        return;
    }
    Nearest nearest{word.text};
    for (const MachineWord& each : machine_commands) nearest.consider(each.name);
    fail_unknown(word, "command", nearest, " of child machines");
}

constexpr void Statements::parse_set_in_machine(const Token& at, std::uint16_t number) {
    const Child& child = children_[number];
    need(Sign::dot, "a dot and a variable of the child machine");
    const Token word = need_word("a variable of the child machine");
    const VariableRow* const variable = ok() ? child_variable(child, word) : nullptr;
    if (variable == nullptr) return;
    if (!need(Sign::assign, "\"=\"")) return;
    const Token where = token_;
    const Operand value = as(where, parse_expression(variable->type), variable->type, "");
    Instruction in;
    in.run = &primitive::write_child;
    in.rows = static_cast<std::uint8_t>(child.number);
    set_child_place(in, *variable);
    in.a = value.at;
    emit(in);
    pending_ = add_arc(end_action(at));
}

} // namespace tappet::script_detail
