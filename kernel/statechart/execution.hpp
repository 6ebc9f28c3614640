// Executes a resolved state machine on a component (thesis 5.2). The table in kernel/statechart/README.md
// gives the order of execution and the differences between UML and the thesis; each of its lines has a test.
#pragma once

#include "kernel/statechart/resolve.hpp"
#include "kernel/statechart/status.hpp"

#include <array>
#include <atomic>

namespace tappet {

class StateMachineExecution;

/// Limits and options of one execution, from its row.
struct StateMachinePolicy {
    /// Most statements per step, event or request; the rest runs in the next step, see left_over().
    std::uint32_t statements = 1000;
    /// A fault also puts the parent machine into error (thesis 5.2.2).
    bool escalates = false;
};

/// The compiled form of a machine, see native.hpp: the fast path of outer calls while the machine is idle. It
/// stores all state where the loaded form does; the loaded form continues whatever it could not finish.
struct StateMachineFast {
    StateOutcome (*dispatch)(StateMachineExecution&, std::size_t trigger, Time now,
                             const std::byte* arguments) noexcept TAPPET_REALTIME = nullptr;
    void (*step)(StateMachineExecution&, Time now) noexcept TAPPET_REALTIME = nullptr;
    /// Copies the arguments of a transition's event into its variables; false: one does not fit.
    bool (*capture)(StateMachineExecution&, TransitionIndex, const std::byte* arguments) noexcept
        TAPPET_REALTIME = nullptr;
    /// Most statements of a call that runs without counting; 0: it counts. With a lower limit in its policy,
    /// the machine runs in its loaded form.
    std::uint32_t statements = 0;
};

namespace statechart {
template <class Table> struct Order;
template <bool quick> struct Memory;
} // namespace statechart
namespace native {
template <const auto& source, std::size_t type> struct MachineRows;
template <const auto& source, std::size_t type, StateIndex leaf> struct AtLeaf;
template <const auto& source, std::size_t type> struct MachineCode;
} // namespace native

/// Inputs of an execution; must outlive it.
struct StateMachineBinding {
    ResolvedView machine{};
    void* component = nullptr;
    ProgramCode code{};        ///< of machine.table.programs; without run: C++ functions only
    std::byte* data = nullptr; ///< see DataLayout; filled from the instance's image
    const ProgramLink* links = nullptr;
    void* machines = nullptr; ///< see ProgramContext
    ProgramsBeside beside{};  ///< see ProgramContext
    WorkLimit* limit = nullptr;
    std::span<StateIndex> history{}; ///< machine.sizes.history
    std::span<std::byte> deferred{}; ///< machine.sizes.captured * StateMachineExecution::max_raised_events
    StateMachineExecution* parent = nullptr;
    StateMachinePolicy policy{};
    StateMachineFast fast{};
};

/// Returns the names of a state and its enclosing states, outermost first; empty for no_state. Real-time.
[[nodiscard]] Bounded<std::string_view, max_state_depth> path_of(const ResolvedView& machine,
                                                                 StateIndex state) noexcept TAPPET_REALTIME;

class StateMachineExecution {
public:
    static constexpr std::size_t max_transitions_per_step = 8;
    static constexpr std::size_t max_raised_events = 8;

    /// Called after each transition, start and deactivation with the leaf that was exited and the leaf that
    /// was entered; no_state: none. Real-time.
    using Trace = void (*)(void* context, StateIndex from, StateIndex to, TransitionIndex transition,
                           Time now) noexcept TAPPET_REALTIME;

    StateMachineExecution() = default;

    /// Binds an inactive execution, on any thread, before start(). Returns false and binds nothing when the
    /// machine needs more memory than is given. Variables keep their values between activations.
    [[nodiscard]] bool bind(const StateMachineBinding& binding) noexcept TAPPET_REALTIME;
    /// Binds a machine whose programs are C++ functions and that has no history.
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

    // ---- commands of thesis fig. 5.19; `now` never decreases from call to call

    /// Enters the initial state, in reactive mode. Ignored when active or without a machine.
    StateOutcome activate(Time now) noexcept TAPPET_REALTIME;
    /// Switches to automatic mode and ends a pause; activates an inactive machine. Otherwise ignored.
    StateOutcome start(Time now) noexcept TAPPET_REALTIME;
    /// Switches to reactive mode and ends a pause. Run programs that wait stop where they are.
    StateOutcome reactive() noexcept TAPPET_REALTIME;
    /// Pauses: only single steps execute, programs stop where they are, events are queued.
    StateOutcome pause() noexcept TAPPET_REALTIME;
    /// Executes one step of the engine. Returns false when there was nothing to run or to evaluate.
    bool step(Time now) noexcept TAPPET_REALTIME {
        if ((mode_ & (inactive | busy | paused | error)) != 0) [[unlikely]]
            return false;
        stepped_at_ = now;
        conditions_left_ = false;
        if (mode_ == ready && automatic_) [[likely]] {
            fast_.step(*this, now);
            return true;
        }
        if (mode_ == ready && !run_once_) return false;
        step_in_memory<false>(*this, now);
        return true;
    }
    /// Single-steps a paused machine: executes one statement of the current program, or evaluates one
    /// transition (5.2.3). Returns false when there was nothing to do.
    bool step_once(Time now) noexcept TAPPET_REALTIME;
    /// Dispatches an event. `trigger` is an index into machine().triggers; out of range it is ignored.
    /// `arguments`: packed by the event, copied. Ignored when a transition needs arguments and there are
    /// none.
    StateOutcome dispatch(std::size_t trigger, Time now, const std::byte* arguments = nullptr) noexcept
        TAPPET_REALTIME {
        if (mode_ != ready) [[unlikely]]
            return dispatch_generally(trigger, now, arguments);
        return fast_.dispatch(*this, trigger, now, arguments);
    }
    /// Takes the first condition transition to `target` whose guard holds. Requests for the final state and,
    /// from it, for the initial state are always valid. No effect when already in `target`. `run_once`: in
    /// reactive mode, then runs the run programs of the active states once.
    StateOutcome request_state(StateIndex target, Time now, bool run_once = false) noexcept TAPPET_REALTIME;
    /// Requests the final state: valid in every active state; ignored in the final one. `reason` must outlive
    /// the execution.
    StateOutcome request_final(Time now, std::string_view reason = {}) noexcept TAPPET_REALTIME;
    /// Goes from the final to the initial state; ignored elsewhere and when called from a program.
    StateOutcome request_initial(Time now) noexcept TAPPET_REALTIME;
    /// Runs the exits and becomes inactive; drops queued events and requests. After an error during
    /// deactivation, a second call continues without the failed program. Ignored when inactive or when called
    /// from a program.
    StateOutcome deactivate(Time now) noexcept TAPPET_REALTIME;

    // ---- observation

    [[nodiscard]] MachineStatus machine_status() const noexcept TAPPET_REALTIME;
    [[nodiscard]] bool is_active() const noexcept TAPPET_REALTIME { return !is(inactive); }
    [[nodiscard]] bool is_automatic() const noexcept TAPPET_REALTIME { return automatic_; }
    [[nodiscard]] bool is_paused() const noexcept TAPPET_REALTIME { return is(paused); }
    [[nodiscard]] bool in_error() const noexcept TAPPET_REALTIME { return is(error); }
    /// Returns whether a transition, exit, entry or handle program waits for a later step.
    [[nodiscard]] bool under_way() const noexcept TAPPET_REALTIME { return is(in_hand); }
    /// Returns whether a request for a state waits until the current program has ended.
    [[nodiscard]] bool request_waits() const noexcept TAPPET_REALTIME { return wanted_state_ != no_state; }
    /// Returns the active leaf; with regions, the first. During a transition, the innermost state that is
    /// still or already active; no_state only inside a call.
    [[nodiscard]] StateIndex active() const noexcept TAPPET_REALTIME { return status_.active; }
    [[nodiscard]] bool is_in(StateIndex state) const noexcept TAPPET_REALTIME {
        for (const ActiveState& each : status_.states)
            if (each.state == state) return true;
        return false;
    }
    [[nodiscard]] bool is_final() const noexcept TAPPET_REALTIME {
        return status_.active != no_state && status_.active == machine_.final_state;
    }
    /// Returns the names of the active leaf and its enclosing states, outermost first.
    [[nodiscard]] Bounded<std::string_view, max_state_depth> path() const noexcept TAPPET_REALTIME {
        return path_of(machine_, status_.active);
    }
    /// Returns all active states, each before those inside it.
    [[nodiscard]] const Bounded<ActiveState, max_active_states>& states() const noexcept TAPPET_REALTIME {
        return status_.states;
    }
    /// Returns the time at which the active leaf was entered.
    [[nodiscard]] Time entered_at() const noexcept TAPPET_REALTIME {
        for (const ActiveState& each : status_.states)
            if (each.state == status_.active) return each.entered_at;
        return {};
    }
    /// Returns the earliest time at which a step must check a time-out of a transition or of a waiting
    /// program; `never`: there is none. Use it to arm a timer. While work is left over, it is the time of the
    /// last step.
    [[nodiscard]] Time next_timeout() const noexcept TAPPET_REALTIME;
    /// Returns the last reason that a transition gave; it stays until another transition gives one.
    [[nodiscard]] std::string_view reason() const noexcept TAPPET_REALTIME { return reason_; }
    /// The last transition that gave a reason, and the number of reasons since bind(), for observers on any
    /// thread: two different readings are two reasons.
    struct News {
        std::uint64_t number = 0; ///< 0: no reason was given yet
        TransitionIndex transition = 0;
        bool operator==(const News&) const = default;
    };
    [[nodiscard]] News news() const noexcept TAPPET_REALTIME { return read(news_); }
    /// Returns the last transition whose guard refused an event with a reason, in the same way.
    [[nodiscard]] News refusals() const noexcept TAPPET_REALTIME { return read(refused_); }
    /// Whether a transition could be taken now.
    struct Look {
        enum class Answer : std::uint8_t {
            open,         ///< when its event comes; without an event, in the next step
            too_early,    ///< a time-out: `left` remains
            guard,        ///< its guard says no
            precondition, ///< the precondition of `state` says no
            arguments,    ///< its guard needs the arguments of its event
            failed,       ///< the guard or the precondition failed
            elsewhere     ///< its source is not active
        };
        Answer answer = Answer::elsewhere;
        StateIndex state = no_state;
        Duration left{};
        std::string_view detail{}; ///< see GuardReason
    };
    /// Evaluates a transition of the table as a step or an event does, without taking it. Call it in the
    /// machine's activity, between its steps.
    [[nodiscard]] Look look(TransitionIndex transition, Time now) noexcept TAPPET_REALTIME;
    /// Returns whether the last call reached a bound with work left: a condition that still held, an event
    /// that could be handled, or statements.
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME {
        return conditions_left_ || statements_left_ || (raised_count_ != 0 && !is(in_hand));
    }
    [[nodiscard]] std::size_t waiting_events() const noexcept TAPPET_REALTIME { return raised_count_; }
    /// Returns the current program of a transition, exit, entry or handle; no_node: none.
    [[nodiscard]] NodeIndex node_in_hand() const noexcept TAPPET_REALTIME {
        return program_begun_ ? position_.node : no_node;
    }
    [[nodiscard]] const StateMachineStatus& status() const noexcept TAPPET_REALTIME { return status_; }
    [[nodiscard]] const StateMachineFault& fault() const noexcept TAPPET_REALTIME { return status_.fault; }
    [[nodiscard]] const ResolvedView& machine() const noexcept TAPPET_REALTIME { return machine_; }
    /// Returns the variables, to read or write between the machine's steps.
    [[nodiscard]] std::byte* data() const noexcept TAPPET_REALTIME { return context_.data; }

private:
    template <class Table> friend struct statechart::Order;
    template <bool quick> friend struct statechart::Memory;
    template <const auto& source, std::size_t type> friend struct native::MachineRows;
    template <const auto& source, std::size_t type, StateIndex leaf> friend struct native::AtLeaf;
    template <const auto& source, std::size_t type> friend struct native::MachineCode;

    // Conditions that exclude the fast path; 0: none.
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
    /// The current job.
    struct Job {
        StepIndex at = no_step; ///< the current step; no_step: none
        ArcIndex arc = no_arc;
        StateIndex from = no_state;      ///< the leaf, for the trace
        std::uint8_t first = 0, end = 0; ///< the active states that are still to be exited
        std::uint8_t remembered = 0;     ///< of a history: states entered so far
        bool placed = false;             ///< of a history: the next one is already active
        bool all = false;                ///< after the current exit, exits all states
    };
    struct Selected {
        StateIndex source = no_state;
        ArcIndex arc = no_arc;
        bool otherwise = false;
    };
    enum class Answer : std::uint8_t { no, yes, otherwise, failed };
    static constexpr Answer answer_of(ConditionResult result) noexcept TAPPET_REALTIME {
        switch (result) {
        case ConditionResult::no: return Answer::no;
        case ConditionResult::yes: return Answer::yes;
        case ConditionResult::failed: break;
        }
        return Answer::failed;
    }
    /// A call from outside.
    struct Call {
        std::int64_t left = 0; ///< statements
    };

    void set(Mode bit) noexcept TAPPET_REALTIME { mode_ = static_cast<Mode>(mode_ | bit); }
    void clear(Mode bit) noexcept TAPPET_REALTIME { mode_ = static_cast<Mode>(mode_ & ~bit); }
    [[nodiscard]] bool is(Mode bit) const noexcept TAPPET_REALTIME { return (mode_ & bit) != 0; }

    // ---- calls from outside
    [[nodiscard]] Call open_ready(Time now) noexcept TAPPET_REALTIME {
        mode_ = ready;
        return open(now);
    }
    [[nodiscard]] Call open(Time now) noexcept TAPPET_REALTIME {
        set(busy);
        context_.now = now;
        statements_left_ = false;
        return {policy_.statements};
    }
    /// Serves what programs requested while they ran, then returns.
    void close(Call call) noexcept TAPPET_REALTIME {
        if (mode_ == busy) [[likely]]
            mode_ = ready;
        else
            finish(call);
    }
    template <bool quick>
    static StateOutcome dispatch_in_memory(StateMachineExecution& execution, std::size_t trigger, Time now,
                                           const std::byte* arguments) noexcept TAPPET_REALTIME;
    template <bool quick>
    static void step_in_memory(StateMachineExecution& execution, Time now) noexcept TAPPET_REALTIME;
    StateOutcome carry_out(Time now) noexcept TAPPET_REALTIME;
    template <bool quick> void go_round(Call& call) noexcept TAPPET_REALTIME;
    void begin_round() noexcept TAPPET_REALTIME {
        for (ActiveState& active : status_.states)
            if (active.run == RunPhase::waits)
                active.run = RunPhase::under_way;
            else if (!is(mid_round) && active.run != RunPhase::under_way)
                active.run = RunPhase::fresh;
        if (!is(mid_round)) asked_ = 0;
        set(mid_round);
    }
    StateOutcome dispatch_generally(std::size_t trigger, Time now, const std::byte* arguments) noexcept
        TAPPET_REALTIME;
    void finish(Call call) noexcept TAPPET_REALTIME;
    Call serve_final(Call call) noexcept TAPPET_REALTIME;
    StateOutcome serve_request(Call& call) noexcept TAPPET_REALTIME;
    void handle_raised(Call& call) noexcept TAPPET_REALTIME;
    // The arc of a finished job is still stored.
    [[nodiscard]] bool has_in_hand(ArcIndex arc) const noexcept TAPPET_REALTIME {
        return is(in_hand) && job_.at != no_step && job_.arc == arc;
    }
    [[nodiscard]] bool is_leaving() const noexcept TAPPET_REALTIME { return has_in_hand(leaving_arc); }
    StateOutcome queue(std::size_t trigger, Time now, const std::byte* arguments) noexcept TAPPET_REALTIME;
    void drop_waiting() noexcept TAPPET_REALTIME;
    void give_reason(TransitionIndex transition, std::string_view text) noexcept TAPPET_REALTIME;
    [[gnu::cold]] void tell_refusal(TransitionIndex transition) noexcept TAPPET_REALTIME {
        write(refused_, transition);
    }
    static News read(std::uint64_t& place) noexcept TAPPET_REALTIME {
        const std::uint64_t word = std::atomic_ref{place}.load(std::memory_order_relaxed);
        return {word >> transition_bits, static_cast<TransitionIndex>(word)};
    }
    static void write(std::uint64_t& place, TransitionIndex transition) noexcept TAPPET_REALTIME {
        std::atomic_ref{place}.store((read(place).number + 1) << transition_bits | transition,
                                     std::memory_order_relaxed);
    }
    void begin_request(ArcIndex arc) noexcept TAPPET_REALTIME;
    void supersede(ArcIndex arc) noexcept TAPPET_REALTIME;

    // ---- effects during execution
    void holds(const Job& job) noexcept TAPPET_REALTIME {
        job_ = job;
        set(in_hand);
    }
    /// Stops at a step of a compiled machine whose leaf is active; `kept`: states that are not exited.
    [[gnu::cold]] void stands_at(StepIndex step, ArcIndex arc, StateIndex leaf, std::uint8_t kept) noexcept
        TAPPET_REALTIME;
    void depart() noexcept TAPPET_REALTIME;
    /// Handles a program or question that did not end normally. Returns false.
    bool breaks_off(ProgramReturn why, StatePart part, StateIndex state, NodeIndex node) noexcept
        TAPPET_REALTIME;
    bool lacks_statements() noexcept TAPPET_REALTIME {
        statements_left_ = true;
        return false;
    }
    Answer refuses(StatePart part, const StateArc& arc) noexcept TAPPET_REALTIME;
    void fail(StatePart part, StateIndex state, NodeIndex node) noexcept TAPPET_REALTIME;
    bool capture(TransitionIndex transition, const std::byte* arguments) noexcept TAPPET_REALTIME;
    /// Resumes a state's run program; false: nothing more runs in this call.
    bool resume_running(ActiveState& at, Call& call) noexcept TAPPET_REALTIME {
        context_.position = at.position;
        const ProgramReturn why = run(at.position, call);
        return why == ProgramReturn::ended || has_not_run(at, why);
    }
    [[gnu::cold]] bool has_not_run(ActiveState& at, ProgramReturn why) noexcept TAPPET_REALTIME;
    /// No condition of the active states held; some handle programs run later.
    [[gnu::cold]] void has_asked_all() noexcept TAPPET_REALTIME {
        for (ActiveState& active : status_.states)
            if (active.run == RunPhase::ran) active.run = RunPhase::asked;
    }
    /// Runs a program of the table from the context's position; stores the position when it does not end.
    ProgramReturn run(ProgramPosition& kept, Call& call) noexcept TAPPET_REALTIME {
        auto left = static_cast<std::uint32_t>(call.left > 0 ? call.left : 0);
        const ProgramReturn why = code_.run(*code_.tables, context_, left);
        call.left = left;
        if (why != ProgramReturn::ended) [[unlikely]]
            kept = context_.position;
        return why;
    }

    // ---- the active states
    void plan_remembered(statechart::Entering& into, const StateArc& arc) const noexcept TAPPET_REALTIME;
    [[nodiscard]] std::size_t index_of(StateIndex state) const noexcept TAPPET_REALTIME;
    [[nodiscard]] std::size_t end_of(std::size_t index) const noexcept TAPPET_REALTIME;
    void insert(std::size_t index, StateIndex state) noexcept TAPPET_REALTIME;
    void remove(std::size_t index) noexcept TAPPET_REALTIME;
    void leaves_last() noexcept TAPPET_REALTIME;
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
    Mode mode_ = inactive;
    bool automatic_ = false;
    bool conditions_left_ = false;
    bool statements_left_ = false;
    bool single_ = false;        // a single step: evaluations count as statements
    bool run_once_ = false;      // requested by request_state()
    bool program_begun_ = false; // position_ is valid

    Job job_;
    ProgramPosition position_; // of the current program
    statechart::Entering remembered_;
    Bounded<Selected, max_active_states> selected_; // by one event, not yet taken; next one first
    std::uint32_t asked_ = 0;                       // evaluations that single steps made in this round
    std::array<std::uint64_t, max_states / 64> ran_{};
    StateMachinePolicy policy_;
    StateMachineStatus status_;
    std::string_view reason_;
    static constexpr int transition_bits = 16;
    static_assert(sizeof(TransitionIndex) * 8 == transition_bits,
                  "news_ holds a transition in its lowest bits");
    // mutable: atomic_ref reads them
    alignas(std::atomic_ref<std::uint64_t>::required_alignment) mutable std::uint64_t news_ = 0;
    alignas(std::atomic_ref<std::uint64_t>::required_alignment) mutable std::uint64_t refused_ = 0;
    std::string_view final_reason_;
    StateIndex wanted_state_ = no_state;
    bool wanted_run_ = false;
    Time stepped_at_{};
    Trace trace_ = nullptr;
    void* trace_context_ = nullptr;
    StateMachineExecution* parent_ = nullptr;
    std::span<StateIndex> history_;
    std::span<std::byte> deferred_;
    std::array<TriggerIndex, max_raised_events> raised_{}; // ring buffer
    std::uint8_t raised_first_ = 0;
    std::uint8_t raised_count_ = 0;
};

} // namespace tappet
