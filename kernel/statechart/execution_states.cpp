// Effects during execution: states become active and inactive, programs stop and fail, requests supersede the
// current job.
#include "kernel/statechart/in_memory.hpp"

#include <cstring>

namespace tappet {

// ---- the active states

std::size_t StateMachineExecution::index_of(StateIndex state) const noexcept TAPPET_REALTIME {
    std::size_t i = 0;
    while (i < status_.states.size() && status_.states[i].state != state) ++i;
    return i;
}

// The active states inside a state follow it in the list.
std::size_t StateMachineExecution::end_of(std::size_t index) const noexcept TAPPET_REALTIME {
    if (index >= status_.states.size()) return index;
    const std::uint16_t depth = machine_.plans[status_.states[index].state].depth;
    do ++index;
    while (index < status_.states.size() && machine_.plans[status_.states[index].state].depth > depth);
    return index;
}

void StateMachineExecution::insert(std::size_t index, StateIndex state) noexcept TAPPET_REALTIME {
    auto& states = status_.states;
    if (states.full()) return; // the check rejects such a machine
    for (std::size_t i = states.used++; i > index; --i) states[i] = states[i - 1];
    states[index] = {state, RunPhase::fresh, {}, context_.now};
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

// Removes the last of the states that are to be exited.
void StateMachineExecution::leaves_last() noexcept TAPPET_REALTIME {
    remove(--job_.end);
    if (!job_.all) return;
    job_.all = false;
    job_.first = 0;
    job_.end = static_cast<std::uint8_t>(status_.states.size());
}

void StateMachineExecution::find_active() noexcept TAPPET_REALTIME {
    status_.active = no_state;
    for (const ActiveState& each : status_.states) {
        status_.active = each.state;
        if (machine_.plans[each.state].regions == 0) break;
    }
}

// Uses the state that was active when its region was last exited; a state still active counts as such.
void StateMachineExecution::plan_remembered(statechart::Entering& into, const StateArc& arc) const noexcept
    TAPPET_REALTIME {
    statechart::plan_entries(
        machine_, into, arc.to, arc.kept_levels,
        [&](StateIndex state, std::size_t region, bool is_above) noexcept TAPPET_REALTIME {
            const bool remembers =
                (arc.enters == EntryKind::shallow_history && state == arc.to) ||
                (arc.enters == EntryKind::deep_history && !is_above && machine_.is_inside(state, arc.to));
            if (!remembers || history_.empty()) return no_state;
            for (const ActiveState& each : status_.states)
                if (machine_.plans[each.state].region == region) return each.state;
            return history_[region];
        });
}

// ---- programs and questions

bool StateMachineExecution::capture(TransitionIndex transition, const std::byte* arguments) noexcept
    TAPPET_REALTIME {
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

bool StateMachineExecution::has_not_run(ActiveState& at, ProgramReturn why) noexcept TAPPET_REALTIME {
    at.run = why == ProgramReturn::waits ? RunPhase::waits : RunPhase::under_way;
    return why == ProgramReturn::waits || breaks_off(why, StatePart::run, at.state, at.position.node);
}

bool StateMachineExecution::breaks_off(ProgramReturn why, StatePart part, StateIndex state,
                                       NodeIndex node) noexcept TAPPET_REALTIME {
    if (why == ProgramReturn::left_over) statements_left_ = true;
    if (why == ProgramReturn::failed) fail(part, state, node);
    return false;
}

auto StateMachineExecution::refuses(StatePart part, const StateArc& arc) noexcept TAPPET_REALTIME -> Answer {
    fail(part, arc.source, end_node);
    status_.fault.transition = arc.transition;
    return Answer::failed;
}

void StateMachineExecution::fail(StatePart part, StateIndex state, NodeIndex node) noexcept TAPPET_REALTIME {
    const bool in_transition = part == StatePart::then || part == StatePart::otherwise;
    const TransitionIndex transition = in_transition ? machine_.arcs[job_.arc].transition : no_transition;
    status_.fault = {part, state, transition, node, status_.fault.number + 1, context_.now};
    set(error);
    StateMachineExecution* child = this;
    for (StateMachineExecution* parent = parent_; parent != nullptr && child->policy_.escalates;
         child = parent, parent = parent->parent_) {
        if (parent->is(inactive) || parent->is(error)) return;
        parent->status_.fault = {StatePart::child, parent->status_.active,           no_transition,
                                 end_node,         parent->status_.fault.number + 1, context_.now};
        parent->set(error);
    }
}

// ---- the current job

void StateMachineExecution::begin_request(ArcIndex arc) noexcept TAPPET_REALTIME {
    const std::size_t active = status_.states.size();
    job_ = {};
    job_.at = machine_.arcs[arc].steps;
    job_.arc = arc;
    job_.from = active == 0 ? no_state : status_.states[active - 1].state;
    job_.end = static_cast<std::uint8_t>(active);
    asked_ = 0;
    set(in_hand);
}

// Aborts whatever waits. An exit program runs to its end first: it is what makes leaving safe.
void StateMachineExecution::supersede(ArcIndex arc) noexcept TAPPET_REALTIME {
    const bool in_exit =
        job_.at != no_step && machine_.steps[job_.at].kind == StepKind::leave && program_begun_ && !is(error);
    const std::uint8_t first = job_.first, end = job_.end;
    selected_.clear();
    run_once_ = false;
    clear(error);
    begin_request(arc);
    if (in_exit) {
        job_.first = first;
        job_.end = end;
        job_.all = true;
    } else
        program_begun_ = false;
}

void StateMachineExecution::stands_at(StepIndex step, ArcIndex arc, StateIndex leaf,
                                      std::uint8_t kept) noexcept TAPPET_REALTIME {
    const std::size_t active = arc != no_arc ? status_.states.size() : 0;
    holds({.at = step, .arc = arc, .from = leaf, .first = kept, .end = static_cast<std::uint8_t>(active)});
}

void StateMachineExecution::depart() noexcept TAPPET_REALTIME {
    const StateIndex from = job_.from;
    job_ = {};
    selected_.clear();
    drop_waiting();
    mode_ = static_cast<Mode>(inactive | busy);
    automatic_ = false;
    status_.last_transition = leaving_transition;
    ++status_.transitions;
    if (trace_ != nullptr) trace_(trace_context_, from, no_state, leaving_transition, context_.now);
}

} // namespace tappet
