// Where native code hands over to the walk: it brings the execution to where the walk would be, had it come
// as far by itself.
#include "kernel/statechart/execution.hpp"

namespace tappet {

// The walk skips the programs that have run. An error that came from elsewhere is seen after the last.
void StateMachineExecution::hand_over(std::size_t part, ProgramReturn why) noexcept TAPPET_REALTIME {
    handed_parts_ = static_cast<std::uint8_t>(part + 1);
    handed_why_ = why;
    handed_error_ = is(error);
    clear(error);
}

ProgramReturn StateMachineExecution::take_over(const ProgramRef& program) noexcept TAPPET_REALTIME {
    handed_parts_ = 0;
    if (handed_error_) set(error);
    if (handed_why_ == ProgramReturn::left_over) statements_left_ = true;
    if (program.call == nullptr && context_.position.node != no_node) {
        program_begun_ = true;
        position_ = context_.position;
    }
    return handed_why_;
}

StateOutcome StateMachineExecution::resume_event(std::size_t trigger, Time now, const std::byte* arguments,
                                                 ArcIndex from) noexcept TAPPET_REALTIME {
    open(now);
    const bool taken = react(trigger, arguments, now, from);
    static_cast<void>(go_on(now));
    finish(now);
    return taken ? StateOutcome::taken : StateOutcome::ignored;
}

void StateMachineExecution::resume_transition(ArcIndex arc, std::size_t part, ProgramReturn why,
                                              Time now) noexcept TAPPET_REALTIME {
    set(busy);
    StateArc rest = machine_.arcs[arc];
    rest.gives_reason = false; // it was given
    begin(rest, false, now);
    hand_over(part, why);
    static_cast<void>(go_on(now));
    finish(now);
}

// After the last transition of an event or a step whose code keeps nothing of it itself.
void StateMachineExecution::tell(StateIndex from, StateIndex to, TransitionIndex transition,
                                 Time now) noexcept TAPPET_REALTIME {
    set(busy);
    trace_(trace_context_, from, to, transition, now);
}

// The end of an outer call, with something to serve.
StateOutcome StateMachineExecution::finish_with(StateOutcome outcome, std::int64_t statements,
                                                Time now) noexcept TAPPET_REALTIME {
    statements_ = static_cast<std::uint32_t>(statements);
    finish(now);
    return outcome;
}

// The run programs of so many levels have ended or are held.
void StateMachineExecution::note_round(Round round, std::size_t levels) noexcept TAPPET_REALTIME {
    set(busy);
    set(mid_round);
    asked_ = 0;
    if (round.taken == 0) ran_ = {};
    for (std::size_t i = 0; i < status_.states.size(); ++i) {
        ActiveState& active = status_.states[i];
        const bool is_held = (round.held >> i & 1u) != 0;
        active.run = i >= levels ? RunPhase::fresh : is_held ? RunPhase::held : RunPhase::ran;
        if (i < levels) note_run(active.state);
    }
}

void StateMachineExecution::resume_run(Round round, std::size_t level, ProgramReturn why, Time now) noexcept
    TAPPET_REALTIME {
    ActiveState& at = status_.states[level];
    const bool is_function = row(at.state).run.call != nullptr;
    const bool has_begun =
        why != ProgramReturn::left_over || (!is_function && context_.position.node != no_node);
    note_round(round, has_begun ? level + 1 : level);
    if (!is_function && has_begun) at.position = context_.position;
    switch (why) {
    case ProgramReturn::ended: break;
    case ProgramReturn::waits: at.run = RunPhase::waits; break;
    case ProgramReturn::left_over:
        statements_left_ = true;
        if (has_begun) at.run = RunPhase::under_way;
        break;
    case ProgramReturn::failed:
        at.run = RunPhase::under_way;
        fail(StatePart::run, at.state, at.position.node, now);
        break;
    }
    if (why == ProgramReturn::waits && !is(error)) go_round(round.taken, now);
    finish(now);
}

void StateMachineExecution::resume_round(Round round, std::size_t levels, Time now) noexcept TAPPET_REALTIME {
    note_round(round, levels);
    statements_ = machine_.folded ? policy_.statements : static_cast<std::uint32_t>(round.statements);
    if (round.taken != 0 && is(final_wanted)) serve_final(now);
    if ((mode_ & (in_hand | error)) == 0) go_round(round.taken, now);
    finish(now);
}

void StateMachineExecution::resume_handle(Round round, std::size_t level, ProgramReturn why,
                                          Time now) noexcept TAPPET_REALTIME {
    note_round(round, status_.states.size());
    for (std::size_t i = 0; i < status_.states.size(); ++i)
        if (status_.states[i].run == RunPhase::ran)
            status_.states[i].run = i <= level ? RunPhase::done : RunPhase::asked;
    begin_handle(status_.states[level].state);
    hand_over(0, why);
    static_cast<void>(go_on(now));
    finish(now);
}

} // namespace tappet
