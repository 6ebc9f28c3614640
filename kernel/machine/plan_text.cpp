// Writes the sections of the plan in the order in which a reader asks: which activity runs when, which writes
// to which, and what memory they use.
#include "kernel/machine/plan_text.hpp"

#include "kernel/machine/check/stop.hpp"
#include "kernel/machine/check/time.hpp"
#include "kernel/machine/check/units.hpp"

namespace tappet {

namespace {

struct Writer {
    const AcceptedMachine& machine;
    void* to;
    void (*line)(void* to, std::string_view);

    void say(const Sentence& text) const { line(to, text.view()); }
    [[nodiscard]] std::string_view activity(std::size_t a) const { return machine.table.activities[a].name; }

    /// Prints each activity with its components in the order in which they step; the most urgent first.
    void activities() const {
        const auto rows = machine.table.activities;
        for (std::size_t rank = 0; rank < rows.size(); ++rank)
            for (std::size_t a = 0; a < rows.size(); ++a) {
                if (machine.index.rank[a] != rank) continue;
                const ActivityPlan& plan = machine.plan.activities[a];
                Sentence text{"activity ", activity(a), ": "};
                if (plan.priority == 0)
                    text.add("not real-time");
                else
                    text.add("priority ").add(plan.priority);
                text.add(", processor ").add(plan.processor);
                text.add(", stack ").add(plan.stack_bytes / 1024).add(" KiB, runs");
                for (std::size_t position = 0; position < plan.parts.count; ++position)
                    for (std::size_t c = 0; c < machine.table.components.size(); ++c)
                        if (machine.index.activity[c] == a && machine.index.position[c] == position)
                            text.add(" ").add(machine.table.components[c].name);
                say(text);
            }
    }

    /// Prints each sender and receiver, and how many messages and commands may wait there.
    void mailboxes() const {
        const std::size_t n = machine.table.activities.size();
        for (std::size_t receiver = 0; receiver < n; ++receiver) {
            for (std::size_t sender = 0; sender < n; ++sender) {
                const auto messages = machine.plan.mail[sender * n + receiver].capacity;
                const auto commands = machine.plan.command_mail[sender * n + receiver].capacity;
                if (messages + commands == 0) continue;
                Sentence text{"mailbox ", activity(sender), " -> ", activity(receiver), ": "};
                text.add(messages).add(" messages, ").add(commands).add(" commands");
                say(text);
            }
        }
    }

    void connections() const {
        std::size_t shared = 0, copied = 0, buffered = 0, waking = 0;
        for (std::size_t x = 0; x < machine.table.connections.size(); ++x) {
            const ConnectionRow& row = machine.table.connections[x];
            (row.buffered ? buffered : machine.plan.connections[x].shared ? shared : copied) += 1;
            waking += row.wakes_reader;
        }
        say(Sentence{"connections: ", copied, " within an activity, ", shared, " across, ", buffered,
                     " buffered; ", waking, " wake their reader"});
        for (std::size_t x = 0; x < machine.table.connections.size(); ++x) units(x);
    }

    /// Prints units that no check could compare, and rows that are scaled.
    void units(std::size_t x) const {
        const ConnectionRow& row = machine.table.connections[x];
        const Facet& from = facet_at(machine.table, machine.index.connections[x].from);
        const Facet& into = facet_at(machine.table, machine.index.connections[x].to);
        if (is_scaled(row))
            say(Sentence{"scaled: ", row.from, " -> ", row.to, ", from ", checks::in_unit(from), " to ",
                         checks::in_unit(into)});
        else if (from.unit.empty() != into.unit.empty())
            say(Sentence{"unit at one end only: ", row.from, " (", checks::in_unit(from), ") -> ", row.to,
                         " (", checks::in_unit(into), ")"});
    }

    void stop() const {
        const Board& board = *machine.board;
        const auto responses =
            checks::worst_responses_ns(machine.table, board, *machine.binding, machine.index);
        const checks::StopPromise promise =
            checks::promised_stop(machine.table, board, machine.index.activity, responses);
        say(Sentence{"stop: every output is safe within ", board.stop_within / 1ms,
                     " ms, by the guardian where the machine has not done it; it begins within ",
                     promise.begins / 1ms, " ms and takes ", (promise.sum() - promise.begins) / 1ms,
                     " ms by what the table claims"});
    }

    void memory() const {
        const auto kib = [](std::size_t bytes) { return (bytes + 1023) / 1024; };
        std::size_t components = 0, behaviours = 0, stacks = 0;
        for (const ComponentRow& row : machine.table.components) components += row.type->size;
        for (const BehaviourPlan& plan : machine.plan.behaviours) behaviours += plan.memory.count;
        for (const ActivityPlan& plan : machine.plan.activities) stacks += plan.stack_bytes;
        say(Sentence{"memory: ", kib(machine.plan.bytes), " KiB; of these components ", kib(components),
                     ", behaviours ", kib(behaviours), ", map ", kib(machine.map.size()), ", stacks ",
                     kib(stacks)});
    }
};

} // namespace

void describe_plan(const AcceptedMachine& machine, void* to, void (*line)(void* to, std::string_view)) {
    const Writer writer{machine, to, line};
    line(to, Sentence{machine.table.name, ", processors of its box: ", machine.board->processors}.view());
    writer.activities();
    writer.mailboxes();
    writer.connections();
    writer.stop();
    writer.memory();
}

} // namespace tappet
