// Wires the uses rows: method calls to methods, command objects to the engines that accept them. Also places
// the mailboxes of engines, for messages and for commands.
#include "kernel/machine/instance/builder.hpp"
#include "kernel/machine/plan/operations.hpp"

namespace tappet {

void MachineBuilder::connect_operations() {
    const MachineView& table = machine_.table;
    for (std::size_t row = 0; row < table.reactions.size(); ++row) {
        if (table.reactions[row].kind != ReactionKind::uses) continue;
        const Link& link = machine_.index.reactions[row];
        const Facet& requester = facet_at(table, link.from);
        if (requester.method_call != nullptr) {
            requester.method_call->bind(instance_.facet(link.from), {facet_at(table, link.to).method->call,
                                                                     instance_.gate_of(link.to.component)});
            continue;
        }
        const std::size_t sender = sender_of(table, machine_.index, row);
        const CommandSlot::Route route = instance_.requests().command_route(link.to, sender);
        requester.command_call->slot(instance_.facet(link.from))
            ->place(route, requester.command_call->values(instance_.facet(link.from)));
    }
}

template <class Box>
std::span<Box> MachineBuilder::make_mailboxes(const PlacesOf<Box>& places, std::span<const MailPlan> mail,
                                              const MailPlan& requests, std::size_t receiver) {
    const std::span<Box> boxes = make(places);
    const auto place = [&](const MailPlan& each) {
        if (each.capacity != 0)
            boxes[each.sender_index].place(instance_.at<std::byte>(each.storage_at), each.capacity,
                                           Overflow::reject);
    };
    const std::size_t n = machine_.table.activities.size();
    for (std::size_t sender = 0; sender < n; ++sender) place(mail[sender * n + receiver]);
    place(requests);
    return boxes;
}

void MachineBuilder::place_mailboxes() {
    const auto& plan = machine_.plan;
    const bool has_lines = find_interpreter(machine_.table) != nowhere;
    for (std::size_t receiver = 0; receiver < plan.activities.size(); ++receiver) {
        const ActivityPlan& places = plan.activities[receiver];
        Engine& engine = instance_.engines()[receiver];
        engine.inbox().place(make_mailboxes(places.mailboxes, plan.mail, plan.requests[receiver], receiver));
        const MailPlan& requests = plan.command_requests[receiver];
        const auto boxes = make_mailboxes(places.command_mailboxes, plan.command_mail, requests, receiver);
        if (has_lines) {
            const MailPlan lines = line_mail(requests);
            boxes[lines.sender_index].place(instance_.at<std::byte>(lines.storage_at), lines.capacity,
                                            Overflow::reject);
        }
        engine.commands().place(boxes, make(places.followed),
                                requests.capacity + (has_lines ? line_commands : 0));
    }
}

} // namespace tappet
