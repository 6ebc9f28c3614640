// The execution engine (thesis 5.3): runs one activity's cycle in a fixed order: due timers, the components
// in data-flow order, then commands, messages and behaviours. It knows no thread: a thread or a virtual world
// calls it.
#pragma once

#include "kernel/activity/command_processor.hpp"
#include "kernel/activity/cycle_tape.hpp"
#include "kernel/activity/timing.hpp"
#include "kernel/base/digest.hpp"
#include "kernel/base/random.hpp"
#include "kernel/component/cause.hpp"
#include "kernel/component/component.hpp"
#include "kernel/component/life.hpp"
#include "kernel/exchange/mailbox.hpp"
#include "kernel/os/stamps.hpp"
#include "kernel/os/waiter.hpp"

#include <array>
#include <atomic>
#include <span>
#include <string_view>

namespace tappet {

/// A behaviour as its engine sees it: a program or a state machine. Plain pointers, set at start-up.
struct Behaviour {
    void* self = nullptr;
    std::uint32_t part = 0; ///< number of the component that it drives
    void (*start)(void* self, Time) noexcept TAPPET_REALTIME = nullptr;
    /// Runs the programs. Null, or returns false: it has none.
    bool (*programs)(void* self, Time) noexcept TAPPET_REALTIME = nullptr;
    /// Runs after all programs. Returns false when there was nothing to run or to evaluate.
    bool (*step)(void* self, Time) noexcept TAPPET_REALTIME = nullptr;
    void (*stop)(void* self, Time) noexcept TAPPET_REALTIME = nullptr; ///< requests its end
    bool (*has_ended)(const void* self) noexcept TAPPET_REALTIME = nullptr;
    Time (*next)(const void* self) noexcept
        TAPPET_REALTIME = nullptr; ///< when it needs a step although nothing happened
};

/// The parts of a component that are timed separately.
enum class FunctionKind : std::uint8_t { step, timers, reactions, behaviour };
inline constexpr std::uint32_t functions_per_part = 4;

/// A component in its engine; the members that a step needs come first.
struct EnginePart : GatedComponent {
    void (*step)(void* component, const Cycle&) noexcept TAPPET_REALTIME = nullptr; ///< of its type
    std::string_view name{};
    LifeRequests requests{};
    // For a component whose stop waits for the ends of its behaviours; never: no stop is waiting.
    Time ends_at = never;
    LifeTicket ending{};
    LifeChange wanted{};
    std::atomic<bool> left_unsafe{false}; ///< a driver: its last stop() did not reach its device
    Stops stops{}; ///< a force ends when the component that writes the forced input has stopped
};

struct EngineTimer {
    Timer* timer = nullptr;
    void (*fire)(void* component, const Cycle&) noexcept TAPPET_REALTIME = nullptr;
    std::uint32_t part = 0;
};

/// An input whose staleness has an effect: its row stops the machine, or wakes its reader.
struct GuardedInput {
    void* input = nullptr;
    const PortOperations* port = nullptr;
    std::size_t connection = 0; ///< its row
    std::uint32_t part = 0;     ///< number of the component that reads it
    bool stops = false;         ///< stops the machine
    bool was_valid = false;     ///< only a value that was good before can become stale
    Time expires = never; ///< an activity without a period polls it then, because nothing else would wake it
};

/// An input that a component needs before it starts.
struct NeededInput {
    void* input = nullptr;
    Flow (*flow)(void*) noexcept TAPPET_REALTIME = nullptr;
    std::uint32_t part = 0;
    std::uint16_t facet = 0;
    bool has_initial = false;    ///< its row gives a value before the first one comes
    bool same_activity = false;  ///< its writer runs in the same engine
    bool valid_to_start = false; ///< the component waits for it even when the whole machine starts
    /// State of the writer when the writer in turn needs an output of this component. While it does not run
    /// or has not written yet, neither can be first, and the input is not awaited. Else null.
    const AtomicComponentState* circle = nullptr;
};

/// The reason for an engine's request to stop the machine.
enum class StopReason : std::uint8_t {
    none,
    stale_input,
    missed_deadline,
    broken_contract,
    requested,
    behaviour,
    section,        ///< a row of a section of the table that another folder adds
    activity_hangs, ///< its start or stop alone was not finished in time
    not_started     ///< an activity, while the machine was started
};

struct EnginePlan {
    std::string_view name{};
    std::uint32_t activity = 0; ///< its number in the table
    bool periodic = false;
    bool real_time = true;
    Duration period{};
    Duration phase{}; ///< of its periods, against the beginning of the clock
    Duration deadline{};
    Duration budget{}; ///< of a cycle, claimed by the table
    std::int64_t at_most_n = 1;
    Duration at_most_per{};
    bool stop_when_late = false;
    bool hears_causes = false;           ///< edges or frames may cause what it does in its periods
    std::span<EnginePart> parts;         ///< in data-flow order
    std::span<FunctionTiming> functions; ///< functions_per_part for each part
    std::span<EngineTimer> timers;
    std::span<Behaviour> behaviours;
    std::span<GuardedInput> guarded;
    std::span<const NeededInput> inputs;
    std::atomic<std::uint32_t>* forced = nullptr; ///< counts the machine's forced ports; null: no counter

    /// Returns the claim that the table's analysis used: the processor time of a period's cycle, or of all
    /// cycles within at_most's time, which may come together. Zero: no claim.
    [[nodiscard]] Duration claim() const noexcept TAPPET_REALTIME {
        return periodic ? budget : at_most_n * budget;
    }
};

/// Records each cycle's outputs for observers: called at the end of each cycle, in the activity's thread.
/// `stepped`: its components ran.
struct CycleRecorder {
    void (*record)(CycleRecorder& self, const Cycle&, bool stepped) noexcept TAPPET_REALTIME = nullptr;
};

/// Counters that an observer may read while the machine runs; only the engine writes them.
struct EngineStatistics {
    std::uint64_t cycles = 0;
    std::uint64_t messages = 0;
    std::uint64_t misses = 0;
    std::uint64_t skipped_periods = 0;
    std::uint64_t wakes_too_many = 0; ///< more than at_most(n, per) promised
    Duration longest_response{};
    Duration longest_lateness{}; ///< from release to begin
    Duration longest_busy{};     ///< from begin to end, preemption included
    /// The most processor time of the thread for one EnginePlan::claim(). It is measured from the first cycle
    /// on that is busy for longer than its budget, or comes too often; until then the claim is kept. A claim
    /// is for a period, or for a time of at_most. Engine::measured_at_first of them are measured, then, at
    /// random, one of Engine::measured_one_of.
    Duration most_processor{};
    std::uint64_t over_claim = 0; ///< claims that were measured and exceeded
    std::uint64_t measured_claims = 0;
    std::array<Miss, 8> recent_misses{};
};

class Engine {
public:
    static constexpr std::int64_t max_wakes_watched = 32;

    /// A request to stop the machine; the first call wins. Real-time, any thread.
    using StopCall = void (*)(void* context, StopReason, std::uint64_t detail, const Engine& from) noexcept
        TAPPET_REALTIME;

    /// Sets up the engine, while it is not active. The spans outlive the engine.
    void place(const EnginePlan& plan, os::Clock& clock) noexcept;
    void on_stop(StopCall call, void* context) noexcept { stop_call_ = call, stop_context_ = context; }

    /// Records its cycles on that tape whenever that is on. Set while not active; the tape outlives the
    /// engine.
    void record_to(CycleTape* tape) noexcept {
        expect_standing();
        recorded_ = tape;
        if (tape != nullptr) serves_ = Serves::everything;
    }
    /// Records the values of its components. Set while not active. The recorder's time counts in the cycle's
    /// response and claim.
    void record_values_by(CycleRecorder* recorder) noexcept {
        expect_standing();
        recorder_ = recorder;
        if (recorder != nullptr) serves_ = Serves::everything;
    }

    /// Initialises the components, on the makers' thread, while not active. When one refuses, those
    /// initialised before it are finalised again. Empty: all are ready. Not real-time.
    [[nodiscard]] Sentence initialise();
    /// Finalises the components on the makers' thread after stop(), in reverse order. Not real-time.
    void finalise();

    /// Starts components, then behaviours, in its own thread, before the first cycle. A component whose
    /// valid_to_start inputs have no valid value yet stays `waiting` and starts when they have.
    void start(Time now) noexcept TAPPET_REALTIME;
    /// Runs one cycle. `woken`: by a message, a connection or the device; otherwise by time.
    void run(bool woken) noexcept TAPPET_REALTIME {
        if (running_activity() == plan_.activity) return cycle(woken); // in its own thread always
        const RunsActivity here{plan_.activity, &cycle_.now};
        cycle(woken);
    }
    /// Longest time for behaviours to reach their final states when their component or activity stops.
    static constexpr Duration end_limit = 100ms;
    /// Asks behaviours to end, in its own thread, before stop(). Cycles continue until has_ended(), at the
    /// latest at ends_at(), which is not after `until`: a final state may wait, or send commands that take
    /// time. Nothing is started meanwhile.
    void begin_end(Time now, Time until = never) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool has_ended(Time now) const noexcept TAPPET_REALTIME;
    [[nodiscard]] Time ends_at() const noexcept TAPPET_REALTIME { return ends_at_; }
    /// Stops the components, in its own thread. They leave safe values in data-flow order, so that a source's
    /// last value reaches the driver after it. Behaviours that were not asked to end before are asked now,
    /// and get only the effect of one step.
    void stop(Time now) noexcept TAPPET_REALTIME;
    /// Rejects late commands, in the thread that stopped it, when it is woken before the next start. So the
    /// sender of a command that checked before the stop and posted after it gets its answer.
    void reject_late() noexcept TAPPET_REALTIME;

    /// Requests a change in the life of one component; served between two steps (thesis 3.1.3). A component
    /// starts only when each of its required inputs has a valid value. Real-time, any thread.
    LifeTicket ask(std::uint32_t part, LifeChange change) noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer answer_to(std::uint32_t part, LifeTicket ticket) const noexcept TAPPET_REALTIME;
    /// Returns whether it is between start() and stop(). Real-time, any thread.
    [[nodiscard]] bool is_active() const noexcept TAPPET_REALTIME {
        return active_.load(std::memory_order_acquire); // no step: asked by whoever wants to know
    }
    /// Returns why it could not start while the rest of the machine runs: an input that another activity
    /// writes has no valid value. While not active.
    [[nodiscard]] LifeAnswer readiness(Time now) noexcept TAPPET_REALTIME;
    /// A set of parts: bit i is part i.
    using Parts = std::uint64_t;
    /// Makes the parts `waiting` wait for their turn and the others of `of_all` not (thesis 3.1.3); nobody
    /// can start a waiting part alone. Called from the start() of a part before them. Real-time.
    void rest(Parts waiting, Parts of_all) noexcept TAPPET_REALTIME {
        resting_ = (resting_ & ~of_all) | waiting;
        tell_resting();
    }
    /// Starts those parts from the values that they read now. On a refusal all of them keep waiting, and the
    /// answer names the input in the way. Called from a step of a part before them. Real-time.
    [[nodiscard]] LifeAnswer enter(Parts entering) noexcept TAPPET_REALTIME;
    /// Calls start() again for those parts that run, from the values that they read now. If refused, some
    /// were not started again. Called as enter(). Real-time.
    [[nodiscard]] LifeAnswer begin_anew(Parts running) noexcept TAPPET_REALTIME;
    /// Stops those parts, which then wait. Called as enter(). Real-time.
    void leave(Parts leaving) noexcept TAPPET_REALTIME;
    /// Marks its components as failed: its thread hangs or broke a contract.
    void mark_failed() noexcept TAPPET_REALTIME;
    /// Returns the component that decides itself when it runs, which is then the only one; null: none does.
    [[nodiscard]] const EnginePart* looping() const noexcept TAPPET_REALTIME {
        return plan_.parts.size() == 1 && plan_.parts.front().type->loop != nullptr ? &plan_.parts.front()
                                                                                    : nullptr;
    }
    /// Lets only the devices of running drivers end waits of its thread, not those of stopped ones.
    void heed_devices_of_running() noexcept TAPPET_REALTIME;
    /// Returns the first part whose last stop() did not reach its device, or the number of parts. Any thread.
    [[nodiscard]] std::size_t left_unsafe() const noexcept TAPPET_REALTIME;

    /// Announces that a connection row that wakes this engine has a value caused by an edge or a frame: the
    /// next cycle counts as the row's effect. The last of several rows counts. Real-time, any thread.
    void expect(WakingRow& row, Time cause) noexcept TAPPET_REALTIME {
        row.cause_ns.store(to_ns(cause), std::memory_order_relaxed); // no step: for the report
        waking_.store(&row, std::memory_order_release);              // no step: for the report
    }

    /// Returns when it must run although nothing wakes it.
    [[nodiscard]] Time next_wake() const noexcept TAPPET_REALTIME {
        return serves_ == Serves::steps && awaiting_ == 0 ? next_release_ : earliest_wake();
    }

    [[nodiscard]] std::string_view name() const noexcept TAPPET_REALTIME { return plan_.name; }
    [[nodiscard]] const EnginePlan& plan() const noexcept TAPPET_REALTIME { return plan_; }
    [[nodiscard]] os::Waiter& waiter() noexcept TAPPET_REALTIME { return waiter_; }
    /// States the time at which its thread will be awake, for a watcher.
    void sleeps_until(Time time) noexcept TAPPET_REALTIME {
        wakes_at_ns_.store(to_ns(time), std::memory_order_relaxed); // no step: looked at again and again
    }
    [[nodiscard]] Time wakes_at() const noexcept TAPPET_REALTIME {
        return at_ns(wakes_at_ns_.load(std::memory_order_relaxed)); // no step: looked at again and again
    }
    /// Returns whether it was woken and has not begun the cycle for that.
    [[nodiscard]] bool is_woken() const noexcept TAPPET_REALTIME { return waiter_.is_woken(); }
    [[nodiscard]] Inbox& inbox() noexcept TAPPET_REALTIME { return inbox_; }
    [[nodiscard]] CommandProcessor& commands() noexcept TAPPET_REALTIME { return commands_; }
    /// Returns this thread's time stamps.
    [[nodiscard]] os::Stamps& stamps() noexcept TAPPET_REALTIME { return stamps_; }
    [[nodiscard]] const Time* now_address() const noexcept { return &cycle_.now; }
    [[nodiscard]] Time now() const noexcept TAPPET_REALTIME { return cycle_.now; }
    [[nodiscard]] const EngineStatistics& statistics() const noexcept TAPPET_REALTIME { return statistics_; }
    /// Reading the thread's processor time enters the kernel, so not every claim is measured.
    static constexpr std::uint32_t measured_at_first = 64, measured_one_of = 61;
    /// Restarts the measurement as at first, from the next cycle on, if it measures at all. In its thread.
    void measure_as_at_first() noexcept TAPPET_REALTIME {
        next_measured_ = measured_at_first;
        if (!measures_claim_) claim_began_ = Time::min(); // a claim that is not measured tells nothing
    }
    /// Returns by how much the last exceeded claim was exceeded, at the end of the cycle in which that
    /// happened. In its thread.
    [[nodiscard]] Duration claim_exceeded_by() const noexcept TAPPET_REALTIME { return claim_exceeded_by_; }
    /// Returns the digest of this engine in virtual time: every message, timer and transition with its time.
    /// Equal in two runs that did the same. Under real time no two runs are alike, and nothing is added.
    [[nodiscard]] const Digest& digest() const noexcept TAPPET_REALTIME { return digest_; }
    /// Adds a transition of a behaviour to the digest.
    void note(std::uint64_t what, Time when) noexcept TAPPET_REALTIME {
        if (!clock_->is_virtual()) return;
        digest_.add(to_ns(when));
        digest_.add(what);
    }
    /// Odd while a cycle runs: an observer whose two readings differ, or are odd, must read again.
    [[nodiscard]] const void* generation_address() const noexcept { return &generation_; }
    [[nodiscard]] std::uint64_t generation() const noexcept TAPPET_REALTIME {
        return generation_.load(std::memory_order_acquire); // no step: observers look by map_view.hpp
    }

private:
    void expect_standing() const noexcept TAPPET_REALTIME {
        TAPPET_CONTRACT(!is_active(), Contract::engine_runs, plan_.activity);
    }
    [[nodiscard]] FunctionTiming& function(std::uint32_t part, FunctionKind kind) noexcept TAPPET_REALTIME {
        return plan_.functions[part * functions_per_part + static_cast<std::uint32_t>(kind)];
    }
    [[nodiscard]] std::uint32_t index_of(const FunctionTiming& timing) const noexcept TAPPET_REALTIME {
        return static_cast<std::uint32_t>(&timing - plan_.functions.data());
    }
    /// Runs one function and times it. The end of one function is the beginning of the next: one stamp each.
    template <class F>
    void timed(std::uint32_t part, FunctionKind kind, F&& body) noexcept TAPPET_REALTIME {
        timed(function(part, kind), body);
    }
    template <class F>
    void timed(FunctionTiming& timing, F&& body) noexcept TAPPET_REALTIME {
        body();
        end_of(timing);
    }
    // Out of line where a cycle seldom comes, inlined in the loop over all components.
    void end_of(FunctionTiming& timing, std::uint64_t together = 1) noexcept TAPPET_REALTIME {
        account(timing, together);
    }
    [[gnu::always_inline]] void account(FunctionTiming& timing, std::uint64_t together) noexcept
        TAPPET_REALTIME {
        const Time end = stamps_.now();
        const Duration took = end - lap_;
        const Duration each = together == 1 ? took : took / static_cast<std::int64_t>(together);
        if (timing.exceeds_usual(each, worst_excess_)) note_excess(timing, each);
        timing.add(took, together);
        lap_ = end;
        if (tape_ != nullptr) tape_->mark(index_of(timing), (end - cycle_.now).count());
    }
    [[nodiscard]] Time due_at(const EngineTimer& timer) const noexcept TAPPET_REALTIME {
        return is_running(plan_.parts[timer.part].state) ? timer.timer->when() : never;
    }
    /// Begins a change of observable data: a cycle, a start or a stop. Pass the result to end_change(). It is
    /// is_changing when a thread that broke a contract in its cycle stops after it.
    static constexpr std::uint64_t is_changing = 0;
    [[nodiscard]] std::uint64_t begin_change() noexcept TAPPET_REALTIME {
        // Only the engine writes its generation, so no atomic read-modify-write is needed. A stop after a
        // cycle that broke a contract finds the generation odd and leaves it.
        const std::uint64_t before =
            generation_.load(std::memory_order_relaxed); // no step: nobody else writes it
        if (before % 2 != 0) return is_changing;
        generation_.store(before + 1, std::memory_order_relaxed); // observe.begin
        std::atomic_thread_fence(std::memory_order_release);      // what follows is stored after it
        return before + 2;
    }
    void end_change(std::uint64_t generation) noexcept TAPPET_REALTIME {
        if (generation != is_changing)
            generation_.store(generation, std::memory_order_release); // observe.end
    }
    [[nodiscard]] Time earliest_wake() const noexcept TAPPET_REALTIME;
    enum class Rule : std::uint8_t { with_the_machine, alone };
    [[nodiscard]] bool rests(std::uint32_t part) const noexcept TAPPET_REALTIME {
        return (resting_ >> part & 1) != 0;
    }
    [[nodiscard]] [[nodiscard]] bool may_wait(std::uint32_t part) const noexcept TAPPET_REALTIME;
    LifeAnswer check_inputs(std::uint32_t part, Rule rule) noexcept TAPPET_REALTIME;
    void start_part(std::uint32_t part) noexcept TAPPET_REALTIME;
    void stop_part(std::uint32_t part) noexcept TAPPET_REALTIME;
    /// Asks the behaviours of a running component to end; the second function returns whether all have ended.
    void stop_behaviours(std::uint32_t part) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool have_ended(std::uint32_t part) const noexcept TAPPET_REALTIME;
    void carry_out(std::uint32_t part, LifeTicket ticket, LifeChange wanted) noexcept TAPPET_REALTIME;
    void end_parts() noexcept TAPPET_REALTIME;
    void refuse_ending(std::uint32_t part) noexcept TAPPET_REALTIME;
    void end_forces(const EnginePart& part, FacetKind of) const noexcept TAPPET_REALTIME;
    static void begin_life(const EnginePart& part) noexcept TAPPET_REALTIME;
    /// Tells the gates of all parts which of them wait for their turn.
    void tell_resting() noexcept TAPPET_REALTIME;
    void cancel_timers(std::uint32_t part) noexcept TAPPET_REALTIME;
    static void say_at_rest(const EnginePart& part) noexcept TAPPET_REALTIME;
    /// Lets the component's writes reach its readers from now on, or no longer.
    static void open_outputs(EnginePart& part) noexcept TAPPET_REALTIME;
    static void close_outputs(EnginePart& part, std::uint64_t stop) noexcept TAPPET_REALTIME;
    void start_behaviours(std::uint32_t part) noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer change(std::uint32_t part, LifeChange wanted) noexcept TAPPET_REALTIME;
    void serve_requests() noexcept TAPPET_REALTIME;
    void start_awaiting() noexcept TAPPET_REALTIME;
    [[nodiscard]] WakingRow* take_waking_row() noexcept TAPPET_REALTIME;
    bool run_timers() noexcept TAPPET_REALTIME;
    void run_components() noexcept TAPPET_REALTIME;
    bool run_commands() noexcept TAPPET_REALTIME;
    bool run_messages() noexcept TAPPET_REALTIME;
    void run_behaviours(bool all) noexcept TAPPET_REALTIME;
    void note(const Message& message) noexcept TAPPET_REALTIME;
    /// In an activity without a period: whether an input became stale since the last cycle.
    enum class Expired : std::uint8_t { none, looked, stale };
    [[nodiscard]] Expired look_at_expired() noexcept TAPPET_REALTIME;
    void watch_inputs() noexcept TAPPET_REALTIME;
    void record_values(bool stepped) noexcept TAPPET_REALTIME;
    void watch_wakes() noexcept TAPPET_REALTIME;
    [[nodiscard]] Duration used_processor() const noexcept TAPPET_REALTIME;
    [[nodiscard]] bool measures_cycle() noexcept TAPPET_REALTIME;
    void note_processor(Duration used) noexcept TAPPET_REALTIME;
    void note_excess(const FunctionTiming& function, Duration took) noexcept TAPPET_REALTIME;
    void note_miss(Duration response) noexcept TAPPET_REALTIME;
    void note_response(Duration response) noexcept TAPPET_REALTIME;
    void measure_processor() noexcept TAPPET_REALTIME;
    void end_period() noexcept TAPPET_REALTIME;
    /// The work of a cycle beside requests, commands and messages. Rare features cost nothing in activities
    /// without them.
    enum class Serves : std::uint8_t {
        steps,
        behaviours, ///< and steps
        everything  ///< also timers, guarded inputs, processor time, a tape or a recorder
    };
    void cycle(bool woken) noexcept TAPPET_REALTIME {
        switch (serves_) {
        case Serves::steps: return cycle_as<Serves::steps>(woken);
        case Serves::behaviours: return cycle_as<Serves::behaviours>(woken);
        case Serves::everything: return cycle_as<Serves::everything>(woken);
        }
    }
    template <Serves serves>
    void cycle_as(bool woken) noexcept TAPPET_REALTIME;
    void ask_stop(StopReason reason, std::uint64_t detail) const noexcept TAPPET_REALTIME {
        if (stop_call_ != nullptr) stop_call_(stop_context_, reason, detail, *this);
    }

    EnginePlan plan_{};
    bool has_deadline_ = false;
    bool watches_wakes_ = false;
    Serves serves_ = Serves::everything;
    bool measures_processor_ = false;
    bool measures_claim_ = false;                     ///< the one of this cycle
    std::uint32_t next_measured_ = measured_at_first; ///< claims that are measured next
    std::uint32_t left_out_ = 0;                      ///< claims that are not measured, until the next one is
    Random chance_{measured_one_of};
    Duration claim_exceeded_by_{};
    Time claim_began_ = Time::min(); ///< begin of a time of at_most
    Duration claim_used_{};
    os::Clock* clock_ = nullptr;
    os::Stamps stamps_{};
    Cycle cycle_{};
    /// Interval of checks whether a component that waits for an input may start.
    static constexpr Duration awaiting_period = 10ms;
    std::atomic<bool> active_{false};
    std::atomic<bool> asked_{false}; ///< one of the parts has a request
    bool was_stopped_ = false;
    Time ends_at_ = never;       ///< for behaviours that were asked to end; never: they were not
    std::uint32_t awaiting_ = 0; ///< parts that wait for an input
    std::uint32_t ending_ = 0;   ///< parts whose stop waits for the end of their behaviours
    Parts resting_ = 0;          ///< parts that wait for their turn
    Time next_release_ = never;
    Time lap_{};
    Time ended_{};
    Time cause_{}; ///< cause of this cycle: that of its wake, or of the first message that has one
    Time left_{};  ///< of a periodic activity: cause of the first message, for the components' next step
    std::atomic<WakingRow*> waking_{nullptr};
    Duration least_excess_{}; ///< least excess for which a function can be to blame: zero, or never
    Duration worst_excess_{}; ///< of this cycle; least_excess_: no function took longer than usual
    Duration worst_took_{};
    Duration worst_usual_{};
    std::uint32_t worst_function_ = Miss::nobody;
    CycleTape* recorded_ = nullptr;
    CycleTape* tape_ = nullptr; ///< of this cycle; null: it is not recorded
    CycleRecorder* recorder_ = nullptr;
    Duration quiet_response_{-1}; ///< a response up to here is neither a maximum nor a miss
    Duration quiet_busy_{-1};     ///< the same, for a cycle that begins at its release
    std::array<Time, max_wakes_watched> wakes_{};
    std::uint64_t wake_count_ = 0;
    std::uint64_t oldest_wake_ = 0; ///< its index
    StopCall stop_call_ = nullptr;
    void* stop_context_ = nullptr;
    EngineStatistics statistics_{};
    Digest digest_{};
    std::atomic<std::uint64_t> generation_{0};
    std::atomic<std::int64_t> wakes_at_ns_{0};
    os::Waiter waiter_{};
    Inbox inbox_{};
    CommandProcessor commands_{};
};

} // namespace tappet
