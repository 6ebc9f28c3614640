// One step of the automatic mode (thesis 5.2.2, fig. 5.17): run, conditions, handle; for machines of C++
// functions straight through, for others resumable at each program and question.
#include "kernel/statechart/execution.hpp"

namespace tappet {

// ---- a machine of C++ functions

const StateArc* StateMachineExecution::folded_condition(std::uint8_t held, Time now) const noexcept
    TAPPET_REALTIME {
    const ArcIndex first = machine_.plans[status_.active].conditions;
    if (first == no_arc) return nullptr;
    for (const StateArc* arc = machine_.arcs + first;; ++arc) {
        const bool asked =
            (held >> arc->source_level & 1u) == 0 &&
            (arc->after == Duration{} || now >= due(*arc, status_.states[arc->source_level].entered_at));
        if (asked && (arc->guard == nullptr || arc->guard(context_.component))) return arc;
        if (arc->last) return nullptr;
    }
}

void StateMachineExecution::step_folded(Time now) noexcept TAPPET_REALTIME {
    set(busy);
    serve_final(now);
    const auto& states = status_.states;
    std::size_t taken = 0, fresh = 0;
    std::uint8_t held = 0; // levels that were entered again in this step
    bool first = true, noted = false;
    const auto note_all = [&]() noexcept TAPPET_REALTIME {
        if (noted) return;
        noted = true;
        ran_ = {};
        for (const ActiveState& active : states) note_run(active.state);
    };
    const auto serve = [&]() noexcept TAPPET_REALTIME {
        if (!is(final_wanted)) return false;
        note_all();
        const std::uint64_t before = status_.transitions;
        serve_final(now);
        if (status_.transitions == before) return false;
        fresh = 0;
        held = 0;
        return true;
    };
    for (;;) {
        if (first) {
            call(machine_.plans[status_.active].run);
            first = false;
        } else
            for (std::size_t level = fresh; level < states.size(); ++level) {
                const ProgramRef& program = row(states[level].state).run;
                if (program.call == nullptr) continue;
                if (has_run(states[level].state)) {
                    held = static_cast<std::uint8_t>(held | 1u << level);
                    continue;
                }
                note_run(states[level].state);
                program.call(context_.component);
            }
        fresh = states.size();
        if (serve()) continue;
        const StateArc* arc = folded_condition(held, now);
        if (arc == nullptr) break;
        note_all();
        take(*arc, now);
        fresh = arc->kept_levels;
        held = static_cast<std::uint8_t>(held & ((1u << fresh) - 1u));
        serve();
        conditions_left_ = ++taken == max_transitions_per_step;
        if (conditions_left_) break;
    }
    if (machine_.handles && !conditions_left_)
        for (std::size_t level = 0; level < states.size(); ++level) {
            const ProgramRef& program = row(states[level].state).handle;
            if ((held >> level & 1u) == 0 && program.call != nullptr) program.call(context_.component);
        }
    clear(busy);
    if (mode_ != ready) finish(now);
}

// ---- any machine

void StateMachineExecution::round(Time now) noexcept TAPPET_REALTIME {
    if (!go_on(now) || is(inactive)) return;
    if (!automatic_ && !run_once_) return;
    for (ActiveState& active : status_.states)
        if (active.run == RunPhase::waits)
            active.run = RunPhase::under_way;
        else if (!is(mid_round) && active.run != RunPhase::under_way)
            active.run = RunPhase::fresh;
    if (!is(mid_round)) asked_ = 0;
    set(mid_round);
    go_round(0, now);
}

void StateMachineExecution::go_round(std::size_t taken, Time now) noexcept TAPPET_REALTIME {
    for (;;) {
        if (!run_states(now)) return;
        while (is(final_wanted)) {
            serve_final(now);
            if ((mode_ & (in_hand | error)) != 0 || !run_states(now)) return;
        }
        if (!automatic_) break;
        Selected found;
        const Answer answer = find_condition(now, found);
        if (answer == Answer::failed || statements_left_) return;
        if (answer == Answer::no) break;
        begin(machine_.arcs[found.arc], false, now);
        if (!go_on(now)) return;
        if (is(final_wanted)) {
            serve_final(now);
            if ((mode_ & (in_hand | error)) != 0) return;
        }
        conditions_left_ = ++taken == max_transitions_per_step;
        if (conditions_left_) {
            clear(mid_round);
            return;
        }
    }
    if (automatic_) {
        if (!handle_states(now)) return;
    } else
        for (const ActiveState& active : status_.states)
            if (active.run == RunPhase::waits) return;
    run_once_ = false;
    clear(mid_round);
}

bool StateMachineExecution::run_states(Time now) noexcept TAPPET_REALTIME {
    for (ActiveState& active : status_.states)
        if ((active.run == RunPhase::fresh || active.run == RunPhase::under_way) && !run_state(active, now))
            return false;
    return true;
}

bool StateMachineExecution::run_state(ActiveState& at, Time now) noexcept TAPPET_REALTIME {
    const ProgramRef& program = row(at.state).run;
    if (program.empty()) {
        at.run = RunPhase::ran;
        return true;
    }
    if (at.run == RunPhase::fresh) {
        if (has_run(at.state)) {
            at.run = RunPhase::held;
            return true;
        }
        if (statements_ == 0) {
            statements_left_ = true;
            return false;
        }
        if (program.call == nullptr) at.position = {code_.tables->programs[program.program].first};
        at.run = RunPhase::under_way;
    }
    note_run(at.state);
    if (program.call != nullptr) {
        --statements_;
        program.call(context_.component);
        at.run = RunPhase::ran;
        return !is(error);
    }
    switch (run(at.position, now)) {
    case ProgramReturn::ended: at.run = RunPhase::ran; return !is(error);
    case ProgramReturn::waits: at.run = RunPhase::waits; return !is(error);
    case ProgramReturn::left_over: return false;
    case ProgramReturn::failed: fail(StatePart::run, at.state, at.position.node, now); return false;
    }
    return false;
}

// The innermost states first; of the states around several leaves, after all of those.
auto StateMachineExecution::find_condition(Time now, Selected& found) noexcept TAPPET_REALTIME -> Answer {
    std::uint32_t number = 0;
    for (std::size_t leaf = 0; leaf < status_.states.size(); ++leaf) {
        const StatePlan& plan = machine_.plans[status_.states[leaf].state];
        if (plan.regions != 0 || plan.conditions == no_arc) continue;
        std::size_t at = leaf;
        for (const StateArc* arc = machine_.arcs + plan.conditions;; ++arc) {
            if (status_.states[at].state != arc->source) at = index_of(arc->source);
            if (end_of(at) != leaf + 1) break; // asked from the last leaf inside it
            const RunPhase phase = status_.states[at].run;
            // A time-out is an event of time: it does not wait for the run program.
            if (phase == RunPhase::ran || (phase == RunPhase::waits && arc->after != Duration{})) {
                if (single_ && number++ >= asked_) {
                    if (statements_ == 0) {
                        statements_left_ = true;
                        return Answer::no;
                    }
                    --statements_;
                    ++asked_;
                } else if (single_) {
                    if (arc->last) break;
                    continue;
                }
                const Answer answer = ask(*arc, nullptr, now);
                if (answer == Answer::failed) return answer;
                if (answer == Answer::yes) {
                    found = {arc->source, static_cast<ArcIndex>(arc - machine_.arcs), false};
                    return answer;
                }
            }
            if (arc->last) break;
        }
    }
    for (ActiveState& active : status_.states)
        if (active.run == RunPhase::ran) active.run = RunPhase::asked;
    return Answer::no;
}

bool StateMachineExecution::handle_states(Time now) noexcept TAPPET_REALTIME {
    for (std::size_t i = 0; i < status_.states.size(); ++i) {
        ActiveState& active = status_.states[i];
        if (active.run != RunPhase::asked) continue;
        active.run = RunPhase::done;
        if (row(active.state).handle.empty()) continue;
        begin_handle(active.state);
        if (!go_on(now)) return false;
    }
    return true;
}

} // namespace tappet
