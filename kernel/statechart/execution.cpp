// What an execution does besides handling one event: steps, requests, and what programs asked for while they
// ran.
#include "kernel/statechart/execution.hpp"

namespace tappet {

void StateMachineExecution::give_reason(TransitionIndex transition, std::string_view text, Time now) noexcept
    TAPPET_REALTIME {
    status_.reason = transition;
    status_.reason_at = now;
    reason_ = text;
    std::atomic_ref{news_}.store((news().number + 1) << transition_bits | transition,
                                 std::memory_order_relaxed);
}

StateOutcome StateMachineExecution::queue(std::size_t trigger, Time now) noexcept TAPPET_REALTIME {
    if (is(inactive)) return StateOutcome::ignored;
    if (!raised_.push(static_cast<TriggerIndex>(trigger))) {
        ++status_.lost_events;
        if (!is(busy)) finish(now);
        return StateOutcome::lost;
    }
    set(waiting);
    if (!is(busy)) finish(now);
    return StateOutcome::queued;
}

void StateMachineExecution::serve_final(Time now) noexcept TAPPET_REALTIME {
    if (!is(final_wanted)) return;
    clear(final_wanted);
    if (is_final()) return;
    if (!final_reason_.empty()) give_reason(final_transition, final_reason_, now);
    take(machine_.arcs[machine_.plans[status_.active].to_final], now);
}

// The end of every outer call: what programs asked for while they ran. The last request for the final state
// is served even when the bound is reached.
void StateMachineExecution::finish(Time now) noexcept TAPPET_REALTIME {
    set(busy);
    for (std::size_t n = 0; n < max_raised_events; ++n) {
        serve_final(now);
        if (raised_.empty()) break;
        const TriggerIndex trigger = raised_[0];
        for (std::size_t i = 1; i < raised_.used; ++i) raised_[i - 1] = raised_[i];
        --raised_.used;
        static_cast<void>(take_first(first_arc(trigger), now));
    }
    serve_final(now);
    clear(busy);
    if (raised_.empty()) clear(waiting);
}

bool StateMachineExecution::take_condition(Time now) noexcept TAPPET_REALTIME {
    const ArcIndex first = machine_.plans[status_.active].conditions;
    if (first == no_arc) return false;
    for (const StateArc* arc = machine_.arcs + first;; ++arc) {
        const bool is_due = arc->after == Duration{} || now >= due(*arc);
        if (is_due && (arc->guard == nullptr || arc->guard(component_))) {
            take(*arc, now);
            return true;
        }
        if (arc->last) return false;
    }
}

void StateMachineExecution::step(Time now) noexcept TAPPET_REALTIME {
    if (is(inactive) || is(busy)) return;
    set(busy);
    stepped_at_ = now;
    std::size_t taken = 0;
    serve_final(now);
    while (taken < max_transitions_per_step && take_condition(now)) {
        ++taken;
        serve_final(now);
    }
    conditions_left_ = taken == max_transitions_per_step;
    call(machine_.plans[status_.active].run);
    clear(busy);
    if (mode_ != ready) finish(now);
}

StateOutcome StateMachineExecution::start(Time now) noexcept TAPPET_REALTIME {
    if (!is(inactive) || machine_.arcs == nullptr) return StateOutcome::ignored;
    mode_ = busy;
    conditions_left_ = false;
    raised_.clear();
    take(machine_.arcs[start_arc], now);
    clear(busy);
    if (mode_ != ready) finish(now);
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::deactivate(Time now) noexcept TAPPET_REALTIME {
    if (is(inactive) || is(busy)) return StateOutcome::ignored;
    set(busy);
    call(machine_.plans[status_.active].leave);
    mode_ = inactive;
    raised_.clear();
    conditions_left_ = false;
    const StateIndex from = status_.active;
    status_.active = no_state;
    status_.last_transition = leaving_transition;
    ++status_.transitions;
    if (trace_ != nullptr) trace_(trace_context_, from, no_state, leaving_transition, now);
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::request_final(Time now, std::string_view reason) noexcept
    TAPPET_REALTIME {
    if (is(inactive)) return StateOutcome::ignored;
    final_reason_ = reason;
    set(final_wanted);
    if (is(busy)) return StateOutcome::queued;
    if (is_final()) {
        clear(final_wanted);
        return StateOutcome::ignored;
    }
    finish(now);
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::request_initial(Time now) noexcept TAPPET_REALTIME {
    if (is(busy) || !is_final()) return StateOutcome::ignored;
    set(busy);
    take(machine_.arcs[reset_arc], now);
    clear(busy);
    if (mode_ != ready) finish(now);
    return StateOutcome::taken;
}

Time StateMachineExecution::next_timeout() const noexcept TAPPET_REALTIME {
    if (!is_active()) return never;
    if (left_over()) return stepped_at_;
    const ArcIndex first = machine_.plans[status_.active].conditions;
    Time earliest = never;
    if (first == no_arc) return earliest;
    for (const StateArc* arc = machine_.arcs + first;; ++arc) {
        const Time at = arc->after == Duration{} ? never : due(*arc);
        if (at > stepped_at_ && at < earliest) earliest = at;
        if (arc->last) return earliest;
    }
}

auto StateMachineExecution::path() const noexcept TAPPET_REALTIME
-> Bounded<std::string_view, max_state_depth> {
    Bounded<std::string_view, max_state_depth> names;
    if (!is_active()) return names;
    StateIndex state = status_.active;
    names.used = machine_.plans[state].depth;
    for (std::size_t level = names.used; level-- > 0; state = machine_.plans[state].parent)
        names[level] = machine_.table.states[state].name;
    return names;
}

} // namespace tappet
