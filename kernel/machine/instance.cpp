// Makes a machine out of its plan: constructs, sets properties, places engines and wires every row.
#include "kernel/machine/instance.hpp"

#include <new>

namespace tappet {

namespace {

// The chain of an output's wakers ends after as many nodes as it has rows that wake.
void wake_chain(void* first) noexcept TAPPET_REALTIME {
    for (const auto* node = static_cast<const WakerNode*>(first); node != nullptr; node = node->next)
        node->waker();
}

void run_trigger(void* binding, const std::byte*) noexcept TAPPET_REALTIME {
    const auto& trigger = *static_cast<const TriggerBinding*>(binding);
    static_cast<void>(trigger.execution->dispatch(trigger.trigger, trigger.engine->now()));
}

void note_transition(void* engine, StateIndex from, StateIndex to, TransitionIndex transition,
                     Time now) noexcept TAPPET_REALTIME {
    const std::uint64_t what = (std::uint64_t{from} << 32) | (std::uint64_t{to} << 16) | transition;
    static_cast<Engine*>(engine)->note(what, now);
}

StateMachineExecution& execution_of(void* self) noexcept TAPPET_REALTIME {
    return *static_cast<StateMachineExecution*>(self);
}

} // namespace

std::expected<void, Sentence> MachineInstance::configure(std::span<const ProvidedDevice> devices) {
    construct();
    place_engines();
    connect_clocks();
    connect_data();
    place_behaviours();
    connect_events();
    place_mailboxes();
    const MachineView& table = machine_.table;
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const ComponentRow& row = table.components[c];
        if (row.type->configure == nullptr) continue;
        Setup setup{row.name, row.device, devices, clock_, &engines()[machine_.index.activity[c]].waiter()};
        if (const Sentence refusal = row.type->configure(component(c), setup); !refusal.empty())
            return std::unexpected(refusal);
    }
    return {};
}

void MachineInstance::construct() {
    for (std::size_t c = 0; c < machine_.table.components.size(); ++c) {
        machine_.table.components[c].type->construct(component(c));
        apply_settings(c);
    }
}

void MachineInstance::apply_settings(std::size_t c) {
    const ComponentRow& row = machine_.table.components[c];
    for (const PropertyRow& setting : row.settings) {
        const std::size_t index = find_facet(row, setting.name);
        row.type->facets[index].property->set(facet({c, index}), setting.setting);
    }
}

void* MachineInstance::facet(End end) noexcept {
    const Facet& row = facet_at(machine_.table, end);
    return row.at(component(end.component), row.index);
}

std::span<Engine> MachineInstance::engines() noexcept {
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
            new (parts + part) EnginePart{component_row.name, component(c), component_row.type};
            for (std::size_t f = 0; f < component_row.type->facets.size(); ++f) {
                const Facet& each = component_row.type->facets[f];
                if (each.kind == FacetKind::timer)
                    new (timers + timer_count++)
                        EngineTimer{static_cast<Timer*>(facet({c, f})), each.timer->fire, part};
            }
        }
        EnginePlan engine;
        engine.name = row.name;
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
        engine.guarded = {at<GuardedInput>(plan.guarded_at), plan.guarded_count};
        auto* placed = new (&engines()[a]) Engine;
        placed->place(engine, *clock_);
        placed->on_stop(
            [](void* self, StopReason reason, std::uint64_t detail, const Engine& from) noexcept
            TAPPET_REALTIME { static_cast<MachineInstance*>(self)->ask_stop(reason, detail, &from); },
            this);
    }
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

Waker MachineInstance::waker_of(std::size_t activity) noexcept {
    Engine& engine = engines()[activity];
    // A periodic activity serves its messages at its next period: nothing wakes it in between.
    if (engine.plan().periodic) return {};
    return {&os::Waiter::wake_thunk, &engine.waiter()};
}

void MachineInstance::connect_data() {
    std::size_t guarded[checks::max_activities] = {};
    for (std::size_t x = 0; x < machine_.table.connections.size(); ++x) {
        connect_row(x);
        const ConnectionRow& row = machine_.table.connections[x];
        const Link& link = machine_.index.connections[x];
        if (row.wakes_reader) add_waker(x);
        if (row.when_stale != WhenStale::stop) continue;
        const std::size_t reader = machine_.index.activity[link.to.component];
        new (at<GuardedInput>(machine_.plan.activities[reader].guarded_at) + guarded[reader]++)
            GuardedInput{facet(link.to), facet_at(machine_.table, link.to).port->flow, x, false};
    }
}

void MachineInstance::connect_row(std::size_t x) {
    const ConnectionRow& row = machine_.table.connections[x];
    const ConnectionPlan& plan = machine_.plan.connections[x];
    const Link& link = machine_.index.connections[x];
    const Facet& from = facet_at(machine_.table, link.from);
    if (row.buffered) {
        from.buffer->link(facet(link.from), facet(link.to), at<std::byte>(plan.memory_at), row.capacity,
                          row.overflow);
        return;
    }
    if (plan.shared && plan.first_of_output)
        from.port->place_shared(facet(link.from), at<void>(plan.memory_at));
    if (plan.shared)
        from.port->link_shared(facet(link.to), facet(link.from));
    else
        from.port->link_local(facet(link.to), facet(link.from));
    from.port->set_policy(facet(link.to), row.max_age, row.when_stale, row.substitute_value);
}

void MachineInstance::add_waker(std::size_t x) {
    const Link& link = machine_.index.connections[x];
    // The newest node stands first and leads to the ones before it of the same output.
    WakerNode* before = nullptr;
    for (std::size_t j = 0; j < x; ++j)
        if (machine_.index.connections[j].from == link.from && machine_.table.connections[j].wakes_reader)
            before = at<WakerNode>(machine_.plan.connections[j].waker_at);
    auto* node = new (at<WakerNode>(machine_.plan.connections[x].waker_at))
        WakerNode{waker_of(machine_.index.activity[link.to.component]), before};
    const Waker chain{&wake_chain, node};
    const Facet& from = facet_at(machine_.table, link.from);
    if (machine_.table.connections[x].buffered)
        from.buffer->set_waker(facet(link.from), chain);
    else
        from.port->set_waker(facet(link.from), chain);
}

void MachineInstance::connect_events() {
    const auto& plan = machine_.plan;
    for (std::size_t s = 0; s < plan.subscriptions.size(); ++s) {
        const Subscription& row = plan.subscriptions[s];
        const SubscriptionPlan& place = plan.subscription_at[s];
        const EventOperations& event = *facet_at(machine_.table, row.event).event;
        if (place.subscribers_at != nowhere)
            event.give_storage(facet(row.event), at<void>(place.subscribers_at));
        if (row.synchronous) {
            event.subscribe(facet(row.event), facet_at(machine_.table, row.operation).operation->call,
                            component(row.operation.component));
            continue;
        }
        auto* reaction = new (at<AsyncReaction>(place.async_at)) AsyncReaction;
        const std::size_t n = machine_.table.activities.size();
        Engine& receiver = engines()[row.receiver];
        reaction->inbox = &receiver.inbox();
        reaction->sender = plan.mail[row.sender * n + row.receiver].sender_index;
        reaction->waker = waker_of(row.receiver);
        reaction->quota = row.quota;
        if (row.behaviour == nowhere) {
            reaction->run = facet_at(machine_.table, row.operation).operation->run;
            reaction->object = component(row.operation.component);
            reaction->part = plan.part_of[row.operation.component];
        } else {
            auto* execution = at<StateMachineExecution>(plan.behaviours[row.behaviour].execution_at);
            reaction->run = &run_trigger;
            reaction->object =
                new (at<TriggerBinding>(place.binding_at)) TriggerBinding{execution, &receiver, row.trigger};
            reaction->part = plan.part_of[find_component(machine_.table,
                                                         machine_.table.behaviours[row.behaviour].component)];
        }
        event.subscribe(facet(row.event), event.post, reaction);
    }
}

void MachineInstance::place_mailboxes() {
    const std::size_t n = machine_.table.activities.size();
    for (std::size_t receiver = 0; receiver < n; ++receiver) {
        const ActivityPlan& plan = machine_.plan.activities[receiver];
        auto* mailboxes = at<Mailbox>(plan.mailboxes_at);
        for (std::size_t i = 0; i < plan.sender_count; ++i) new (mailboxes + i) Mailbox;
        for (std::size_t sender = 0; sender < n; ++sender) {
            const MailPlan& mail = machine_.plan.mail[sender * n + receiver];
            if (mail.capacity != 0)
                mailboxes[mail.sender_index].place(at<std::byte>(mail.storage_at), mail.capacity,
                                                   Overflow::reject);
        }
        engines()[receiver].inbox().place({mailboxes, plan.sender_count});
    }
}

void MachineInstance::place_behaviours() {
    std::size_t placed[checks::max_activities] = {};
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b) {
        const BehaviourRow& row = machine_.table.behaviours[b];
        if (row.is_slot()) continue;
        const BehaviourPlan& plan = machine_.plan.behaviours[b];
        const ResolvedSizes& sizes = plan.sizes;
        const ResolvedRoom room{{at<StatePlan>(plan.plans_at), sizes.states},
                                {at<std::string_view>(plan.triggers_at), sizes.triggers},
                                {at<ArcIndex>(plan.cells_at), sizes.states * sizes.triggers},
                                {at<StateArc>(plan.arcs_at), sizes.arcs},
                                {at<StateProgram>(plan.programs_at), sizes.programs}};
        static_cast<void>(resolve_into(row.machine, room));
        const std::size_t c = find_component(machine_.table, row.component);
        const std::size_t activity = machine_.index.activity[c];
        auto* execution = new (at<void>(plan.execution_at)) StateMachineExecution;
        execution->bind({row.machine, room.triggers, room.plans.data(), room.cells.data(), room.arcs.data(),
                         room.programs.data()},
                        component(c));
        execution->trace(&note_transition, &engines()[activity]);
        Behaviour behaviour;
        behaviour.self = execution;
        behaviour.part = machine_.plan.part_of[c];
        behaviour.start = [](void* self, Time now) noexcept
            TAPPET_REALTIME { static_cast<void>(execution_of(self).start(now)); };
        behaviour.step = [](void* self, Time now) noexcept TAPPET_REALTIME { execution_of(self).step(now); };
        behaviour.stop = [](void* self, Time now) noexcept TAPPET_REALTIME {
            static_cast<void>(execution_of(self).request_final(now, "the machine stops"));
        };
        behaviour.next = [](const void* self) noexcept
            TAPPET_REALTIME { return static_cast<const StateMachineExecution*>(self)->next_timeout(); };
        new (at<Behaviour>(machine_.plan.activities[activity].behaviours_at) + placed[activity]++)
            Behaviour{behaviour};
    }
}

const StateMachineExecution* MachineInstance::state_machine_of(std::string_view component) const noexcept {
    for (std::size_t b = 0; b < machine_.table.behaviours.size(); ++b)
        if (machine_.table.behaviours[b].component == component && !machine_.table.behaviours[b].is_slot())
            return reinterpret_cast<const StateMachineExecution*>(machine_.memory.data() +
                                                                  machine_.plan.behaviours[b].execution_at);
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
    case StopReason::behaviour: return Sentence{"asked for by a behaviour in activity \"", who, "\""};
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
    }
    return {};
}

std::uint64_t MachineInstance::event_log_digest() const noexcept {
    Digest digest;
    for (const Engine& engine : engines()) digest.add(engine.digest().value());
    return digest.value();
}

std::uint64_t MachineInstance::lost_emissions() const noexcept {
    std::uint64_t lost = 0;
    for (const SubscriptionPlan& place : machine_.plan.subscription_at)
        if (place.async_at != nowhere)
            lost += reinterpret_cast<const AsyncReaction*>(machine_.memory.data() + place.async_at)->lost;
    return lost;
}

} // namespace tappet
