// Connects the task of a slot to the behaviour that is loaded there.
#include "kernel/machine/slots/slot_task.hpp"

#include "kernel/base/nearest.hpp"
#include "kernel/program/operator_kinds.hpp"

#include <algorithm>
#include <cstring>

namespace tappet {

namespace {

/// Writes a declaration as in a script: "param double heat".
void add_declaration(Sentence& text, const VariableRow& row, bool is_program) {
    if (row.kind == VariableKind::result) {
        text.add("a result of type ").add(type_name(row.type));
        return;
    }
    text.add("\"");
    if (!is_program) text.add(row.kind == VariableKind::parameter ? "param " : "var ");
    text.add(type_name(row.type)).add(" ").add(row.name).add("\"");
}

} // namespace

void SlotTask::place(std::string_view name, const TaskShape& shape, const Room& room) noexcept {
    name_ = name, shape_ = shape, room_ = room;
    const auto image = shape.instance->image.subspan(shape.type->tables.layout.constants);
    std::copy_n(image.data(), std::min(image.size(), room.values.size()), room.values.data());
    std::ranges::copy(room.values, room.seen.begin());
}

Sentence SlotTask::fit(const ScriptUnit& unit, std::size_t bank) {
    const std::string_view wanted = shape_.instance->name;
    Nearest nearest{wanted};
    std::size_t part = 0;
    for (; part < unit.instances.size() && unit.instances[part].name != wanted; ++part)
        nearest.consider(unit.instances[part].name);
    const bool is_program = shape_.type->is_program();
    const std::string_view kind = !is_program                   ? "state machine"
                                  : shape_.instance->on_command ? "program with parameters"
                                                                : "program";
    if (part == unit.instances.size()) {
        Sentence text{"task \"", name_, "\" is that of ", kind, " \"", wanted, "\", which it does not have"};
        if (nearest.best().empty()) return text.add("; add one");
        return text.add("; did you mean \"").add(nearest.best()).add("\"?");
    }
    const BehaviourInstance& found = unit.instances[part];
    const BehaviourType& type = unit.types[found.type];
    if (type.is_program() != is_program || found.on_command != shape_.instance->on_command)
        return Sentence{"task \"",
                        name_,
                        "\" is that of a ",
                        kind,
                        ", and \"",
                        wanted,
                        "\" is not one; write it so, or rename it"};
    if (is_program && type.parameters() != shape_.type->parameters())
        return Sentence{"task \"",
                        name_,
                        "\" gives \"",
                        wanted,
                        "\" ",
                        shape_.type->parameters(),
                        " parameters, and it has ",
                        type.parameters(),
                        "; give it those of the task"};
    for (std::size_t i = 0; i < shape_.variables.size(); ++i) {
        const std::size_t number = shape_.variables[i];
        const VariableRow& asked = shape_.type->tables.variables[number];
        const auto all = type.tables.variables;
        const auto same = std::ranges::find_if(all, [&](const VariableRow& row) {
            const bool is_there =
                !is_program || &row == all.data() + number; // a command packs them in their order
            return is_there && row.name == asked.name && row.kind == asked.kind && row.type == asked.type;
        });
        if (same == all.end()) {
            Sentence text{"task \"", name_, "\" has "};
            add_declaration(text, asked, is_program);
            return text.add(" of \"").add(wanted).add("\", which it does not have so; declare it there");
        }
        room_.places[bank * shape_.variables.size() + i] = same->at;
    }
    parts_[bank] = part;
    return {};
}

void SlotTask::exchange(BehaviourUnit& unit, std::size_t bank, When when) noexcept TAPPET_REALTIME {
    std::byte* const data = part(unit, bank).data;
    const DataOffset* const places = room_.places.data() + bank * shape_.variables.size();
    for (std::size_t i = 0; i < shape_.variables.size(); ++i) {
        const std::size_t number = shape_.variables[i];
        const std::size_t at = TaskShape::place_of(*shape_.type, number);
        const std::size_t size = shape_.type->tables.variables[number].type->size;
        std::byte *const own = room_.values.data() + at, *const seen = room_.seen.data() + at,
                         *const its = data + places[i];
        const bool is_set =
            !std::equal(own, own + size, seen); // not memcmp, which is no builtin under the fuzzer
        if (is_set) set_ |= std::uint64_t{1} << i;
        const bool was_set = when == When::take_back && (set_ >> i & 1) != 0;
        const bool gives = is_set || was_set || when == When::take_over;
        std::memcpy(gives ? its : own, gives ? own : its, size);
        std::memcpy(seen, own, size);
    }
    if (when != When::step) set_ = 0;
}

} // namespace tappet
