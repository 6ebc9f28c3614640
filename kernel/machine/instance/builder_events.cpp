// Wires the subscriptions of events: reaction rows, waits, the triggers of state machines, counters, the
// observer; and their handles.
#include "kernel/machine/instance/builder.hpp"

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

void MachineBuilder::connect_events() {
    for (std::size_t s = 0; s < machine_.plan.subscriptions.size(); ++s) {
        const Subscription& row = machine_.plan.subscriptions[s];
        const SubscriptionPlan& place = machine_.plan.subscription_at[s];
        const EventOperations& event = *facet_at(machine_.table, row.event).event;
        if (place.subscribers_at != nowhere)
            event.give_storage(instance_.facet(row.event), instance_.at<void>(place.subscribers_at));
        AsyncReaction* reaction = nullptr;
        const std::uint64_t bit = std::uint64_t{1} << row.turn;
        if (!row.synchronous) {
            reaction = new (instance_.at<AsyncReaction>(place.async_at)) AsyncReaction;
            reaction->bit = bit;
            place_lanes(s, *reaction);
            bind_receiver(s, *reaction);
        }
        const void* call = event.post;
        void* context = reaction;
        if (row.kind == SubscriberKind::counter) {
            call = event.count;
            context = machine_.table.extras->at(row.section)
                          ->counter(instance_.extra_memory(row.section), row.counted);
        } else if (row.synchronous) {
            call = facet_at(machine_.table, row.target).operation->enter;
            context = instance_.gate_of(row.target.component);
        }
        std::atomic<std::uint64_t>& connected = event.subscribe(instance_.facet(row.event), call, context);
        if (reaction != nullptr) reaction->connected = &connected;
        const EventHandle handle{connected, bit, reaction == nullptr ? nullptr : &reaction->epoch};
        if (row.is_connected) handle.connect();
        if (row.kind == SubscriberKind::trigger && instance_.slot_of_row(row.behaviour) != nullptr)
            new (instance_.at<EventHandle>(machine_.plan.behaviours[row.behaviour].handles_at) + row.trigger)
                EventHandle{handle};
        if (row.handle.component != nowhere) *static_cast<EventHandle*>(instance_.facet(row.handle)) = handle;
    }
}

void MachineBuilder::place_lanes(std::size_t s, AsyncReaction& reaction) {
    const Subscription& row = machine_.plan.subscriptions[s];
    const SubscriptionPlan& place = machine_.plan.subscription_at[s];
    const std::size_t n = machine_.table.activities.size();
    auto* lane_of = instance_.at<std::uint8_t>(place.lane_of_at);
    const auto lanes = make(place.lanes);
    const std::size_t bytes = parcel_bytes(facet_at(machine_.table, row.event).type->size);
    const std::uint32_t places = parcel_places(row.quota, row.keeps_latest);
    std::size_t count = 0;
    for (std::size_t a = 0; a < n; ++a) {
        lane_of[a] = AsyncReaction::no_lane;
        if ((row.emitters >> a & 1) == 0) continue;
        EventLane& lane = lanes[count];
        lane.row = &reaction;
        lane.sender =
            row.kind == SubscriberKind::wait ? count : machine_.plan.mail[a * n + row.receiver].sender_index;
        if (row.keeps_latest)
            lane.latest = new (instance_.at<LatestMessage>(place.latest_at) + count) LatestMessage;
        if (bytes != 0) lane.parcels = instance_.at<std::byte>(place.parcels_at) + count * places * bytes;
        lane_of[a] = static_cast<std::uint8_t>(count++);
    }
    reaction.lanes = lanes.data();
    reaction.lane_of = lane_of;
    // An emission from a test or a plant in virtual time counts as the component's own.
    if (instance_.clock().is_virtual())
        reaction.outside = lane_of[machine_.index.activity[row.event.component]];
    reaction.lane_count = static_cast<std::uint32_t>(count);
    reaction.activities = static_cast<std::uint32_t>(n);
    reaction.quota = row.quota;
    reaction.parcel_bytes = static_cast<std::uint32_t>(bytes);
    reaction.parcel_mask = places - 1;
}

void MachineBuilder::bind_receiver(std::size_t s, AsyncReaction& reaction) {
    const auto& plan = machine_.plan;
    const Subscription& row = plan.subscriptions[s];
    const SubscriptionPlan& place = plan.subscription_at[s];
    Engine& receiver = instance_.engines()[row.receiver];
    reaction.inbox = &receiver.inbox();
    reaction.waker = instance_.post_waker_of(row.receiver);
    switch (row.kind) {
    case SubscriberKind::operation:
        reaction.operation = facet_at(machine_.table, row.target).operation->run;
        reaction.part = plan.part_of[row.target.component];
        break;
    case SubscriberKind::wait: {
        auto* wait = static_cast<EventWaitState*>(instance_.facet(row.target));
        const auto mailboxes = make(PlacesOf<Mailbox>{place.mailboxes_at, place.lanes.count});
        for (std::size_t i = 0; i < mailboxes.size(); ++i)
            mailboxes[i].place(instance_.at<std::byte>(place.mail_at + i * Mailbox::bytes_for(row.quota)),
                               row.quota, Overflow::reject);
        wait->place(reaction.waker, instance_.clock(), mailboxes, mailboxes.size() * row.quota);
        reaction.inbox = &wait->inbox();
        reaction.waker = {&EventWaitState::wake, wait};
        reaction.run = &EventWaitState::receive;
        reaction.object = wait;
        reaction.part = plan.part_of[row.target.component];
        break;
    }
    case SubscriberKind::trigger:
        reaction.run = &run_trigger;
        reaction.object = new (instance_.at<TriggerBinding>(place.binding_at))
            TriggerBinding{instance_.unit_of_row(row.behaviour), instance_.slot_of_row(row.behaviour),
                           &receiver, row.trigger};
        reaction.part =
            plan.part_of[find_component(machine_.table, machine_.table.behaviours[row.behaviour].component)];
        break;
    case SubscriberKind::counter: break; // it is synchronous and has no receiver
    case SubscriberKind::observer:
        reaction.run = &run_observer;
        reaction.object = new (instance_.at<ObserverBinding>(place.binding_at))
            ObserverBinding{&instance_.observation().event_observer_, &receiver, s};
        reaction.part = plan.part_of[find_observer(machine_.table)];
        break;
    }
    reaction.receiver = &receiver.plan().parts[reaction.part];
}

} // namespace tappet
