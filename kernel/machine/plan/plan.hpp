// Plans a machine's memory: one block, laid out by the compiler from a checked table.
#pragma once

#include "kernel/machine/plan/operations.hpp"
#include "kernel/machine/plan/places.hpp"
#include "kernel/machine/plan/scope.hpp"
#include "kernel/machine/plan/subscription.hpp"
#include "kernel/machine/slots/memory.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

namespace tappet {

namespace detail {

/// The C library starts no thread with a smaller stack, whatever the row claims.
#if defined(__aarch64__)
inline constexpr std::size_t least_stack_bytes = 128 * 1024;
#else
inline constexpr std::size_t least_stack_bytes = 16 * 1024;
#endif

constexpr void plan_components(const MachineView& m, const TableIndexView& r, PlanView& p, Layout& layout) {
    // Activity by activity, so that components that run together are adjacent, each on cache lines of its
    // own.
    std::size_t begin = 0;
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        ActivityPlan& activity = p.activities[a];
        layout.take(0, line_pair_bytes);
        activity.parts.count = m.activities[a].runs.size();
        for (const std::size_t c : r.in_order.subspan(begin, activity.parts.count)) {
            p.component_at[c] = layout.take(m.components[c].type->size, m.components[c].type->align);
            p.part_of[c] = static_cast<std::uint32_t>(r.position[c]);
            for (const auto& facet : m.components[c].type->facets)
                activity.timers.count += facet.kind == FacetKind::timer;
        }
        begin += activity.parts.count;
        layout.place(activity.parts);
        activity.functions_at = layout.take<FunctionTiming>(activity.parts.count * functions_per_part);
        layout.place(activity.timers);
    }
}

constexpr void plan_connections(const MachineView& m, const TableIndexView& r, PlanView& p, Layout& layout) {
    for (std::size_t x = 0; x < m.connections.size(); ++x) {
        const ConnectionRow& row = m.connections[x];
        const Link& link = r.connections[x];
        const std::size_t writer = r.activity[link.from.component];
        const std::size_t reader = r.activity[link.to.component];
        ConnectionPlan& plan = p.connections[x];
        plan.shared = writer != reader || is_scaled(row);
        const Facet& from = facet_at(m, link.from);
        if (row.buffered) {
            const auto& buffer = *from.buffer;
            plan.memory_at = layout.take(buffer.ring_bytes(row.capacity, plan.shared), buffer.ring_align);
        } else if (plan.shared) {
            // Rows of one output share one object; the chain leads from this row to the earlier ones.
            for (std::size_t j = r.connections_from.next[x]; j != nowhere && plan.first_of_output;
                 j = r.connections_from.next[j])
                if (r.connections[j].from == link.from && p.connections[j].shared)
                    plan.memory_at = p.connections[j].memory_at, plan.first_of_output = false;
            const auto& port = *from.port;
            if (plan.first_of_output) plan.memory_at = layout.take(port.shared_bytes, port.shared_align);
        }
        if (row.wakes_reader) plan.waker_at = layout.take<WakerNode>();
        if (has_values_between(row)) plan.between_at = layout.take<BetweenValues>();
        if (is_guarded(row)) ++p.activities[reader].guarded.count;
        if (is_needed_input(m, row, link)) ++p.activities[reader].inputs.count;
    }
    for (auto& activity : p.activities) {
        layout.place(activity.guarded);
        layout.place(activity.inputs);
    }
}

constexpr void plan_subscriptions(const MachineView& m, const TableIndexView& r, PlanView& p,
                                  Layout& layout) {
    list_subscriptions(m, r, p.subscriptions);
    const std::size_t activities = m.activities.size();
    std::size_t lane_of_at = nowhere;
    for (std::size_t s = 0; s < p.subscriptions.size(); ++s) {
        const Subscription& row = p.subscriptions[s];
        SubscriptionPlan& plan = p.subscription_at[s];
        if (row.turn == 0) {
            std::size_t listeners = 1;
            while (s + listeners < p.subscriptions.size() && p.subscriptions[s + listeners].turn != 0)
                ++listeners;
            plan.subscribers_at = layout.take(listeners * facet_at(m, row.event).event->subscriber_bytes,
                                              alignof(std::max_align_t));
        }
        if (s == 0 || p.subscriptions[s - 1].event.component != row.event.component) lane_of_at = nowhere;
        if (row.synchronous) continue;
        if (lane_of_at == nowhere) lane_of_at = layout.take<std::uint8_t>(activities);
        plan.lane_of_at = lane_of_at;
        plan.async_at = layout.take<AsyncReaction>();
        plan.lanes.count = static_cast<std::size_t>(std::popcount(row.emitters));
        layout.place(plan.lanes);
        if (row.keeps_latest) plan.latest_at = layout.take<LatestMessage>(plan.lanes.count);
        if (const std::size_t bytes = parcel_bytes(facet_at(m, row.event).type->size); bytes != 0)
            plan.parcels_at =
                layout.take(plan.lanes.count * parcel_places(row.quota, row.keeps_latest) * bytes,
                            alignof(std::uint64_t));
        if (row.kind == SubscriberKind::trigger) plan.binding_at = layout.take<TriggerBinding>();
        if (row.kind == SubscriberKind::observer) plan.binding_at = layout.take<ObserverBinding>();
        if (row.kind == SubscriberKind::wait) {
            plan.mailboxes_at = layout.take<Mailbox>(plan.lanes.count);
            plan.mail_at = layout.take(plan.lanes.count * Mailbox::bytes_for(row.quota), Mailbox::alignment);
            continue;
        }
        for (std::size_t sender = 0; sender < activities; ++sender)
            if ((row.emitters >> sender & 1) != 0)
                p.mail[sender * activities + row.receiver].capacity += row.quota;
    }
    for (std::size_t receiver = 0; receiver < activities; ++receiver) {
        auto& boxes = p.activities[receiver].mailboxes;
        plan_mail(m, r, boxes, p.mail, p.requests[receiver], receiver, layout);
        layout.place(boxes);
    }
}

constexpr void plan_behaviours(const MachineView& m, const TableIndexView& r, PlanView& p, Layout& layout) {
    for (std::size_t b = 0; b < m.behaviours.size(); ++b) {
        const BehaviourRow& row = m.behaviours[b];
        BehaviourPlan& plan = p.behaviours[b];
        if (row.is_slot()) {
            plan.events.count = count_slot_events(m, row);
            plan.slot_at = layout.take<BehaviourSlot>();
            plan.handles_at = layout.take<EventHandle>(plan.events.count);
            plan.text.count = slot_text_bytes(row.slot);
            layout.place(plan.text);
            plan.memory.count = 2 * bank_bytes(row, plan.events.count, longest_slot_event(m, row));
        } else {
            const ScriptUnit unit = row.unit();
            plan.events.count = events_of(unit).count;
            plan.unit_at = layout.take<BehaviourUnit>();
            plan.memory.count = unit_bytes(unit, plan.events.count);
        }
        layout.place(plan.events);
        plan.memory.at = layout.take(plan.memory.count, unit_alignment);
        ++p.activities[r.activity[find_component(m, row.component)]].behaviours.count;
    }
    for (auto& activity : p.activities) layout.place(activity.behaviours);
}

} // namespace detail

/// Plans a checked table for a board. The map comes first: every reader of the memory begins there.
constexpr void make_plan(const MachineView& m, const Board& board, const Binding& binding,
                         const TableIndexView& r, std::size_t map_bytes, PlanView& p) {
    Layout layout;
    layout.take(map_bytes, alignof(std::max_align_t));
    p.observed_at = layout.take<Observed>();
    detail::plan_components(m, r, p, layout);
    detail::plan_connections(m, r, p, layout);
    detail::plan_subscriptions(m, r, p, layout);
    detail::plan_commands(m, r, p, layout);
    detail::plan_behaviours(m, r, p, layout);
    p.extras_at = layout.take(0, alignof(std::max_align_t));
    for (std::size_t e = 0; e < m.extras->size(); ++e)
        layout.take(align_section(m.extras->at(e)->bytes(m)), 1);
    p.engines_at = layout.take<Engine>(m.activities.size());
    detail::plan_scope(m, p, layout);
    const std::size_t before_stacks = layout.used();
    constexpr std::size_t page = 4096;
    p.shared_bytes = (before_stacks + page - 1) / page * page;
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        ActivityPlan& plan = p.activities[a];
        const ActivityRow& row = m.activities[a];
        plan.stack_bytes = (std::max(row.stack_bytes(), detail::least_stack_bytes) + page - 1) / page * page;
        plan.stack_at = layout.take(plan.stack_bytes, page);
        plan.priority = row.real_time ? board.highest_priority - static_cast<int>(r.rank[a]) : 0;
        plan.processor = checks::processor_of(board, binding, row.name);
    }
    p.bytes = (layout.used() + page - 1) / page * page;
    p.stack_bytes = layout.used() - before_stacks;
}

/// Returns the fault that only the plan shows: too many reactions to an event, or too little memory. Empty:
/// none.
constexpr Sentence check_plan(const MachineView& m, const Board& board, std::span<const Subscription> list,
                              std::size_t machine_bytes, std::size_t stack_bytes) {
    if (const Sentence listeners = over_subscribed(m, list); !listeners.empty()) return listeners;
    std::size_t bytes = 0;
    if (__builtin_add_overflow(machine_bytes, board.heap_bytes, &bytes)) bytes = ~std::size_t{0};
    if (bytes <= board.memory_budget_bytes) return {};
    return Sentence{m.name,
                    ": board \"",
                    board.name,
                    "\": the machine takes ",
                    bytes,
                    " bytes of static memory (",
                    stack_bytes,
                    " of them stacks, ",
                    board.heap_bytes,
                    " the heap) but the board's budget is ",
                    board.memory_budget_bytes,
                    "; shorten stacks, buffers or slots, or raise memory_budget_bytes"};
}

/// The storage of a plan, in the table's sizes.
template <std::size_t C, std::size_t A, std::size_t X, std::size_t S, std::size_t B>
struct Plan : PlanOfAll {
    std::array<std::size_t, C> component_at{};
    std::array<std::uint32_t, C> part_of{};
    std::array<ActivityPlan, A> activities{};
    std::array<ConnectionPlan, X> connections{};
    std::array<Subscription, S> subscriptions{};
    std::array<SubscriptionPlan, S> subscription_at{};
    std::array<BehaviourPlan, B> behaviours{};
    std::array<MailPlan, A * A> mail{};
    std::array<MailPlan, A> requests{};
    std::array<MailPlan, A * A> command_mail{};
    std::array<MailPlan, A> command_requests{};

    constexpr PlanView view() noexcept {
        return {*this,           component_at, part_of, activities, connections,  subscriptions,
                subscription_at, behaviours,   mail,    requests,   command_mail, command_requests};
    }
};

} // namespace tappet
