// Wires the uses rows: method calls to methods, command objects to the engines that take them up; and what
// reaches a running engine from a component that sees the machine.
#include "kernel/machine/instance/instance.hpp"

#include <new>

namespace tappet {

void MachineInstance::connect_operations() {
    place_command_processors();
    const MachineView& table = machine_.table;
    for (std::size_t row = 0; row < table.reactions.size(); ++row) {
        if (table.reactions[row].kind != ReactionKind::uses) continue;
        const Link& link = machine_.index.reactions[row];
        const Facet& requester = facet_at(table, link.from);
        if (requester.method_call != nullptr) {
            requester.method_call->bind(facet(link.from), facet_at(table, link.to).method->call,
                                        component(link.to.component));
            continue;
        }
        const std::size_t sender = sender_of(table, machine_.index, row);
        const CommandSlot::Route route = command_route(link.to, sender);
        requester.command_call->slot(facet(link.from))
            ->place(route, requester.command_call->values(facet(link.from)));
    }
}

void MachineInstance::place_command_processors() {
    const std::size_t n = machine_.table.activities.size();
    for (std::size_t receiver = 0; receiver < n; ++receiver) {
        const ActivityPlan& plan = machine_.plan.activities[receiver];
        auto* mailboxes = at<CommandMailbox>(plan.command_mailboxes_at);
        for (std::size_t i = 0; i < plan.command_sender_count; ++i) new (mailboxes + i) CommandMailbox;
        const auto place = [&](const MailPlan& mail) {
            if (mail.capacity != 0)
                mailboxes[mail.sender_index].place(at<std::byte>(mail.storage_at), mail.capacity,
                                                   Overflow::reject);
        };
        for (std::size_t sender = 0; sender < n; ++sender)
            place(machine_.plan.command_mail[sender * n + receiver]);
        place(machine_.plan.command_requests[receiver]);
        auto* followed = at<CommandSlot*>(plan.followed_at);
        for (std::size_t i = 0; i < plan.followed_count; ++i) new (followed + i) CommandSlot* {nullptr};
        engines()[receiver].commands().place({mailboxes, plan.command_sender_count},
                                             {followed, plan.followed_count},
                                             machine_.plan.command_requests[receiver].capacity);
    }
}

CommandSlot::Route MachineInstance::command_route(End to, std::size_t sender) noexcept {
    const std::size_t receiver = machine_.index.activity[to.component];
    CommandSlot::Route route = route_to(to);
    route.sender =
        machine_.plan.command_mail[sender * machine_.table.activities.size() + receiver].sender_index;
    route.sending_activity = static_cast<std::uint32_t>(sender);
    route.wake_sender = waker_of(sender);
    return route;
}

CommandSlot::Route MachineInstance::route_to(End to) noexcept {
    const std::size_t receiver = machine_.index.activity[to.component];
    CommandSlot::Route route;
    route.command = facet_at(machine_.table, to).command;
    route.component = component(to.component);
    route.part = machine_.plan.part_of[to.component];
    route.receiver_state = &engines()[receiver].plan().parts[route.part].state;
    route.inbox = &engines()[receiver].commands().inbox();
    route.wake_receiver = post_waker_of(receiver);
    route.clock = clock_;
    return route;
}

bool MachineInstance::bind_command(End to, CommandSlot& slot, std::span<std::byte> values) noexcept {
    const Facet& facet = facet_at(machine_.table, to);
    const std::size_t receiver = machine_.index.activity[to.component];
    const MailPlan& mail = machine_.plan.command_requests[receiver];
    if (facet.kind != FacetKind::command || mail.capacity == 0 || !slot.is_mine() ||
        values.size() < facet.command->value_bytes())
        return false;
    CommandSlot::Route route = route_to(to);
    route.sender = mail.sender_index;
    route.planned = false;
    slot.place(route, values.data());
    return slot.reset();
}

bool MachineInstance::request_method(End to, MethodRequest& request, std::span<std::byte> values) noexcept {
    const Facet& facet = facet_at(machine_.table, to);
    if (facet.kind != FacetKind::method || !request.done() ||
        values.size() < facet.method->argument_bytes + facet.method->result_bytes)
        return false;
    request.place(*facet.method, component(to.component), values.data());
    Message message;
    message.run = &MethodRequest::run;
    message.object = &request;
    message.id = machine_.plan.part_of[to.component];
    if (post_request(machine_.index.activity[to.component], message)) return true;
    request.withdraw();
    return false;
}

bool MachineInstance::post_request(std::size_t activity, const Message& message) noexcept TAPPET_REALTIME {
    const MailPlan& mail = machine_.plan.requests[activity];
    // The index of a mailbox that was not planned is another's.
    if (mail.capacity == 0 || !engines()[activity].inbox().post(mail.sender_index, message)) return false;
    post_waker_of(activity)();
    return true;
}

} // namespace tappet
