// Starting and stopping parts of a running machine (thesis 3.1.3, 4.2.2).
#pragma once

#include "kernel/machine/instance/placed.hpp"

#include <array>
#include <atomic>

namespace tappet {

/// Lets a world start and stop the engine of an activity. Called by the supervisor's thread; none of these
/// functions makes it wait for a function of a component.
struct ActivityControl {
    /// lost: the thread hangs, or broke a contract.
    enum class Progress : std::uint8_t { pending, done, lost };
    void* world = nullptr;
    void (*start)(void* world, std::size_t activity) = nullptr;
    Progress (*started)(void* world, std::size_t activity) = nullptr;
    void (*stop)(void* world, std::size_t activity) = nullptr;
    Progress (*stopped)(void* world, std::size_t activity) = nullptr;
    /// Runs MachineLife::run_makers_functions, on a thread that nobody waits for.
    void (*run_makers_functions)(void* world) = nullptr;
};

/// The life of components and activities. Requests are real-time, on any thread.
class MachineLife {
public:
    MachineLife(PlacedMachine& placed, os::Waiter& supervisor) noexcept
        : placed_{placed}, machine_{placed.machine()}, supervisor_{supervisor} {}

    /// Starts, stops or restarts one component while the others run: its engine does it between two steps,
    /// and answers.
    LifeTicket ask_component(std::size_t index, LifeChange change) noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer answer_of_component(std::size_t index, LifeTicket ticket) noexcept
        TAPPET_REALTIME;
    [[nodiscard]] ComponentState state_of(std::size_t component) noexcept TAPPET_REALTIME;
    /// Starts, stops or restarts a whole activity, with initialise and finalise of its components.
    LifeTicket ask_activity(std::size_t index, LifeChange change) noexcept TAPPET_REALTIME;
    [[nodiscard]] LifeAnswer answer_of_activity(std::size_t index, LifeTicket ticket) const noexcept
        TAPPET_REALTIME;
    /// Describes a refusal, with its cure; empty when nothing was refused. Not real-time.
    [[nodiscard]] Sentence describe(std::size_t activity, LifeAnswer answer) const;

    // ---- for worlds, on the supervisor's thread; not real-time. Several activities may change at the same
    // time, in steps: stop, finalise, initialise, start. Only finalise and initialise wait for those of
    // others.

    enum class Begin : std::uint8_t {
        with_the_machine, ///< whatever its components read from other activities
        alone             ///< the values read from other activities must be valid
    };
    /// Begins a change of an activity that is not changing yet.
    void begin_change(std::size_t index, LifeChange change, Begin begin, const ActivityControl& control);
    /// Begins the finalising of a stopped activity, when no other changes; false: nothing needs finalising.
    [[nodiscard]] bool begin_finalising(std::size_t index, const ActivityControl& control);
    /// Advances all changes as far as possible without waiting.
    void progress(const ActivityControl& control);
    [[nodiscard]] bool changes(std::size_t index) const noexcept {
        return changes_[index].phase != Phase::none;
    }
    /// Whether any activity is changing.
    [[nodiscard]] bool changes() const noexcept;
    /// Begins the requested changes.
    void serve_activity_requests(const ActivityControl& control);
    /// The machine stops: abandons all changes and refuses their requests.
    void give_up_changes();
    /// Returns the refusal of the last change that was not requested from outside; empty: it was done.
    [[nodiscard]] const Sentence& refusal() const noexcept { return refusal_; }
    /// Whether initialise or finalise of a component of activity makers_of() runs, or is about to.
    [[nodiscard]] bool makers_at_work() const noexcept {
        return makers_at_work_.load(std::memory_order_acquire);
    }
    [[nodiscard]] std::size_t makers_of() const noexcept { return makers_of_; }
    /// Runs the initialise and finalise functions that changes need now; mostly none. On one thread.
    void run_makers_functions();
    /// Marks the activity's thread as given up.
    void lose(std::size_t activity) noexcept { thread_lost_[activity] = true; }
    /// Whether nothing runs: no activity, no thread that was given up while it hung, no initialise or
    /// finalise.
    [[nodiscard]] bool stands() const noexcept;
    /// Returns the first driver whose last stop() did not reach its device; empty: none. Real-time, any
    /// thread.
    [[nodiscard]] std::string_view left_unsafe() const noexcept;

private:
    enum class Phase : std::uint8_t { none, stopping, waiting_for_makers, makers, starting };
    struct Change {
        LifeChange wanted{};
        Begin begin{};
        Phase phase = Phase::none;
        bool was_asked = false;
        LifeTicket ticket{};
        LifeAnswer answer{.outcome = LifeOutcome::done};
    };
    void begin(std::size_t index, const ActivityControl& control);
    void progress(std::size_t index, const ActivityControl& control);
    void let_makers_work(const ActivityControl& control);
    void end_change(std::size_t index, const Sentence& refusal);
    void end_stop(std::size_t index);
    void end_refused(std::size_t index, LifeAnswer answer) {
        changes_[index].answer = answer;
        end_change(index, describe(index, answer));
    }

    PlacedMachine& placed_;
    const AcceptedMachine& machine_;
    os::Waiter& supervisor_;
    std::array<LifeRequests, max_activities> activity_requests_{};
    std::array<bool, max_activities> thread_lost_{};
    std::array<bool, max_activities> is_initialised_{}; ///< written by run_makers_functions()
    std::array<Change, max_activities> changes_{};
    Sentence refusal_{};
    std::size_t makers_of_ = 0;
    Sentence makers_refusal_{}; ///< result of the makers' functions; read when they do not run
    LifeAnswer makers_answer_{};
    std::atomic<bool> makers_at_work_{false};
    std::atomic<bool> is_given_up_{false};
};

} // namespace tappet
