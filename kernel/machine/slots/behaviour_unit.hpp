// A placed unit of behaviour: each state machine and program of a compiled or loaded script with its data,
// its links and its command slots, in one block of memory of known size. One engine steps it.
#pragma once

#include "kernel/component/output_gate.hpp"
#include "kernel/machine/table/unit_rows.hpp"
#include "kernel/program/execution.hpp"
#include "kernel/statechart/execution.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace tappet {

class MachineInstance;
class Engine;

/// One instance of a unit; it has exactly one of the two executions.
struct UnitPart {
    const BehaviourInstance* row = nullptr;
    const BehaviourType* type = nullptr;
    StateMachineExecution* machine = nullptr;
    ProgramExecution* program = nullptr;
    std::byte* data = nullptr;
    ProgramLink* links = nullptr;
    CommandSlot* slots = nullptr;
    std::size_t slot_count = 0;
    bool begins_anew = false; ///< after it has reached its final state
    /// Set when a command waits for it to come to rest: the activity polls for this many further steps, since
    /// commands are followed before behaviours are stepped.
    std::uint8_t awaited = 0;
    StateMachineBinding binding{}; ///< of a state machine, for binding it again

    [[nodiscard]] bool has_failed() const noexcept TAPPET_REALTIME {
        return machine != nullptr ? machine->in_error() : program->status() == ProgramStatus::error;
    }
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME {
        return machine != nullptr ? machine->left_over() : program->left_over();
    }
};

/// Whether a program has ended or was stopped, or a machine is in its final state or inactive. Real-time.
inline bool is_at_rest(const UnitPart& part) noexcept TAPPET_REALTIME {
    if (part.machine != nullptr)
        return !part.machine->is_active() || (part.machine->is_final() && !part.machine->under_way());
    return !part.program->is_at_work();
}

inline void await_rest(UnitPart& part) noexcept TAPPET_REALTIME { part.awaited = 2; }

/// The trigger of an instance for an event; no_trigger: none.
struct UnitRoute {
    TriggerIndex trigger = no_trigger;
};

/// A gate that is open while one of these states is active, from before its entry program to after its exit
/// program, and its machine is not in error. Judged after each step of the unit and after each event.
struct StateGate {
    struct Where {
        InstanceIndex instance = no_instance;
        StateIndex state = no_state;
    };
    static constexpr std::size_t most_states = 16;

    OutputGate gate{};
    Bounded<Where, most_states> open_in{};
    Waker driver{}; ///< of the output
    StateGate* next = nullptr;
};

/// Not real-time except where stated. place() only while no engine steps it.
class BehaviourUnit {
public:
    /// Places the unit. `driven`: the component. `events` are the names that its routes count; they and
    /// everything in `unit` must outlive it. The error: the unit does not fit, or names something that the
    /// machine does not have; then it must not be started.
    [[nodiscard]] Sentence place(const ScriptUnit& unit, std::span<const BehaviourCode> code,
                                 const BehaviourOptions& options, std::span<std::byte> memory,
                                 std::span<const std::string_view> events, MachineInstance& machine,
                                 std::size_t driven);
    /// Connects its links to components, once all units are placed: a link may lead to a task that is a
    /// variable of another unit.
    void connect_links();
    [[nodiscard]] std::span<UnitPart> parts() noexcept TAPPET_REALTIME { return parts_; }
    [[nodiscard]] std::span<const UnitPart> parts() const noexcept TAPPET_REALTIME { return parts_; }
    [[nodiscard]] const ScriptUnit& unit() const noexcept TAPPET_REALTIME { return unit_; }
    /// Whether any of its state machines hears the event of that number.
    [[nodiscard]] bool hears(std::size_t event) const noexcept TAPPET_REALTIME;
    /// Whether none of its commands is in progress: its memory may be reused.
    [[nodiscard]] bool is_quiet() const noexcept TAPPET_REALTIME;
    [[nodiscard]] bool has_programs() const noexcept { return has_programs_; }
    /// Adds a gate that outlives it; after place().
    void add_gate(StateGate& gate) noexcept {
        gate.next = gates_;
        gates_ = &gate;
    }
    void trace(StateMachineExecution::Trace hook, void* context) noexcept;

    // Real-time, in the component's engine.

    /// Starts its root machines; their children start on request. A machine that is still on its way to the
    /// final state completes that first: what makes the component safe is not interrupted.
    void start(Time now) noexcept TAPPET_REALTIME;
    /// Steps the programs alone; the engine does so before it steps any state machine (thesis fig. 5.21).
    /// False: it has none.
    bool step_programs(Time now) noexcept TAPPET_REALTIME;
    /// Steps the state machines.
    bool step(Time now) noexcept TAPPET_REALTIME;
    /// Requests the final states; machines that cannot go at once follow in the next steps.
    void finish(Time now, std::string_view reason) noexcept TAPPET_REALTIME;
    /// Whether finish() is complete, or cannot complete: a machine in error stays where it is.
    [[nodiscard]] bool is_finished() const noexcept TAPPET_REALTIME;
    /// Leaves the final states. A second call continues without a program that failed in the first.
    void deactivate(Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool is_active() const noexcept TAPPET_REALTIME;
    /// True between start() and finish(): outside of it nothing begins.
    [[nodiscard]] bool may_begin() const noexcept TAPPET_REALTIME { return may_begin_; }
    /// While the component does not run, nothing of the unit runs, not even on request.
    [[nodiscard]] bool component_runs() const noexcept TAPPET_REALTIME;
    /// Makes it inactive at once, whatever was in progress: no program of it runs.
    void drop() noexcept TAPPET_REALTIME;
    /// Returns the first instance in error; null: none.
    [[nodiscard]] const UnitPart* failed_part() const noexcept TAPPET_REALTIME;
    /// Whether an event reached it or a program of it ran since the last call.
    [[nodiscard]] bool has_worked() noexcept TAPPET_REALTIME;
    /// Whether the last step used up its statements with more to do.
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME;
    /// Records which instance is in error, for describe_fault().
    void note_fault() noexcept TAPPET_REALTIME;
    /// Applies the row's policy for errors after a step, once for each error.
    void report_errors() noexcept TAPPET_REALTIME {
        if (has_failed_ && !reported_) report_failure();
    }
    [[nodiscard]] Time next() const noexcept TAPPET_REALTIME;
    void dispatch(std::size_t event, const std::byte* packed, Time now) noexcept TAPPET_REALTIME;

    /// Increases with each place(): pointers found before it are no longer valid.
    [[nodiscard]] std::uint32_t placed() const noexcept TAPPET_REALTIME { return placed_; }
    /// The number of steps that left statements over, since place().
    [[nodiscard]] std::uint64_t steps_left_over() const noexcept TAPPET_REALTIME { return left_over_; }
    /// Says what failed last: instance, program and line. Not real-time.
    [[nodiscard]] Sentence describe_fault() const;

private:
    void bind(UnitPart& part, const BehaviourCode& native, const ResolvedView& view);
    [[gnu::cold]] void report_failure() noexcept TAPPET_REALTIME;
    void limit_work(Time now) noexcept TAPPET_REALTIME;
    void begin_anew(UnitPart& part, Time now) noexcept TAPPET_REALTIME;
    void judge_gates() noexcept TAPPET_REALTIME;

    ScriptUnit unit_{};
    BehaviourOptions options_{};
    MachineInstance* machine_ = nullptr;
    const Engine* engine_ = nullptr;
    WorkLimit limit_{}; ///< for types that are interpreted from memory
    std::size_t driven_ = 0;
    std::span<UnitPart> parts_{};
    std::uint64_t left_over_ = 0;
    std::uint32_t placed_ = 0;
    Time stepped_at_{};
    struct {
        InstanceIndex instance = no_instance;
        std::uint16_t line = 0; // of a program
        StateMachineFault machine{};
    } fault_;
    bool has_failed_ = false; // after the last step
    bool reported_ = false;
    bool has_worked_ = false; // before limit_ was reset, or by an event
    bool may_begin_ = false;
    bool has_programs_ = false;
    StateMachineExecution::Trace trace_ = nullptr;
    void* trace_context_ = nullptr;
    StateGate* gates_ = nullptr;
    std::span<const UnitRoute> routes_{}; // [event * instances + instance]
};

} // namespace tappet
