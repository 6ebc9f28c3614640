// Calls from outside: steps, requests, queued events, and requests that programs made while they ran.
#include "kernel/statechart/in_memory.hpp"

#include <cstring>

namespace tappet {

namespace {

using Order = statechart::Order<statechart::InMemory>;

} // namespace

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
    context_.beside = binding.beside;
    context_.limit = binding.limit;
    policy_ = binding.policy;
    fast_ = binding.fast;
    if (fast_.dispatch == nullptr || policy_.statements < fast_.statements) {
        fast_.dispatch = machine_.plain ? &dispatch_in_memory<true> : &dispatch_in_memory<false>;
        fast_.step = machine_.plain ? &step_in_memory<true> : &step_in_memory<false>;
    }
    parent_ = binding.parent;
    history_ = binding.history;
    deferred_ = binding.deferred;
    for (StateIndex& last : history_) last = no_state;
    mode_ = inactive;
    automatic_ = run_once_ = program_begun_ = false;
    status_ = {};
    reason_ = {};
    news_ = refused_ = 0;
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

void StateMachineExecution::give_reason(TransitionIndex transition, std::string_view text) noexcept
    TAPPET_REALTIME {
    status_.reason = transition;
    status_.reason_at = context_.now;
    reason_ = text;
    write(news_, transition);
}

auto StateMachineExecution::look(TransitionIndex transition, Time now) noexcept TAPPET_REALTIME -> Look {
    using statechart::InMemory;
    using Said = Look::Answer;
    if (transition >= machine_.table.transitions.size()) return {};
    const InMemory::Arc arc = InMemory::arc_of(*this, static_cast<ArcIndex>(first_arc + transition));
    const StateArc& row = arc.row();
    if (!is_in(row.source)) return {};
    const Time due_at = due(row, status_.states[index_of(row.source)].entered_at);
    if (row.after != Duration{} && now < due_at) return {.answer = Said::too_early, .left = due_at - now};
    if (row.captures) return {.answer = Said::arguments};
    context_.now = now;
    const auto said = [&](Answer answer, Said no, StateIndex state, const GuardReason& reason) noexcept
        TAPPET_REALTIME {
            if (answer == Answer::failed) no = Said::failed;
            return Look{no, state, {}, reason.detail != nullptr ? reason.detail(context_.component) : ""};
        };
    context_.position.entered = false;
    if (const Answer answer = InMemory::ask(*this, arc.guard()); answer != Answer::yes)
        return said(answer, Said::guard, row.source, machine_.table.transitions[transition].refusal);
    Look found{.answer = Said::open};
    InMemory::for_each_entered<false>(*this, arc, [&](InMemory::State state) noexcept TAPPET_REALTIME {
        const Answer answer = InMemory::ask(*this, state.precondition());
        if (answer == Answer::yes) return true;
        found = said(answer, Said::precondition, state.number(), state.row.refusal);
        return false;
    });
    return found;
}

// Ends a call from outside: serves what programs requested while they ran, and what was queued behind it.
// Serves the last request for the final state even when the bound is reached.
void StateMachineExecution::finish(Call call) noexcept TAPPET_REALTIME {
    for (std::size_t n = 0; n < max_raised_events; ++n) {
        call = serve_final(call);
        if ((mode_ & (inactive | error | in_hand | paused)) != 0) break;
        if (wanted_state_ != no_state)
            static_cast<void>(serve_request(call));
        else if (raised_count_ != 0)
            handle_raised(call);
        else
            break;
    }
    call = serve_final(call);
    clear(busy);
    if (raised_count_ == 0 && wanted_state_ == no_state) clear(waiting);
}

auto StateMachineExecution::serve_final(Call call) noexcept TAPPET_REALTIME -> Call {
    if (!is(final_wanted)) return call;
    clear(final_wanted);
    const bool under_way = has_in_hand(final_arc) && !is(error);
    const bool is_there = is_final() && !is(in_hand) && !is(error);
    if (is(inactive) || is_leaving() || under_way || is_there) return call;
    if (!final_reason_.empty()) give_reason(final_transition, final_reason_);
    supersede(final_arc);
    static_cast<void>(Order::resume(*this, call));
    if (is_final() && (mode_ & (in_hand | error)) == 0) clear(final_wanted); // requested on the way there
    return call;
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
        Call call = open(now);
        finish(call);
    }
    return outcome;
}

void StateMachineExecution::handle_raised(Call& call) noexcept TAPPET_REALTIME {
    const std::size_t place = raised_first_;
    raised_first_ = static_cast<std::uint8_t>((place + 1) % max_raised_events);
    --raised_count_;
    static_cast<void>(Order::dispatch(*this, statechart::InMemory::Cell{raised_[place]},
                                      deferred_.data() + place * machine_.sizes.captured, call));
}

template <bool quick>
StateOutcome StateMachineExecution::dispatch_in_memory(StateMachineExecution& execution, std::size_t trigger,
                                                       Time now, const std::byte* arguments) noexcept
    TAPPET_REALTIME {
    using Table = statechart::Memory<quick>;
    if (trigger >= execution.machine_.triggers.size()) return StateOutcome::ignored;
    if (execution.machine_.captured[trigger] != 0 && arguments == nullptr) return StateOutcome::ignored;
    Call call = execution.open(now);
    const bool taken =
        statechart::Order<Table>::dispatch(execution, typename Table::Cell{trigger}, arguments, call);
    execution.close(call);
    return taken ? StateOutcome::taken : StateOutcome::ignored;
}

StateOutcome StateMachineExecution::dispatch_generally(std::size_t trigger, Time now,
                                                       const std::byte* arguments) noexcept TAPPET_REALTIME {
    if (trigger >= machine_.triggers.size()) return StateOutcome::ignored;
    if (is(inactive) || is(error) || is_leaving()) return StateOutcome::ignored;
    if (machine_.captured[trigger] != 0 && arguments == nullptr) return StateOutcome::ignored;
    if ((mode_ & (busy | in_hand | waiting | paused | final_wanted)) != 0)
        return queue(trigger, now, arguments);
    return dispatch_in_memory<false>(*this, trigger, now, arguments);
}

// ---- commands

StateOutcome StateMachineExecution::activate(Time now) noexcept TAPPET_REALTIME {
    if (!is(inactive) || machine_.arcs == nullptr) return StateOutcome::ignored;
    mode_ = ready;
    automatic_ = run_once_ = program_begun_ = false;
    job_ = {};
    selected_.clear();
    drop_waiting();
    begin_request(start_arc);
    return carry_out(now);
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

// Executes the job that was begun.
StateOutcome StateMachineExecution::carry_out(Time now) noexcept TAPPET_REALTIME {
    Call call = open(now);
    static_cast<void>(Order::resume(*this, call));
    finish(call);
    return StateOutcome::taken;
}

template <bool quick>
void StateMachineExecution::step_in_memory(StateMachineExecution& execution, Time now) noexcept
    TAPPET_REALTIME {
    Call call = quick ? execution.open_ready(now) : execution.open(now);
    execution.ran_ = {};
    if (!quick) call = execution.serve_final(call);
    execution.go_round<quick>(call);
    execution.close(call);
}
template void StateMachineExecution::step_in_memory<false>(StateMachineExecution&, Time) noexcept
    TAPPET_REALTIME;

template <bool quick> void StateMachineExecution::go_round(Call& call) noexcept TAPPET_REALTIME {
    if (!quick) {
        if (!Order::resume(*this, call) || is(inactive)) return;
        if (!automatic_ && !run_once_) return;
    }
    begin_round();
    std::size_t taken = 0;
    while (statechart::Order<statechart::Memory<quick>>::run_round(*this, taken, call)) {
    }
}

bool StateMachineExecution::step_once(Time now) noexcept TAPPET_REALTIME {
    if (!is(paused) || (mode_ & (inactive | busy | error)) != 0) return false;
    Call call = open(now);
    const std::uint64_t transitions = status_.transitions;
    call.left = 1;
    single_ = true;
    if (!is(mid_round)) ran_ = {};
    stepped_at_ = now;
    if (!is(in_hand) && !is(mid_round) && raised_count_ != 0) {
        call.left = 0;
        handle_raised(call);
    } else
        go_round<false>(call);
    call = serve_final(call);
    single_ = statements_left_ = false;
    clear(busy);
    if (raised_count_ == 0 && wanted_state_ == no_state) clear(waiting);
    return call.left <= 0 || status_.transitions != transitions;
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
    Call call = open(now);
    const StateOutcome outcome = serve_request(call);
    finish(call);
    return outcome;
}

StateOutcome StateMachineExecution::serve_request(Call& call) noexcept TAPPET_REALTIME {
    using Table = statechart::InMemory;
    const StateIndex target = wanted_state_;
    wanted_state_ = no_state;
    TransitionIndex of_no_event = no_transition;
    bool there = is_in(target);
    if (!there && target == machine_.final_state) {
        supersede(final_arc);
        there = true;
    } else if (!there && is_final() && target == machine_.arcs[start_arc].to) {
        supersede(reset_arc);
        there = true;
    }
    if (!there)
        Table::for_each_asked(
            *this, Table::conditions(), [&](Table::Leaf, Table::Arc arc) noexcept TAPPET_REALTIME {
                const Answer answer =
                    arc.row().to == target ? Order::evaluate(*this, arc, nullptr, of_no_event) : Answer::no;
                there = answer == Answer::yes;
                if (there) Order::begin<false>(*this, arc);
                return there || answer == Answer::failed ? statechart::Flow::stop : statechart::Flow::on;
            });
    if (!there) return StateOutcome::ignored;
    run_once_ = wanted_run_ && !automatic_;
    const bool has_ended = Order::resume(*this, call);
    if (has_ended && run_once_) {
        ran_ = {};
        go_round<false>(call);
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
    Call call = open(now);
    finish(call);
    return StateOutcome::taken;
}

StateOutcome StateMachineExecution::request_initial(Time now) noexcept TAPPET_REALTIME {
    if ((mode_ & (busy | in_hand | error)) != 0 || !is_final()) return StateOutcome::ignored;
    clear(paused);
    supersede(reset_arc);
    return carry_out(now);
}

StateOutcome StateMachineExecution::deactivate(Time now) noexcept TAPPET_REALTIME {
    if (is(inactive) || is(busy) || (is_leaving() && !is(error))) return StateOutcome::ignored;
    const bool second = is_leaving();
    clear(paused);
    clear(final_wanted);
    drop_waiting();
    Call call = open(now);
    if (!second)
        supersede(leaving_arc);
    else {
        clear(error);
        program_begun_ = false;
        if (job_.end > job_.first) leaves_last();
    }
    static_cast<void>(Order::resume(*this, call));
    clear(busy);
    return StateOutcome::taken;
}

// ---- observation

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
        if (plan.regions != 0 || plan.conditions == none_asked || !automatic_) continue;
        for (const AskedArc* asked = machine_.asked + plan.conditions;; ++asked) {
            const StateArc& arc = machine_.arcs[asked->arc()];
            if (arc.after != Duration{}) {
                const std::size_t source = machine_.plain ? arc.source_level : index_of(arc.source);
                if (source < status_.states.size()) {
                    const Time at = due(arc, status_.states[source].entered_at);
                    if (at > stepped_at_) earliest = std::min(earliest, at);
                }
            }
            if (asked->is_last()) break;
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
