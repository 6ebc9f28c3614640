// Wires the subscriptions of events: reaction rows, waits, the triggers of state machines, the observer;
// their handles and the mailboxes.
#include "kernel/machine/instance/instance.hpp"

#include <new>

namespace tappet {

namespace {

void run_trigger(void* binding, const std::byte* packed) noexcept TAPPET_REALTIME {
    const auto& trigger = *static_cast<const TriggerBinding*>(binding);
    if (trigger.slot != nullptr)
        trigger.slot->dispatch(trigger.event, packed, trigger.engine->now());
    else
        trigger.unit->dispatch(trigger.event, packed, trigger.engine->now());
}

void run_observer(void* binding, const std::byte* packed) noexcept TAPPET_REALTIME {
    const auto& event = *static_cast<const ObserverBinding*>(binding);
    if (event.to->observe != nullptr)
        event.to->observe(event.to->observer, event.event_index, packed, event.engine->now());
}

} // namespace

void MachineInstance::connect_events() {
    for (std::size_t s = 0; s < machine_.plan.subscriptions.size(); ++s) {
        const Subscription& row = machine_.plan.subscriptions[s];
        const SubscriptionPlan& place = machine_.plan.subscription_at[s];
        const EventOperations& event = *facet_at(machine_.table, row.event).event;
        if (place.subscribers_at != nowhere)
            event.give_storage(facet(row.event), at<void>(place.subscribers_at));
        AsyncReaction* reaction = nullptr;
        const std::uint64_t bit = std::uint64_t{1} << row.turn;
        if (!row.synchronous) {
            reaction = new (at<AsyncReaction>(place.async_at)) AsyncReaction;
            reaction->bit = bit;
            place_lanes(s, *reaction);
            bind_receiver(s, *reaction);
        }
        std::atomic<std::uint64_t>& connected =
            row.synchronous
                ? event.subscribe(facet(row.event), facet_at(machine_.table, row.target).operation->enter,
                                  gate_of(row.target.component))
                : event.subscribe(facet(row.event), event.post, reaction);
        if (reaction != nullptr) reaction->connected = &connected;
        const EventHandle handle{connected, bit, reaction == nullptr ? nullptr : &reaction->epoch};
        if (row.is_connected) handle.connect();
        if (row.kind == SubscriberKind::trigger && slot_of_row(row.behaviour) != nullptr)
            new (at<EventHandle>(machine_.plan.behaviours[row.behaviour].handles_at) + row.trigger)
                EventHandle{handle};
        if (row.handle.component != nowhere) *static_cast<EventHandle*>(facet(row.handle)) = handle;
    }
}

void MachineInstance::place_lanes(std::size_t s, AsyncReaction& reaction) {
    const Subscription& row = machine_.plan.subscriptions[s];
    const SubscriptionPlan& place = machine_.plan.subscription_at[s];
    const std::size_t n = machine_.table.activities.size();
    auto* lane_of = at<std::uint8_t>(place.lane_of_at);
    auto* lanes = at<EventLane>(place.lanes_at);
    std::size_t count = 0;
    for (std::size_t a = 0; a < n; ++a) {
        lane_of[a] = AsyncReaction::no_lane;
        if ((row.emitters >> a & 1) == 0) continue;
        auto* lane = new (lanes + count) EventLane;
        lane->row = &reaction;
        lane->sender =
            row.kind == SubscriberKind::wait ? count : machine_.plan.mail[a * n + row.receiver].sender_index;
        if (row.keeps_latest) lane->latest = new (at<LatestMessage>(place.latest_at) + count) LatestMessage;
        lane_of[a] = static_cast<std::uint8_t>(count++);
    }
    reaction.lanes = lanes;
    reaction.lane_of = lane_of;
    // What a test or a plant emits in virtual time counts as the component's own.
    if (clock_->is_virtual()) reaction.outside = lane_of[machine_.index.activity[row.event.component]];
    reaction.lane_count = static_cast<std::uint32_t>(count);
    reaction.activities = static_cast<std::uint32_t>(n);
    reaction.quota = row.quota;
}

void MachineInstance::bind_receiver(std::size_t s, AsyncReaction& reaction) {
    const auto& plan = machine_.plan;
    const Subscription& row = plan.subscriptions[s];
    const SubscriptionPlan& place = plan.subscription_at[s];
    Engine& receiver = engines()[row.receiver];
    reaction.inbox = &receiver.inbox();
    reaction.waker = post_waker_of(row.receiver);
    switch (row.kind) {
    case SubscriberKind::operation:
        reaction.run = facet_at(machine_.table, row.target).operation->run;
        reaction.object = component(row.target.component);
        reaction.part = plan.part_of[row.target.component];
        break;
    case SubscriberKind::wait: {
        auto* wait = static_cast<EventWaitState*>(facet(row.target));
        auto* mailboxes = at<Mailbox>(place.mailboxes_at);
        for (std::size_t i = 0; i < place.lane_count; ++i)
            (new (mailboxes + i) Mailbox)
                ->place(at<std::byte>(place.mail_at + i * Mailbox::bytes_for(row.quota)), row.quota,
                        Overflow::reject);
        wait->place(reaction.waker, *clock_, {mailboxes, place.lane_count}, place.lane_count * row.quota);
        reaction.inbox = &wait->inbox();
        reaction.waker = {&EventWaitState::wake, wait};
        reaction.run = &EventWaitState::receive;
        reaction.object = wait;
        reaction.part = plan.part_of[row.target.component];
        break;
    }
    case SubscriberKind::trigger:
        reaction.run = &run_trigger;
        reaction.object = new (at<TriggerBinding>(place.binding_at))
            TriggerBinding{unit_of_row(row.behaviour), slot_of_row(row.behaviour), &receiver, row.trigger};
        reaction.part =
            plan.part_of[find_component(machine_.table, machine_.table.behaviours[row.behaviour].component)];
        break;
    case SubscriberKind::observer:
        reaction.run = &run_observer;
        reaction.object =
            new (at<ObserverBinding>(place.binding_at)) ObserverBinding{&event_observer_, &receiver, s};
        reaction.part = plan.part_of[find_observer(machine_.table)];
        break;
    }
    reaction.receiver = &receiver.plan().parts[reaction.part].state;
}

void MachineInstance::place_mailboxes() {
    const std::size_t n = machine_.table.activities.size();
    for (std::size_t receiver = 0; receiver < n; ++receiver) {
        const ActivityPlan& plan = machine_.plan.activities[receiver];
        auto* mailboxes = at<Mailbox>(plan.mailboxes_at);
        for (std::size_t i = 0; i < plan.sender_count; ++i) new (mailboxes + i) Mailbox;
        for (std::size_t sender = 0; sender < n; ++sender) {
            const MailPlan& mail = machine_.plan.mail[sender * n + receiver];
            if (mail.capacity != 0)
                mailboxes[mail.sender_index].place(at<std::byte>(mail.storage_at), mail.capacity,
                                                   Overflow::reject);
        }
        if (const MailPlan& mail = machine_.plan.requests[receiver]; mail.capacity != 0)
            mailboxes[mail.sender_index].place(at<std::byte>(mail.storage_at), mail.capacity,
                                               Overflow::reject);
        engines()[receiver].inbox().place({mailboxes, plan.sender_count});
    }
}

EventHandle MachineInstance::observe_event(std::size_t component, std::size_t facet_index) noexcept {
    const std::size_t s = observed_index({component, facet_index});
    if (s == nowhere) return {};
    auto* reaction = at<AsyncReaction>(machine_.plan.subscription_at[s].async_at);
    return {*reaction->connected, reaction->bit, &reaction->epoch};
}

std::size_t MachineInstance::observed_index(End event) const noexcept {
    for (std::size_t s = 0; s < machine_.plan.subscriptions.size(); ++s)
        if (machine_.plan.subscriptions[s].kind == SubscriberKind::observer &&
            machine_.plan.subscriptions[s].event == event)
            return s;
    return nowhere;
}

SubscriptionCounts MachineInstance::counts_of(std::size_t s) const noexcept TAPPET_REALTIME {
    const std::size_t place = machine_.plan.subscription_at[s].async_at;
    if (place == nowhere) return {};
    return reinterpret_cast<const AsyncReaction*>(machine_.memory.data() + place)->counts();
}

const ReactionTimes* MachineInstance::times_of_reaction(std::size_t row) const noexcept {
    const auto& plan = machine_.plan;
    const Link& link = machine_.index.reactions[row];
    for (std::size_t s = 0; s < plan.subscriptions.size(); ++s) {
        const Subscription& each = plan.subscriptions[s];
        if (each.kind == SubscriberKind::operation && !each.synchronous && each.event == link.from &&
            each.target == link.to)
            return &reinterpret_cast<const AsyncReaction*>(machine_.memory.data() +
                                                           plan.subscription_at[s].async_at)
                        ->times;
    }
    return nullptr;
}

std::uint64_t MachineInstance::lost_emissions() const noexcept {
    std::uint64_t lost = 0;
    for (std::size_t s = 0; s < machine_.plan.subscriptions.size(); ++s) {
        const Subscription& row = machine_.plan.subscriptions[s];
        if (!row.keeps_latest && row.kind != SubscriberKind::observer) lost += counts_of(s).lost;
    }
    return lost;
}

} // namespace tappet
