// The other behaviours that a program uses: the child machines of its state machine, and the programs that
// are defined before it.
#pragma once

#include "kernel/program/beside.hpp"
#include "kernel/script/child_machines.hpp"
#include "kernel/script/scope.hpp"

namespace tappet::script_detail {

template <class Meaning>
struct BehaviourWord {
    std::string_view name;
    Meaning meaning;
};
inline constexpr BehaviourWord<MachineCommand> machine_commands[] = {
    {"activate", MachineCommand::activate},
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
inline constexpr BehaviourWord<MachineQuestion> machine_questions[] = {
    {"inState", MachineQuestion::in_state},   {"inError", MachineQuestion::in_error},
    {"isActive", MachineQuestion::is_active}, {"isRunning", MachineQuestion::is_running},
    {"isPaused", MachineQuestion::is_paused}, {"isStopped", MachineQuestion::is_stopped}};
inline constexpr BehaviourWord<ProgramCommand> program_commands[] = {
    {"start", ProgramCommand::start}, {"stop", ProgramCommand::stop}, {"pause", ProgramCommand::pause}};
inline constexpr BehaviourWord<ProgramQuestion> program_questions[] = {
    {"isRunning", ProgramQuestion::is_running},
    {"isPaused", ProgramQuestion::is_paused},
    {"inError", ProgramQuestion::in_error}};

/// Null: there is no such word.
template <class Meaning, std::size_t N>
constexpr const BehaviourWord<Meaning>* find_word(const BehaviourWord<Meaning> (&words)[N],
                                                  const Token& name) noexcept {
    for (const BehaviourWord<Meaning>& each : words)
        if (each.name == name.text) return &each;
    return nullptr;
}

/// Values for the parameters of an instance, among all arguments of the script.
struct ArgumentList {
    std::uint16_t first = 0;
    std::uint16_t count = 0;
};
/// "SubStateMachine Type name(arguments)" in a machine.
struct Child {
    std::string_view name{};
    TypeIndex parent = 0;
    TypeIndex type = 0;
    std::uint16_t number = 0; ///< among its parent's children
    ArgumentList arguments{};
};

class Behaviours {
    // A template must be complete before a constant expression calls it.

    /// Parses ".word()" of a program; returns the meaning of the word.
    template <class Meaning, std::size_t N>
    constexpr Meaning parse_word(const BehaviourWord<Meaning> (&words)[N], std::string_view wanted) {
        text_.need(Sign::dot, "a dot");
        const Token name = text_.need_word(wanted);
        const auto* const word = find_word(words, name);
        if (word == nullptr) text_.fail_unknown(name, "word", words, " of programs");
        text_.need(Sign::open_round, "\"(\"");
        text_.need(Sign::close_round, "\")\"");
        return word != nullptr ? word->meaning : Meaning{};
    }

public:
    constexpr Behaviours(Reader& text, Emitter& out) : text_{text}, out_{out} {}

    // ---- child machines

    [[nodiscard]] constexpr std::span<const Child> children() const noexcept {
        return std::span{children_}.first(children_used_);
    }
    [[nodiscard]] constexpr std::uint16_t count_children(TypeIndex parent) const noexcept {
        std::uint16_t count = 0;
        for (const Child& each : children())
            if (each.parent == parent) ++count;
        return count;
    }
    constexpr void add(const Child& child) {
        if (children_used_ == children_.size()) return text_.fail_limit("child machines");
        children_[children_used_++] = child;
    }
    /// Parses a question to a child, or one of its variables, after the child's name.
    constexpr Operand parse_machine_value(std::uint16_t number) {
        const Child& child = children_[number];
        text_.need(Sign::dot, "a dot and what is asked of the child machine");
        const Token word = text_.need_word("a variable of the child machine, inState or inError");
        if (!text_.ok()) return {};
        if (const auto* const asked = find_word(machine_questions, word)) {
            Instruction in = instruction(&primitive::ask_child, child);
            in.size = parse_brackets(child, asked->meaning == MachineQuestion::in_state);
            in.inner = static_cast<std::uint8_t>(asked->meaning);
            return made(script_bool, out_.emit_to_scratch(in, 1));
        }
        const VariableRow* const variable = find_variable(child, word);
        if (variable == nullptr) return {};
        const Instruction in = instruction(&primitive::read_child, child, *variable);
        return made(variable->type, out_.emit_to_scratch(in, variable->type->size));
    }
    /// False: there is no such command.
    constexpr bool parse_machine_command(std::uint16_t number) {
        const Child& child = children_[number];
        text_.need(Sign::dot, "a dot and a command of the child machine");
        const Token word =
            text_.need_word("activate, start, pause, stop, reset, deactivate, requestState or step");
        if (!text_.ok()) return false;
        const auto* const command = find_word(machine_commands, word);
        if (command == nullptr) {
            text_.fail_unknown(word, "command", machine_commands, " of child machines");
            return false;
        }
        Instruction in = instruction(&primitive::command_child, child);
        in.size = parse_brackets(child, command->meaning >= MachineCommand::request_state);
        in.inner = static_cast<std::uint8_t>(command->meaning);
        out_.emit(in);
        return true;
    }
    /// Parses a child's variable that is assigned; sets the instruction that writes it. Null: a fault.
    constexpr const VariableRow* parse_machine_variable(std::uint16_t number, Instruction& in) {
        const Child& child = children_[number];
        text_.need(Sign::dot, "a dot and a variable of the child machine");
        const Token word = text_.need_word("a variable of the child machine");
        const VariableRow* const variable = text_.ok() ? find_variable(child, word) : nullptr;
        if (variable != nullptr) in = instruction(&primitive::write_child, child, *variable);
        return variable;
    }

    // ---- programs beside

    /// Returns a program that is defined before; no_instance: none has that name.
    [[nodiscard]] constexpr InstanceIndex find_program(std::string_view name) const noexcept {
        for (std::size_t i = 0; i < out_.instances.used; ++i)
            if (out_.instances[i].name == name && out_.types[out_.instances[i].type].is_program())
                return static_cast<InstanceIndex>(i);
        return no_instance;
    }
    [[nodiscard]] constexpr Instruction instruction(Primitive run, InstanceIndex program) {
        const std::size_t number = count_programs(out_.types.room, out_.instances.room.first(program));
        if (number > 0xff) text_.fail_limit("programs before one that is commanded");
        return {.run = run, .rows = static_cast<std::uint8_t>(number)};
    }
    /// Parses ".isRunning()" and the like.
    constexpr Operand parse_program_value(InstanceIndex program) {
        const auto asked = parse_word(program_questions, "isRunning, isPaused or inError");
        Instruction in = instruction(&primitive::ask_program, program);
        in.inner = static_cast<std::uint8_t>(asked);
        return made(script_bool, out_.emit_to_scratch(in, 1));
    }
    /// Parses ".start()" and the like.
    constexpr void parse_program_command(InstanceIndex program) {
        const auto what = parse_word(program_commands, "start, stop or pause");
        Instruction in = instruction(&primitive::control_program, program);
        in.inner = static_cast<std::uint8_t>(what);
        out_.emit(in);
    }

private:
    /// Parses "()", or "(State)" of the child; returns the state.
    constexpr std::uint16_t parse_brackets(const Child& child, bool with_state) {
        text_.need(Sign::open_round, "\"(\"");
        const std::uint16_t state = with_state ? parse_state(child) : std::uint16_t{0};
        text_.need(Sign::close_round, "\")\"");
        return state;
    }
    /// Parses the name of a state of the child, in quotes or without.
    constexpr std::uint16_t parse_state(const Child& child) {
        const Token name = text_.token();
        if (!text_.is(Sign::text) && !name.is_word()) {
            text_.fail_expected("the name of a state");
            return 0;
        }
        text_.advance();
        const auto states = out_.types[child.type].machine.states;
        for (std::size_t i = 0; i < states.size(); ++i)
            if (states[i].name == name.text) return static_cast<std::uint16_t>(i);
        text_.fail_unknown(name, "state", states, " of the child machine");
        return 0;
    }
    constexpr const VariableRow* find_variable(const Child& child, const Token& word) {
        const auto variables = out_.types[child.type].tables.variables;
        for (const VariableRow& each : variables)
            if (each.name == word.text) return &each;
        text_.fail_unknown(word, "variable", variables, " of the child machine");
        return nullptr;
    }
    static constexpr Instruction instruction(Primitive run, const Child& child) noexcept {
        return {.run = run, .rows = static_cast<std::uint8_t>(child.number)};
    }
    static constexpr Instruction instruction(Primitive run, const Child& child,
                                             const VariableRow& variable) noexcept {
        return {.run = run,
                .size = static_cast<std::uint16_t>(variable.type->size),
                .rows = static_cast<std::uint8_t>(child.number),
                .inner = static_cast<std::uint8_t>(variable.at & 0xff),
                .columns = static_cast<std::uint8_t>(variable.at >> 8)};
    }

    Reader& text_;
    Emitter& out_;
    std::array<Child, 32> children_{};
    std::size_t children_used_ = 0;
};

} // namespace tappet::script_detail
