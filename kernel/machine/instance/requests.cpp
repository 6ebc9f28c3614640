// Passes requests of a component that sees the machine to a running engine.
#include "kernel/machine/instance/requests.hpp"

#include "kernel/machine/plan/operations.hpp"

namespace tappet {

bool MachineRequests::post(std::size_t activity, const Message& message, Role role) noexcept TAPPET_REALTIME {
    const MailPlan& mail = machine_.plan.requests[activity];
    Inbox& inbox = placed_.engines()[activity].inbox();
    // The index of an unplanned mailbox belongs to another one. Withdrawn requests stay in the mailbox, too,
    // until the engine reaches them.
    if (mail.capacity == 0 ||
        inbox.waiting(mail.sender_index) + kept_from(role, mail.capacity) >= mail.capacity ||
        !inbox.post(mail.sender_index, message))
        return false;
    placed_.post_waker_of(activity)();
    return true;
}

bool MachineRequests::post_change(BehaviourSlot& slot) noexcept TAPPET_REALTIME {
    Message message;
    message.run = &BehaviourSlot::obey;
    message.object = &slot;
    message.id = machine_.plan.part_of[slot.component()];
    return post(machine_.index.activity[slot.component()], message);
}

bool MachineRequests::bind_command(End to, CommandSlot& slot, std::span<std::byte> values) noexcept {
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

bool MachineRequests::request_method(End to, MethodRequest& request, std::span<std::byte> values) noexcept {
    const Facet& facet = facet_at(machine_.table, to);
    const ActivityRow& activity = machine_.table.activities[machine_.index.activity[to.component]];
    if (facet.kind != FacetKind::method || !request.done() || (facet.may_block && activity.real_time) ||
        values.size() < facet.method->argument_bytes + facet.method->result_bytes)
        return false;
    request.place(*facet.method, *placed_.gate_of(to.component), values.data());
    Message message;
    message.run = &MethodRequest::run;
    message.object = &request;
    message.id = machine_.plan.part_of[to.component];
    if (post(machine_.index.activity[to.component], message)) return true;
    request.withdraw();
    return false;
}

CommandSlot::Route MachineRequests::command_route(End to, std::size_t sender) noexcept {
    const std::size_t receiver = machine_.index.activity[to.component];
    CommandSlot::Route route = route_to(to);
    route.sender =
        machine_.plan.command_mail[sender * machine_.table.activities.size() + receiver].sender_index;
    route.sending_activity = static_cast<std::uint32_t>(sender);
    route.wake_sender = placed_.waker_of(sender);
    return route;
}

CommandSlot::Route MachineRequests::line_route(End to) noexcept {
    CommandSlot::Route route = route_to(to);
    route.sender =
        line_mail(machine_.plan.command_requests[machine_.index.activity[to.component]]).sender_index;
    route.planned = false;
    return route;
}

CommandSlot::Route MachineRequests::route_to(End to) noexcept {
    const std::size_t receiver = machine_.index.activity[to.component];
    CommandSlot::Route route;
    route.command = facet_at(machine_.table, to).command;
    route.receiver = placed_.gate_of(to.component);
    route.part = machine_.plan.part_of[to.component];
    route.inbox = &placed_.engines()[receiver].commands().inbox();
    route.wake_receiver = placed_.post_waker_of(receiver);
    route.clock = &placed_.clock();
    return route;
}

} // namespace tappet
