// The calls that come from outside: steps, requests, events that wait, and what programs asked for while they
// ran.
#include "kernel/statechart/execution.hpp"

#include <cstring>

namespace tappet {

bool StateMachineExecution::bind(const StateMachineBinding& binding) noexcept TAPPET_REALTIME {
    const ResolvedSizes& sizes = binding.machine.sizes;
    const bool complete = binding.history.size() >= sizes.history &&
                          binding.deferred.size() >= sizes.captured * max_raised_events &&
                          (binding.machine.table.programs == nullptr || binding.code.run != nullptr);
    machine_ = complete ? binding.machine : ResolvedView{};
    code_ = binding.code;
    if (code_.tables == nullptr) code_.tables = binding.machine.table.programs;
    context_ = {};
    context_.component = binding.component;
    context_.data = binding.data;
    context_.links = binding.links;
    context_.machines = binding.machines;
    fast_ = binding.fast;
    policy_ = binding.policy;
    const bool is_quick = fast_.dispatch != nullptr && policy_.statements >= fast_.statements;
    dispatch_ = is_quick ? fast_.dispatch : machine_.folded ? &dispatch_folded : &dispatch_walked;
    step_ = is_quick ? fast_.step : &step_walked;
    parent_ = binding.parent;
    history_ = binding.history;
    deferred_ = binding.deferred;
    for (StateIndex& last : history_) last = no_state;
    mode_ = inactive;
    automatic_ = run_once_ = program_begun_ = false;
    status_ = {};
    reason_ = {};
    news_ = 0;
    stepped_at_ = {};
    job_ = {};
    selected_.clear();
    drop_waiting();
    return complete;
}

void StateMachineExecution::drop_waiting() noexcept TAPPET_REALTIME {
    raised_count_ = 0;
    wanted_state_ = no_state;
    conditions_left_ = statements_left_ = false;
    clear(waiting);
}

void StateMachineExecution::give_reason(TransitionIndex transition, std::string_view text, Time now) noexcept
    TAPPET_REALTIME {
    status_.reason = transition;
    status_.reason_at = now;
    reason_ = text;
    std::atomic_ref{news_}.store((news().number + 1) << transition_bits | transition,
                                 std::memory_order_relaxed);
}

void StateMachineExecution::open(Time now) noexcept TAPPET_REALTIME {
    set(busy);
    context_.now = now;
    statements_ = policy_.statements;
    statements_left_ = false;
}

// The end of every outer call: what programs asked for while they ran, and what had to wait for them. The
// last request for the final state is served even when the bound is reached.
void StateMachineExecution::finish(Time now) noexcept TAPPET_REALTIME {
    set(busy);
    if (machine_.folded) statements_ = policy_.statements;
    for (std::size_t n = 0; n < max_raised_events; ++n) {
        serve_final(now);
        if ((mode_ & (inactive | error | in_hand | paused)) != 0) break;
        if (wanted_state_ != no_state)
            static_cast<void>(serve_request(now));
        else if (raised_count_ != 0)
            handle_raised(now);
        else
            break;
    }
    serve_final(now);
    clear(busy);
    if (raised_count_ == 0 && wanted_state_ == no_state) clear(waiting);
}

void StateMachineExecution::serve_final(Time now) noexcept TAPPET_REALTIME {
    if (!is(final_wanted)) return;
    clear(final_wanted);
    const bool under_way = is(in_hand) && job_.transition == final_transition && !is(error);
    const bool is_there = is_final() && !is(in_hand) && !is(error);
    if (is(inactive) || is_leaving() || under_way || is_there) return;
    if (!final_reason_.empty()) give_reason(final_transition, final_reason_, now);
    if (machine_.folded && (mode_ & (in_hand | error)) == 0)
        take(machine_.arcs[machine_.plans[status_.active].to_final], now);
    else {
        supersede(final_transition, machine_.final_state);
        static_cast<void>(go_on(now));
    }
    if (is_final() && (mode_ & (in_hand | error)) == 0) clear(final_wanted); // asked for on the way there
}

// ---- events

StateOutcome StateMachineExecution::queue(std::size_t trigger, Time now, const std::byte* arguments) noexcept
    TAPPET_REALTIME {
    const bool called_from_outside = !is(busy);
    StateOutcome outcome = StateOutcome::lost;
    if (raised_count_ == max_raised_events) {
        ++status_.lost_events;
    } else {
        const std::size_t place = (raised_first_ + raised_count_++) % max_raised_events;
        raised_[place] = static_cast<TriggerIndex>(trigger);
        if (const std::size_t bytes = machine_.captured[trigger]; bytes != 0)
            std::memcpy(deferred_.data() + place * machine_.sizes.captured, arguments, bytes);
        ++status_.deferred_events;
        set(waiting);
        outcome = StateOutcome::queued;
    }
    if (called_from_outside) {
        open(now);
        finish(now);
    }
    return outcome;
}

void StateMachineExecution::handle_raised(Time now) noexcept TAPPET_REALTIME {
    const std::size_t place = raised_first_;
    const TriggerIndex trigger = raised_[place];
    raised_first_ = static_cast<std::uint8_t>((place + 1) % max_raised_events);
    --raised_count_;
    if (machine_.folded) {
        static_cast<void>(take_first(machine_.cells[cell_of(trigger)], now));
        return;
    }
    static_cast<void>(react(trigger, deferred_.data() + place * machine_.sizes.captured, now));
    if (!single_) static_cast<void>(go_on(now));
}

StateOutcome StateMachineExecution::dispatch_folded(StateMachineExecution& execution, std::size_t trigger,
                                                    Time now, const std::byte*) noexcept TAPPET_REALTIME {
    if (trigger >= execution.machine_.triggers.size()) return StateOutcome::ignored;
    execution.mode_ = busy;
    const bool taken = execution.take_first(execution.machine_.cells[execution.cell_of(trigger)], now);
    execution.clear(busy);
    if (execution.mode_ != ready) [[unlikely]]
        execution.finish(now);
    return taken ? StateOutcome::taken : StateOutcome::ignored;
}

StateOutcome StateMachineExecution::dispatch_generally(std::size_t trigger, Time now,
                                                       const std::byte* arguments) noexcept TAPPET_REALTIME {
    if (trigger >= machine_.triggers.size()) return StateOutcome::ignored;
    if (is(inactive) || is(error) || is_leaving()) return StateOutcome::ignored;
    if (machine_.captured[trigger] != 0 && arguments == nullptr) return StateOutcome::ignored;
    if ((mode_ & (busy | in_hand | waiting | paused | final_wanted)) != 0)
        return queue(trigger, now, arguments);
    open(now);
    bool taken = false;
    if (machine_.folded)
        taken = take_first(machine_.cells[cell_of(trigger)], now);
    else {
        taken = react(trigger, arguments, now);
        static_cast<void>(go_on(now));
    }
    finish(now);
    return taken ? StateOutcome::taken : StateOutcome::ignored;
}

// ---- commands

StateOutcome StateMachineExecution::activate(Time now) noexcept TAPPET_REALTIME {
    if (!is(inactive) || machine_.arcs == nullptr) return StateOutcome::ignored;
    mode_ = ready;
    automatic_ = run_once_ = program_begun_ = false;
    job_ = {};
    selected_.clear();
    drop_waiting();
    open(now);
    if (machine_.folded)
        take(machine_.arcs[start_arc], now);
    else {
        begin_request(start_transition, machine_.arcs[start_arc].to);
        static_cast<void>(go_on(now));
    }
    finish(now);
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::start(Time now) noexcept TAPPET_REALTIME {
    if (is(inactive)) {
        const StateOutcome outcome = activate(now);
        automatic_ = outcome == StateOutcome::taken;
        return outcome;
    }
    if (automatic_ && !is(paused)) return StateOutcome::ignored;
    clear(paused);
    automatic_ = true;
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::reactive() noexcept TAPPET_REALTIME {
    if (is(inactive) || (!automatic_ && !is(paused))) return StateOutcome::ignored;
    clear(paused);
    automatic_ = false;
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::pause() noexcept TAPPET_REALTIME {
    if (is(inactive) || is(paused)) return StateOutcome::ignored;
    set(paused);
    return StateOutcome::taken;
}

void StateMachineExecution::step_slowly(Time now) noexcept TAPPET_REALTIME {
    if ((mode_ & (inactive | busy | paused | error)) != 0) return;
    stepped_at_ = now;
    conditions_left_ = false;
    if (machine_.folded && automatic_ && (mode_ & (in_hand | mid_round)) == 0)
        step_folded(now);
    else
        step_generally(now);
}

void StateMachineExecution::step_generally(Time now) noexcept TAPPET_REALTIME {
    open(now);
    ran_ = {};
    serve_final(now);
    round(now);
    finish(now);
}

bool StateMachineExecution::step_once(Time now) noexcept TAPPET_REALTIME {
    if (!is(paused) || (mode_ & (inactive | busy | error)) != 0) return false;
    open(now);
    const std::uint64_t transitions = status_.transitions;
    statements_ = 1;
    single_ = true;
    if (!is(mid_round)) ran_ = {};
    stepped_at_ = now;
    if (!is(in_hand) && !is(mid_round) && raised_count_ != 0) {
        statements_ = 0;
        handle_raised(now);
    } else
        round(now);
    serve_final(now);
    single_ = statements_left_ = false;
    clear(busy);
    if (raised_count_ == 0 && wanted_state_ == no_state) clear(waiting);
    return statements_ == 0 || status_.transitions != transitions;
}

StateOutcome StateMachineExecution::request_state(StateIndex target, Time now, bool run_once) noexcept
    TAPPET_REALTIME {
    if (is(inactive) || is(error) || is_leaving() || target >= machine_.table.states.size())
        return StateOutcome::ignored;
    if (wanted_state_ != no_state) {
        ++status_.lost_events;
        return StateOutcome::lost;
    }
    wanted_state_ = target;
    wanted_run_ = run_once;
    if ((mode_ & (busy | in_hand | waiting | paused)) != 0) {
        set(waiting);
        return StateOutcome::queued;
    }
    open(now);
    const StateOutcome outcome = serve_request(now);
    finish(now);
    return outcome;
}

StateOutcome StateMachineExecution::serve_request(Time now) noexcept TAPPET_REALTIME {
    const StateIndex target = wanted_state_;
    wanted_state_ = no_state;
    bool there = is_in(target);
    if (!there && target == machine_.final_state) {
        supersede(final_transition, target);
        there = true;
    } else if (!there && is_final() && target == machine_.arcs[start_arc].to) {
        supersede(reset_transition, target);
        there = true;
    }
    for (std::size_t i = 0; !there && i < status_.states.size(); ++i) {
        const StatePlan& plan = machine_.plans[status_.states[i].state];
        if (plan.regions != 0 || plan.conditions == no_arc) continue;
        for (const StateArc* arc = machine_.arcs + plan.conditions; !there; ++arc) {
            const Answer answer = arc->to == target ? ask(*arc, nullptr, now) : Answer::no;
            if (answer == Answer::failed) return StateOutcome::ignored;
            there = answer == Answer::yes;
            if (there) begin(*arc, false, now);
            if (arc->last) break;
        }
    }
    if (!there) return StateOutcome::ignored;
    run_once_ = wanted_run_ && !automatic_;
    if (go_on(now) && run_once_) {
        ran_ = {};
        round(now);
    }
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::request_final(Time now, std::string_view reason) noexcept
    TAPPET_REALTIME {
    if (is(inactive) || is_leaving()) return StateOutcome::ignored;
    const bool is_there = is_final() && (mode_ & (busy | in_hand | error)) == 0;
    if (is_there) return StateOutcome::ignored;
    final_reason_ = reason;
    set(final_wanted);
    if (is(busy)) return StateOutcome::queued;
    clear(paused);
    open(now);
    finish(now);
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::request_initial(Time now) noexcept TAPPET_REALTIME {
    if ((mode_ & (busy | in_hand | error)) != 0 || !is_final()) return StateOutcome::ignored;
    clear(paused);
    open(now);
    if (machine_.folded)
        take(machine_.arcs[reset_arc], now);
    else {
        supersede(reset_transition, machine_.arcs[reset_arc].to);
        static_cast<void>(go_on(now));
    }
    finish(now);
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::deactivate(Time now) noexcept TAPPET_REALTIME {
    if (is(inactive) || is(busy) || (is_leaving() && !is(error))) return StateOutcome::ignored;
    const bool second = is_leaving();
    clear(paused);
    clear(final_wanted);
    drop_waiting();
    open(now);
    if (!second)
        supersede(leaving_transition, no_state);
    else {
        clear(error);
        program_begun_ = false;
        if (job_.end > job_.first) remove(--job_.end);
    }
    static_cast<void>(go_on(now));
    clear(busy);
    return StateOutcome::taken;
}

// ---- what there is to see

MachineStatus StateMachineExecution::machine_status() const noexcept TAPPET_REALTIME {
    if (is(inactive)) return MachineStatus::inactive;
    if (is(error)) return MachineStatus::error;
    if (is(paused)) return MachineStatus::paused;
    if (is_final() && !is(in_hand)) return MachineStatus::stopped;
    return automatic_ ? MachineStatus::running : MachineStatus::active;
}

Time StateMachineExecution::next_timeout() const noexcept TAPPET_REALTIME {
    if ((mode_ & (inactive | paused | error)) != 0) return never;
    if (left_over()) return stepped_at_;
    Time earliest = never;
    const auto program = [&](const ProgramPosition& position) noexcept TAPPET_REALTIME {
        if (code_.wakes == nullptr) return;
        ProgramContext context = context_;
        context.position = position;
        earliest = std::min(earliest, code_.wakes(*code_.tables, context));
    };
    if (program_begun_) program(position_);
    if ((!automatic_ && !run_once_) || is(in_hand)) return earliest;
    for (const ActiveState& active : status_.states) {
        if (active.run == RunPhase::waits) program(active.position);
        const StatePlan& plan = machine_.plans[active.state];
        if (plan.regions != 0 || plan.conditions == no_arc || !automatic_) continue;
        for (const StateArc* arc = machine_.arcs + plan.conditions;; ++arc) {
            if (arc->after != Duration{}) {
                const std::size_t source = machine_.plain ? arc->source_level : index_of(arc->source);
                if (source < status_.states.size()) {
                    const Time at = due(*arc, status_.states[source].entered_at);
                    if (at > stepped_at_) earliest = std::min(earliest, at);
                }
            }
            if (arc->last) break;
        }
    }
    return earliest;
}

Bounded<std::string_view, max_state_depth> path_of(const ResolvedView& machine, StateIndex state) noexcept
    TAPPET_REALTIME {
    Bounded<std::string_view, max_state_depth> names;
    if (state == no_state) return names;
    names.used = machine.plans[state].depth;
    for (std::size_t level = names.used; level-- > 0; state = machine.plans[state].parent)
        names[level] = machine.table.states[state].name;
    return names;
}

} // namespace tappet
