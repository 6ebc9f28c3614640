// The requests of a behaviour's unit to its machine, row by row: the events that it hears, the components in
// its reach, the commands that it sends to other activities. The checks, the plan and start-up iterate over
// them.
#pragma once

#include "kernel/machine/table/behaviours.hpp"
#include "kernel/machine/table/index.hpp"

#include <array>

namespace tappet {

/// The names of events that the state machines of a unit hear, each once, in the order of their first use.
struct UnitEvents {
    std::array<std::string_view, max_state_events> names{};
    std::size_t count = 0;
    bool too_many = false;

    constexpr void add(std::string_view name) noexcept {
        if (find(name) != nowhere) return;
        too_many |= count == names.size();
        if (!too_many) names[count++] = name;
    }
    [[nodiscard]] constexpr std::size_t find(std::string_view name) const noexcept {
        for (std::size_t i = 0; i < count; ++i)
            if (names[i] == name) return i;
        return nowhere;
    }
    [[nodiscard]] constexpr std::span<const std::string_view> all() const noexcept {
        return {names.data(), count};
    }
};

constexpr UnitEvents events_of(const ScriptUnit& unit) noexcept {
    UnitEvents events;
    for (const BehaviourType& type : unit.types)
        for (const TransitionRow& row : type.machine.transitions)
            if (row.on_event) events.add(row.event);
    return events;
}

/// Returns the component at a number of a unit's reach; 0 is the one that the row drives.
constexpr std::size_t component_of(const MachineView& m, std::string_view driven, const ScriptUnit& unit,
                                   std::size_t peer) noexcept {
    return find_component(m, peer == 0 || peer >= unit.reach.size() ? driven : unit.reach[peer].name);
}

/// Calls visit(component, facet) for each command slot that the instances of a unit need.
template <class Visit>
constexpr void for_each_command_slot(const MachineView& m, std::string_view driven, const ScriptUnit& unit,
                                     const Visit& visit) {
    for (const BehaviourInstance& instance : unit.instances)
        for (const LinkRow& link : unit.types[instance.type].tables.links)
            if (link.needs_slot) visit(End{component_of(m, driven, unit, link.peer), link.facet});
}

/// Calls visit(event) for each event that a slot reserves: those of its own component, and the events of its
/// peers that it names.
template <class Visit>
constexpr void for_each_slot_event(const MachineView& m, const BehaviourRow& row, const Visit& visit) {
    const std::size_t own = find_component(m, row.component);
    for (std::size_t f = 0; f < m.components[own].type->facets.size(); ++f) {
        const Facet& facet = m.components[own].type->facets[f];
        if (facet.kind == FacetKind::event && facet.type->size <= most_trigger_bytes) visit(End{own, f});
    }
    for (const std::string_view name : row.slot.events) {
        End event;
        static_cast<void>(resolve(m, name, FacetKind::event, event));
        if (event.component != own) visit(event);
    }
}

/// Returns the bytes of the longest arguments of these events, at least those of a message.
constexpr std::size_t longest_slot_event(const MachineView& m, const BehaviourRow& row) {
    std::size_t longest = sizeof(Message::arguments);
    for_each_slot_event(m, row, [&](End event) {
        if (const std::size_t size = facet_at(m, event).type->size; size > longest) longest = size;
    });
    return longest;
}
constexpr std::size_t count_slot_events(const MachineView& m, const BehaviourRow& row) {
    std::size_t count = 0;
    for_each_slot_event(m, row, [&](End) { ++count; });
    return count;
}

} // namespace tappet
