// Wires the connection rows: ports, rings, policies and wakers; and the sections of other folders.
#include "kernel/machine/instance/builder.hpp"

#include "kernel/base/only_numbers.hpp"
#include "kernel/machine/check/flow.hpp"

#include <new>

namespace tappet {

namespace {

// The chain of an output's wakers has as many nodes as the output has rows that wake.
void wake_chain(void* first) noexcept TAPPET_REALTIME {
    const Time cause = running_cause();
    for (auto* node = static_cast<WakerNode*>(first); node != nullptr; node = node->next) {
        if (cause != no_cause) node->reader->expect(node->row, cause);
        node->waker();
    }
}

} // namespace

/// Checks the constants that rows name: the compiler knows only some of their values.
Sentence MachineBuilder::check_constants() const {
    const auto is_good = [](const RowValue& value) {
        return value.constant == nullptr ||
               has_only_numbers(*value.type, static_cast<const std::byte*>(value.constant));
    };
    for (const ConnectionRow& row : machine_.table.connections) {
        if (!is_good(row.substitute)) return checks::no_number_in(row, "substitute");
        if (!is_good(row.before_first)) return checks::no_number_in(row, "initially");
    }
    return {};
}

void MachineBuilder::connect_data() {
    std::size_t guarded[max_activities] = {};
    for (std::size_t x = 0; x < machine_.table.connections.size(); ++x) {
        connect_row(x);
        const ConnectionRow& row = machine_.table.connections[x];
        const Link& link = machine_.index.connections[x];
        if (row.wakes_reader) add_waker(x);
        if (!is_guarded(row)) continue;
        const std::size_t reader = machine_.index.activity[link.to.component];
        new (&instance_.at(machine_.plan.activities[reader].guarded)[guarded[reader]++])
            GuardedInput{.input = instance_.facet(link.to),
                         .port = facet_at(machine_.table, link.to).port,
                         .connection = x,
                         .part = machine_.plan.part_of[link.to.component],
                         .stops = row.when_stale == WhenStale::stop};
    }
}

void MachineBuilder::connect_extras() {
    for (std::size_t e = 0; e < machine_.table.extras->size(); ++e)
        machine_.table.extras->at(e)->connect(instance_, e, instance_.extra_memory(e));
}

/// Whether a row brings the stamps of edges and frames into the cycles of a periodic activity, which they do
/// not wake.
bool MachineBuilder::is_cause(std::size_t x) const {
    const Link& link = machine_.index.connections[x];
    return machine_.plan.connections[x].shared && facet_at(machine_.table, link.from).stamps_cause &&
           machine_.table.activities[machine_.index.activity[link.to.component]].periodic();
}

void MachineBuilder::connect_row(std::size_t x) {
    const ConnectionRow& row = machine_.table.connections[x];
    const ConnectionPlan& plan = machine_.plan.connections[x];
    const Link& link = machine_.index.connections[x];
    const Facet& from = facet_at(machine_.table, link.from);
    if (row.buffered) {
        from.buffer->link(instance_.facet(link.from), instance_.facet(link.to),
                          instance_.at<std::byte>(plan.memory_at), row.capacity, row.overflow, plan.shared);
        return;
    }
    if (plan.shared && plan.first_of_output)
        from.port->place_shared(instance_.facet(link.from), instance_.at<void>(plan.memory_at));
    const Stops* const writer = &instance_.engines()[machine_.index.activity[link.from.component]]
                                     .plan()
                                     .parts[machine_.plan.part_of[link.from.component]]
                                     .stops;
    if (plan.shared)
        from.port->link_shared(instance_.facet(link.to), instance_.facet(link.from), writer);
    else
        from.port->link_local(instance_.facet(link.to), instance_.facet(link.from), writer);
    BetweenValues* between = nullptr;
    if (has_values_between(row))
        between = new (instance_.at<BetweenValues>(plan.between_at)) BetweenValues{
            row.transition, machine_.table.activities[machine_.index.activity[link.from.component]].period};
    from.port->set_policy(instance_.facet(link.to),
                          {row.max_age, row.when_stale, row.substitute, row.before_first,
                           checks::factor_of(row, from, facet_at(machine_.table, link.to)), between,
                           is_cause(x)});
}

void MachineBuilder::add_waker(std::size_t x) {
    const Link& link = machine_.index.connections[x];
    // The newest node is the first and leads to the earlier ones of the same output.
    WakerNode* before = nullptr;
    for (std::size_t j = 0; j < x; ++j)
        if (machine_.index.connections[j].from == link.from && machine_.table.connections[j].wakes_reader)
            before = instance_.at<WakerNode>(machine_.plan.connections[j].waker_at);
    const std::size_t reader = machine_.index.activity[link.to.component];
    auto* node = new (instance_.at<WakerNode>(machine_.plan.connections[x].waker_at))
        WakerNode{instance_.waker_of(reader), before, &instance_.engines()[reader]};
    const Waker chain{&wake_chain, node};
    const Facet& from = facet_at(machine_.table, link.from);
    if (machine_.table.connections[x].buffered)
        from.buffer->set_waker(instance_.facet(link.from), chain);
    else
        from.port->set_waker(instance_.facet(link.from), chain);
}

} // namespace tappet
