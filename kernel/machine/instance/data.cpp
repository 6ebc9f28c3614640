// Wires the connection rows: ports, rings, policies and who is woken.
#include "kernel/machine/instance/instance.hpp"

#include <new>

namespace tappet {

namespace {

// The chain of an output's wakers ends after as many nodes as it has rows that wake.
void wake_chain(void* first) noexcept TAPPET_REALTIME {
    const Time cause = running_cause();
    for (auto* node = static_cast<WakerNode*>(first); node != nullptr; node = node->next) {
        if (cause != no_cause) node->reader->expect(node->row, cause);
        node->waker();
    }
}

} // namespace

void MachineInstance::connect_data() {
    std::size_t guarded[checks::max_activities] = {};
    for (std::size_t x = 0; x < machine_.table.connections.size(); ++x) {
        connect_row(x);
        const ConnectionRow& row = machine_.table.connections[x];
        const Link& link = machine_.index.connections[x];
        if (row.wakes_reader) add_waker(x);
        if (!is_guarded(row)) continue;
        const std::size_t reader = machine_.index.activity[link.to.component];
        new (at<GuardedInput>(machine_.plan.activities[reader].guarded_at) + guarded[reader]++)
            GuardedInput{.input = facet(link.to),
                         .port = facet_at(machine_.table, link.to).port,
                         .connection = x,
                         .part = machine_.plan.part_of[link.to.component],
                         .stops = row.when_stale == WhenStale::stop};
    }
}

std::span<std::byte> MachineInstance::extra_memory(std::size_t section) const noexcept {
    std::size_t place = machine_.plan.extras_at;
    for (std::size_t before = 0; before < section; ++before)
        place += align_section(machine_.table.extras->at(before)->bytes(machine_.table));
    return machine_.memory.subspan(place, machine_.table.extras->at(section)->bytes(machine_.table));
}

void MachineInstance::connect_extras() {
    for (std::size_t e = 0; e < machine_.table.extras->size(); ++e)
        machine_.table.extras->at(e)->connect(*this, e, extra_memory(e));
}

SectionCount MachineInstance::counted(std::size_t section, std::size_t row) const noexcept {
    if (section >= machine_.table.extras->size()) return {};
    return machine_.table.extras->at(section)->counted(extra_memory(section), row);
}

void MachineInstance::connect_row(std::size_t x) {
    const ConnectionRow& row = machine_.table.connections[x];
    const ConnectionPlan& plan = machine_.plan.connections[x];
    const Link& link = machine_.index.connections[x];
    const Facet& from = facet_at(machine_.table, link.from);
    if (row.buffered) {
        from.buffer->link(facet(link.from), facet(link.to), at<std::byte>(plan.memory_at), row.capacity,
                          row.overflow, plan.shared);
        return;
    }
    if (plan.shared && plan.first_of_output)
        from.port->place_shared(facet(link.from), at<void>(plan.memory_at));
    if (plan.shared)
        from.port->link_shared(facet(link.to), facet(link.from));
    else
        from.port->link_local(facet(link.to), facet(link.from));
    from.port->set_policy(facet(link.to), {row.max_age, row.when_stale, row.substitute, row.before_first});
}

void MachineInstance::add_waker(std::size_t x) {
    const Link& link = machine_.index.connections[x];
    // The newest node stands first and leads to the ones before it of the same output.
    WakerNode* before = nullptr;
    for (std::size_t j = 0; j < x; ++j)
        if (machine_.index.connections[j].from == link.from && machine_.table.connections[j].wakes_reader)
            before = at<WakerNode>(machine_.plan.connections[j].waker_at);
    const std::size_t reader = machine_.index.activity[link.to.component];
    auto* node = new (at<WakerNode>(machine_.plan.connections[x].waker_at))
        WakerNode{waker_of(reader), before, &engines()[reader]};
    const Waker chain{&wake_chain, node};
    const Facet& from = facet_at(machine_.table, link.from);
    if (machine_.table.connections[x].buffered)
        from.buffer->set_waker(facet(link.from), chain);
    else
        from.port->set_waker(facet(link.from), chain);
}

const ReactionTimes* MachineInstance::times_of_connection(std::size_t row) const noexcept {
    if (!machine_.table.connections[row].wakes_reader) return nullptr;
    const std::size_t place = machine_.plan.connections[row].waker_at;
    return &reinterpret_cast<const WakerNode*>(machine_.memory.data() + place)->row.times;
}

} // namespace tappet
