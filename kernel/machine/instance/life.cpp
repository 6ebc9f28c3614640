// Starting and stopping parts of a running machine (thesis 3.1.3, 4.2.2): components by their engines,
// activities by the supervisor.
#include "kernel/machine/instance/instance.hpp"

#include <new>

namespace tappet {

namespace {

std::uint64_t cycles_of(const void* engine) noexcept TAPPET_REALTIME {
    return static_cast<const Engine*>(engine)->generation();
}

bool is_part_expected(const void* part) noexcept TAPPET_REALTIME {
    const ComponentState state = static_cast<const EnginePart*>(part)->state.load(std::memory_order_acquire);
    return state != ComponentState::stopped && state != ComponentState::inactive;
}

// One whose thread was given up is not active, but nobody wanted that.
bool is_engine_expected(const void* self) noexcept TAPPET_REALTIME {
    const auto& engine = *static_cast<const Engine*>(self);
    return engine.is_active() ||
           engine.plan().parts.front().state.load(std::memory_order_acquire) == ComponentState::failed;
}

bool rests(const void* self) noexcept TAPPET_REALTIME {
    const auto& engine = *static_cast<const Engine*>(self);
    return engine.generation() % 2 == 0 && !engine.is_woken();
}

} // namespace

void MachineInstance::place_needed_inputs() {
    const MachineView& table = machine_.table;
    std::size_t placed[checks::max_activities] = {};
    for (std::size_t x = 0; x < table.connections.size(); ++x) {
        const Link& link = machine_.index.connections[x];
        if (!is_needed_input(table, table.connections[x], link)) continue;
        const Facet& input = facet_at(table, link.to);
        const std::size_t reader = machine_.index.activity[link.to.component];
        new (at<NeededInput>(machine_.plan.activities[reader].inputs_at) + placed[reader]++) NeededInput{
            .input = facet(link.to),
            .flow = input.port->flow,
            .part = machine_.plan.part_of[link.to.component],
            .facet = static_cast<std::uint16_t>(link.to.facet),
            .has_initial = table.connections[x].substitute.given || table.connections[x].before_first.given,
            .same_activity = machine_.index.activity[link.from.component] == reader,
            .valid_to_start = input.valid_to_start};
    }
}

LifeSign MachineInstance::life_sign_of(std::string_view watched) noexcept {
    if (watched.empty()) return {};
    if (const std::size_t a = find_activity(machine_.table, watched); a != nowhere)
        return {&engines()[a], &engines()[a], &cycles_of, &is_engine_expected,
                engines()[a].plan().periodic ? nullptr : &rests};
    End output;
    static_cast<void>(resolve(machine_.table, machine_.index.by_name, watched, FacetKind::output, output));
    for (std::size_t x = 0; x < machine_.table.connections.size(); ++x)
        if (machine_.index.connections[x].from == output && machine_.plan.connections[x].shared) {
            const std::size_t a = machine_.index.activity[output.component];
            return {at<void>(machine_.plan.connections[x].memory_at),
                    &engines()[a].plan().parts[machine_.plan.part_of[output.component]],
                    facet_at(machine_.table, output).port->written, &is_part_expected};
        }
    return {};
}

GatedComponent* MachineInstance::gate_of(std::size_t c) noexcept {
    return &engines()[machine_.index.activity[c]].plan().parts[machine_.plan.part_of[c]];
}

LifeTicket MachineInstance::ask_component(std::size_t c, LifeChange change) noexcept TAPPET_REALTIME {
    const std::size_t a = machine_.index.activity[c];
    // A loop that blocks is broken off by the supervisor only: it is alone in its activity.
    if (machine_.table.components[c].type->loop != nullptr) return ask_activity(a, change);
    return engines()[a].ask(machine_.plan.part_of[c], change);
}

LifeAnswer MachineInstance::answer_of_component(std::size_t c, LifeTicket ticket) noexcept TAPPET_REALTIME {
    const std::size_t a = machine_.index.activity[c];
    if (machine_.table.components[c].type->loop != nullptr) return answer_of_activity(a, ticket);
    return engines()[a].answer_to(machine_.plan.part_of[c], ticket);
}

ComponentState MachineInstance::state_of(std::size_t c) noexcept TAPPET_REALTIME {
    const EnginePlan& plan = engines()[machine_.index.activity[c]].plan();
    return plan.parts[machine_.plan.part_of[c]].state.load(std::memory_order_acquire);
}

LifeTicket MachineInstance::ask_activity(std::size_t a, LifeChange change) noexcept TAPPET_REALTIME {
    const LifeTicket ticket = activity_requests_[a].ask(change);
    supervisor_.wake();
    return ticket;
}

LifeAnswer MachineInstance::answer_of_activity(std::size_t a, LifeTicket ticket) const noexcept
    TAPPET_REALTIME {
    return activity_requests_[a].answer_to(ticket);
}

Sentence MachineInstance::describe(std::size_t activity, LifeAnswer answer) const {
    const EnginePlan& plan = engines()[activity].plan();
    const EnginePart& part = plan.parts[answer.part];
    switch (answer.refusal) {
    case LifeRefusal::none: return {};
    case LifeRefusal::not_initialised:
        return Sentence{"component \"", part.name,
                        "\" is not started: it could not be initialised; cure what it said then, and start "
                        "its activity \"",
                        plan.name, "\""};
    case LifeRefusal::activity_stopped:
        return Sentence{"component \"", part.name, "\" is not started: its activity \"", plan.name,
                        "\" does not run; start that"};
    case LifeRefusal::thread_lost:
        return Sentence{"activity \"", plan.name,
                        "\" is not started: its thread hangs, broke a contract or came too late; free its "
                        "processor of other "
                        "real-time work, and restart the machine"};
    case LifeRefusal::input_never_written:
    case LifeRefusal::input_stale: break;
    }
    const std::string_view input = part.type->facets[answer.facet].name;
    Sentence text{"component \"",
                  part.name,
                  "\" is not started: its input \"",
                  input,
                  "\" ",
                  answer.refusal == LifeRefusal::input_stale ? "is stale" : "was never written"};
    for (std::size_t x = 0; x < machine_.table.connections.size(); ++x) {
        const Link& link = machine_.index.connections[x];
        if (link.to.facet == answer.facet && machine_.table.components[link.to.component].name == part.name)
            return text.add("; see that \"")
                .add(machine_.table.components[link.from.component].name)
                .add("\" runs and writes \"")
                .add(machine_.table.connections[x].from)
                .add("\"");
    }
    return text;
}

Sentence MachineInstance::initialise_and_start(std::size_t a, const ActivityControl& control,
                                               LifeAnswer& answer) {
    Engine& engine = engines()[a];
    if (Sentence refusal = engine.initialise(); !refusal.empty()) {
        answer = {.outcome = LifeOutcome::refused, .refusal = LifeRefusal::not_initialised};
        for (std::size_t i = 0; i < engine.plan().parts.size(); ++i)
            if (engine.plan().parts[i].state.load(std::memory_order_relaxed) == ComponentState::failed)
                answer.part = static_cast<std::uint8_t>(i);
        return refusal;
    }
    if (control.start(control.world, a)) return {};
    thread_lost_[a] = !control.stop(control.world, a);
    if (!thread_lost_[a]) engine.finalise();
    answer = {.outcome = LifeOutcome::refused, .refusal = LifeRefusal::thread_lost};
    return describe(a, answer);
}

Sentence MachineInstance::start_activities(const ActivityControl& control) {
    for (std::size_t a = 0; a < machine_.table.activities.size(); ++a) {
        LifeAnswer answer;
        if (Sentence refusal = initialise_and_start(a, control, answer); !refusal.empty()) return refusal;
    }
    return {};
}

Sentence MachineInstance::change_activity(std::size_t a, LifeChange change, const ActivityControl& control,
                                          LifeAnswer& answer) {
    Engine& engine = engines()[a];
    answer = {.outcome = LifeOutcome::done};
    if (!thread_lost_[a] && change != LifeChange::start && engine.is_active()) {
        if (control.stop(control.world, a))
            engine.finalise();
        else
            thread_lost_[a] = true;
    }
    if (thread_lost_[a]) {
        answer = {.outcome = LifeOutcome::refused, .refusal = LifeRefusal::thread_lost};
        return describe(a, answer);
    }
    if (change == LifeChange::stop || engine.is_active()) return {};
    if (const LifeAnswer ready = engine.readiness(clock_->now()); ready.outcome == LifeOutcome::refused) {
        answer = ready;
        return describe(a, answer);
    }
    return initialise_and_start(a, control, answer);
}

std::uint64_t MachineInstance::dropped_messages() const noexcept {
    std::uint64_t dropped = 0;
    for (std::size_t s = 0; s < machine_.plan.subscriptions.size(); ++s) dropped += counts_of(s).dropped;
    for (const Engine& engine : engines())
        for (const EnginePart& part : engine.plan().parts)
            dropped += part.dropped.load(std::memory_order_relaxed);
    return dropped;
}

void MachineInstance::serve_activity_requests(const ActivityControl& control) {
    for (std::size_t a = 0; a < machine_.table.activities.size(); ++a) {
        LifeTicket ticket;
        LifeChange change{};
        if (!activity_requests_[a].take(ticket, change)) continue;
        LifeAnswer answer;
        static_cast<void>(change_activity(a, change, control, answer));
        activity_requests_[a].answer(ticket, answer);
    }
}

} // namespace tappet
