// Gives a unit of behaviour its memory and steps what is in it.
#include "kernel/machine/behaviour_unit.hpp"

#include "kernel/machine/instance.hpp"

#include <algorithm>
#include <cstring>
#include <new>

namespace tappet {

namespace {

template <class T>
T* make(detail::UnitGround& ground, std::size_t count) noexcept {
    T* memory = ground.take<T>(count);
    for (std::size_t i = 0; i < count && memory != nullptr; ++i) new (memory + i) T{};
    return memory;
}

/// The addresses behind an instance's links, and slots for the commands that it sends to other activities.
void bind_links(const ScriptUnit& unit, UnitPart& part, detail::UnitGround& ground, MachineInstance& machine,
                std::size_t driven) {
    const MachineView& table = machine.machine().table;
    const auto rows = part.type->tables.links;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::size_t c = component_of(table, table.components[driven].name, unit, rows[i].peer);
        ProgramLink& link = part.links[i];
        link.component = link.place = machine.component(c);
        if (rows[i].facet == LinkRow::component_itself) continue;
        if (void* place = machine.place_of({c, rows[i].facet}); place != nullptr) link.place = place;
    }
    std::size_t slot = 0;
    const std::size_t sender = machine.machine().index.activity[driven];
    detail::for_each_slot_link(unit, *part.type, [&](std::size_t i, const Facet& facet) {
        std::byte* values = ground.take(facet.command->value_bytes(), data_alignment);
        const std::size_t c = component_of(table, table.components[driven].name, unit, rows[i].peer);
        if (values == nullptr || part.slots == nullptr) return;
        part.slots[slot].place(machine.command_route({c, rows[i].facet}, sender), values);
        part.links[i].slot = &part.slots[slot++];
    });
}

} // namespace

Sentence BehaviourUnit::place(const ScriptUnit& unit, std::span<const ProgramCode> code,
                              const BehaviourOptions& options, std::span<std::byte> memory,
                              std::span<const std::string_view> events, MachineInstance& machine,
                              std::size_t driven) {
    unit_ = unit;
    parts_ = {};
    routes_ = {};
    detail::UnitGround ground{memory};
    auto* parts = make<UnitPart>(ground, unit.instances.size());
    auto* views = make<ResolvedView>(ground, unit.types.size());
    auto* routes = make<UnitRoute>(ground, events.size() * unit.instances.size());
    if (ground.full()) return Sentence{"it has more instances than there is room for; make the slot larger"};
    for (std::size_t t = 0; t < unit.types.size(); ++t) {
        const BehaviourType& type = unit.types[t];
        if (type.is_program()) continue;
        const ResolvedRoom room = take_room(ground, measure(type.machine));
        if (ground.full()) return Sentence{"its states do not fit; make the slot larger"};
        views[t] = resolve_into(type.machine, room);
    }
    for (std::size_t i = 0; i < unit.instances.size(); ++i) {
        const BehaviourInstance& row = unit.instances[i];
        UnitPart& part = parts[i];
        part.row = &row;
        part.type = &unit.types[row.type];
        StateMachineBinding binding;
        if (!part.type->is_program()) {
            part.machine = make<StateMachineExecution>(ground, 1);
            const MachineMemory kept = take_machine_memory(ground, views[row.type].sizes);
            binding.history = kept.history;
            binding.deferred = kept.deferred;
        }
        const std::size_t bytes = part.type->tables.layout.size;
        part.data = ground.take(bytes, data_alignment);
        part.links = make<ProgramLink>(ground, part.type->tables.links.size());
        detail::for_each_slot_link(unit, *part.type, [&](std::size_t, const Facet&) { ++part.slot_count; });
        part.slots = make<CommandSlot>(ground, part.slot_count);
        if (ground.full()) return Sentence{"its data and commands do not fit; make the slot larger"};
        std::fill_n(part.data, bytes, std::byte{});
        std::copy(row.image.begin(), row.image.end(), part.data);
        bind_links(unit, part, ground, machine, driven);
        if (ground.full()) return Sentence{"its commands do not fit; make the slot larger"};
        if (part.machine == nullptr) continue;
        binding.machine = views[row.type];
        binding.component = machine.component(driven);
        binding.code = row.type < code.size() ? code[row.type] : ProgramCode{};
        binding.data = part.data;
        binding.links = part.links;
        if (!part.machine->bind(binding)) return Sentence{"its programs have no code"};
        for (std::size_t e = 0; e < events.size(); ++e)
            for (std::size_t t = 0; t < views[row.type].triggers.size(); ++t)
                if (views[row.type].triggers[t] == events[e])
                    routes[e * unit.instances.size() + i].trigger = static_cast<TriggerIndex>(t);
    }
    parts_ = {parts, unit.instances.size()};
    routes_ = {routes, events.size() * unit.instances.size()};
    static_cast<void>(options);
    return {};
}

void BehaviourUnit::trace(StateMachineExecution::Trace hook, void* context) noexcept {
    for (UnitPart& part : parts_)
        if (part.machine != nullptr) part.machine->trace(hook, context);
}

bool BehaviourUnit::hears(std::size_t event) const noexcept TAPPET_REALTIME {
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (routes_[event * parts_.size() + i].trigger != no_trigger) return true;
    return false;
}

bool BehaviourUnit::is_quiet() const noexcept TAPPET_REALTIME {
    for (const UnitPart& part : parts_)
        for (std::size_t i = 0; i < part.slot_count; ++i)
            if (!part.slots[i].is_mine()) return false;
    return true;
}

// The stop of a component leaves its machines in the final state; the next start leads from there.
void BehaviourUnit::start(Time now) noexcept TAPPET_REALTIME {
    for (UnitPart& part : parts_) {
        if (part.row->parent != no_instance || part.machine == nullptr) continue;
        if (part.machine->start(now) == StateOutcome::ignored)
            static_cast<void>(part.machine->request_initial(now));
    }
}

void BehaviourUnit::step_programs(Time) noexcept TAPPET_REALTIME {}

void BehaviourUnit::step(Time now) noexcept TAPPET_REALTIME {
    for (UnitPart& part : parts_)
        if (part.machine != nullptr) part.machine->step(now);
}

void BehaviourUnit::finish(Time now, std::string_view reason) noexcept TAPPET_REALTIME {
    for (UnitPart& part : parts_)
        if (part.machine != nullptr) static_cast<void>(part.machine->request_final(now, reason));
}

bool BehaviourUnit::is_finished() const noexcept TAPPET_REALTIME {
    for (const UnitPart& part : parts_)
        if (part.machine != nullptr && part.machine->is_active() && !part.machine->is_final()) return false;
    return true;
}

void BehaviourUnit::deactivate(Time now) noexcept TAPPET_REALTIME {
    for (UnitPart& part : parts_)
        if (part.machine != nullptr) static_cast<void>(part.machine->deactivate(now));
}

Time BehaviourUnit::next() const noexcept TAPPET_REALTIME {
    Time earliest = never;
    for (const UnitPart& part : parts_)
        if (part.machine != nullptr) earliest = std::min(earliest, part.machine->next_timeout());
    return earliest;
}

void BehaviourUnit::dispatch(std::size_t event, const std::byte* packed, Time now) noexcept TAPPET_REALTIME {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const TriggerIndex trigger = routes_[event * parts_.size() + i].trigger;
        if (trigger != no_trigger) static_cast<void>(parts_[i].machine->dispatch(trigger, now, packed));
    }
}

} // namespace tappet
