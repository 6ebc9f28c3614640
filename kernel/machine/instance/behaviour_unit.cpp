// Places a unit of behaviour in its memory, and describes its faults.
#include "kernel/machine/slots/behaviour_unit.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/slots/memory.hpp"
#include "kernel/program/check_tables.hpp"
#include "kernel/statechart/check_references.hpp"

#include <algorithm>
#include <new>

namespace tappet {

namespace {

template <class T>
T* make(detail::UnitLayout& layout, std::size_t count) noexcept {
    T* memory = layout.take<T>(count);
    for (std::size_t i = 0; i < count && memory != nullptr; ++i) new (memory + i) T{};
    return memory;
}

/// Places slots for the commands that an instance sends to other activities.
void aim_slots(const ScriptUnit& unit, UnitPart& part, detail::UnitLayout& layout, MachineInstance& machine,
               std::size_t driven) {
    const MachineView& table = machine.machine().table;
    std::size_t slot = 0;
    const std::size_t sender = machine.machine().index.activity[driven];
    detail::for_each_slot_link(unit, *part.type, [&](std::size_t i, const Facet& facet) {
        std::byte* values = layout.take(facet.command->value_bytes(), data_alignment);
        if (values == nullptr) return;
        const LinkRow& row = part.type->tables.links[i];
        const std::size_t c = component_of(table, table.components[driven].name, unit, row.peer);
        part.slots[slot].place(machine.requests().command_route({c, row.facet}, sender), values);
        part.links[i].slot = &part.slots[slot++];
    });
}

/// Returns the number of an event among those that a unit may hear, spelled as in the script.
std::size_t find_event(std::span<const std::string_view> events, std::string_view name,
                       std::string_view driven) noexcept {
    for (std::size_t e = 0; e < events.size(); ++e)
        if (events[e] == name) return e;
    for (std::size_t e = 0; e < events.size(); ++e)
        if (is_named(name, driven, events[e])) return e;
    return nowhere;
}

Sentence too_small(std::string_view what) {
    return Sentence{"its ", what, " take more than the slot has room for; make the slot larger"};
}

/// Checks one type. Native code is generated from tables that the C++ compiler checked, and the tables that
/// remain beside it are no program.
Sentence check_type(const BehaviourType& type, bool is_native) {
    if (!is_native)
        if (Sentence fault = check_tables(type.tables); !fault.empty()) return fault;
    if (type.is_program()) return {};
    if (Sentence fault = check(type.machine); !fault.empty()) return fault;
    return is_native ? Sentence{} : check_references(type.machine);
}

/// Maps events to the triggers of an instance's state machine. `routes`: those of the instance; those of
/// consecutive events are `instances` apart.
Sentence route_events(const ResolvedView& view, std::span<const std::string_view> events,
                      std::string_view component, UnitRoute* routes, std::size_t instances) {
    for (std::size_t t = 0; t < view.triggers.size(); ++t) {
        const std::string_view name = view.triggers[t];
        const std::size_t e = find_event(events, name, component);
        if (e == nowhere)
            return Sentence{"it hears event \"", name,
                            "\", which is not in its reach; name it in events(...) of its row"};
        UnitRoute& route = routes[e * instances];
        if (route.trigger != no_trigger)
            return Sentence{"it spells event \"", name, "\" in two ways; use one of them"};
        route.trigger = static_cast<TriggerIndex>(t);
    }
    return {};
}

} // namespace

Sentence BehaviourUnit::place(const ScriptUnit& unit, std::span<const BehaviourCode> code,
                              const BehaviourOptions& options, std::span<std::byte> memory,
                              std::span<const std::string_view> events, MachineInstance& machine,
                              std::size_t driven) {
    const std::uint32_t placed = placed_ + 1;
    *this = {};
    placed_ = placed;
    unit_ = unit;
    options_ = options;
    machine_ = &machine;
    Engine& engine = machine.engines()[machine.machine().index.activity[driven]];
    engine_ = &engine;
    limit_.stamps = &engine.stamps();
    driven_ = driven;
    const std::string_view driven_name = machine.machine().table.components[driven].name;
    const std::size_t instances = unit.instances.size();
    detail::UnitLayout layout{memory};
    auto* parts = make<UnitPart>(layout, instances);
    auto* machines = make<StateMachineExecution>(layout, instances); // children side by side
    const std::size_t program_count = count_programs(unit.types, unit.instances);
    const ProgramsBeside beside{make<ProgramExecution>(layout, program_count), program_count};
    auto* views = make<ResolvedView>(layout, unit.types.size());
    auto* routes = make<UnitRoute>(layout, events.size() * instances);
    if (layout.full()) return too_small("instances");
    for (std::size_t t = 0; t < unit.types.size(); ++t) {
        const BehaviourType& type = unit.types[t];
        if (Sentence fault = check_type(type, t < code.size() && code[t].code.run != nullptr); !fault.empty())
            return fault;
        if (type.is_program()) continue;
        const ResolvedRoom room = take_room(layout, measure(type.machine));
        if (layout.full()) return too_small("states and transitions");
        views[t] = resolve_into(type.machine, room);
        for (std::size_t i = 0; i < instances; ++i) {
            if (unit.instances[i].type != t) continue;
            const MachineMemory kept = take_machine_memory(layout, views[t].sizes);
            parts[i].machine = &machines[i];
            parts[i].binding.history = kept.history;
            parts[i].binding.deferred = kept.deferred;
        }
    }
    std::size_t program = 0;
    for (std::size_t i = 0; i < instances; ++i) {
        const BehaviourInstance& row = unit.instances[i];
        UnitPart& part = parts[i];
        part.row = &row;
        part.type = &unit.types[row.type];
        if (part.type->is_program()) part.program = beside.first + program++;
        has_programs_ = has_programs_ || part.program != nullptr;
        part.binding.beside = beside;
        if (row.children != 0) part.binding.machines = &machines[row.first_child];
        const std::size_t bytes = part.type->tables.layout.size;
        part.data = layout.take(bytes, data_alignment);
        part.links = make<ProgramLink>(layout, part.type->tables.links.size());
        detail::for_each_slot_link(unit, *part.type, [&](std::size_t, const Facet&) { ++part.slot_count; });
        part.slots = make<CommandSlot>(layout, part.slot_count);
        if (layout.full()) return too_small("data and commands");
        aim_slots(unit, part, layout, machine, driven);
        if (layout.full()) return too_small("commands");
        std::fill_n(part.data, bytes, std::byte{});
        std::copy(row.image.begin(), row.image.end(), part.data);
        bind(part, row.type < code.size() ? code[row.type] : BehaviourCode{}, views[row.type]);
        if (part.machine == nullptr) continue;
        if (Sentence fault = route_events(views[row.type], events, driven_name, &routes[i], instances);
            !fault.empty())
            return fault;
    }
    parts_ = {parts, instances};
    routes_ = {routes, events.size() * instances};
    return {};
}

void BehaviourUnit::connect_links() {
    const MachineView& table = machine_->machine().table;
    for (UnitPart& part : parts_)
        for (std::size_t i = 0; i < part.type->tables.links.size(); ++i) {
            const LinkRow& row = part.type->tables.links[i];
            const std::size_t c = component_of(table, table.components[driven_].name, unit_, row.peer);
            ProgramLink& link = part.links[i];
            link.component = machine_->gate_of(c);
            link.place = machine_->component(c);
            link.type = table.components[c].type;
            if (row.facet == LinkRow::component_itself) continue;
            if (void* place = machine_->place_of({c, row.facet}); place != nullptr) link.place = place;
        }
}

void BehaviourUnit::bind(UnitPart& part, const BehaviourCode& native, const ResolvedView& view) {
    const std::uint32_t statements = options_.statements != 0 ? options_.statements : default_statements;
    const ProgramCode code = native.code.run != nullptr ? native.code : interpreted(part.type->tables);
    void* component = machine_->component(driven_);
    if (part.program != nullptr) {
        ProgramContext context;
        context.component = component;
        context.data = part.data;
        context.links = part.links;
        context.limit = &limit_;
        context.beside = part.binding.beside;
        part.program->bind(code, context, part.row->image, {statements, options_.on_error == OnError::go_on});
        return;
    }
    part.binding.machine = view;
    part.binding.component = component;
    part.binding.code = part.type->machine.programs == nullptr ? native.code : code;
    part.binding.fast = native.fast;
    part.binding.data = part.data;
    part.binding.links = part.links;
    part.binding.limit = &limit_;
    part.binding.policy = {statements, options_.escalates};
    if (part.row->parent != no_instance)
        part.binding.parent = (&part - (part.row - unit_.instances.data()) + part.row->parent)->machine;
    static_cast<void>(part.machine->bind(part.binding));
}

void BehaviourUnit::trace(StateMachineExecution::Trace hook, void* context) noexcept {
    trace_ = hook;
    trace_context_ = context;
    for (UnitPart& part : parts_)
        if (part.machine != nullptr) part.machine->trace(hook, context);
}

Sentence BehaviourUnit::describe_fault() const {
    if (fault_.instance >= parts_.size()) return {};
    const UnitPart& part = parts_[fault_.instance];
    Sentence text{"\"", part.row->name, "\""};
    std::uint16_t line = fault_.line;
    if (part.machine != nullptr) {
        const StateMachineTable& table = part.type->machine;
        const StateMachineFault& fault = fault_.machine;
        if (fault.state < table.states.size())
            text.add(": ")
                .add(to_text(fault.part))
                .add(" of state \"")
                .add(table.states[fault.state].name)
                .add("\"");
        if (fault.node < part.type->tables.nodes.size())
            line = part.type->tables.nodes[fault.node].line;
        else if (fault.transition < table.transitions.size())
            line = table.transitions[fault.transition].line;
        else if (fault.state < table.states.size())
            line = table.states[fault.state].line;
    }
    text.add(" failed");
    if (line != 0) text.add(" in line ").add(unsigned{line});
    return text;
}

} // namespace tappet
