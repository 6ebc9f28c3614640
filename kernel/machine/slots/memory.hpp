// Memory that behaviours need: the same sums for the plan, which counts, and for start-up and loading, which
// place objects.
#pragma once

#include "kernel/base/layout.hpp"
#include "kernel/machine/slots/behaviour_unit.hpp"
#include "kernel/script/room.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace tappet {

namespace detail {

/// Places objects one after the other in a block of memory; without a block it only counts.
class UnitLayout {
public:
    constexpr UnitLayout() = default;
    explicit constexpr UnitLayout(std::span<std::byte> memory) noexcept : memory_{memory} {}
    template <class T>
    constexpr T* take(std::size_t count) noexcept {
        std::byte* place = take(count * sizeof(T), alignof(T));
        if (place == nullptr) return nullptr;
        return reinterpret_cast<T*>(place);
    }
    constexpr std::byte* take(std::size_t bytes, std::size_t align) noexcept {
        const std::size_t here = counted_.take(bytes, align);
        return memory_.empty() || full() ? nullptr : memory_.data() + here;
    }
    template <class T> constexpr void take(std::span<T>& into, std::size_t count) noexcept {
        into = {take<T>(count), count};
    }
    [[nodiscard]] constexpr std::size_t used() const noexcept { return counted_.used(); }
    [[nodiscard]] constexpr bool full() const noexcept { return used() > memory_.size(); }

private:
    std::span<std::byte> memory_{};
    Layout counted_{};
};

/// Calls visit(link number, facet) for each command of one instance that is sent to another activity.
template <class Visit>
constexpr void for_each_slot_link(const ScriptUnit& unit, const BehaviourType& type, const Visit& visit) {
    for (std::size_t i = 0; i < type.tables.links.size(); ++i) {
        const LinkRow& link = type.tables.links[i];
        if (link.needs_slot) visit(i, unit.reach[link.peer].type->facets[link.facet]);
    }
}

} // namespace detail

/// Reserves the memory of a type's resolved state machine.
constexpr ResolvedRoom take_room(detail::UnitLayout& layout, const ResolvedSizes& sizes) noexcept {
    ResolvedRoom room;
    layout.take(room.plans, sizes.states);
    layout.take(room.triggers, sizes.triggers);
    layout.take(room.cells, sizes.states * sizes.triggers);
    layout.take(room.asked, sizes.asked);
    layout.take(room.arcs, sizes.arcs);
    layout.take(room.steps, sizes.steps);
    layout.take(room.regions, sizes.regions);
    layout.take(room.captured, sizes.triggers);
    return room;
}

/// Memory that the execution of one instance keeps from step to step.
struct MachineMemory {
    std::span<StateIndex> history{};
    std::span<std::byte> deferred{};
};
constexpr MachineMemory take_machine_memory(detail::UnitLayout& layout, const ResolvedSizes& sizes) noexcept {
    const std::size_t bytes = sizes.captured * StateMachineExecution::max_raised_events;
    auto* history = layout.take<StateIndex>(sizes.history);
    return {{history, sizes.history}, {layout.take(bytes, data_alignment), bytes}};
}

/// Alignment of the memory of a unit.
inline constexpr std::size_t unit_alignment = std::max(alignof(CommandSlot), data_alignment);

/// Returns the bytes of a unit that hears so many events, aligned to unit_alignment. The same sums as in
/// BehaviourUnit::place.
constexpr std::size_t unit_bytes(const ScriptUnit& unit, std::size_t events) {
    detail::UnitLayout layout;
    layout.take<UnitPart>(unit.instances.size());
    layout.take<StateMachineExecution>(unit.instances.size());
    layout.take<ProgramExecution>(count_programs(unit.types, unit.instances));
    layout.take<ResolvedView>(unit.types.size());
    layout.take<UnitRoute>(events * unit.instances.size());
    for (std::size_t t = 0; t < unit.types.size(); ++t) {
        if (unit.types[t].is_program()) continue;
        const ResolvedSizes sizes = measure(unit.types[t].machine);
        static_cast<void>(take_room(layout, sizes));
        for (const BehaviourInstance& instance : unit.instances)
            if (instance.type == t) static_cast<void>(take_machine_memory(layout, sizes));
    }
    for (const BehaviourInstance& instance : unit.instances) {
        const BehaviourType& type = unit.types[instance.type];
        layout.take(type.tables.layout.size, data_alignment);
        layout.take<ProgramLink>(type.tables.links.size());
        std::size_t slots = 0;
        detail::for_each_slot_link(unit, type, [&](std::size_t, const Facet&) { ++slots; });
        layout.take<CommandSlot>(slots);
        detail::for_each_slot_link(unit, type, [&](std::size_t, const Facet& facet) {
            layout.take(facet.command->value_bytes(), data_alignment);
        });
    }
    return layout.used();
}

namespace detail {

/// Reserves the memory of the rows of a compiled script in a bank.
constexpr ScriptRoom take_script_room(UnitLayout& layout, const ScriptSizes& sizes) noexcept {
    ScriptRoom room;
    for_each_table(
        [&layout]<class Row>(std::span<Row>& rows, std::size_t count) {
            if constexpr (std::is_same_v<Row, std::byte>) layout.take(0, data_alignment);
            layout.take(rows, count);
        },
        room, sizes);
    return room;
}

} // namespace detail

/// The bytes of the arguments and results, together, of one command that a loaded behaviour sends.
inline constexpr std::size_t slot_command_bytes = 128;

constexpr ScriptSizes slot_sizes(const Slot& slot) noexcept {
    return script_sizes_for(slot.nodes, slot.data_bytes, static_cast<std::uint32_t>(slot.peers.size() + 1));
}
constexpr std::size_t slot_text_bytes(const Slot& slot) noexcept {
    return slot.text_bytes != 0 ? slot.text_bytes : 48 * std::size_t{slot.nodes};
}
/// Returns the sizes of a script's resolved machines, assuming usual proportions: few transitions lead out of
/// a composite state and so out of each of its leaves.
constexpr ResolvedSizes slot_resolved_sizes(const ScriptSizes& sizes, std::size_t events) noexcept {
    ResolvedSizes resolved;
    resolved.states = resolved.regions = sizes.states;
    resolved.triggers = std::min<std::size_t>(sizes.transitions, events * sizes.types);
    resolved.arcs = std::size_t{sizes.transitions} + first_arc;
    resolved.asked = 3 * std::size_t{sizes.transitions};
    resolved.steps = 12 * resolved.arcs + 2 * std::size_t{sizes.states};
    return resolved;
}
/// Returns the bytes of one bank: the rows, and the unit made of them. Each instance keeps `longest` bytes of
/// arguments for every waiting event. A machine of unusual proportions may need more memory for its resolved
/// form; then it is refused.
constexpr std::size_t slot_bank_bytes(const Slot& slot, std::size_t events, std::size_t longest) noexcept {
    const ScriptSizes sizes = slot_sizes(slot);
    detail::UnitLayout layout;
    static_cast<void>(detail::take_script_room(layout, sizes));
    layout.take(0, unit_alignment);
    layout.take<UnitPart>(sizes.instances);
    layout.take<ResolvedView>(sizes.types);
    layout.take<UnitRoute>(events * sizes.instances);
    static_cast<void>(take_room(layout, slot_resolved_sizes(sizes, events)));
    layout.take<StateIndex>(sizes.states);
    for (std::size_t i = 0; i < sizes.instances; ++i) {
        layout.take<StateMachineExecution>(1);
        layout.take<ProgramExecution>(1);
        layout.take(longest * StateMachineExecution::max_raised_events, data_alignment);
    }
    layout.take(sizes.data + sizes.instances * data_alignment, data_alignment);
    layout.take<ProgramLink>(2 * sizes.links);
    layout.take<CommandSlot>(slot.command_slots);
    layout.take(slot.command_slots * slot_command_bytes, data_alignment);
    return layout.used();
}
/// Returns the bytes of either bank of a row: the initial behaviour must fit, too.
constexpr std::size_t bank_bytes(const BehaviourRow& row, std::size_t events, std::size_t longest) {
    detail::UnitLayout layout;
    layout.take(std::max(slot_bank_bytes(row.slot, events, longest), unit_bytes(row.unit(), events)),
                unit_alignment);
    layout.take(0, unit_alignment); // the other bank follows
    return layout.used();
}

} // namespace tappet
