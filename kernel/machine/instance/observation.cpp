// Reports the state of a running machine.
#include "kernel/machine/instance/observation.hpp"

#include "kernel/machine/map/layout.hpp"
#include "kernel/os/local_socket.hpp"
#include "kernel/os/memory.hpp"

namespace tappet {

void MachineObservation::be_this_process() noexcept {
    if (!machine_.map.empty()) placed_.at<map::Header>(0)->process = os::own_process();
}

EventHandle MachineObservation::observe_event(std::size_t component, std::size_t facet_index) noexcept {
    const std::size_t s = observed_index({component, facet_index});
    if (s == nowhere) return {};
    auto* reaction = placed_.at<AsyncReaction>(machine_.plan.subscription_at[s].async_at);
    return {*reaction->connected, reaction->bit, &reaction->epoch};
}

std::size_t MachineObservation::observed_index(End event) const noexcept {
    for (std::size_t s = 0; s < machine_.plan.subscriptions.size(); ++s)
        if (machine_.plan.subscriptions[s].kind == SubscriberKind::observer &&
            machine_.plan.subscriptions[s].event == event)
            return s;
    return nowhere;
}

SubscriptionCounts MachineObservation::counts_of(std::size_t s) const noexcept TAPPET_REALTIME {
    const std::size_t place = machine_.plan.subscription_at[s].async_at;
    if (place == nowhere) return {};
    return placed_.at<AsyncReaction>(place)->counts();
}

const ReactionTimes* MachineObservation::times_of_reaction(std::size_t row) const noexcept {
    const auto& plan = machine_.plan;
    const Link& link = machine_.index.reactions[row];
    for (std::size_t s = 0; s < plan.subscriptions.size(); ++s) {
        const Subscription& each = plan.subscriptions[s];
        if (each.kind == SubscriberKind::operation && !each.synchronous && each.event == link.from &&
            each.target == link.to)
            return &placed_.at<AsyncReaction>(plan.subscription_at[s].async_at)->times;
    }
    return nullptr;
}

const ReactionTimes* MachineObservation::times_of_connection(std::size_t row) const noexcept {
    if (!machine_.table.connections[row].wakes_reader) return nullptr;
    const std::size_t place = machine_.plan.connections[row].waker_at;
    return &placed_.at<WakerNode>(place)->row.times;
}

SectionCount MachineObservation::counted(std::size_t section, std::size_t row) const noexcept {
    if (section >= machine_.table.extras->size()) return {};
    return machine_.table.extras->at(section)->counted(placed_.extra_memory(section), row);
}

std::uint64_t MachineObservation::lost_emissions() const noexcept {
    std::uint64_t lost = 0;
    for (std::size_t s = 0; s < machine_.plan.subscriptions.size(); ++s) {
        const Subscription& row = machine_.plan.subscriptions[s];
        if (!row.keeps_latest && row.kind != SubscriberKind::observer) lost += counts_of(s).lost;
    }
    return lost;
}

std::uint64_t MachineObservation::dropped_messages() const noexcept {
    std::uint64_t dropped = 0;
    for (std::size_t s = 0; s < machine_.plan.subscriptions.size(); ++s) dropped += counts_of(s).dropped;
    for (const Engine& engine : placed_.engines())
        for (const EnginePart& part : engine.plan().parts)
            dropped += part.dropped.load(std::memory_order_relaxed);
    return dropped;
}

std::size_t MachineObservation::stack_high_water_bytes(std::size_t activity) const noexcept {
    // In virtual time the world's own thread runs every engine: no stack was painted.
    return placed_.clock().is_virtual() ? 0 : os::stack_high_water_bytes(placed_.stack_of(activity));
}

std::uint64_t MachineObservation::event_log_digest() const noexcept {
    Digest digest;
    for (const Engine& engine : placed_.engines()) digest.add(engine.digest().value());
    return digest.value();
}

Sentence MachineObservation::describe_budget(std::size_t activity) const {
    const Engine& engine = placed_.engines()[activity];
    const EnginePlan& plan = engine.plan();
    const EngineStatistics& seen = engine.statistics();
    if (seen.over_claim == 0) return {};
    const std::int64_t cycles = plan.periodic ? 1 : plan.at_most_n;
    const std::int64_t needed_ns = (seen.most_processor.count() + cycles - 1) / cycles;
    Sentence text{"activity \"", engine.name(), "\" used up to ", seen.most_processor.count() / 1000,
                  " us of its processor "};
    if (plan.periodic)
        text.add("in a cycle");
    else
        text.add("within ").add(plan.at_most_per.count() / 1000).add(" us");
    return text.add("; its row claims ")
        .add(plan.claim().count() / 1000)
        .add(" us, which was too little ")
        .add(seen.over_claim)
        .add(" of ")
        .add(seen.measured_claims)
        .add(" times that were measured")
        .add("; write budget(")
        .add((needed_ns + 999) / 1000)
        .add("us) or more, or shorten what it does");
}

Sentence MachineObservation::describe_end(std::size_t activity) const {
    if (placed_.engines()[activity].is_active()) return {};
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b) {
        const std::string_view driven = machine_.table.behaviours[b].component;
        if (machine_.index.activity[find_component(machine_.table, driven)] != activity) continue;
        const BehaviourSlot* slot = placed_.slot_of_row(b);
        const BehaviourUnit* unit = slot != nullptr ? slot->active() : placed_.unit_of_row(b);
        if (unit == nullptr || unit->is_finished()) continue;
        Sentence text{"the behaviour of \"", driven, "\" was left in \""};
        for (const UnitPart& part : unit->parts())
            if (part.machine != nullptr && part.machine->is_active())
                for (std::size_t level = 0; level < part.machine->path().size(); ++level)
                    text.add(level == 0 ? "" : "/").add(part.machine->path()[level]);
        return text.add("\": ")
            .add(Engine::end_limit / 1ms)
            .add(" ms after the request to end it had not ended; it ends first when it is started again; "
                 "shorten its way to the end");
    }
    return {};
}

} // namespace tappet
