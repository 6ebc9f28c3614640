// Executes a resolved state machine on a component (thesis 5.2.2,
// 5.2.3). What holds, where UML and the thesis differ:
//
// clang-format off
//   order of a transition  its program, the exits from the inside, the entries from the outside. Thesis 5.2.1 (UML: the
//                          program between exits and entries): it still sees the state it was written for.
//   what is left           all states below the innermost one that is around source and target and is neither: a
//                          transition to itself, to its own composite or into its own sub-state leaves its source
//                          (UML, external). An internal transition leaves and enters nothing.
//   what is entered        the target, then the initial state of each composite (UML).
//   which transition       the innermost state's first, each state's in table order; the first whose guard holds (UML).
//                          When no guard holds the event is gone; it is not kept for a later state.
//   step()                 condition transitions until none holds, at most `max_transitions_per_step`; then the run
//                          programs of the active states, outermost first, so that the more special state has the last
//                          word; then the events that programs raised. The thesis runs before it checks: here no run
//                          program acts in a state whose reason to be left is already there.
//   time-outs              conditions on the time since their source was entered, in table order among the conditions,
//                          true from `after` on. With a guard: once due, asked in every step.
//   dispatch()             one event, at most one transition. Condition transitions wait for the next step.
//   run to completion      no program or guard is interrupted: an event raised by one of them waits, at most
//                          `max_raised_events` do, and is handled before the outer call returns, in the order raised.
//                          As many are handled in one call; the rest in the next: left_over() says so.
//   final and initial      a request for the final state is always valid, also out of a program: then it is served
//                          before the next transition or event. From the final state a reset is (5.2.2).
//   start, deactivate      enter the initial state; run the exits from the inside and react to nothing any more.
// clang-format on
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/statechart/resolve.hpp"

#include <array>
#include <atomic>

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

    /// Before start(), on any thread. The resolved machine and the component outlive the execution. Swapping
    /// the machine needs an inactive execution.
    void bind(const ResolvedView& machine, void* component) noexcept TAPPET_REALTIME {
        machine_ = machine;
        component_ = component;
        mode_ = inactive;
        status_ = {};
        reason_ = {};
        news_ = 0;
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
    /// Runs the exits and becomes inactive; what waited is dropped.
    /// Ignored when inactive or called out of a program.
    StateOutcome deactivate(Time now) noexcept TAPPET_REALTIME;
    /// One step of the engine. `now` never decreases from call to call.
    void step(Time now) noexcept TAPPET_REALTIME;
    /// An event. `trigger` is an index into machine().triggers; out of range it is ignored.
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
    /// The earliest time-out that a step has still to look at, `never` when there is none: arm a timer with
    /// it. It is the time of the last step while something is left over.
    [[nodiscard]] Time next_timeout() const noexcept TAPPET_REALTIME;
    /// The last reason that a transition gave, and still gives until another one does.
    [[nodiscard]] std::string_view reason() const noexcept TAPPET_REALTIME { return reason_; }
    /// The last transition that gave a reason, for observers on any thread, with how many did before it since
    /// bind(): two readings that differ are two reasons.
    struct News {
        std::uint64_t number = 0; ///< 0: no reason was given yet
        TransitionIndex transition = 0;
        bool operator==(const News&) const = default;
    };
    [[nodiscard]] News news() const noexcept TAPPET_REALTIME {
        const std::uint64_t word = std::atomic_ref{news_}.load(std::memory_order_relaxed);
        return {word >> transition_bits, static_cast<TransitionIndex>(word)};
    }
    /// The last call reached a bound with more to do: a condition
    /// that still held, or an event that still waits.
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME {
        return conditions_left_ || !raised_.empty();
    }
    [[nodiscard]] const StateMachineStatus& status() const noexcept TAPPET_REALTIME { return status_; }
    [[nodiscard]] const ResolvedView& machine() const noexcept TAPPET_REALTIME { return machine_; }

private:
    // What keeps an event from being handled at once; 0: nothing.
    enum Mode : std::uint8_t { ready = 0, inactive = 1, busy = 2, waiting = 4, final_wanted = 8 };

    void set(Mode bit) noexcept TAPPET_REALTIME { mode_ = static_cast<std::uint8_t>(mode_ | bit); }
    void clear(Mode bit) noexcept TAPPET_REALTIME { mode_ = static_cast<std::uint8_t>(mode_ & ~bit); }
    [[nodiscard]] bool is(Mode bit) const noexcept TAPPET_REALTIME { return (mode_ & bit) != 0; }

    void call(ProgramSlice programs) const noexcept TAPPET_REALTIME {
        const StateProgram* program = machine_.programs + programs.first;
        for (const StateProgram* end = program + programs.count; program != end; ++program)
            (*program)(component_);
    }
    bool take_first(ArcIndex first, Time now) noexcept TAPPET_REALTIME;
    bool take_condition(Time now) noexcept TAPPET_REALTIME;
    void take(const StateArc& arc, Time now) noexcept TAPPET_REALTIME;
    void give_reason(TransitionIndex transition, std::string_view text, Time now) noexcept TAPPET_REALTIME;
    void serve_final(Time now) noexcept TAPPET_REALTIME;
    void finish(Time now) noexcept TAPPET_REALTIME;
    StateOutcome queue(std::size_t trigger, Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] ArcIndex first_arc(std::size_t trigger) const noexcept TAPPET_REALTIME {
        return machine_.cells[first_cell_ + trigger];
    }
    [[nodiscard]] Time due(const StateArc& arc) const noexcept TAPPET_REALTIME {
        const Time entered = status_.entered_at[arc.source_level];
        return arc.after >= never - entered ? never : entered + arc.after;
    }

    ResolvedView machine_;
    void* component_ = nullptr;
    std::uint8_t mode_ = inactive;
    std::uint16_t first_cell_ = 0; // of the active leaf
    bool conditions_left_ = false;
    StateMachineStatus status_;
    std::string_view reason_;
    static constexpr int transition_bits = 16;
    static_assert(sizeof(TransitionIndex) * 8 == transition_bits,
                  "news_ holds a transition in its lowest bits");
    alignas(std::atomic_ref<std::uint64_t>::required_alignment) mutable std::uint64_t news_ =
        0; // mutable: atomic_ref reads it
    std::string_view final_reason_;
    Time stepped_at_{};
    Trace trace_ = nullptr;
    void* trace_context_ = nullptr;
    Bounded<TriggerIndex, max_raised_events> raised_; // oldest first
};

inline void StateMachineExecution::take(const StateArc& arc, Time now) noexcept TAPPET_REALTIME {
    if (arc.gives_reason)
        give_reason(arc.transition, machine_.table.transitions[arc.transition].because, now);
    call(arc.programs);
    for (std::size_t level = arc.kept_levels; level < arc.target_levels; ++level)
        status_.entered_at[level] = now;
    const StateIndex from = status_.active;
    status_.active = arc.target;
    status_.last_transition = arc.transition;
    first_cell_ = arc.first_cell;
    ++status_.transitions;
    if (trace_ != nullptr) trace_(trace_context_, from, arc.target, arc.transition, now);
}

inline bool StateMachineExecution::take_first(ArcIndex first, Time now) noexcept TAPPET_REALTIME {
    if (first == no_arc) return false;
    for (const StateArc* arc = machine_.arcs + first;; ++arc) {
        if (arc->guard == nullptr || arc->guard(component_)) {
            take(*arc, now);
            return true;
        }
        if (arc->last) return false;
    }
}

inline StateOutcome StateMachineExecution::dispatch(std::size_t trigger, Time now) noexcept TAPPET_REALTIME {
    if (trigger >= machine_.triggers.size()) return StateOutcome::ignored;
    if (mode_ != ready) [[unlikely]]
        return queue(trigger, now);
    mode_ = busy;
    const bool taken = take_first(first_arc(trigger), now);
    mode_ = static_cast<std::uint8_t>(mode_ & ~busy);
    if (mode_ != ready) [[unlikely]]
        finish(now);
    return taken ? StateOutcome::taken : StateOutcome::ignored;
}

} // namespace tappet
