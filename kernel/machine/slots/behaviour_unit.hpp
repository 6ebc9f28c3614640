// A unit of behaviour come to life: each state machine and program of a compiled or loaded script with its
// data, its links and its command slots, in one piece of memory of a size known before. One engine steps it.
#pragma once

#include "kernel/machine/table/unit_rows.hpp"
#include "kernel/program/execution.hpp"
#include "kernel/statechart/execution.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace tappet {

class MachineInstance;
class Engine;

/// One instance of a unit; it has either of the two executions.
struct UnitPart {
    const BehaviourInstance* row = nullptr;
    const BehaviourType* type = nullptr;
    StateMachineExecution* machine = nullptr;
    ProgramExecution* program = nullptr;
    std::byte* data = nullptr;
    ProgramLink* links = nullptr;
    CommandSlot* slots = nullptr;
    std::size_t slot_count = 0;
    bool begins_anew = false; ///< once it has come to its final state
    /// A command waits for it to come to rest: for so many steps from then on its activity looks again, since
    /// commands are followed before behaviours are stepped.
    std::uint8_t awaited = 0;
    StateMachineBinding binding{}; ///< of a machine, to bind it anew

    [[nodiscard]] bool has_failed() const noexcept TAPPET_REALTIME {
        return machine != nullptr ? machine->in_error() : program->status() == ProgramStatus::error;
    }
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME {
        return machine != nullptr ? machine->left_over() : program->left_over();
    }
};

/// A program that has ended or was stopped, a machine in its final state or in none. Real-time.
inline bool is_at_rest(const UnitPart& part) noexcept TAPPET_REALTIME {
    if (part.machine != nullptr)
        return !part.machine->is_active() || (part.machine->is_final() && !part.machine->under_way());
    return !part.program->is_at_work();
}

inline void await_rest(UnitPart& part) noexcept TAPPET_REALTIME { part.awaited = 2; }

/// The trigger of an instance that an event means; no_trigger: none.
struct UnitRoute {
    TriggerIndex trigger = no_trigger;
};

/// Not real-time but for what says so. place() while nobody steps it.
class BehaviourUnit {
public:
    /// `driven`: the component. `events` name what its routes count, and outlive it as everything in `unit`
    /// does. An error: it does not fit, or names what the machine does not have; then it must not be started.
    [[nodiscard]] Sentence place(const ScriptUnit& unit, std::span<const BehaviourCode> code,
                                 const BehaviourOptions& options, std::span<std::byte> memory,
                                 std::span<const std::string_view> events, MachineInstance& machine,
                                 std::size_t driven);
    /// What it touches of components, once all units are placed: of a task that is a variable of one.
    void connect_links();
    [[nodiscard]] std::span<UnitPart> parts() noexcept TAPPET_REALTIME { return parts_; }
    [[nodiscard]] std::span<const UnitPart> parts() const noexcept TAPPET_REALTIME { return parts_; }
    [[nodiscard]] const ScriptUnit& unit() const noexcept TAPPET_REALTIME { return unit_; }
    /// Whether any of its state machines hears the event of that number.
    [[nodiscard]] bool hears(std::size_t event) const noexcept TAPPET_REALTIME;
    /// None of its commands is on its way: its memory may be used anew.
    [[nodiscard]] bool is_quiet() const noexcept TAPPET_REALTIME;
    [[nodiscard]] bool has_programs() const noexcept { return has_programs_; }
    void trace(StateMachineExecution::Trace hook, void* context) noexcept;

    // Real-time, in the component's engine.

    /// Its roots start; their children when they are told to. One that is still on its way to the final state
    /// first comes to its end: what makes the component safe is not broken off.
    void start(Time now) noexcept TAPPET_REALTIME;
    /// The programs alone; their engine does so before it steps any state machine (thesis fig. 5.21). False:
    /// there is none.
    bool step_programs(Time now) noexcept TAPPET_REALTIME;
    /// The state machines.
    bool step(Time now) noexcept TAPPET_REALTIME;
    /// Into the final states; those that cannot go at once follow in the next steps.
    void finish(Time now, std::string_view reason) noexcept TAPPET_REALTIME;
    /// Whether finish() has come to its end, or cannot: a machine in error stays where it is.
    [[nodiscard]] bool is_finished() const noexcept TAPPET_REALTIME;
    /// Out of the final states. A second call goes on without a program that failed in the first.
    void deactivate(Time now) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool is_active() const noexcept TAPPET_REALTIME;
    /// Between start() and finish(): outside of it nothing begins.
    [[nodiscard]] bool may_begin() const noexcept TAPPET_REALTIME { return may_begin_; }
    /// While it does not, nothing of the unit runs, whoever asks.
    [[nodiscard]] bool component_runs() const noexcept TAPPET_REALTIME;
    /// Inactive from now on, whatever was in hand: no program of it runs.
    void drop() noexcept TAPPET_REALTIME;
    /// The first instance in error; null: none is.
    [[nodiscard]] const UnitPart* failed_part() const noexcept TAPPET_REALTIME;
    /// Whether it was told an event or a program of it ran since this was asked last.
    [[nodiscard]] bool has_worked() noexcept TAPPET_REALTIME;
    /// The last step used up its statements with more to do.
    [[nodiscard]] bool left_over() const noexcept TAPPET_REALTIME;
    /// Keeps which instance is in error, for describe_fault().
    void note_fault() noexcept TAPPET_REALTIME;
    /// After a step: does what the row says about errors, once for each.
    void report_errors() noexcept TAPPET_REALTIME {
        if (has_failed_ && !reported_) report_failure();
    }
    [[nodiscard]] Time next() const noexcept TAPPET_REALTIME;
    void dispatch(std::size_t event, const std::byte* packed, Time now) noexcept TAPPET_REALTIME;

    /// Rises with each place(): what was found in it before holds no longer.
    [[nodiscard]] std::uint32_t placed() const noexcept TAPPET_REALTIME { return placed_; }
    /// Steps that left statements over, since place().
    [[nodiscard]] std::uint64_t steps_left_over() const noexcept TAPPET_REALTIME { return left_over_; }
    /// What failed last: instance, program and line. Not real-time.
    [[nodiscard]] Sentence describe_fault() const;

private:
    void bind(UnitPart& part, const BehaviourCode& native, const ResolvedView& view);
    [[gnu::cold]] void report_failure() noexcept TAPPET_REALTIME;
    void limit_work(Time now) noexcept TAPPET_REALTIME;
    void begin_anew(UnitPart& part, Time now) noexcept TAPPET_REALTIME;

    ScriptUnit unit_{};
    BehaviourOptions options_{};
    MachineInstance* machine_ = nullptr;
    const Engine* engine_ = nullptr;
    WorkLimit limit_{}; ///< of what runs in memory
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
    bool has_worked_ = false; // before limit_ began anew, or by an event
    bool may_begin_ = false;
    bool has_programs_ = false;
    StateMachineExecution::Trace trace_ = nullptr;
    void* trace_context_ = nullptr;
    std::span<const UnitRoute> routes_{}; // [event * instances + instance]
};

} // namespace tappet
