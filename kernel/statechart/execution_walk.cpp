// The walk over the active states: which transitions an event takes, what they leave and enter, one program
// or question at a time, so that it may stop at each of them and go on in a later step.
#include "kernel/statechart/execution.hpp"

#include <cstring>

namespace tappet {

// ---- the active states

StateIndex StateMachineExecution::ancestor(StateIndex state, std::size_t depth) const noexcept
    TAPPET_REALTIME {
    while (state != no_state && machine_.plans[state].depth > depth) state = machine_.plans[state].parent;
    return state;
}

bool StateMachineExecution::is_inside(StateIndex state, StateIndex outer) const noexcept TAPPET_REALTIME {
    return ancestor(state, machine_.plans[outer].depth) == outer;
}

std::size_t StateMachineExecution::index_of(StateIndex state) const noexcept TAPPET_REALTIME {
    std::size_t i = 0;
    while (i < status_.states.size() && status_.states[i].state != state) ++i;
    return i;
}

// The active states inside one stand after it.
std::size_t StateMachineExecution::end_of(std::size_t index) const noexcept TAPPET_REALTIME {
    if (index >= status_.states.size()) return index;
    const std::uint16_t depth = machine_.plans[status_.states[index].state].depth;
    do ++index;
    while (index < status_.states.size() && machine_.plans[status_.states[index].state].depth > depth);
    return index;
}

void StateMachineExecution::insert(std::size_t index, StateIndex state, Time now) noexcept TAPPET_REALTIME {
    auto& states = status_.states;
    if (states.full()) return; // the check allows no such machine
    for (std::size_t i = states.used++; i > index; --i) states[i] = states[i - 1];
    states[index] = {state, RunPhase::fresh, {}, now};
    find_active();
}

void StateMachineExecution::remove(std::size_t index) noexcept TAPPET_REALTIME {
    auto& states = status_.states;
    const StateIndex state = states[index].state;
    if (!history_.empty()) history_[machine_.plans[state].region] = state;
    --states.used;
    for (std::size_t i = index; i < states.used; ++i) states[i] = states[i + 1];
    std::size_t kept = 0;
    for (std::size_t i = 0; i < selected_.size(); ++i)
        if (selected_[i].source != state) selected_[kept++] = selected_[i];
    selected_.used = kept;
    find_active();
}

void StateMachineExecution::find_active() noexcept TAPPET_REALTIME {
    status_.active = no_state;
    for (const ActiveState& each : status_.states) {
        status_.active = each.state;
        if (machine_.plans[each.state].regions == 0) break;
    }
}

StateIndex StateMachineExecution::child_to_enter(StateIndex state, std::size_t region, StateIndex target,
                                                 EntryKind enters) const noexcept TAPPET_REALTIME {
    const bool is_above = state != target && is_inside(target, state);
    if (is_above) {
        const StateIndex on_the_way = ancestor(target, machine_.plans[state].depth + 1u);
        if (machine_.plans[on_the_way].region == region) return on_the_way;
    }
    const bool remembers = (enters == EntryKind::shallow_history && state == target) ||
                           (enters == EntryKind::deep_history && !is_above && is_inside(state, target));
    if (remembers && !history_.empty()) {
        for (const ActiveState& each : status_.states) // it will have been the last
            if (machine_.plans[each.state].region == region) return each.state;
        if (history_[region] != no_state) return history_[region];
    }
    return machine_.regions[region];
}

// Depth first, so that a state stands before those inside it and regions stand in their order.
void StateMachineExecution::plan_entries(Entering& into, StateIndex target, std::size_t kept,
                                         EntryKind enters) const noexcept TAPPET_REALTIME {
    Entering open;
    into.clear();
    static_cast<void>(open.push(ancestor(target, kept + 1)));
    while (!open.empty() && !into.full()) {
        const StateIndex state = open[--open.used];
        static_cast<void>(into.push(state));
        const StatePlan& plan = machine_.plans[state];
        for (std::size_t r = plan.regions; r-- > 0;)
            static_cast<void>(open.push(child_to_enter(state, plan.first_region + r, target, enters)));
    }
}

// ---- questions

auto StateMachineExecution::ask(const ConditionRef& condition, Time now) noexcept TAPPET_REALTIME -> Answer {
    if (condition.call != nullptr) return condition.call(context_.component) ? Answer::yes : Answer::no;
    if (condition.condition == no_condition) return Answer::yes;
    context_.now = now;
    switch (code_.test(*code_.tables, context_, condition.condition)) {
    case ConditionResult::no: return Answer::no;
    case ConditionResult::yes: return Answer::yes;
    case ConditionResult::failed: break;
    }
    return Answer::failed;
}

auto StateMachineExecution::may_enter(StateIndex target, std::size_t kept, EntryKind enters,
                                      Time now) noexcept TAPPET_REALTIME -> Answer {
    if (!machine_.preconditions || target == no_state) return Answer::yes;
    Entering states;
    plan_entries(states, target, kept, enters);
    for (StateIndex state : states)
        if (const Answer answer = ask(row(state).precondition, now); answer != Answer::yes) return answer;
    return Answer::yes;
}

bool StateMachineExecution::capture(TransitionIndex transition, const std::byte* arguments, Time now) noexcept
    TAPPET_REALTIME {
    context_.now = now;
    if (fast_.capture != nullptr) return fast_.capture(*this, transition, arguments);
    const TransitionRow& row = machine_.table.transitions[transition];
    for (std::size_t i = 0; i < row.captures; ++i) {
        const CaptureRow& each = machine_.table.captures[row.first_capture + i];
        std::memcpy(context_.data + each.raw, arguments + each.from, each.size);
        const auto at = [this](DataOffset offset) noexcept
            TAPPET_REALTIME { return offset == no_data ? nullptr : context_.data + offset; };
        for (std::size_t n = each.first, end = n + each.count; n < end; ++n) {
            const Instruction& in = code_.tables->instructions[n];
            const ActionResult result = in.run(context_, in, at(in.to), at(in.a), at(in.b));
            if (result == ActionResult::skip)
                n += in.size;
            else if (result != ActionResult::done)
                return false;
        }
    }
    return true;
}

auto StateMachineExecution::ask(const StateArc& arc, const std::byte* arguments, Time now) noexcept
    TAPPET_REALTIME -> Answer {
    const TransitionRow& transition = machine_.table.transitions[arc.transition];
    if (arc.after != Duration{} && now < due(arc, status_.states[index_of(arc.source)].entered_at))
        return Answer::no;
    const auto failed = [&](StatePart part) noexcept TAPPET_REALTIME {
        fail(part, arc.source, end_node, now);
        status_.fault.transition = arc.transition;
        return Answer::failed;
    };
    if (transition.captures != 0 && !capture(arc.transition, arguments, now))
        return failed(StatePart::capture);
    Answer answer = ask(transition.guard, now);
    if (answer == Answer::yes) answer = may_enter(arc.to, arc.kept_levels, transition.enters, now);
    if (answer == Answer::no && transition.has_otherwise) {
        answer = may_enter(arc.otherwise, arc.otherwise_kept, EntryKind::initial, now);
        if (answer == Answer::yes) answer = Answer::otherwise;
    }
    return answer == Answer::failed ? failed(StatePart::guard) : answer;
}

// Each region's leaf from the inside; a state around several leaves is asked when none of them took it.
// Nothing runs before all have been asked (UML: one run to completion).
bool StateMachineExecution::react(std::size_t trigger, const std::byte* arguments, Time now,
                                  ArcIndex from) noexcept TAPPET_REALTIME {
    StateIndex refused = no_state;
    selected_.clear();
    for (std::size_t leaf = 0; leaf < status_.states.size(); ++leaf) {
        const StateIndex state = status_.states[leaf].state;
        if (machine_.plans[state].regions != 0) continue;
        const ArcIndex first = machine_.cells[state * machine_.triggers.size() + trigger];
        if (first == no_arc) continue;
        for (const StateArc* arc = machine_.arcs + first;; ++arc) {
            if (end_of(index_of(arc->source)) != leaf + 1) break;
            bool is_taken = false;
            for (const Selected& each : selected_) is_taken = is_taken || is_inside(each.source, arc->source);
            if (!is_taken) {
                const bool was_asked = arc < machine_.arcs + from;
                const Answer answer = was_asked ? Answer::no : ask(*arc, arguments, now);
                if (answer == Answer::failed) return false;
                if (answer == Answer::no) {
                    if (refused == no_state) refused = arc->source;
                } else
                    static_cast<void>(selected_.push({arc->source, static_cast<ArcIndex>(arc - machine_.arcs),
                                                      answer == Answer::otherwise}));
            }
            if (arc->last) break;
        }
    }
    if (!selected_.empty()) {
        set(in_hand);
        return true;
    }
    if (refused != no_state && !row(refused).handle.empty()) begin_handle(refused);
    return false;
}

// ---- programs

ProgramReturn StateMachineExecution::run(ProgramPosition& position, Time now) noexcept TAPPET_REALTIME {
    context_.now = now;
    context_.position = position;
    const ProgramReturn result = code_.run(*code_.tables, context_, statements_);
    position = context_.position;
    if (result == ProgramReturn::left_over) statements_left_ = true;
    return result;
}

StatePart StateMachineExecution::part_in_hand() const noexcept TAPPET_REALTIME {
    switch (job_.phase) {
    case Job::acting: return job_.otherwise ? StatePart::otherwise : StatePart::then;
    case Job::exiting: return StatePart::exit;
    case Job::entering: return StatePart::entry;
    case Job::handling: return StatePart::handle;
    case Job::none:
    case Job::arriving: break;
    }
    return StatePart::none;
}

// Whether it has ended.
bool StateMachineExecution::perform(const ProgramRef& program, Time now) noexcept TAPPET_REALTIME {
    if (program.empty()) return true;
    if (handed_parts_ > 1) {
        --handed_parts_;
        return true;
    }
    ProgramReturn why = ProgramReturn::ended;
    if (handed_parts_ == 1) {
        why = take_over(program);
        if (program.call != nullptr) return why == ProgramReturn::ended;
    } else if (statements_ == 0) {
        statements_left_ = true;
        return false;
    } else if (program.call != nullptr) {
        --statements_;
        program.call(context_.component);
        return true;
    } else {
        if (!program_begun_) position_ = {code_.tables->programs[program.program].first};
        program_begun_ = true;
        why = run(position_, now);
    }
    switch (why) {
    case ProgramReturn::ended: program_begun_ = false; return true;
    case ProgramReturn::waits:
    case ProgramReturn::left_over: return false;
    case ProgramReturn::failed: break;
    }
    StateIndex state = job_.source;
    if (job_.phase == Job::exiting) state = status_.states[job_.end - 1u].state;
    if (job_.phase == Job::entering) state = entering_[job_.entered];
    fail(part_in_hand(), state, position_.node, now);
    return false;
}

void StateMachineExecution::fail(StatePart part, StateIndex state, NodeIndex node, Time now) noexcept
    TAPPET_REALTIME {
    const bool in_transition = part == StatePart::then || part == StatePart::otherwise;
    status_.fault = {
        part, state, in_transition ? job_.transition : no_transition, node, status_.fault.number + 1, now};
    set(error);
    if (fault_hook_ != nullptr) fault_hook_(fault_context_, *this);
    StateMachineExecution* child = this;
    for (StateMachineExecution* parent = parent_; parent != nullptr && child->policy_.escalates;
         child = parent, parent = parent->parent_) {
        if (parent->is(inactive) || parent->is(error)) return;
        parent->status_.fault = {StatePart::child, parent->status_.active,           no_transition,
                                 end_node,         parent->status_.fault.number + 1, now};
        parent->set(error);
        if (parent->fault_hook_ != nullptr) parent->fault_hook_(parent->fault_context_, *parent);
    }
}

// ---- what is in hand

void StateMachineExecution::begin(const StateArc& arc, bool otherwise, Time now) noexcept TAPPET_REALTIME {
    const TransitionRow& transition = machine_.table.transitions[arc.transition];
    job_ = {};
    job_.phase = Job::acting;
    job_.otherwise = otherwise;
    job_.transition = arc.transition;
    job_.source = arc.source;
    job_.target = otherwise ? arc.otherwise : arc.to;
    job_.kept = otherwise ? arc.otherwise_kept : arc.kept_levels;
    job_.enters = otherwise ? EntryKind::initial : transition.enters;
    job_.from = status_.states[end_of(index_of(arc.source)) - 1].state;
    if (job_.target != no_state) {
        const std::size_t first = index_of(ancestor(arc.source, job_.kept + 1u));
        job_.first = static_cast<std::uint8_t>(first);
        job_.end = static_cast<std::uint8_t>(end_of(first));
    }
    if (!otherwise && arc.gives_reason) give_reason(arc.transition, transition.because, now);
    for (ActiveState& active : status_.states)
        if (active.run == RunPhase::asked) active.run = RunPhase::ran; // the conditions are asked again
    asked_ = 0;
    set(in_hand);
}

void StateMachineExecution::begin_request(TransitionIndex number, StateIndex target) noexcept
    TAPPET_REALTIME {
    job_ = {};
    job_.phase = Job::exiting;
    job_.transition = number;
    job_.target = target;
    job_.from = status_.states.empty() ? no_state : status_.states[status_.states.size() - 1].state;
    job_.end = static_cast<std::uint8_t>(status_.states.size());
    asked_ = 0;
    set(in_hand);
}

void StateMachineExecution::begin_handle(StateIndex state) noexcept TAPPET_REALTIME {
    job_ = {};
    job_.phase = Job::handling;
    job_.source = state;
    set(in_hand);
}

// What waits is given up, but an exit program is brought to its end: it is what makes leaving safe.
void StateMachineExecution::supersede(TransitionIndex number, StateIndex target) noexcept TAPPET_REALTIME {
    const bool in_exit = job_.phase == Job::exiting && program_begun_ && !is(error);
    const std::uint8_t first = job_.first, end = job_.end;
    selected_.clear();
    run_once_ = false;
    clear(error);
    begin_request(number, target);
    if (in_exit) {
        job_.first = first;
        job_.end = end;
        job_.all = true;
    } else
        program_begun_ = false;
}

// True when nothing is in hand any more.
bool StateMachineExecution::go_on(Time now) noexcept TAPPET_REALTIME {
    for (;;) {
        if (is(error)) return false;
        if (job_.phase == Job::handling) {
            if (!perform(row(job_.source).handle, now)) return false;
            job_.phase = Job::none;
        } else if (job_.phase != Job::none) {
            if (!advance(now)) return false;
        } else if (selected_.empty() || is(final_wanted)) {
            selected_.clear();
            clear(in_hand);
            return true;
        } else {
            const Selected next = selected_[0];
            for (std::size_t i = 1; i < selected_.size(); ++i) selected_[i - 1] = selected_[i];
            --selected_.used;
            begin(machine_.arcs[next.arc], next.otherwise, now);
        }
    }
}

// True when the transition in hand has arrived.
bool StateMachineExecution::advance(Time now) noexcept TAPPET_REALTIME {
    if (job_.phase == Job::acting) {
        const TransitionRow& transition = machine_.table.transitions[job_.transition];
        if (!perform(job_.otherwise ? transition.otherwise : transition.then, now) || is(error)) return false;
        job_.phase = job_.target == no_state ? Job::arriving : Job::exiting;
    }
    if (job_.phase == Job::exiting) {
        while (job_.end > job_.first) {
            if (!perform(row(status_.states[job_.end - 1u].state).exit, now) || is(error)) return false;
            remove(--job_.end);
            if (job_.all) {
                job_.all = false;
                job_.first = 0;
                job_.end = static_cast<std::uint8_t>(status_.states.size());
            }
        }
        if (job_.transition == leaving_transition) {
            depart(now);
            return true;
        }
        plan_entries(entering_, job_.target, job_.kept, job_.enters);
        job_.phase = Job::entering;
    }
    if (job_.phase == Job::entering)
        for (; job_.entered < entering_.size(); ++job_.entered) {
            const StateIndex state = entering_[job_.entered];
            if (!job_.placed) insert(std::size_t{job_.first} + job_.entered, state, now);
            job_.placed = true;
            if (!perform(row(state).entry, now) || is(error)) return false;
            job_.placed = false;
        }
    settle(now);
    return true;
}

void StateMachineExecution::settle(Time now) noexcept TAPPET_REALTIME {
    const bool is_internal = job_.target == no_state;
    const StateIndex to = is_internal ? job_.from : entering_[entering_.size() - 1];
    const TransitionIndex number = job_.transition;
    const StateIndex from = number == start_transition ? no_state : job_.from;
    job_.phase = Job::none;
    status_.last_transition = number;
    ++status_.transitions;
    if (trace_ != nullptr) trace_(trace_context_, from, to, number, now);
}

void StateMachineExecution::depart(Time now) noexcept TAPPET_REALTIME {
    const StateIndex from = job_.from;
    job_ = {};
    selected_.clear();
    drop_waiting();
    mode_ = static_cast<Mode>(inactive | busy);
    automatic_ = false;
    status_.last_transition = leaving_transition;
    ++status_.transitions;
    if (trace_ != nullptr) trace_(trace_context_, from, no_state, leaving_transition, now);
}

} // namespace tappet
