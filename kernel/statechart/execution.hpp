// Executes a resolved state machine on a component (thesis 5.2). The order of everything, and where UML and
// the thesis differ, is the table in kernel/statechart/README.md; each line of it has a test.
#pragma once

#include "kernel/statechart/resolve.hpp"
#include "kernel/statechart/status.hpp"

#include <array>
#include <atomic>

namespace tappet {

class StateMachineExecution;

/// Limits and manners of one execution, as its row says.
struct StateMachinePolicy {
    /// In one step, event or request; the rest goes on in the next step, and left_over() says so.
    std::uint32_t statements = 1000;
    /// What a fault does beside stopping this machine: its parent comes into error too (thesis 5.2.2).
    bool escalates = false;
};

/// Native code for the quick path of a machine, see native.hpp: called when nothing waits and nothing is
/// under way. It does what the walk does; where a program waits or fails it hands over to the walk.
struct StateMachineFast {
    StateOutcome (*dispatch)(StateMachineExecution&, std::size_t trigger, Time now,
                             const std::byte* arguments) noexcept TAPPET_REALTIME = nullptr;
    void (*step)(StateMachineExecution&, Time now) noexcept TAPPET_REALTIME = nullptr;
    /// The arguments of a transition's event into its variables; false: one does not fit.
    bool (*capture)(StateMachineExecution&, TransitionIndex, const std::byte* arguments) noexcept
        TAPPET_REALTIME = nullptr;
    /// What it runs without counting. An execution with a policy of fewer walks.
    std::uint32_t statements = 0;
};

namespace native {
template <const auto& source, std::size_t type>
struct TransitionCode;
template <const auto& source, std::size_t type>
struct StepCode;
template <const auto& source, std::size_t type>
struct MachineCode;
} // namespace native

/// All that an execution works on; it outlives it.
struct StateMachineBinding {
    ResolvedView machine{};
    void* component = nullptr;
    ProgramCode code{};        ///< of machine.table.programs; without run: C++ functions only
    std::byte* data = nullptr; ///< see DataLayout; filled from the instance's image
    const ProgramLink* links = nullptr;
    void* machines = nullptr;        ///< see ProgramContext
    std::span<StateIndex> history{}; ///< machine.sizes.history
    std::span<std::byte> deferred{}; ///< machine.sizes.captured * StateMachineExecution::max_raised_events
    StateMachineExecution* parent = nullptr;
    StateMachinePolicy policy{};
    StateMachineFast fast{};
};

/// Names of a state and of those around it, from the outside; none: empty. Real-time.
[[nodiscard]] Bounded<std::string_view, max_state_depth> path_of(const ResolvedView& machine,
                                                                 StateIndex state) noexcept TAPPET_REALTIME;

class StateMachineExecution {
public:
    static constexpr std::size_t max_transitions_per_step = 8;
    static constexpr std::size_t max_raised_events = 8;

    /// Called after each transition, start and deactivation with the leaf that was left and the one that was
    /// entered; no_state there: none. Real-time.
    using Trace = void (*)(void* context, StateIndex from, StateIndex to, TransitionIndex transition,
                           Time now) noexcept TAPPET_REALTIME;
    /// Called when a program failed, before the parent hears of it. Real-time.
    using FaultHook = void (*)(void* context, const StateMachineExecution& machine) noexcept TAPPET_REALTIME;

    StateMachineExecution() = default;

    /// Before start(), on any thread, of an inactive execution. False, and nothing is bound, when memory that
    /// the machine takes is missing. Variables keep their values from one activation to the next.
    [[nodiscard]] bool bind(const StateMachineBinding& binding) noexcept TAPPET_REALTIME;
    /// Of a machine whose programs are C++ functions and that has no history.
    void bind(const ResolvedView& machine, void* component) noexcept TAPPET_REALTIME {
        StateMachineBinding binding;
        binding.machine = machine;
        binding.component = component;
        static_cast<void>(bind(binding));
    }
    void trace(Trace hook, void* context) noexcept TAPPET_REALTIME {
        trace_ = hook;
        trace_context_ = context;
    }
    void on_fault(FaultHook hook, void* context) noexcept TAPPET_REALTIME {
        fault_hook_ = hook;
        fault_context_ = context;
    }

    // ---- commands of thesis fig. 5.19; `now` never decreases from call to call

    /// Enters the initial state, in reactive mode. Ignored when active, or without a machine.
    StateOutcome activate(Time now) noexcept TAPPET_REALTIME;
    /// Automatic mode, and out of a pause: activates what is inactive. Ignored when it is so already.
    StateOutcome start(Time now) noexcept TAPPET_REALTIME;
    /// Reactive mode, and out of a pause. Run programs that are under way stop where they stand.
    StateOutcome reactive() noexcept TAPPET_REALTIME;
    /// From here on single steps only; programs stand where they are, events wait.
    StateOutcome pause() noexcept TAPPET_REALTIME;
    /// One step of the engine.
    void step(Time now) noexcept TAPPET_REALTIME {
        if (mode_ != ready || !automatic_) [[unlikely]]
            return step_slowly(now);
        stepped_at_ = now;
        conditions_left_ = false;
        step_(*this, now);
    }
    /// Of a paused machine: one statement of the program in hand, or one transition is asked (5.2.3).
    /// False: there was nothing to do.
    bool step_once(Time now) noexcept TAPPET_REALTIME;
    /// An event. `trigger` is an index into machine().triggers; out of range it is ignored. `arguments` as
    /// packed by its event; they are copied. Without those that a transition takes it is ignored.
    StateOutcome dispatch(std::size_t trigger, Time now, const std::byte* arguments = nullptr) noexcept
        TAPPET_REALTIME {
        if (mode_ != ready) [[unlikely]]
            return dispatch_generally(trigger, now, arguments);
        return dispatch_(*this, trigger, now, arguments);
    }
    /// Takes the first condition transition to that state whose guard holds; the final state and, from it,
    /// the initial one are always valid; in that state already it does nothing. `run_once`: in reactive mode
    /// the run programs of the active states are run once, then.
    StateOutcome request_state(StateIndex target, Time now, bool run_once = false) noexcept TAPPET_REALTIME;
    /// Valid in every active state; ignored in the final one. `reason` outlives the execution.
    StateOutcome request_final(Time now, std::string_view reason = {}) noexcept TAPPET_REALTIME;
    /// From the final to the initial state; ignored elsewhere and out of a program.
    StateOutcome request_initial(Time now) noexcept TAPPET_REALTIME;
    /// Runs the exits and becomes inactive; what waited is dropped. After an error in it a second call goes
    /// on without the program that failed. Ignored when inactive or called out of a program.
    StateOutcome deactivate(Time now) noexcept TAPPET_REALTIME;

    // ---- what there is to see

    [[nodiscard]] MachineStatus machine_status() const noexcept TAPPET_REALTIME;
    [[nodiscard]] bool is_active() const noexcept TAPPET_REALTIME { return !is(inactive); }
    [[nodiscard]] bool is_automatic() const noexcept TAPPET_REALTIME { return automatic_; }
    [[nodiscard]] bool is_paused() const noexcept TAPPET_REALTIME { return is(paused); }
    [[nodiscard]] bool in_error() const noexcept TAPPET_REALTIME { return is(error); }
    /// A transition, exit, entry or handle program waits for a later step.
    [[nodiscard]] bool under_way() const noexcept TAPPET_REALTIME { return is(in_hand); }
    /// The active leaf; with regions the first. While a transition is under way the innermost state that is
    /// still, or already, active; no_state only inside a call.
    [[nodiscard]] StateIndex active() const noexcept TAPPET_REALTIME { return status_.active; }
    [[nodiscard]] bool is_in(StateIndex state) const noexcept TAPPET_REALTIME {
        for (const ActiveState& each : status_.states)
            if (each.state == state) return true;
        return false;
    }
    [[nodiscard]] bool is_final() const noexcept TAPPET_REALTIME {
        return status_.active != no_state && status_.active == machine_.final_state;
    }
    /// Names of the active leaf and of the states around it, from the outside.
    [[nodiscard]] Bounded<std::string_view, max_state_depth> path() const noexcept TAPPET_REALTIME {
        return path_of(machine_, status_.active);
    }
    /// All active states, each before those inside it.
    [[nodiscard]] const Bounded<ActiveState, max_active_states>& states() const noexcept TAPPET_REALTIME {
        return status_.states;
    }
    /// When the active leaf was entered.
    [[nodiscard]] Time entered_at() const noexcept TAPPET_REALTIME {
        for (const ActiveState& each : status_.states)
            if (each.state == status_.active) return each.entered_at;
        return {};
    }
    /// The earliest time at which a step has still to look at a time-out, of a transition or of a program
    /// that waits; `never` when there is none: arm a timer with it. It is the time of the last step while
    /// something is left over.
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
    /// The last call reached a bound with more to do: a condition that still held, an event that still waits
    /// although nothing hinders it, or statements.
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME {
        return conditions_left_ || statements_left_ || (raised_count_ != 0 && !is(in_hand));
    }
    [[nodiscard]] std::size_t waiting_events() const noexcept TAPPET_REALTIME { return raised_count_; }
    /// The program in hand, of a transition, exit, entry or handle; no_node: none.
    [[nodiscard]] NodeIndex node_in_hand() const noexcept TAPPET_REALTIME {
        return program_begun_ ? position_.node : no_node;
    }
    [[nodiscard]] const StateMachineStatus& status() const noexcept TAPPET_REALTIME { return status_; }
    [[nodiscard]] const StateMachineFault& fault() const noexcept TAPPET_REALTIME { return status_.fault; }
    [[nodiscard]] const ResolvedView& machine() const noexcept TAPPET_REALTIME { return machine_; }
    /// For whoever reads or writes its variables; between its steps.
    [[nodiscard]] std::byte* data() const noexcept TAPPET_REALTIME { return context_.data; }

private:
    template <const auto& source, std::size_t type>
    friend struct native::TransitionCode;
    template <const auto& source, std::size_t type>
    friend struct native::StepCode;
    template <const auto& source, std::size_t type>
    friend struct native::MachineCode;

    // What keeps a call from taking the quick path; 0: nothing.
    enum Mode : std::uint8_t {
        ready = 0,
        inactive = 1,
        busy = 2,
        waiting = 4, // an event or a request
        final_wanted = 8,
        in_hand = 16, // a job
        paused = 32,
        error = 64,
        mid_round = 128, // of run, conditions and handle
    };
    enum class Job : std::uint8_t { none, acting, exiting, entering, arriving, handling };
    struct Selected {
        StateIndex source = no_state;
        ArcIndex arc = no_arc;
        bool otherwise = false;
    };
    enum class Answer : std::uint8_t { no, yes, otherwise, failed };

    void set(Mode bit) noexcept TAPPET_REALTIME { mode_ = static_cast<Mode>(mode_ | bit); }
    void clear(Mode bit) noexcept TAPPET_REALTIME { mode_ = static_cast<Mode>(mode_ & ~bit); }
    [[nodiscard]] bool is(Mode bit) const noexcept TAPPET_REALTIME { return (mode_ & bit) != 0; }

    // ---- the quick path: a plain machine of C++ functions
    void call(ProgramSlice programs) const noexcept TAPPET_REALTIME {
        const StateProgram* program = machine_.programs + programs.first;
        for (const StateProgram* end = program + programs.count; program != end; ++program)
            (*program)(context_.component);
    }
    void take(const StateArc& arc, Time now) noexcept TAPPET_REALTIME;
    void arrive(const StateArc& arc, Time now) noexcept TAPPET_REALTIME;
    bool take_first(ArcIndex first, Time now) noexcept TAPPET_REALTIME;
    static StateOutcome dispatch_folded(StateMachineExecution& execution, std::size_t trigger, Time now,
                                        const std::byte* arguments) noexcept TAPPET_REALTIME;
    static StateOutcome dispatch_walked(StateMachineExecution& execution, std::size_t trigger, Time now,
                                        const std::byte* arguments) noexcept TAPPET_REALTIME {
        return execution.dispatch_generally(trigger, now, arguments);
    }
    static void step_walked(StateMachineExecution& execution, Time now) noexcept TAPPET_REALTIME {
        execution.machine_.folded ? execution.step_folded(now) : execution.step_generally(now);
    }
    [[nodiscard]] std::size_t cell_of(std::size_t trigger) const noexcept TAPPET_REALTIME {
        return status_.active * machine_.triggers.size() + trigger;
    }
    void step_slowly(Time now) noexcept TAPPET_REALTIME;
    void step_folded(Time now) noexcept TAPPET_REALTIME;
    void step_generally(Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] const StateArc* folded_condition(std::uint8_t held, Time now) const noexcept
        TAPPET_REALTIME;
    StateOutcome dispatch_generally(std::size_t trigger, Time now, const std::byte* arguments) noexcept
        TAPPET_REALTIME;

    // ---- outer calls
    void open(Time now) noexcept TAPPET_REALTIME;
    void finish(Time now) noexcept TAPPET_REALTIME;
    void serve_final(Time now) noexcept TAPPET_REALTIME;
    StateOutcome serve_request(Time now) noexcept TAPPET_REALTIME;
    void handle_raised(Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool is_leaving() const noexcept TAPPET_REALTIME {
        return is(in_hand) && job_.transition == leaving_transition;
    }
    StateOutcome queue(std::size_t trigger, Time now, const std::byte* arguments) noexcept TAPPET_REALTIME;
    void drop_waiting() noexcept TAPPET_REALTIME;
    void give_reason(TransitionIndex transition, std::string_view text, Time now) noexcept TAPPET_REALTIME;

    // ---- the walk: one program or question at a time, so that it may stop anywhere
    bool go_on(Time now) noexcept TAPPET_REALTIME;
    bool advance(Time now) noexcept TAPPET_REALTIME;
    void begin(const StateArc& arc, bool otherwise, Time now) noexcept TAPPET_REALTIME;
    void begin_request(TransitionIndex number, StateIndex target) noexcept TAPPET_REALTIME;
    void begin_handle(StateIndex state) noexcept TAPPET_REALTIME;
    void supersede(TransitionIndex number, StateIndex target) noexcept TAPPET_REALTIME;
    void depart(Time now) noexcept TAPPET_REALTIME;
    void settle(Time now) noexcept TAPPET_REALTIME;
    // Arcs before `from` have said no.
    bool react(std::size_t trigger, const std::byte* arguments, Time now, ArcIndex from = start_arc) noexcept
        TAPPET_REALTIME;
    void round(Time now) noexcept TAPPET_REALTIME;
    bool run_states(Time now) noexcept TAPPET_REALTIME;
    bool run_state(ActiveState& at, Time now) noexcept TAPPET_REALTIME;
    bool handle_states(Time now) noexcept TAPPET_REALTIME;
    Answer find_condition(Time now, Selected& found) noexcept TAPPET_REALTIME;
    Answer ask(const StateArc& arc, const std::byte* arguments, Time now) noexcept TAPPET_REALTIME;
    Answer ask(const ConditionRef& condition, Time now) noexcept TAPPET_REALTIME;
    bool capture(TransitionIndex transition, const std::byte* arguments, Time now) noexcept TAPPET_REALTIME;
    Answer may_enter(StateIndex target, std::size_t kept, EntryKind enters, Time now) noexcept
        TAPPET_REALTIME;
    bool perform(const ProgramRef& program, Time now) noexcept TAPPET_REALTIME;
    ProgramReturn run(ProgramPosition& position, Time now) noexcept TAPPET_REALTIME;
    void fail(StatePart part, StateIndex state, NodeIndex node, Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] StatePart part_in_hand() const noexcept TAPPET_REALTIME;

    // ---- where native code hands over. The position of a program that did not end is in the context.

    /// How far a step has come: what is left of its statements, whose run programs are due (by level), which
    /// were entered again after they had run, and how many transitions it has taken.
    struct Round {
        std::int64_t statements = 0;
        std::uint8_t due = 0xff;
        std::uint8_t held = 0;
        std::uint8_t taken = 0;
    };
    void tell(StateIndex from, StateIndex to, TransitionIndex transition, Time now) noexcept TAPPET_REALTIME;
    StateOutcome finish_with(StateOutcome outcome, std::int64_t statements, Time now) noexcept
        TAPPET_REALTIME;
    void resume_transition(ArcIndex arc, std::size_t part, ProgramReturn why, Time now) noexcept
        TAPPET_REALTIME;
    StateOutcome resume_event(std::size_t trigger, Time now, const std::byte* arguments,
                              ArcIndex from) noexcept TAPPET_REALTIME;
    void resume_run(Round round, std::size_t level, ProgramReturn why, Time now) noexcept TAPPET_REALTIME;
    void resume_handle(Round round, std::size_t level, ProgramReturn why, Time now) noexcept TAPPET_REALTIME;
    void resume_round(Round round, std::size_t levels, Time now) noexcept TAPPET_REALTIME;
    void note_round(Round round, std::size_t levels) noexcept TAPPET_REALTIME;
    void go_round(std::size_t taken, Time now) noexcept TAPPET_REALTIME;
    void hand_over(std::size_t part, ProgramReturn why) noexcept TAPPET_REALTIME;
    ProgramReturn take_over(const ProgramRef& program) noexcept TAPPET_REALTIME;

    // ---- the active states
    using Entering = Bounded<StateIndex, max_active_states>;
    void plan_entries(Entering& into, StateIndex target, std::size_t kept, EntryKind enters) const noexcept
        TAPPET_REALTIME;
    [[nodiscard]] StateIndex child_to_enter(StateIndex state, std::size_t region, StateIndex target,
                                            EntryKind enters) const noexcept TAPPET_REALTIME;
    [[nodiscard]] StateIndex ancestor(StateIndex state, std::size_t depth) const noexcept TAPPET_REALTIME;
    [[nodiscard]] bool is_inside(StateIndex state, StateIndex outer) const noexcept TAPPET_REALTIME;
    [[nodiscard]] std::size_t index_of(StateIndex state) const noexcept TAPPET_REALTIME;
    [[nodiscard]] std::size_t end_of(std::size_t index) const noexcept TAPPET_REALTIME;
    void insert(std::size_t index, StateIndex state, Time now) noexcept TAPPET_REALTIME;
    void remove(std::size_t index) noexcept TAPPET_REALTIME;
    void find_active() noexcept TAPPET_REALTIME;

    [[nodiscard]] const StateRow& row(StateIndex state) const noexcept TAPPET_REALTIME {
        return machine_.table.states[state];
    }
    [[nodiscard]] bool has_run(StateIndex state) const noexcept TAPPET_REALTIME {
        return (ran_[state / 64u] >> (state % 64u) & 1u) != 0;
    }
    void note_run(StateIndex state) noexcept TAPPET_REALTIME {
        ran_[state / 64u] |= std::uint64_t{1} << (state % 64u);
    }
    [[nodiscard]] static Time due(const StateArc& arc, Time entered) noexcept TAPPET_REALTIME {
        return arc.after >= never - entered ? never : entered + arc.after;
    }

    ResolvedView machine_;
    ProgramContext context_;
    ProgramCode code_;
    StateMachineFast fast_;
    StateOutcome (*dispatch_)(StateMachineExecution&, std::size_t trigger, Time now,
                              const std::byte* arguments) noexcept TAPPET_REALTIME = &dispatch_walked;
    void (*step_)(StateMachineExecution&, Time now) noexcept TAPPET_REALTIME = &step_walked;
    Mode mode_ = inactive;
    bool automatic_ = false;
    bool conditions_left_ = false;
    bool statements_left_ = false;
    bool single_ = false;        // a single step: questions count as statements
    bool run_once_ = false;      // asked for by request_state()
    bool program_begun_ = false; // position_ holds

    struct {
        Job phase = Job::none;
        bool otherwise = false;
        bool placed = false; // the state that is being entered stands among the active ones
        bool all = false;    // once the exit in hand has ended, everything is left
        EntryKind enters = EntryKind::initial;
        std::uint8_t kept = 0;
        std::uint8_t entered = 0;
        std::uint8_t first = 0, end = 0; // the active states that are left
        TransitionIndex transition = no_transition;
        StateIndex source = no_state; // of a handle program: its state
        StateIndex target = no_state;
        StateIndex from = no_state; // the leaf, for the trace
    } job_;
    ProgramPosition position_; // of the program in hand
    Entering entering_;
    Bounded<Selected, max_active_states> selected_; // of one event, that have still to be taken; last first
    std::uint32_t statements_ = 0;                  // left in this call
    // What native code has run of what is in hand: so many programs, of which the last stands as `why` says.
    std::uint8_t handed_parts_ = 0;
    ProgramReturn handed_why_ = ProgramReturn::ended;
    bool handed_error_ = false;
    std::uint32_t asked_ = 0; // questions of this round that single steps have had
    std::array<std::uint64_t, max_states / 64> ran_{};
    StateMachinePolicy policy_;
    StateMachineStatus status_;
    std::string_view reason_;
    static constexpr int transition_bits = 16;
    static_assert(sizeof(TransitionIndex) * 8 == transition_bits,
                  "news_ holds a transition in its lowest bits");
    alignas(std::atomic_ref<std::uint64_t>::required_alignment) mutable std::uint64_t news_ =
        0; // mutable: atomic_ref reads it
    std::string_view final_reason_;
    StateIndex wanted_state_ = no_state;
    bool wanted_run_ = false;
    Time stepped_at_{};
    Trace trace_ = nullptr;
    void* trace_context_ = nullptr;
    FaultHook fault_hook_ = nullptr;
    void* fault_context_ = nullptr;
    StateMachineExecution* parent_ = nullptr;
    std::span<StateIndex> history_;
    std::span<std::byte> deferred_;
    std::array<TriggerIndex, max_raised_events> raised_{}; // a ring
    std::uint8_t raised_first_ = 0;
    std::uint8_t raised_count_ = 0;
};

// What a taken transition leaves and enters. Its programs have run.
inline void StateMachineExecution::arrive(const StateArc& arc, Time now) noexcept TAPPET_REALTIME {
    StateIndex state = arc.target;
    for (std::size_t level = arc.target_levels; level > arc.kept_levels;
         state = machine_.plans[state].parent) {
        ActiveState& at = status_.states[--level];
        at.state = state;
        at.run = RunPhase::fresh;
        at.entered_at = now;
    }
    status_.states.used = arc.target_levels;
    const StateIndex from = status_.active;
    status_.active = arc.target;
    status_.last_transition = arc.transition;
    ++status_.transitions;
    if (trace_ != nullptr) trace_(trace_context_, from, arc.target, arc.transition, now);
}

inline void StateMachineExecution::take(const StateArc& arc, Time now) noexcept TAPPET_REALTIME {
    if (arc.gives_reason)
        give_reason(arc.transition, machine_.table.transitions[arc.transition].because, now);
    call(arc.programs);
    arrive(arc, now);
}

inline bool StateMachineExecution::take_first(ArcIndex first, Time now) noexcept TAPPET_REALTIME {
    if (first == no_arc) return false;
    for (const StateArc* arc = machine_.arcs + first;; ++arc) {
        if (arc->guard == nullptr || arc->guard(context_.component)) {
            take(*arc, now);
            return true;
        }
        if (arc->last) break;
    }
    if (machine_.handles) {
        const ProgramRef& handle = row(machine_.arcs[first].source).handle;
        if (handle.call != nullptr) handle.call(context_.component);
    }
    return false;
}

} // namespace tappet
