// Wires the reaction rows and the triggers of state machines: subscribers and mailboxes.
#include "kernel/machine/instance.hpp"

#include <new>

namespace tappet {

namespace {

void run_trigger(void* binding, const std::byte*) noexcept TAPPET_REALTIME {
    const auto& trigger = *static_cast<const TriggerBinding*>(binding);
    static_cast<void>(trigger.execution->dispatch(trigger.trigger, trigger.engine->now()));
}

} // namespace

void MachineInstance::connect_events() {
    const auto& plan = machine_.plan;
    for (std::size_t s = 0; s < plan.subscriptions.size(); ++s) {
        const Subscription& row = plan.subscriptions[s];
        const SubscriptionPlan& place = plan.subscription_at[s];
        const EventOperations& event = *facet_at(machine_.table, row.event).event;
        if (place.subscribers_at != nowhere)
            event.give_storage(facet(row.event), at<void>(place.subscribers_at));
        if (row.synchronous) {
            event.subscribe(facet(row.event), facet_at(machine_.table, row.operation).operation->call,
                            component(row.operation.component));
            continue;
        }
        auto* reaction = new (at<AsyncReaction>(place.async_at)) AsyncReaction;
        const std::size_t n = machine_.table.activities.size();
        Engine& receiver = engines()[row.receiver];
        reaction->inbox = &receiver.inbox();
        reaction->sender = plan.mail[row.sender * n + row.receiver].sender_index;
        reaction->waker = waker_of(row.receiver);
        reaction->quota = row.quota;
        if (row.behaviour == nowhere) {
            reaction->run = facet_at(machine_.table, row.operation).operation->run;
            reaction->object = component(row.operation.component);
            reaction->part = plan.part_of[row.operation.component];
        } else {
            auto* execution = at<StateMachineExecution>(plan.behaviours[row.behaviour].execution_at);
            reaction->run = &run_trigger;
            reaction->object =
                new (at<TriggerBinding>(place.binding_at)) TriggerBinding{execution, &receiver, row.trigger};
            reaction->part = plan.part_of[find_component(machine_.table,
                                                         machine_.table.behaviours[row.behaviour].component)];
        }
        reaction->receiver = &receiver.plan().parts[reaction->part].state;
        event.subscribe(facet(row.event), event.post, reaction);
    }
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

} // namespace tappet
