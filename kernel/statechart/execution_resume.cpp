// Where native code hands over to the walk: it brings the execution to where the walk would be, had it come
// as far by itself.
#include "kernel/statechart/execution.hpp"

namespace tappet {

// The walk skips the programs that have run. An error that came from elsewhere is seen behind the last.
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
    StateArc rest = machine_.arcs[arc];
    rest.gives_reason = false; // it was given
    begin(rest, false, now);
    hand_over(part, why);
    static_cast<void>(go_on(now));
    finish(now);
}

// All run programs have ended.
void StateMachineExecution::note_round() noexcept TAPPET_REALTIME {
    set(mid_round);
    asked_ = 0;
    ran_ = {};
    for (ActiveState& active : status_.states) {
        active.run = RunPhase::ran;
        note_run(active.state);
    }
}

void StateMachineExecution::resume_run(std::size_t level, ProgramReturn why, Time now) noexcept
    TAPPET_REALTIME {
    note_round();
    ActiveState& at = status_.states[level];
    const bool is_function = row(at.state).run.call != nullptr;
    const bool has_begun =
        why != ProgramReturn::left_over || (!is_function && context_.position.node != no_node);
    for (std::size_t i = has_begun ? level + 1 : level; i < status_.states.size(); ++i) {
        ActiveState& active = status_.states[i];
        active.run = RunPhase::fresh;
        ran_[active.state / 64u] &= ~(std::uint64_t{1} << (active.state % 64u));
    }
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
    if (why == ProgramReturn::waits && !is(error)) go_round(0, now);
    finish(now);
}

void StateMachineExecution::resume_round(std::size_t taken, Time now) noexcept TAPPET_REALTIME {
    if (taken != 0 && is(final_wanted)) serve_final(now);
    if ((mode_ & (in_hand | error)) == 0) go_round(taken, now);
    finish(now);
}

void StateMachineExecution::resume_handle(std::size_t level, ProgramReturn why, Time now) noexcept
    TAPPET_REALTIME {
    note_round();
    for (std::size_t i = 0; i < status_.states.size(); ++i)
        status_.states[i].run = i <= level ? RunPhase::done : RunPhase::asked;
    begin_handle(status_.states[level].state);
    hand_over(0, why);
    static_cast<void>(go_on(now));
    finish(now);
}

} // namespace tappet
