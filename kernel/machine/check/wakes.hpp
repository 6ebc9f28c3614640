// Checks the wakes of activities that are not periodic: a row must lead to each step() and work() that one
// runs, from a component that acts. Timers and behaviours' waits run nothing but themselves.
#pragma once

#include "kernel/machine/check/behaviours.hpp"

#include <utility>

namespace tappet::checks {

/// Whether a component runs code of its own that may emit, write or call, even if nothing wakes its activity.
constexpr bool acts_by_itself(const ComponentType& type, bool has_browser) noexcept {
    if (type.start != nullptr || type.loop != nullptr || type.sees_machine) return true;
    const bool is_called = has_browser && type.step == nullptr && type.work == nullptr; // a person calls it
    for (const Facet& facet : type.facets)
        if (facet.kind == FacetKind::timer ||
            (is_called && (facet.kind == FacetKind::operation || facet.kind == FacetKind::method ||
                           facet.kind == FacetKind::command)))
            return true;
    return false;
}

/// Whether a driver has nobody who wakes it: neither its device nor the driver whose device it shares.
constexpr bool polls_device(const ComponentType& type) noexcept {
    return type.device_kind != nullptr && !type.woken_by_device && !type.shares_device;
}

/// Calls visit(from, to, name, name) for each row by which component `from`, when it acts, wakes the activity
/// of component `to`.
template <class Visit>
constexpr void for_each_wake(const MachineView& m, const TableIndexView& r, const Visit& visit) {
    for (std::size_t x = 0; x < m.connections.size(); ++x)
        if (m.connections[x].wakes_reader)
            visit(r.connections[x].from.component, r.connections[x].to.component, m.connections[x].from,
                  m.connections[x].to);
    for (std::size_t i = 0; i < m.reactions.size(); ++i) {
        const ReactionRow& row = m.reactions[i];
        const std::size_t from = r.reactions[i].from.component, to = r.reactions[i].to.component;
        const bool is_command =
            row.kind == ReactionKind::uses && facet_at(m, r.reactions[i].to).kind == FacetKind::command;
        if (is_command || (row.kind == ReactionKind::when && !row.target.synchronous))
            visit(from, to, row.event, row.target.operation);
        if (is_command)
            visit(from, from, row.target.operation, row.event); // a finished command wakes its sender
    }
    for (const BehaviourRow& row : m.behaviours) {
        const std::size_t own = find_component(m, r.by_name, row.component);
        const auto hear = [&](std::string_view event) {
            End found;
            if (resolve_trigger(m, row, event, found).empty())
                visit(found.component, own, event, row.component);
        };
        const UnitEvents events = row.is_slot() ? UnitEvents{} : events_of(row.unit());
        for (const std::string_view event : events.all()) hear(event);
        for (const std::string_view event : row.slot.events) hear(event);
    }
}

/// Fills the components that act, and returns the activities that are woken, a bit each: the fixed point from
/// what runs by itself.
constexpr std::uint64_t find_acting(const MachineView& m, const TableIndexView& r) {
    bool has_browser = false;
    for (const ComponentRow& row : m.components) has_browser |= row.type->sees_machine;
    std::uint64_t awake = 0;
    for (std::size_t a = 0; a < m.activities.size(); ++a)
        if (m.activities[a].trigger != Trigger::on_work) awake |= std::uint64_t{1} << a;
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        const ComponentType& type = *m.components[c].type;
        if (type.woken_by_device) awake |= std::uint64_t{1} << r.activity[c];
        r.acts[c] = acts_by_itself(type, has_browser);
    }
    for (const BehaviourRow& row : m.behaviours) {
        r.acts[find_component(m, r.by_name, row.component)] = true;
        const auto reach = row.unit().reach;
        for (std::size_t peer = 1; peer < reach.size(); ++peer)
            r.acts[find_component(m, reach[peer].name)] = true;
        for (const std::string_view peer : row.slot.peers) r.acts[find_component(m, peer)] = true;
    }
    for (bool grown = true; grown;) {
        grown = false;
        const auto act = [&](std::size_t c) { grown |= !std::exchange(r.acts[c], true); };
        for (std::size_t c = 0; c < m.components.size(); ++c)
            if ((awake >> r.activity[c] & 1) != 0) act(c);
        for (std::size_t i = 0; i < m.reactions.size(); ++i)
            if (r.acts[r.reactions[i].from.component]) act(r.reactions[i].to.component);
        const std::uint64_t before = awake;
        for_each_wake(m, r, [&](std::size_t from, std::size_t to, std::string_view, std::string_view) {
            if (r.acts[from]) awake |= std::uint64_t{1} << r.activity[to];
        });
        grown |= awake != before;
    }
    return awake;
}

/// Checks that a row from a component that acts wakes activity `a` for its component `stepped`. `is_awake`: a
/// device or such a row wakes the activity.
constexpr Sentence check_woken(const MachineView& m, const TableIndexView& r, std::size_t a,
                               std::size_t stepped, bool is_awake) {
    Sentence first;
    bool is_woken = false;
    for_each_wake(m, r, [&](std::size_t from, std::size_t to, std::string_view by, std::string_view what) {
        if (r.activity[to] != a) return;
        is_woken |= r.acts[from];
        if (first.empty()) first = Sentence{"\"", by, "\" -> \"", what, "\""};
    });
    const ActivityRow& row = m.activities[a];
    const ComponentRow& component = m.components[stepped];
    const std::string_view step = component.type->step != nullptr ? "step()" : "work()";
    if (is_woken) return {};
    if (is_awake)
        return of_activity(row.name, " is woken by no row but by another driver's device, and component \"",
                           component.name, "\" polls its ", component.type->device_kind->name,
                           " device, which wakes nobody; run it every(...)");
    if (!first.empty())
        return of_activity(row.name, " runs on_work() but is woken only by what never runs itself, first by ",
                           first, ", so the ", step, " of component \"", component.name,
                           "\" would never run; add wakes or tell(...) from a component that is run "
                           "every(...) or on_device(...), or run it every(...)");
    return of_activity(row.name, " runs on_work() but no row wakes it, so the ", step, " of component \"",
                       component.name,
                       "\" would never run; add wakes to a connection into it, or "
                       "when(\"...\", tell(\"",
                       component.name, ".operation\")), or run it every(...)");
}

constexpr Sentence check_wakes(const MachineView& m, const TableIndexView& r) {
    if (m.activities.size() >= 64) return {}; // refused by the check of time
    const std::uint64_t awake = find_acting(m, r);
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        const ActivityRow& row = m.activities[a];
        if (row.periodic()) continue;
        const bool is_awake = (awake >> a & 1) != 0;
        for (const auto& name : row.runs) {
            const std::size_t c = find_component(m, r.by_name, name);
            const ComponentType& type = *m.components[c].type;
            if ((type.step == nullptr && type.work == nullptr) || (is_awake && !polls_device(type))) continue;
            if (Sentence fault = check_woken(m, r, a, c, is_awake); !fault.empty()) return fault;
        }
    }
    return {};
}

} // namespace tappet::checks
