// Starts and stops parts of a running machine (thesis 3.1.3, 4.2.2): components by their engines, activities
// by the supervisor, and initialise and finalise on a thread of their own.
#include "kernel/machine/instance/life.hpp"

namespace tappet {

LifeTicket MachineLife::ask_component(std::size_t c, LifeChange change) noexcept TAPPET_REALTIME {
    const std::size_t a = machine_.index.activity[c];
    // A blocking loop is broken off only with its activity, in which it is the only component.
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
                        "\" is not started: it alternates with other components of activity \"", plan.name,
                        "\", and one of them runs; ask the component that switches between them"};
    case LifeRefusal::left_unsafe:
        return Sentence{"component \"", part.name,
                        "\" has stopped, but its safe values did not reach its device; see that the device "
                        "answers, then start and stop it, or stop the machine: its guardian writes them too"};
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
            text.add("; check that \"")
                .add(machine_.table.components[link.from.component].name)
                .add("\" runs and writes \"")
                .add(machine_.table.connections[x].from)
                .add("\"");
    }
    for (const NeededInput& each : plan.inputs)
        if (each.part == answer.part && each.facet == answer.facet && each.circle != nullptr)
            text.add(
                "; the writer may itself wait for this component: if no value arrives, restart the machine");
    return text;
}

void MachineLife::begin_change(std::size_t a, LifeChange wanted, Begin how, const ActivityControl& control) {
    changes_[a] = {.wanted = wanted, .begin = how};
    begin(a, control);
}

void MachineLife::begin(std::size_t a, const ActivityControl& control) {
    const Engine& engine = placed_.engines()[a];
    Change& change = changes_[a];
    is_given_up_.store(false, std::memory_order_relaxed);
    if (thread_lost_[a]) {
        end_refused(a, {.outcome = LifeOutcome::refused, .refusal = LifeRefusal::thread_lost});
    } else if (change.wanted != LifeChange::start && engine.is_active()) {
        change.phase = Phase::stopping;
        control.stop(control.world, a);
    } else if (change.wanted == LifeChange::stop) {
        end_stop(a);
    } else if (engine.is_active()) {
        end_change(a, {});
    } else {
        change.phase = Phase::waiting_for_makers;
    }
    progress(control);
}

bool MachineLife::begin_finalising(std::size_t a, const ActivityControl& control) {
    if (thread_lost_[a] || !is_initialised_[a]) return false;
    changes_[a] = {.wanted = LifeChange::stop, .phase = Phase::waiting_for_makers};
    progress(control);
    return true;
}

void MachineLife::let_makers_work(const ActivityControl& control) {
    if (makers_at_work()) return;
    for (const Change& each : changes_)
        if (each.phase == Phase::makers) return; // its answer is still to be read
    for (std::size_t a = 0; a < machine_.table.activities.size(); ++a) {
        if (changes_[a].phase != Phase::waiting_for_makers) continue;
        changes_[a].phase = Phase::makers;
        makers_of_ = a;
        makers_at_work_.store(true, std::memory_order_release);
        control.run_makers_functions(control.world);
        return;
    }
}

void MachineLife::run_makers_functions() {
    if (!makers_at_work()) return;
    const std::size_t a = makers_of_;
    Engine& engine = placed_.engines()[a];
    makers_answer_ = {.outcome = LifeOutcome::done};
    makers_refusal_ = {};
    if (is_initialised_[a]) engine.finalise();
    is_initialised_[a] = false;
    const Change& change = changes_[a];
    if (change.wanted != LifeChange::stop && !is_given_up_.load(std::memory_order_relaxed)) {
        if (change.begin == Begin::alone) makers_answer_ = engine.readiness(placed_.clock().now());
        if (makers_answer_.outcome == LifeOutcome::refused) {
            makers_refusal_ = describe(a, makers_answer_);
        } else if (makers_refusal_ = engine.initialise(); !makers_refusal_.empty()) {
            makers_answer_ = {.outcome = LifeOutcome::refused, .refusal = LifeRefusal::not_initialised};
            for (std::size_t i = 0; i < engine.plan().parts.size(); ++i)
                if (engine.plan().parts[i].state.load(std::memory_order_relaxed) == ComponentState::failed)
                    makers_answer_.part = static_cast<std::uint8_t>(i);
        } else {
            is_initialised_[a] = true;
        }
    }
    makers_at_work_.store(false, std::memory_order_release);
    supervisor_.wake();
}

void MachineLife::end_change(std::size_t a, const Sentence& refusal) {
    Change& change = changes_[a];
    change.phase = Phase::none;
    if (change.was_asked)
        activity_requests_[a].answer(change.ticket, change.answer);
    else
        refusal_ = refusal;
}

void MachineLife::end_stop(std::size_t a) {
    const Engine& engine = placed_.engines()[a];
    if (const std::size_t part = engine.left_unsafe(); part < engine.plan().parts.size())
        end_refused(a, {LifeOutcome::refused, LifeRefusal::left_unsafe, static_cast<std::uint8_t>(part)});
    else
        end_change(a, {});
}

void MachineLife::progress(const ActivityControl& control) {
    bool moved = true;
    while (moved) { // the end of one change lets the makers' thread work for the next
        moved = false;
        for (std::size_t a = 0; a < machine_.table.activities.size(); ++a) {
            const Phase before = changes_[a].phase;
            if (before != Phase::none) progress(a, control);
            moved |= changes_[a].phase != before;
        }
    }
}

void MachineLife::progress(std::size_t a, const ActivityControl& control) {
    using Progress = ActivityControl::Progress;
    Change& change = changes_[a];
    for (;;) {
        auto result = Progress::done;
        switch (change.phase) {
        case Phase::none: return;
        case Phase::stopping: result = control.stopped(control.world, a); break;
        case Phase::waiting_for_makers:
            let_makers_work(control);
            if (change.phase != Phase::makers) return;
            [[fallthrough]];
        case Phase::makers:
            if (makers_at_work()) return;
            break;
        case Phase::starting: result = control.started(control.world, a); break;
        }
        if (result == Progress::pending) return;
        if (result == Progress::lost) {
            lose(a);
            end_refused(a, {.outcome = LifeOutcome::refused, .refusal = LifeRefusal::thread_lost});
        } else if (change.phase == Phase::stopping) {
            change.phase = Phase::waiting_for_makers;
        } else if (change.wanted == LifeChange::stop) {
            end_stop(a);
        } else if (change.phase == Phase::starting) {
            end_change(a, {});
        } else if (makers_answer_.outcome == LifeOutcome::refused) {
            change.answer = makers_answer_;
            end_change(a, makers_refusal_);
        } else {
            change.phase = Phase::starting;
            control.start(control.world, a);
        }
    }
}

bool MachineLife::changes() const noexcept {
    for (const Change& each : changes_)
        if (each.phase != Phase::none) return true;
    return false;
}

void MachineLife::serve_activity_requests(const ActivityControl& control) {
    progress(control);
    for (std::size_t a = 0; a < machine_.table.activities.size(); ++a) {
        LifeTicket ticket;
        LifeChange wanted{};
        if (changes(a) || !activity_requests_[a].take(ticket, wanted)) continue;
        changes_[a] = {.wanted = wanted, .begin = Begin::alone, .was_asked = true, .ticket = ticket};
        begin(a, control);
    }
}

// A running initialise or finalise completes: the finalising waits for it.
void MachineLife::give_up_changes() {
    is_given_up_.store(true, std::memory_order_relaxed);
    for (std::size_t a = 0; a < machine_.table.activities.size(); ++a) {
        if (!changes(a)) continue;
        if (changes_[a].was_asked)
            activity_requests_[a].answer(changes_[a].ticket, {.outcome = LifeOutcome::refused,
                                                              .refusal = LifeRefusal::activity_stopped});
        changes_[a].phase = Phase::none;
    }
}

std::string_view MachineLife::left_unsafe() const noexcept {
    for (const Engine& engine : placed_.engines())
        if (const std::size_t part = engine.left_unsafe(); part < engine.plan().parts.size())
            return engine.plan().parts[part].name;
    return {};
}

bool MachineLife::stands() const noexcept {
    if (makers_at_work()) return false;
    for (std::size_t a = 0; a < machine_.table.activities.size(); ++a)
        if (thread_lost_[a] || placed_.engines()[a].is_active()) return false;
    return true;
}

} // namespace tappet
