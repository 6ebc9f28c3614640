// Determines the role that a line needs, and why it failed.
#include "kernel/program/primitives_facet.hpp"
#include "kernel/services/interpreter/line_memory.hpp"

#include <algorithm>

namespace tappet::interpreter {

Role role_of(const Instruction& in) noexcept {
    static constexpr Primitive looks[] = {&primitive::look_at_input, &primitive::read_output,
                                          &primitive::read_property, &primitive::input_valid,
                                          &primitive::input_fresh,   &primitive::port_age,
                                          &primitive::buffer_empty};
    static constexpr Primitive asks[] = {&primitive::call_method,    &primitive::call_checked,
                                         &primitive::call_operation, &primitive::send_command,
                                         &primitive::command_ended,  &primitive::command_results};
    if (in.facet == nullptr || std::ranges::find(looks, in.run) != std::end(looks)) return Role::observer;
    if (in.run == &primitive::call_method && in.facet->method->is_const) return Role::observer;
    if (std::ranges::find(asks, in.run) != std::end(asks))
        return std::max(Role::machine_operator, in.facet->least_role);
    return Role::engineer;
}

Sentence check_origin(const Instruction& in, std::string_view facet, Origin origin) noexcept {
    // It reads, or sets a property, which the role alone decides.
    if (role_of(in) == Role::observer || in.run == &primitive::write_property) return {};
    return tappet::check_origin(facet, in.facet->for_people, in.facet->motion, origin);
}

namespace {

Sentence why_of(const Instruction& in, const UnitPart& part, std::string_view name) {
    const bool is_sent = in.run == &primitive::send_command || in.run == &primitive::command_ended;
    if (is_sent) {
        const CommandSlot* const slot = part.links[in.link].slot;
        const CommandState state = slot != nullptr ? slot->state() : CommandState::ready;
        if (state == CommandState::rejected)
            return Sentence{"\"", name, "\" was rejected: its component says no, or does not run"};
        if (state == CommandState::failed)
            return Sentence{"\"", name, "\" failed: its component says so, or was stopped"};
        if (state != CommandState::ready)
            return Sentence{"\"", name, "\" had not ended in time", in_flight(state) ? "; it continues" : ""};
    }
    if (in.run == &primitive::write_property) {
        if (Sentence range = check_range(*in.facet, part.data + in.a); !range.empty()) return range;
        return Sentence{"the component of \"", name, "\" does not consent to this value"};
    }
    const bool is_call = in.run == &primitive::call_checked || in.run == &primitive::call_method ||
                         in.run == &primitive::call_operation;
    if (is_call && !part.links[in.link].component->admits(Entry::at_once))
        return Sentence{"\"", name, "\" was not called: its component does not run; start it first"};
    if (in.run == &primitive::call_checked)
        return Sentence{"\"", name, "\" says no, or its arguments could not be computed"};
    return {};
}

} // namespace

Sentence describe_fault(const Bank& bank, std::span<const Reachable> reach) {
    const UnitPart& part = bank.unit.parts()[0];
    const ProgramTables& tables = part.type->tables;
    const NodeIndex number = bank.program().position().node;
    if (number >= tables.nodes.size()) return Sentence{"it failed"};
    const NodeRow& node = tables.nodes[number];
    Sentence text{part.type->name, ":", unsigned{node.line}, ":", unsigned{node.column}, ": "};
    // The last instruction that acts on a component explains it best; the condition after it tests a
    // command's end.
    for (std::size_t i = std::size_t{node.first} + node.count; i-- > node.first;) {
        const Instruction& in = tables.instructions[i];
        if (in.facet == nullptr) continue;
        const Sentence name{reach[tables.links[in.link].peer].name, ".", in.facet->name};
        if (const Sentence why = why_of(in, part, name.view()); !why.empty()) return text.add(why);
    }
    if (node.count == 0) return text.add("what it waited for did not come in time");
    return text.add("its value could not be computed: a division by zero, a number too large, or an index "
                    "outside");
}

} // namespace tappet::interpreter
