// Executes a resolved state machine on a component (thesis 5.2.2, 5.2.3). What holds, where UML and the thesis differ:
//
//   order of a transition   its transition program, the exits from the inside, the entries from the outside. Thesis 5.2.1
//                           (UML runs the program between exits and entries): it still sees the state it was written for.
//   what is left            all states below the innermost one that is around source and target and is neither: a
//                           transition to itself, to its own composite or into its own sub-state leaves its source (UML,
//                           external). An internal transition leaves and enters nothing.
//   what is entered         the target, then the initial state of each composite (UML).
//   which transition        the innermost state's first, each state's in table order; the first whose guard holds (UML).
//                           When no guard holds the event is gone; it is not kept for a later state.
//   step()                  condition transitions until none holds, at most `max_transitions_per_step`; then the run
//                           programs of the active states, outermost first, so that the more special state has the
//                           last word; then events that these programs raised. The thesis runs before it checks:
//                           here no run program acts in a state whose reason to be left is already there.
//   time-outs               conditions on the time since their source was entered, in table order among the conditions,
//                           true from `after` on. With a guard: once due, asked in every step.
//   dispatch()              one event, at most one transition. Condition transitions wait for the step of the same cycle.
//   run to completion       no program or guard is interrupted: an event raised by one of them waits, at most
//                           `max_raised_events`, and is handled before the outer call returns, in the order raised.
//                           Chains longer than that go on in the next call: left_over() says so.
//   final and initial       a request for the final state is always valid, also out of a program: then it is served
//                           before the next transition, run list or event. From the final state a reset is (5.2.2).
//   start, deactivate       enter the initial state; run the exits from the inside and react to nothing any more.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/statechart/resolve.hpp"

#include <array>

namespace tappet {

enum class StateOutcome : std::uint8_t {
    taken,   ///< a transition was taken
    ignored, ///< inactive, no transition for it here, no guard held, or the request is not valid now
    queued,  ///< called out of a program or guard, or behind events that wait: it will be handled in order
    lost,    ///< no room to queue it; counted
};

/// What an observer sees: plain data without pointers.
struct StateMachineStatus {
    StateIndex active = no_state; ///< the active leaf
    StateIndex previous = no_state;
    TransitionIndex last_transition = 0;
    TransitionIndex reason = 0; ///< the last transition that gave one, see reason()
    std::uint64_t transitions = 0;
    std::uint64_t lost_events = 0;
    Time reason_at{};
    std::array<Time, max_state_depth> entered_at{}; ///< of the active states, from the outside
};

class StateMachineExecution {
public:
    static constexpr std::size_t max_transitions_per_step = 8;
    static constexpr std::size_t max_raised_events = 8;

    /// Called after each transition, start and deactivation; `from` or `to` is no_state there. Real-time.
    using Trace = void (*)(void* context, StateIndex from, StateIndex to, TransitionIndex transition,
                           Time now) noexcept TAPPET_REALTIME;

    StateMachineExecution() = default;

    /// Before start(), on any thread. The resolved machine and the component outlive the execution. Swapping the machine
    /// needs an inactive execution.
    void bind(const ResolvedView& machine, void* component) noexcept TAPPET_REALTIME {
        machine_ = machine;
        component_ = component;
        mode_ = inactive;
        status_ = {};
        reason_ = {};
        stepped_at_ = {};
        conditions_left_ = false;
        raised_.clear();
    }
    void trace(Trace hook, void* context) noexcept TAPPET_REALTIME {
        trace_ = hook;
        trace_context_ = context;
    }

    /// Enters the initial state. Ignored when active, or without a machine.
    StateOutcome start(Time now) noexcept TAPPET_REALTIME;
    /// Runs the exits and becomes inactive; what waited is dropped. Ignored when inactive or called out of a program.
    StateOutcome deactivate(Time now) noexcept TAPPET_REALTIME;
    /// One step of the engine. `now` never decreases from call to call.
    void step(Time now) noexcept TAPPET_REALTIME;
    /// An event. `trigger` is an index into triggers(); out of range it is ignored.
    StateOutcome dispatch(std::size_t trigger, Time now) noexcept TAPPET_REALTIME;
    /// Valid in every active state; ignored in the final one. `reason` outlives the execution.
    StateOutcome request_final(Time now, std::string_view reason = {}) noexcept TAPPET_REALTIME;
    /// From the final to the initial state; ignored elsewhere and out of a program.
    StateOutcome request_initial(Time now) noexcept TAPPET_REALTIME;

    [[nodiscard]] bool is_active() const noexcept TAPPET_REALTIME { return status_.active != no_state; }
    [[nodiscard]] StateIndex active() const noexcept TAPPET_REALTIME { return status_.active; }
    /// True in a state and in every composite around it.
    [[nodiscard]] bool is_in(StateIndex state) const noexcept TAPPET_REALTIME {
        for (StateIndex s = status_.active; s != no_state; s = machine_.plans[s].parent)
            if (s == state) return true;
        return false;
    }
    [[nodiscard]] bool is_final() const noexcept TAPPET_REALTIME {
        return is_active() && machine_.table.states[status_.active].final;
    }
    /// Names of the active states, from the outside.
    [[nodiscard]] Bounded<std::string_view, max_state_depth> path() const noexcept TAPPET_REALTIME;
    /// When the active leaf was entered.
    [[nodiscard]] Time entered_at() const noexcept TAPPET_REALTIME {
        return is_active() ? status_.entered_at[machine_.plans[status_.active].depth - 1u] : Time{};
    }
    /// The earliest time-out that a step has still to look at, `never` when there is none: arm a timer with it. It is the
    /// time of the last step while something is left over.
    [[nodiscard]] Time next_timeout() const noexcept TAPPET_REALTIME;
    /// The last reason that a transition gave, and still gives until another one does.
    [[nodiscard]] std::string_view reason() const noexcept TAPPET_REALTIME { return reason_; }
    /// The last call reached a bound with more to do: a condition that still held, or an event that still waits.
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME { return conditions_left_ || !raised_.empty(); }
    [[nodiscard]] const StateMachineStatus& status() const noexcept TAPPET_REALTIME { return status_; }
    [[nodiscard]] const ResolvedView& machine() const noexcept TAPPET_REALTIME { return machine_; }

private:
    // What keeps an event from being handled at once; 0: nothing.
    enum Mode : std::uint8_t { ready = 0, inactive = 1, busy = 2, waiting = 4, final_wanted = 8 };

    void set(Mode bit) noexcept TAPPET_REALTIME { mode_ = static_cast<std::uint8_t>(mode_ | bit); }
    void clear(Mode bit) noexcept TAPPET_REALTIME { mode_ = static_cast<std::uint8_t>(mode_ & ~bit); }
    [[nodiscard]] bool is(Mode bit) const noexcept TAPPET_REALTIME { return (mode_ & bit) != 0; }

    void call(StateSlice programs) const noexcept TAPPET_REALTIME {
        const StateProgram* program = machine_.programs + programs.first;
        for (const StateProgram* end = program + programs.count; program != end; ++program) (*program)(component_);
    }
    bool take_first(StateSlice arcs, Time now) noexcept TAPPET_REALTIME;
    bool take_condition(Time now) noexcept TAPPET_REALTIME;
    void take(const StateArc& arc, Time now) noexcept TAPPET_REALTIME;
    void give_reason(TransitionIndex transition, std::string_view text, Time now) noexcept TAPPET_REALTIME;
    void serve_final(Time now) noexcept TAPPET_REALTIME;
    void finish(Time now) noexcept TAPPET_REALTIME;
    StateOutcome queue(std::size_t trigger, Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] StateSlice cell(std::size_t trigger) const noexcept TAPPET_REALTIME {
        return machine_.cells[status_.active * machine_.triggers.size() + trigger];
    }
    [[nodiscard]] Time due(const StateArc& arc) const noexcept TAPPET_REALTIME {
        const Time entered = status_.entered_at[arc.source_level];
        return arc.after >= never - entered ? never : entered + arc.after;
    }

    ResolvedView machine_;
    void* component_ = nullptr;
    std::uint8_t mode_ = inactive;
    bool conditions_left_ = false;
    StateMachineStatus status_;
    std::string_view reason_;
    std::string_view final_reason_;
    Time stepped_at_{};
    Trace trace_ = nullptr;
    void* trace_context_ = nullptr;
    Bounded<TriggerIndex, max_raised_events> raised_; // oldest first
};

inline void StateMachineExecution::take(const StateArc& arc, Time now) noexcept TAPPET_REALTIME {
    if (arc.gives_reason) give_reason(arc.transition, machine_.table.transitions[arc.transition].because, now);
    call(arc.programs);
    for (std::size_t level = arc.kept_levels; level < arc.target_levels; ++level) status_.entered_at[level] = now;
    status_.previous = status_.active;
    status_.active = arc.target;
    status_.last_transition = arc.transition;
    ++status_.transitions;
    if (trace_ != nullptr) trace_(trace_context_, status_.previous, arc.target, arc.transition, now);
}

inline void StateMachineExecution::give_reason(TransitionIndex transition, std::string_view text,
                                               Time now) noexcept TAPPET_REALTIME {
    status_.reason = transition;
    status_.reason_at = now;
    reason_ = text;
}

inline bool StateMachineExecution::take_first(StateSlice arcs, Time now) noexcept TAPPET_REALTIME {
    const StateArc* arc = machine_.arcs + arcs.first;
    for (const StateArc* end = arc + arcs.count; arc != end; ++arc) {
        if (arc->guard != nullptr && !arc->guard(component_)) continue;
        take(*arc, now);
        return true;
    }
    return false;
}

inline StateOutcome StateMachineExecution::dispatch(std::size_t trigger, Time now) noexcept TAPPET_REALTIME {
    if (trigger >= machine_.triggers.size()) return StateOutcome::ignored;
    if (mode_ != ready) [[unlikely]] return queue(trigger, now);
    mode_ = busy;
    const bool taken = take_first(cell(trigger), now);
    mode_ = static_cast<std::uint8_t>(mode_ & ~busy);
    if (mode_ != ready) [[unlikely]] finish(now);
    return taken ? StateOutcome::taken : StateOutcome::ignored;
}

inline StateOutcome StateMachineExecution::queue(std::size_t trigger, Time now) noexcept TAPPET_REALTIME {
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

inline void StateMachineExecution::serve_final(Time now) noexcept TAPPET_REALTIME {
    if (!is(final_wanted)) return;
    clear(final_wanted);
    if (is_final()) return;
    if (!final_reason_.empty()) give_reason(final_transition, final_reason_, now);
    take(machine_.arcs[machine_.plans[status_.active].to_final], now);
}

// The end of every outer call: what programs asked for while they ran. The last request for the final state is served
// even when the bound is reached.
inline void StateMachineExecution::finish(Time now) noexcept TAPPET_REALTIME {
    set(busy);
    for (std::size_t n = 0; n < max_raised_events; ++n) {
        serve_final(now);
        if (raised_.empty()) break;
        const TriggerIndex trigger = raised_[0];
        for (std::size_t i = 1; i < raised_.used; ++i) raised_[i - 1] = raised_[i];
        --raised_.used;
        static_cast<void>(take_first(cell(trigger), now));
    }
    serve_final(now);
    clear(busy);
    if (raised_.empty()) clear(waiting);
}

inline bool StateMachineExecution::take_condition(Time now) noexcept TAPPET_REALTIME {
    const StateSlice arcs = machine_.plans[status_.active].conditions;
    for (std::size_t i = arcs.first; i < std::size_t{arcs.first} + arcs.count; ++i) {
        const StateArc& arc = machine_.arcs[i];
        if (arc.after != Duration{} && now < due(arc)) continue;
        if (arc.guard != nullptr && !arc.guard(component_)) continue;
        take(arc, now);
        return true;
    }
    return false;
}

inline void StateMachineExecution::step(Time now) noexcept TAPPET_REALTIME {
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

inline StateOutcome StateMachineExecution::start(Time now) noexcept TAPPET_REALTIME {
    if (!is(inactive) || machine_.arcs == nullptr) return StateOutcome::ignored;
    mode_ = busy;
    conditions_left_ = false;
    raised_.clear();
    take(machine_.arcs[0], now);
    clear(busy);
    if (mode_ != ready) finish(now);
    return StateOutcome::taken;
}

inline StateOutcome StateMachineExecution::deactivate(Time now) noexcept TAPPET_REALTIME {
    if (is(inactive) || is(busy)) return StateOutcome::ignored;
    set(busy);
    call(machine_.plans[status_.active].leave);
    mode_ = inactive;
    raised_.clear();
    conditions_left_ = false;
    status_.previous = status_.active;
    status_.active = no_state;
    status_.last_transition = leaving_transition;
    ++status_.transitions;
    if (trace_ != nullptr) trace_(trace_context_, status_.previous, no_state, leaving_transition, now);
    return StateOutcome::taken;
}

inline StateOutcome StateMachineExecution::request_final(Time now, std::string_view reason) noexcept TAPPET_REALTIME {
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

inline StateOutcome StateMachineExecution::request_initial(Time now) noexcept TAPPET_REALTIME {
    if (is(busy) || !is_final()) return StateOutcome::ignored;
    set(busy);
    take(machine_.arcs[1], now);
    clear(busy);
    if (mode_ != ready) finish(now);
    return StateOutcome::taken;
}

inline Time StateMachineExecution::next_timeout() const noexcept TAPPET_REALTIME {
    if (!is_active()) return never;
    if (left_over()) return stepped_at_;
    const StateSlice arcs = machine_.plans[status_.active].conditions;
    Time earliest = never;
    for (std::size_t i = arcs.first; i < std::size_t{arcs.first} + arcs.count; ++i) {
        const StateArc& arc = machine_.arcs[i];
        if (arc.after == Duration{}) continue;
        const Time at = due(arc);
        if (at > stepped_at_ && at < earliest) earliest = at;
    }
    return earliest;
}

inline auto StateMachineExecution::path() const noexcept TAPPET_REALTIME -> Bounded<std::string_view, max_state_depth> {
    Bounded<std::string_view, max_state_depth> names;
    if (!is_active()) return names;
    StateIndex state = status_.active;
    names.used = machine_.plans[state].depth;
    for (std::size_t level = names.used; level-- > 0; state = machine_.plans[state].parent)
        names[level] = machine_.table.states[state].name;
    return names;
}

} // namespace tappet
