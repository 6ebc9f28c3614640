// Starting and stopping parts of a running machine (thesis 3.1.3, 4.2.2): components by their engines,
// activities by the supervisor.
#include "kernel/machine/instance/life.hpp"

namespace tappet {

LifeTicket MachineLife::ask_component(std::size_t c, LifeChange change) noexcept TAPPET_REALTIME {
    const std::size_t a = machine_.index.activity[c];
    // A loop that blocks is broken off by the supervisor only: it is alone in its activity.
    if (machine_.table.components[c].type->loop != nullptr) return ask_activity(a, change);
    return placed_.engines()[a].ask(machine_.plan.part_of[c], change);
}

LifeAnswer MachineLife::answer_of_component(std::size_t c, LifeTicket ticket) noexcept TAPPET_REALTIME {
    const std::size_t a = machine_.index.activity[c];
    if (machine_.table.components[c].type->loop != nullptr) return answer_of_activity(a, ticket);
    return placed_.engines()[a].answer_to(machine_.plan.part_of[c], ticket);
}

ComponentState MachineLife::state_of(std::size_t c) noexcept TAPPET_REALTIME {
    const EnginePlan& plan = placed_.engines()[machine_.index.activity[c]].plan();
    return plan.parts[machine_.plan.part_of[c]].state.load(std::memory_order_acquire);
}

LifeTicket MachineLife::ask_activity(std::size_t a, LifeChange change) noexcept TAPPET_REALTIME {
    const LifeTicket ticket = activity_requests_[a].ask(change);
    supervisor_.wake();
    return ticket;
}

LifeAnswer MachineLife::answer_of_activity(std::size_t a, LifeTicket ticket) const noexcept TAPPET_REALTIME {
    return activity_requests_[a].answer_to(ticket);
}

Sentence MachineLife::describe(std::size_t activity, LifeAnswer answer) const {
    const EnginePlan& plan = placed_.engines()[activity].plan();
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
    case LifeRefusal::waits_for_its_turn:
        return Sentence{"component \"", part.name,
                        "\" is not started: it runs by turns with others of activity \"", plan.name,
                        "\", and one of those runs; ask the component that hands over between them"};
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
            text.add("; see that \"")
                .add(machine_.table.components[link.from.component].name)
                .add("\" runs and writes \"")
                .add(machine_.table.connections[x].from)
                .add("\"");
    }
    for (const NeededInput& each : plan.inputs)
        if (each.part == answer.part && each.facet == answer.facet && each.circle != nullptr)
            text.add(", which may wait for this one in turn: if it does not come, restart the machine");
    return text;
}

Sentence MachineLife::initialise_and_start(std::size_t a, const ActivityControl& control,
                                           LifeAnswer& answer) {
    Engine& engine = placed_.engines()[a];
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

Sentence MachineLife::start_activities(const ActivityControl& control) {
    for (std::size_t a = 0; a < machine_.table.activities.size(); ++a) {
        LifeAnswer answer;
        if (Sentence refusal = initialise_and_start(a, control, answer); !refusal.empty()) return refusal;
    }
    return {};
}

Sentence MachineLife::change_activity(std::size_t a, LifeChange change, const ActivityControl& control,
                                      LifeAnswer& answer) {
    Engine& engine = placed_.engines()[a];
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
    if (const LifeAnswer ready = engine.readiness(placed_.clock().now());
        ready.outcome == LifeOutcome::refused) {
        answer = ready;
        return describe(a, answer);
    }
    return initialise_and_start(a, control, answer);
}

bool MachineLife::stands() const noexcept {
    for (std::size_t a = 0; a < machine_.table.activities.size(); ++a)
        if (thread_lost_[a] || placed_.engines()[a].is_active()) return false;
    return true;
}

void MachineLife::serve_activity_requests(const ActivityControl& control) {
    for (std::size_t a = 0; a < machine_.table.activities.size(); ++a) {
        LifeTicket ticket;
        LifeChange change{};
        if (!activity_requests_[a].take(ticket, change)) continue;
        if (control.begins != nullptr) control.begins(control.world);
        LifeAnswer answer;
        static_cast<void>(change_activity(a, change, control, answer));
        activity_requests_[a].answer(ticket, answer);
    }
}

} // namespace tappet
