// The subscriptions of all events: the reaction rows, the triggers of the behaviours, and the observer of
// every event if there is one, in one list, event by event.
#pragma once

#include "kernel/machine/check/check.hpp"
#include "kernel/machine/plan/places.hpp"

#include <algorithm>

namespace tappet {

/// The most unserved emissions that a state machine's trigger holds.
inline constexpr std::uint32_t trigger_quota = 8;
/// The most unserved emissions of each event that wait for the component that sees the machine.
inline constexpr std::uint32_t observer_quota = 8;

constexpr bool is_observable(const Facet& facet) noexcept {
    return facet.kind == FacetKind::event && facet.type->size <= most_observed_bytes;
}

/// Returns the number of subscriptions of a checked table.
constexpr std::size_t count_subscriptions(const MachineView& m) {
    std::size_t count = 0;
    for (const auto& row : m.reactions) count += row.kind == ReactionKind::when;
    for (const auto& row : m.behaviours)
        count += row.is_slot() ? count_slot_events(m, row) : events_of(row.unit()).count;
    for (std::size_t e = 0; e < m.extras->size(); ++e)
        for (std::size_t number = 0; !m.extras->at(e)->counts(number).empty(); ++number) ++count;
    if (find_observer(m) == nowhere) return count;
    for (const auto& row : m.components)
        for (const auto& facet : row.type->facets) count += is_observable(facet);
    return count;
}

namespace detail {

/// Writes them in the order of the table; returns their number.
constexpr std::size_t collect_subscriptions(const MachineView& m, const TableIndexView& r,
                                            std::span<Subscription> into) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < m.reactions.size(); ++i) {
        const ReactionRow& row = m.reactions[i];
        if (row.kind != ReactionKind::when) continue;
        Subscription& s = into[n++];
        s.event = r.reactions[i].from;
        s.target = r.reactions[i].to;
        if (facet_at(m, s.target).kind == FacetKind::wait) s.kind = SubscriberKind::wait;
        s.synchronous = row.target.synchronous;
        s.keeps_latest = row.target.keeps_latest;
        s.is_connected = row.is_connected;
        if (!row.handle.empty())
            static_cast<void>(resolve(m, r.by_name, row.handle, FacetKind::handle, s.handle));
        s.quota = row.target.quota;
        s.receiver = r.activity[s.target.component];
    }
    for (std::size_t b = 0; b < m.behaviours.size(); ++b) {
        const BehaviourRow& row = m.behaviours[b];
        std::size_t number = 0;
        const auto hear = [&](End event) {
            Subscription& s = into[n++];
            s.event = event;
            s.kind = SubscriberKind::trigger;
            s.behaviour = b;
            s.trigger = number++;
            s.is_connected = !row.is_slot(); // the loaded behaviour states the events that it hears
            s.quota = trigger_quota;
            s.receiver = r.activity[find_component(m, row.component)];
        };
        if (row.is_slot()) {
            for_each_slot_event(m, row, hear);
            continue;
        }
        for (const std::string_view name : events_of(row.unit()).all()) {
            End event;
            static_cast<void>(checks::resolve_trigger(m, row, name, event));
            hear(event);
        }
    }
    for (std::size_t e = 0; e < m.extras->size(); ++e)
        for (std::size_t number = 0; !m.extras->at(e)->counts(number).empty(); ++number) {
            Subscription& s = into[n++];
            static_cast<void>(
                resolve(m, r.by_name, m.extras->at(e)->counts(number), FacetKind::event, s.event));
            s.kind = SubscriberKind::counter;
            s.synchronous = true;
            s.section = e;
            s.counted = number;
        }
    const std::size_t observer = find_observer(m);
    if (observer == nowhere) return n;
    for (std::size_t c = 0; c < m.components.size(); ++c)
        for (std::size_t f = 0; f < m.components[c].type->facets.size(); ++f) {
            if (!is_observable(m.components[c].type->facets[f])) continue;
            Subscription& s = into[n++];
            s.event = {c, f};
            s.kind = SubscriberKind::observer;
            s.is_connected = false;
            s.quota = observer_quota;
            s.receiver = r.activity[observer];
        }
    return n;
}

} // namespace detail

/// Writes the subscriptions of a checked table into `into`, which must have room for all. Those of one event
/// are adjacent, in the order in which an emission runs them (thesis 4.6.2): first the synchronous ones in
/// the order of the table, then the asynchronous ones, the most urgent receiver first.
constexpr void list_subscriptions(const MachineView& m, const TableIndexView& r,
                                  std::span<Subscription> into) {
    const std::size_t n = detail::collect_subscriptions(m, r, into);
    for (std::size_t i = 0; i < n; ++i) {
        into[i].order = i;
        into[i].emitters = r.reach[into[i].event.component];
    }
    std::sort(into.begin(), into.end(), [&r](const Subscription& a, const Subscription& b) {
        if (a.event.component != b.event.component) return a.event.component < b.event.component;
        if (a.event.facet != b.event.facet) return a.event.facet < b.event.facet;
        if (a.synchronous != b.synchronous) return a.synchronous;
        if (!a.synchronous && a.receiver != b.receiver) return r.rank[a.receiver] < r.rank[b.receiver];
        return a.order < b.order;
    });
    for (std::size_t i = 0; i < n; ++i)
        into[i].turn = i != 0 && into[i - 1].event == into[i].event ? into[i - 1].turn + 1 : 0;
}

/// Returns the fault of an event with more subscriptions than it has bits; empty: none.
constexpr Sentence over_subscribed(const MachineView& m, std::span<const Subscription> list) {
    for (const Subscription& each : list)
        if (each.turn >= max_subscribers)
            return Sentence{m.name,
                            ": event \"",
                            m.components[each.event.component].name,
                            ".",
                            facet_at(m, each.event).name,
                            "\" has more than ",
                            max_subscribers,
                            " reactions and triggers; let one operation emit an event of its own for some of "
                            "them"};
    return {};
}

} // namespace tappet
