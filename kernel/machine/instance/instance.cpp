// Makes a machine out of its plan: constructs, places engines, wires every row and configures.
#include "kernel/machine/instance/instance.hpp"

#include <new>

namespace tappet {

std::expected<void, Sentence> MachineInstance::configure(std::span<const ProvidedDevice> devices) {
    if (auto shared = share_memory(); !shared) return shared;
    construct();
    place_engines();
    place_scope();
    connect_clocks();
    connect_data();
    connect_extras();
    place_needed_inputs();
    if (const Sentence fault = place_behaviours(); !fault.empty()) return std::unexpected(fault);
    connect_events();
    place_mailboxes();
    connect_operations();
    place_map();
    const MachineView& table = machine_.table;
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const ComponentRow& row = table.components[c];
        if (const Sentence refusal = configure_properties(c); !refusal.empty())
            return std::unexpected(refusal);
        if (row.type->configure == nullptr) continue;
        Setup setup{row.name,
                    row.device,
                    devices,
                    clock_,
                    &engines()[machine_.index.activity[c]].waiter(),
                    life_sign_of(row.watched),
                    row.type->sees_machine ? this : nullptr,
                    row.type->records_cycles ? at<scope::Directory>(machine_.plan.scope_at) : nullptr};
        if (const Sentence refusal = row.type->configure(component(c), setup); !refusal.empty())
            return std::unexpected(refusal);
    }
    return {};
}

void MachineInstance::construct() {
    for (std::size_t c = 0; c < machine_.table.components.size(); ++c)
        machine_.table.components[c].type->construct(component(c));
}

void* MachineInstance::facet(End end) noexcept {
    const Facet& row = facet_at(machine_.table, end);
    return row.at(component(end.component), row.index);
}

std::span<Engine> MachineInstance::engines() noexcept TAPPET_REALTIME {
    return {at<Engine>(machine_.plan.engines_at), machine_.table.activities.size()};
}

std::span<std::byte> MachineInstance::stack_of(std::size_t activity) noexcept {
    return machine_.memory.subspan(machine_.plan.activities[activity].stack_at,
                                   machine_.plan.activities[activity].stack_bytes);
}

void MachineInstance::place_engines() {
    const MachineView& table = machine_.table;
    for (std::size_t a = 0; a < table.activities.size(); ++a) {
        const ActivityRow& row = table.activities[a];
        const ActivityPlan& plan = machine_.plan.activities[a];
        auto* parts = at<EnginePart>(plan.parts_at);
        auto* functions = at<FunctionTiming>(plan.functions_at);
        auto* timers = at<EngineTimer>(plan.timers_at);
        for (std::size_t f = 0; f < plan.part_count * functions_per_part; ++f)
            new (functions + f) FunctionTiming{};
        std::size_t timer_count = 0;
        for (std::size_t c = 0; c < table.components.size(); ++c) {
            if (machine_.index.activity[c] != a) continue;
            const ComponentRow& component_row = table.components[c];
            const std::uint32_t part = machine_.plan.part_of[c];
            auto* placed = new (parts + part) EnginePart;
            placed->component = component(c);
            placed->type = component_row.type;
            placed->name = component_row.name;
            for (std::size_t f = 0; f < component_row.type->facets.size(); ++f) {
                const Facet& each = component_row.type->facets[f];
                if (each.kind == FacetKind::timer)
                    new (timers + timer_count++)
                        EngineTimer{static_cast<Timer*>(facet({c, f})), each.timer->fire, part};
            }
        }
        EnginePlan engine;
        engine.name = row.name;
        engine.activity = static_cast<std::uint32_t>(a);
        engine.periodic = row.periodic();
        engine.real_time = row.real_time;
        engine.period = row.period;
        engine.deadline = row.real_time ? row.deadline() : Duration::zero();
        engine.budget = row.budget_each;
        engine.at_most_n = row.at_most_n;
        engine.at_most_per = row.at_most_per;
        engine.stop_when_late = row.when_late == WhenLate::stop;
        engine.parts = {parts, plan.part_count};
        engine.functions = {functions, plan.part_count * functions_per_part};
        engine.timers = {timers, timer_count};
        engine.behaviours = {at<Behaviour>(plan.behaviours_at), plan.behaviour_count};
        engine.inputs = {at<NeededInput>(plan.inputs_at), plan.input_count};
        engine.forced = &observed().forced;
        engine.guarded = {at<GuardedInput>(plan.guarded_at), plan.guarded_count};
        auto* placed = new (&engines()[a]) Engine;
        placed->place(engine, *clock_);
        placed->on_stop(
            [](void* self, StopReason reason, std::uint64_t detail, const Engine& from) noexcept
            TAPPET_REALTIME { static_cast<MachineInstance*>(self)->ask_stop(reason, detail, &from); },
            this);
    }
}

void MachineInstance::place_scope() {
    if (machine_.plan.scope_at == 0) return;
    const MachineView& table = machine_.table;
    const auto behind = [this](std::size_t place) { return place - machine_.plan.scope_at; };
    auto* directory = new (at<scope::Directory>(machine_.plan.scope_at)) scope::Directory;
    directory->tapes_at = sizeof(scope::Directory);
    directory->tapes = static_cast<std::uint32_t>(table.activities.size());
    directory->recordings_at = behind(machine_.plan.recordings_at);
    directory->recordings = static_cast<std::uint32_t>(machine_.plan.recordings);
    directory->recording_stride = scope::recording_bytes;
    directory->bytes = directory->recordings_at + directory->recordings * directory->recording_stride;
    for (std::size_t a = 0; a < table.activities.size(); ++a) {
        const ActivityPlan& plan = machine_.plan.activities[a];
        new (&scope::tapes(*directory)[a]) scope::Tape{behind(plan.tape_at), table.activities[a].real_time};
        engines()[a].record_to(new (at<CycleTape>(plan.tape_at)) CycleTape{plan.tape_words});
    }
    for (std::size_t i = 0; i < directory->recordings; ++i)
        new (&scope::recording(*directory, i)) scope::Recording;
    for (std::size_t c = 0; c < table.components.size(); ++c)
        if (table.components[c].type->records_cycles)
            directory->owner = static_cast<std::uint32_t>(machine_.index.activity[c]);
}

void MachineInstance::connect_clocks() {
    for (std::size_t c = 0; c < machine_.table.components.size(); ++c) {
        const Time* now = engines()[machine_.index.activity[c]].now_address();
        const auto facets = machine_.table.components[c].type->facets;
        for (std::size_t f = 0; f < facets.size(); ++f)
            if (facets[f].kind == FacetKind::input || facets[f].kind == FacetKind::output)
                facets[f].port->set_clock(facet({c, f}), facets[f].kind == FacetKind::input, now);
    }
}

Waker MachineInstance::waker_of(std::size_t activity) noexcept TAPPET_REALTIME {
    Engine& engine = engines()[activity];
    // A periodic activity serves its messages at its next period: nothing wakes it in between.
    if (engine.plan().periodic) return {};
    return {&os::Waiter::wake_thunk, &engine.waiter()};
}

Waker MachineInstance::post_waker_of(std::size_t activity) noexcept TAPPET_REALTIME {
    Waker waker = waker_of(activity);
    if (waker.wake != nullptr) waker.wake = &os::Waiter::wake_after_post_thunk;
    return waker;
}

const BehaviourUnit* MachineInstance::behaviour_of(std::string_view component) const noexcept {
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b)
        if (machine_.table.behaviours[b].component == component && !machine_.table.behaviours[b].is_slot())
            return reinterpret_cast<const BehaviourUnit*>(machine_.memory.data() +
                                                          machine_.plan.behaviours[b].unit_at);
    return nullptr;
}

BehaviourSlot* MachineInstance::slot_of(std::string_view component) noexcept {
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b)
        if (machine_.table.behaviours[b].component == component && machine_.table.behaviours[b].is_slot())
            return slot_of_row(b);
    return nullptr;
}

const StateMachineExecution* MachineInstance::state_machine_of(std::string_view component) const noexcept {
    const BehaviourUnit* unit = behaviour_of(component);
    if (unit == nullptr) return nullptr;
    for (const UnitPart& part : unit->parts())
        if (part.machine != nullptr) return part.machine;
    return nullptr;
}

void MachineInstance::ask_stop(StopReason reason, std::uint64_t detail, const Engine* from) noexcept
    TAPPET_REALTIME {
    int free = 0;
    if (!stop_asked_.compare_exchange_strong(free, 1, std::memory_order_acq_rel)) return;
    stop_ = {reason, detail, from};
    stop_asked_.store(2, std::memory_order_release);
    supervisor_.wake();
}

Sentence MachineInstance::describe_stop() const {
    const std::string_view who = stop_.from == nullptr ? std::string_view{} : stop_.from->name();
    switch (stop_.reason) {
    case StopReason::none: return Sentence{"nobody asked"};
    case StopReason::requested: return Sentence{"asked for from outside"};
    case StopReason::broken_contract: return Sentence{"a contract was broken in activity \"", who, "\""};
    case StopReason::behaviour: {
        const std::string_view driven = machine_.table.components[stop_.detail].name;
        Sentence text{"the behaviour of \"", driven, "\" in activity \"", who, "\" is in error: "};
        if (const BehaviourUnit* unit = behaviour_of(driven);
            unit != nullptr && unit->failed_part() != nullptr)
            return text.add(unit->describe_fault());
        const BehaviourSlot* slot = slot_of(driven);
        return slot != nullptr && slot->active() != nullptr ? text.add(slot->active()->describe_fault())
                                                            : text;
    }
    case StopReason::missed_deadline: {
        const auto function = static_cast<std::uint32_t>(stop_.detail);
        if (function == Miss::nobody || stop_.from == nullptr)
            return Sentence{"activity \"", who, "\" missed its deadline: it began late"};
        return Sentence{"activity \"", who, "\" missed its deadline: component \"",
                        stop_.from->plan().parts[function / functions_per_part].name, "\" took the time"};
    }
    case StopReason::stale_input: {
        const ConnectionRow& row = machine_.table.connections[stop_.detail];
        return Sentence{"connection \"",
                        row.from,
                        "\" -> \"",
                        row.to,
                        "\" is stale: nothing came for more than ",
                        row.max_age.count() / 1000,
                        " us"};
    }
    case StopReason::section:
        return machine_.table.extras->at(stop_.detail >> 32)->describe_stop(stop_.detail & 0xFFFFFFFF);
    }
    return {};
}

Sentence MachineInstance::describe_budget(std::size_t activity) const {
    const Engine& engine = engines()[activity];
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
        .add(seen.over_claim == 1 ? " time" : " times")
        .add("; write budget(")
        .add((needed_ns + 999) / 1000)
        .add("us) or more, or shorten what it does");
}

std::uint64_t MachineInstance::event_log_digest() const noexcept {
    Digest digest;
    for (const Engine& engine : engines()) digest.add(engine.digest().value());
    return digest.value();
}

} // namespace tappet
