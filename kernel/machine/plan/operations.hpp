// The places of commands: a mailbox for each activity that sends to another, and memory to follow all
// commands at once.
#pragma once

#include "kernel/machine/plan/places.hpp"
#include "kernel/machine/table/unit_rows.hpp"

namespace tappet {

/// The most requests of the components that see the machine that wait at one engine, and the most of their
/// commands.
inline constexpr std::uint32_t requests_waiting = 16;

/// The most commands in progress from typed lines: four from each of three lines.
inline constexpr std::uint32_t line_commands = 12;

/// Returns the lines' mailbox at a receiver, which follows that of the requests. The activity that runs a
/// line posts into it: only one line runs at a time, and the next begins after it.
constexpr MailPlan line_mail(const MailPlan& requests) noexcept {
    return {requests.storage_at + CommandMailbox::bytes_for(requests.capacity), line_commands,
            requests.sender_index + 1};
}

/// Returns the activity that sends the command of a uses row.
constexpr std::size_t sender_of(const MachineView& m, const TableIndexView& r, std::size_t row) noexcept {
    const std::string_view sent_by = m.reactions[row].sent_by;
    return r
        .activity[sent_by.empty() ? r.reactions[row].from.component : find_component(m, r.by_name, sent_by)];
}

constexpr bool is_command_row(const MachineView& m, const TableIndexView& r, std::size_t row) noexcept {
    return m.reactions[row].kind == ReactionKind::uses &&
           facet_at(m, r.reactions[row].from).kind == FacetKind::command_call;
}

namespace detail {

/// Counts the mailboxes of one receiver and reserves their memory. The senders' mailboxes come first, that of
/// the most urgent sender before the others. The mailbox of requests is the last, so that an observer of the
/// machine delays no message.
template <class Box>
constexpr void plan_mail(const MachineView& m, const TableIndexView& r, PlacesOf<Box>& boxes,
                         std::span<MailPlan> mail, MailPlan& requests, std::size_t receiver, Layout& layout) {
    const auto place = [&](MailPlan& each) {
        each.sender_index = boxes.count++;
        each.storage_at = layout.take(Box::bytes_for(each.capacity), Box::alignment);
    };
    for (const std::size_t sender : r.by_rank)
        if (auto& each = mail[sender * m.activities.size() + receiver]; each.capacity != 0) place(each);
    if (find_observer(m) == nowhere) return;
    requests.capacity = requests_waiting;
    place(requests);
}

/// Needs a checked table.
constexpr void plan_commands(const MachineView& m, const TableIndexView& r, PlanView& p, Layout& layout) {
    const std::size_t n = m.activities.size();
    const bool has_lines = find_interpreter(m) != nowhere;
    for (std::size_t row = 0; row < m.reactions.size(); ++row) {
        if (!is_command_row(m, r, row)) continue;
        const std::size_t receiver = r.activity[r.reactions[row].to.component];
        // Each command object is one slot, which is sent again only after it has ended: one place for each.
        ++p.command_mail[sender_of(m, r, row) * n + receiver].capacity;
        ++p.activities[receiver].followed.count;
    }
    for (const BehaviourRow& row : m.behaviours) {
        const std::size_t sender = r.activity[find_component(m, r.by_name, row.component)];
        for_each_command_slot(m, row.component, row.unit(), [&](End command) {
            const std::size_t receiver = r.activity[command.component];
            ++p.command_mail[sender * n + receiver].capacity;
            ++p.activities[receiver].followed.count;
        });
        // Each command of a slot may go to any of its peers, for the old behaviour and for the new one.
        for (std::size_t receiver = 0; receiver < n; ++receiver) {
            bool reached = false;
            for (const std::string_view peer : row.slot.peers)
                reached |= r.activity[find_component(m, r.by_name, peer)] == receiver && receiver != sender;
            if (!reached) continue;
            p.command_mail[sender * n + receiver].capacity += 2 * row.slot.command_slots;
            p.activities[receiver].followed.count += 2 * row.slot.command_slots;
        }
    }
    for (std::size_t receiver = 0; receiver < n; ++receiver) {
        auto& activity = p.activities[receiver];
        MailPlan& requests = p.command_requests[receiver];
        plan_mail(m, r, activity.command_mailboxes, p.command_mail, requests, receiver, layout);
        activity.followed.count += requests.capacity;
        // Separate from the commands of browsers, whose places have shares by role: lines would use the
        // others' places.
        if (has_lines) {
            activity.followed.count += line_commands;
            ++activity.command_mailboxes.count;
            layout.take(CommandMailbox::bytes_for(line_commands), CommandMailbox::alignment);
        }
        layout.place(activity.command_mailboxes);
        layout.place(activity.followed);
    }
}

} // namespace detail

} // namespace tappet
