// The execution engine (thesis 5.3): what one activity runs in each cycle, in a fixed order: due timers, the
// components in data-flow order, then commands, messages and behaviours. It knows no thread: a thread or a
// virtual world calls it.
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

/// What a behaviour looks like to its engine: programs and state machines. Plain pointers, filled at
/// start-up.
struct Behaviour {
    void* self = nullptr;
    std::uint32_t part = 0; ///< of the component it drives
    void (*start)(void* self, Time) noexcept TAPPET_REALTIME = nullptr;
    /// Null, or false: it has none.
    bool (*programs)(void* self, Time) noexcept TAPPET_REALTIME = nullptr;
    /// After all programs. False: nothing was there to run or to ask.
    bool (*step)(void* self, Time) noexcept TAPPET_REALTIME = nullptr;
    void (*stop)(void* self, Time) noexcept TAPPET_REALTIME = nullptr; ///< asks for its end
    bool (*has_ended)(const void* self) noexcept TAPPET_REALTIME = nullptr;
    Time (*next)(const void* self) noexcept
        TAPPET_REALTIME = nullptr; ///< when it wants a step although nothing happened
};

/// What of a component is timed separately.
enum class FunctionKind : std::uint8_t { step, timers, reactions, behaviour };
inline constexpr std::uint32_t functions_per_part = 4;

/// A component in its engine; what a step needs stands in front.
struct EnginePart : GatedComponent {
    void (*step)(void* component, const Cycle&) noexcept TAPPET_REALTIME = nullptr; ///< of its type
    std::string_view name{};
    LifeRequests requests{};
    // Of one that is asked to stop while its behaviours come to their ends; never: none is.
    Time ends_at = never;
    LifeTicket ending{};
    LifeChange wanted{};
    std::atomic<bool> left_unsafe{false}; ///< a driver: its last stop() did not reach its device
    Stops stops{};                        ///< who reads it, and is forced to something else, lets go then
};

struct EngineTimer {
    Timer* timer = nullptr;
    void (*fire)(void* component, const Cycle&) noexcept TAPPET_REALTIME = nullptr;
    std::uint32_t part = 0;
};

/// An input on whose growing stale somebody acts: its row stops the machine, or wakes its reader.
struct GuardedInput {
    void* input = nullptr;
    const PortOperations* port = nullptr;
    std::size_t connection = 0; ///< its row
    std::uint32_t part = 0;     ///< of the component that reads it
    bool stops = false;         ///< the machine
    bool was_valid = false;     ///< only a value that was once good can become stale
    Time expires = never;       ///< an activity without a period looks at it then: nothing else would tell
};

/// An input that a component needs before it starts.
struct NeededInput {
    void* input = nullptr;
    Flow (*flow)(void*) noexcept TAPPET_REALTIME = nullptr;
    std::uint32_t part = 0;
    std::uint16_t facet = 0;
    bool has_initial = false;    ///< its row gives it a value before the first one comes
    bool same_activity = false;  ///< what it reads is written by the same engine
    bool valid_to_start = false; ///< awaited also when the whole machine starts
    /// Of who writes it, when that needs in turn what this component writes: while it does not run, or has
    /// not written yet, neither can be the first, and the input is not awaited. Else null.
    const AtomicComponentState* circle = nullptr;
};

/// Why an engine asks for the machine to stop.
enum class StopReason : std::uint8_t {
    none,
    stale_input,
    missed_deadline,
    broken_contract,
    requested,
    behaviour,
    section,        ///< a row of a section of another folder
    activity_hangs, ///< it was to be started or stopped alone, and was not in time
    not_started     ///< an activity, while the machine was started
};

struct EnginePlan {
    std::string_view name{};
    std::uint32_t activity = 0; ///< its number in the table
    bool periodic = false;
    bool real_time = true;
    Duration period{};
    Duration phase{}; ///< of its periods, against those of the clock's beginning
    Duration deadline{};
    Duration budget{}; ///< of a cycle, claimed by the table
    std::int64_t at_most_n = 1;
    Duration at_most_per{};
    bool stop_when_late = false;
    std::span<EnginePart> parts;         ///< in data-flow order
    std::span<FunctionTiming> functions; ///< functions_per_part for each part
    std::span<EngineTimer> timers;
    std::span<Behaviour> behaviours;
    std::span<GuardedInput> guarded;
    std::span<const NeededInput> inputs;
    std::atomic<std::uint32_t>* forced = nullptr; ///< counts the machine's forced ports; null: nobody does

    /// What the analysis of the table believed: the processor time of a period's cycle, or of all cycles
    /// within at_most's time, which may come together. Zero: nothing is claimed.
    [[nodiscard]] Duration claim() const noexcept TAPPET_REALTIME {
        return periodic ? budget : at_most_n * budget;
    }
};

/// Who keeps what cycles made, for observers: called at the end of each, in the activity's thread. `stepped`:
/// its components ran.
struct CycleRecorder {
    void (*record)(CycleRecorder& self, const Cycle&, bool stepped) noexcept TAPPET_REALTIME = nullptr;
};

/// Counters that an observer may read while the machine runs; each is written by the engine alone.
struct EngineStatistics {
    std::uint64_t cycles = 0;
    std::uint64_t messages = 0;
    std::uint64_t misses = 0;
    std::uint64_t skipped_periods = 0;
    std::uint64_t wakes_too_many = 0; ///< more than at_most(n, per) promised
    Duration longest_response{};
    Duration longest_lateness{}; ///< from release to the beginning
    Duration longest_busy{};     ///< from the beginning to the end, preemption included
    /// The most of the thread's processor time for one EnginePlan::claim(). Measured from the cycle on that
    /// is busy for longer than its budget, or comes too often; until then the claim is kept. A claim is of a
    /// period, or of a time of at_most: Engine::measured_at_first of them are measured, then by chance one of
    /// Engine::measured_one_of.
    Duration most_processor{};
    std::uint64_t over_claim = 0; ///< claims that were measured to take more
    std::uint64_t measured_claims = 0;
    std::array<Miss, 8> recent_misses{};
};

class Engine {
public:
    static constexpr std::int64_t max_wakes_watched = 32;

    /// Asked to stop the machine; the first call wins. Real-time, any thread.
    using StopCall = void (*)(void* context, StopReason, std::uint64_t detail, const Engine& from) noexcept
        TAPPET_REALTIME;

    /// While it stands, as all that says so. Spans outlive the engine.
    void place(const EnginePlan& plan, os::Clock& clock) noexcept;
    void on_stop(StopCall call, void* context) noexcept { stop_call_ = call, stop_context_ = context; }

    /// While it stands: its cycles are recorded there, whenever that tape is on. It outlives the engine.
    void record_to(CycleTape* tape) noexcept {
        expect_standing();
        recorded_ = tape;
        if (tape != nullptr) serves_ = Serves::everything;
    }
    /// Likewise: values of its components. What it takes counts in the cycle's response and claim.
    void record_values_by(CycleRecorder* recorder) noexcept {
        expect_standing();
        recorder_ = recorder;
        if (recorder != nullptr) serves_ = Serves::everything;
    }

    /// On the makers' thread, while it stands: initialises the components; those that had
    /// been before one refused are finalised again. Empty: all are ready. Not real-time.
    [[nodiscard]] Sentence initialise();
    /// On the makers' thread, after stop(): the last one initialised comes first. Not real-time.
    void finalise();

    /// In its own thread, before the first cycle: components, then behaviours start. A component whose
    /// valid_to_start inputs have no valid value yet stays `starting` and follows when they have.
    void start(Time now) noexcept TAPPET_REALTIME;
    /// One cycle. `woken`: by a message, a connection or the device; otherwise by time.
    void run(bool woken) noexcept TAPPET_REALTIME {
        if (running_activity() == plan_.activity) return cycle(woken); // in its own thread always
        const RunsActivity here{plan_.activity, &cycle_.now};
        cycle(woken);
    }
    /// How long behaviours may take to come to their final states when their component or activity stops.
    static constexpr Duration end_limit = 100ms;
    /// In its own thread, before stop(): behaviours are asked for their ends. Cycles go on until has_ended(),
    /// at ends_at() at the latest, which is not after `until`: a final state may wait, or send commands that
    /// take their time. Nothing is started meanwhile.
    void begin_end(Time now, Time until = never) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool has_ended(Time now) const noexcept TAPPET_REALTIME;
    [[nodiscard]] Time ends_at() const noexcept TAPPET_REALTIME { return ends_at_; }
    /// In its own thread: components leave safe values, in data-flow order, so that what a source writes last
    /// reaches the driver after it. Behaviours that were not asked to end are asked now, and get what one
    /// step does.
    void stop(Time now) noexcept TAPPET_REALTIME;
    /// In the thread that stopped it, when it is woken before the next start: the sender of a command that
    /// looked before the stop and posted after it gets its answer.
    void reject_late() noexcept TAPPET_REALTIME;

    /// Asks for a change in the life of one component; served between two steps (thesis 3.1.3). A component
    /// starts only when each of its required inputs has a valid value. Real-time, any thread.
    LifeTicket ask(std::uint32_t part, LifeChange change) noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer answer_to(std::uint32_t part, LifeTicket ticket) const noexcept TAPPET_REALTIME;
    /// Whether it is between start() and stop(). Real-time, any thread.
    [[nodiscard]] bool is_active() const noexcept TAPPET_REALTIME {
        return active_.load(std::memory_order_acquire); // no step: asked by whoever wants to know
    }
    /// Why it could not start while the rest of the machine runs: an input that another activity writes has
    /// no valid value. While it stands.
    [[nodiscard]] LifeAnswer readiness(Time now) noexcept TAPPET_REALTIME;
    /// A set of parts: bit i is part i.
    using Parts = std::uint64_t;
    /// Of parts that run by turns (thesis 3.1.3) some wait, and nobody starts one alone. From the start() of
    /// a part before them. Real-time.
    void rest(Parts waiting, Parts of_all) noexcept TAPPET_REALTIME {
        resting_ = (resting_ & ~of_all) | waiting;
        tell_resting();
    }
    /// From a step of a part before them: those parts start from what they read now; or all of them wait on,
    /// and the answer says which input was in the way. Real-time.
    [[nodiscard]] LifeAnswer enter(Parts entering) noexcept TAPPET_REALTIME;
    /// Likewise, of parts that run and run on: from what they read now. Refused: some have not begun anew.
    /// Real-time.
    [[nodiscard]] LifeAnswer begin_anew(Parts running) noexcept TAPPET_REALTIME;
    /// Likewise: they stop, and wait. Real-time.
    void leave(Parts leaving) noexcept TAPPET_REALTIME;
    /// Its thread hangs or broke a contract: its components are failed.
    void mark_failed() noexcept TAPPET_REALTIME;
    /// The component that decides itself when it runs, which is then the only one; null: none does.
    [[nodiscard]] const EnginePart* looping() const noexcept TAPPET_REALTIME {
        return plan_.parts.size() == 1 && plan_.parts.front().type->loop != nullptr ? &plan_.parts.front()
                                                                                    : nullptr;
    }
    /// What its running drivers watch ends waits of its thread, and nothing that a stopped one does.
    void heed_devices_of_running() noexcept TAPPET_REALTIME;
    /// The first part whose last stop() did not reach its device; the number of parts: there is none. Any
    /// thread.
    [[nodiscard]] std::size_t left_unsafe() const noexcept TAPPET_REALTIME;

    /// A connection row that wakes this engine has a value that an edge or a frame set off: the cycle that
    /// follows is counted as what the row led to. Of several rows the last. Real-time, any thread.
    void expect(WakingRow& row, Time cause) noexcept TAPPET_REALTIME {
        row.cause_ns.store(to_ns(cause), std::memory_order_relaxed); // no step: for the report
        waking_.store(&row, std::memory_order_release);              // no step: for the report
    }

    /// When it wants to run although nothing wakes it.
    [[nodiscard]] Time next_wake() const noexcept TAPPET_REALTIME {
        return serves_ == Serves::steps && awaiting_ == 0 ? next_release_ : earliest_wake();
    }

    [[nodiscard]] std::string_view name() const noexcept TAPPET_REALTIME { return plan_.name; }
    [[nodiscard]] const EnginePlan& plan() const noexcept TAPPET_REALTIME { return plan_; }
    [[nodiscard]] os::Waiter& waiter() noexcept TAPPET_REALTIME { return waiter_; }
    /// Its thread wants to be awake at that time. For whoever watches that it is.
    void sleeps_until(Time time) noexcept TAPPET_REALTIME {
        wakes_at_ns_.store(to_ns(time), std::memory_order_relaxed); // no step: looked at again and again
    }
    [[nodiscard]] Time wakes_at() const noexcept TAPPET_REALTIME {
        return at_ns(wakes_at_ns_.load(std::memory_order_relaxed)); // no step: looked at again and again
    }
    /// Somebody woke it, and it has not begun the cycle for that.
    [[nodiscard]] bool is_woken() const noexcept TAPPET_REALTIME { return waiter_.is_woken(); }
    [[nodiscard]] Inbox& inbox() noexcept TAPPET_REALTIME { return inbox_; }
    [[nodiscard]] CommandProcessor& commands() noexcept TAPPET_REALTIME { return commands_; }
    /// Of its thread, for what it runs.
    [[nodiscard]] os::Stamps& stamps() noexcept TAPPET_REALTIME { return stamps_; }
    [[nodiscard]] const Time* now_address() const noexcept { return &cycle_.now; }
    [[nodiscard]] Time now() const noexcept TAPPET_REALTIME { return cycle_.now; }
    [[nodiscard]] const EngineStatistics& statistics() const noexcept TAPPET_REALTIME { return statistics_; }
    /// Reading the thread's processor time enters the kernel, so that not every claim is measured.
    static constexpr std::uint32_t measured_at_first = 64, measured_one_of = 61;
    /// If it measures: as at first, from the next cycle on. In its thread.
    void measure_as_at_first() noexcept TAPPET_REALTIME {
        next_measured_ = measured_at_first;
        if (!measures_claim_) claim_began_ = Time::min(); // one that is not measured tells nothing
    }
    /// By how much the last claim that was measured to take more had exceeded it, at the end of the cycle in
    /// which it did. In its thread.
    [[nodiscard]] Duration claim_exceeded_by() const noexcept TAPPET_REALTIME { return claim_exceeded_by_; }
    /// Of what happened here in virtual time: every message, timer and transition with its time. Equal in two
    /// runs that did the same. Under real time no two runs are alike, and nothing is noted.
    [[nodiscard]] const Digest& digest() const noexcept TAPPET_REALTIME { return digest_; }
    /// Adds a transition of a behaviour to the digest.
    void note(std::uint64_t what, Time when) noexcept TAPPET_REALTIME {
        if (!clock_->is_virtual()) return;
        digest_.add(to_ns(when));
        digest_.add(what);
    }
    /// Odd while a cycle runs: an observer whose two readings differ, or are odd, reads again.
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
    /// Runs one function and times it. The end of one is the beginning of the next: one stamp each.
    template <class F>
    void timed(std::uint32_t part, FunctionKind kind, F&& body) noexcept TAPPET_REALTIME {
        timed(function(part, kind), body);
    }
    template <class F>
    void timed(FunctionTiming& timing, F&& body) noexcept TAPPET_REALTIME {
        body();
        end_of(timing);
    }
    // Out of line where a cycle seldom comes by, inlined in the loop over all components.
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
    /// What observers read changes from here to end_change(), which is given what this returns: a
    /// cycle, a start, a stop. is_changing: when a thread whose contract broke in its cycle stops upon it.
    static constexpr std::uint64_t is_changing = 0;
    [[nodiscard]] std::uint64_t begin_change() noexcept TAPPET_REALTIME {
        // The engine alone writes its generation, so this needs no operation that reads and writes at once;
        // a stop upon a cycle whose contract broke finds it odd and leaves it.
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
    /// Asks those of a running component for their ends. Of them all: whether they have come there.
    void stop_behaviours(std::uint32_t part) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool have_ended(std::uint32_t part) const noexcept TAPPET_REALTIME;
    void carry_out(std::uint32_t part, LifeTicket ticket, LifeChange wanted) noexcept TAPPET_REALTIME;
    void end_parts() noexcept TAPPET_REALTIME;
    void refuse_ending(std::uint32_t part) noexcept TAPPET_REALTIME;
    void end_forces(const EnginePart& part, FacetKind of) const noexcept TAPPET_REALTIME;
    static void begin_life(const EnginePart& part) noexcept TAPPET_REALTIME;
    /// Tells the gates of all parts which of them wait for their turn.
    void tell_resting() noexcept TAPPET_REALTIME;
    /// What the component writes reaches its readers from now on, or no longer.
    void cancel_timers(std::uint32_t part) noexcept TAPPET_REALTIME;
    static void say_at_rest(const EnginePart& part) noexcept TAPPET_REALTIME;
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
    /// In an activity without a period: whether an input grew stale since the last cycle.
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
    void end_period() noexcept TAPPET_REALTIME;
    /// Beside requests, commands and messages. What most activities have none of costs them nothing.
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
    Time claim_began_ = Time::min(); ///< a time of at_most
    Duration claim_used_{};
    os::Clock* clock_ = nullptr;
    os::Stamps stamps_{};
    Cycle cycle_{};
    /// How often it looks whether a component that waits for an input may start.
    static constexpr Duration awaiting_period = 10ms;
    std::atomic<bool> active_{false};
    std::atomic<bool> asked_{false}; ///< one of the parts has a request
    bool was_stopped_ = false;
    Time ends_at_ = never;       ///< of behaviours that were asked to end; never: they were not
    std::uint32_t awaiting_ = 0; ///< parts that wait for an input
    std::uint32_t ending_ = 0;   ///< parts whose stop waits for the end of their behaviours
    Parts resting_ = 0;          ///< parts that wait for their turn
    Time next_release_ = never;
    Time lap_{};
    Time ended_{};
    Time cause_{}; ///< of this cycle: of what woke it, or of the first message that has one
    std::atomic<WakingRow*> waking_{nullptr};
    Duration least_excess_{}; ///< from which on a function could be to blame: zero, or never
    Duration worst_excess_{}; ///< of this cycle; least_excess_: no function took longer than usual
    Duration worst_took_{};
    Duration worst_usual_{};
    std::uint32_t worst_function_ = Miss::nobody;
    CycleTape* recorded_ = nullptr;
    CycleTape* tape_ = nullptr; ///< of this cycle; null: it is not recorded
    CycleRecorder* recorder_ = nullptr;
    Duration quiet_response_{-1}; ///< one up to here is no maximum of anything and no miss
    Duration quiet_busy_{-1};     ///< likewise of a cycle that begins when it is released
    std::array<Time, max_wakes_watched> wakes_{};
    std::uint64_t wake_count_ = 0;
    std::uint64_t oldest_wake_ = 0; ///< its place
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
