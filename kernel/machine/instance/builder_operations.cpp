// Wires the uses rows: method calls to methods, command objects to the engines that take them up.
#include "kernel/machine/instance/builder.hpp"
#include "kernel/machine/plan/operations.hpp"

#include <new>

namespace tappet {

void MachineBuilder::connect_operations() {
    place_command_processors();
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

void MachineBuilder::place_command_processors() {
    const std::size_t n = machine_.table.activities.size();
    for (std::size_t receiver = 0; receiver < n; ++receiver) {
        const ActivityPlan& plan = machine_.plan.activities[receiver];
        auto* mailboxes = instance_.at<CommandMailbox>(plan.command_mailboxes_at);
        for (std::size_t i = 0; i < plan.command_sender_count; ++i) new (mailboxes + i) CommandMailbox;
        const auto place = [&](const MailPlan& mail) {
            if (mail.capacity != 0)
                mailboxes[mail.sender_index].place(instance_.at<std::byte>(mail.storage_at), mail.capacity,
                                                   Overflow::reject);
        };
        for (std::size_t sender = 0; sender < n; ++sender)
            place(machine_.plan.command_mail[sender * n + receiver]);
        place(machine_.plan.command_requests[receiver]);
        const MailPlan& requests = machine_.plan.command_requests[receiver];
        const bool has_lines = find_interpreter(machine_.table) != nowhere;
        if (has_lines) place(line_mail(requests));
        auto* followed = instance_.at<CommandSlot*>(plan.followed_at);
        for (std::size_t i = 0; i < plan.followed_count; ++i) new (followed + i) CommandSlot* {nullptr};
        instance_.engines()[receiver].commands().place({mailboxes, plan.command_sender_count},
                                                       {followed, plan.followed_count},
                                                       requests.capacity + (has_lines ? line_commands : 0));
    }
}

} // namespace tappet
