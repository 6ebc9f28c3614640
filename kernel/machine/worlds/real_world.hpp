// The real world: every activity in a thread of its own, armed only when the box is fit for it, supervised,
// and stopped in a defined order by a thread that runs no function of a component.
#pragma once

#include "kernel/activity/activity.hpp"
#include "kernel/base/contract.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/worlds/makers_thread.hpp"
#include "kernel/os/arming.hpp"
#include "kernel/os/latency.hpp"

#include <array>
#include <atomic>
#include <expected>
#include <string_view>

namespace tappet {

/// Life cycle: configure -> arm -> start -> (supervise) -> stop. One at a time in a process. Called by one
/// thread, the supervisor's; not real-time.
class RealWorld {
public:
    /// How long a thread may take to start or to stop before it counts as hung. A thread that may block, and
    /// is stopped alone, has more time; when the machine stops, each hanging thread gets half of the
    /// remaining time.
    static constexpr int patience_ms = 500, least_patience_ms = 100, patience_beside_ms = 10'000;
    static_assert(Activity::end_within < patience_ms * 1ms, "who comes to an end does not hang");
    /// How long initialise and finalise of one activity may delay the start and the end of the machine.
    static constexpr Duration makers_within = 30s;
    static constexpr std::size_t max_breaches = 8;

    /// The instance has a real clock, and is configured before it is armed.
    explicit RealWorld(MachineInstance& instance) noexcept;
    ~RealWorld();
    RealWorld(const RealWorld&) = delete;
    RealWorld& operator=(const RealWorld&) = delete;

    /// Starts the threads, which wait; then checks everything the machine relies on, seals the heap and locks
    /// the memory. Nothing: the report on `file` states each reason with its cure; nothing has moved.
    [[nodiscard]] std::optional<Armed> arm(os::ArmingReport& report, int file);

    /// Starts the activities in the table's order; each is initialised on the makers' thread. False: one was
    /// not started and refusal() says why, or a stop was requested meanwhile and refusal() is empty. Started
    /// activities run until make_safe().
    [[nodiscard]] bool start(Armed);
    [[nodiscard]] const Sentence& refusal() const noexcept { return refusal_; }

    /// Starts, stops or restarts one activity while the others run. initialise and finalise of its components
    /// run on the makers' thread; its own thread is kept. Returns the reason of a failure; empty: done. A
    /// stop that is requested meanwhile interrupts the change.
    [[nodiscard]] Sentence change_activity(std::size_t activity, LifeChange change);

    /// Sleeps until a stop is requested, possibly by a termination signal (see on_termination), or `time` has
    /// passed. Meanwhile it serves the requests to activities, and waits for none of their functions. Returns
    /// true while the machine runs.
    bool supervise(Duration time);

    /// Stops the activities from the last row of the table to the first, each on its own thread: list drivers
    /// first, so that the safe values of the others still reach the wires. Waits for no function of a
    /// component longer than the board's stop_within, as far as the threads get their processors. Returns how
    /// many threads hung: the outputs of their components are unchanged, and only the end of the process and
    /// a guardian make them safe.
    int make_safe();
    /// Calls make_safe(), then finalises what was initialised, and ends the threads. Returns like
    /// make_safe().
    int stop();

    /// The result of the last make_safe().
    [[nodiscard]] int hung() const noexcept { return hung_; }
    /// The number of threads that broke a contract; each left its safe values nevertheless, or hung.
    [[nodiscard]] int lost() const noexcept;
    /// The activity whose thread hung first; empty: none.
    [[nodiscard]] std::string_view first_hung() const noexcept { return first_hung_; }
    /// Says after stop() why not everything is finalised; empty: it is.
    [[nodiscard]] const Sentence& unfinished() const noexcept { return unfinished_; }
    /// Sets a function that the supervisor's thread calls repeatedly while it waits for other threads.
    void show_life_by(void* context, void (*call)(void* context)) noexcept {
        life_context_ = context;
        show_life_ = call;
    }

    [[nodiscard]] const Activity& activity(std::size_t index) const noexcept { return activities_[index]; }
    /// Describes the first broken contract, whether or not it stopped the machine; empty: none.
    [[nodiscard]] Sentence broken_contract() const noexcept {
        return breaches() == 0 ? Sentence{} : describe_breach(0);
    }
    /// The number of contracts broken since the start, including the stop; the first max_breaches are kept.
    [[nodiscard]] std::size_t breaches() const noexcept { return breaches_.load(std::memory_order_acquire); }
    [[nodiscard]] Sentence describe_breach(std::size_t index) const noexcept;
    [[nodiscard]] std::uint64_t page_faults_in_real_time_threads() const noexcept;

private:
    static void on_breach(const ContractViolation& breach) noexcept TAPPET_REALTIME;
    void keep(const ContractViolation& breach) noexcept TAPPET_REALTIME;
    static void on_signal(int) noexcept;
    [[nodiscard]] ActivityControl control() noexcept;
    [[nodiscard]] ActivityControl::Progress progress_of(std::size_t activity, bool is_there, int patience);
    void ask_to_stop(std::size_t activity, int patience) noexcept;
    void break_loops() noexcept;
    /// Sleeps until a change may have made progress, until `end` at most.
    void wait_for_change(Time end);
    /// False: a stop was requested, or the makers' functions take too long.
    [[nodiscard]] bool complete_change(std::size_t activity, Duration makers_time);
    [[nodiscard]] bool makers_took(Duration time) const;
    /// Waits for the makers' functions while nothing else is left to do; false: they take too long.
    [[nodiscard]] bool await_makers();
    [[nodiscard]] Sentence makers_too_long() const;
    void count_hung(std::size_t activity) noexcept;
    /// Whether other activities use the values that its components leave when they stop.
    [[nodiscard]] bool reaches_others(std::size_t activity) const;
    void give_up(std::size_t activity) noexcept;

    MachineInstance& instance_;
    std::array<Activity, max_activities> activities_{};
    os::CpuDmaLatency latency_{};
    struct KeptBreach {
        ContractViolation breach{};
        std::atomic<bool> complete{false};
    };
    std::array<KeptBreach, max_breaches> kept_breaches_{};
    std::atomic<std::size_t> breaches_{0};
    Sentence refusal_{};
    MakersThread makers_{};  ///< initialise and finalise
    MakersThread breaker_{}; ///< break_loop
    alignas(4096) std::array<std::byte, 256 * 1024> makers_stack_{};
    alignas(4096) std::array<std::byte, 64 * 1024> breakers_stack_{};
    static_assert(max_activities <= 64);
    std::atomic<std::uint64_t> loops_to_break_{0}; ///< a bit for each activity
    std::array<Time, max_activities> began_{};     ///< start of the step that its change waits for
    Time makers_began_{};
    int hung_ = 0;
    std::string_view first_hung_{};
    Sentence unfinished_{};
    bool is_armed_ = false; ///< its threads exist
    bool is_safe_ = false;  ///< nothing started since the last stop
    void (*show_life_)(void*) = nullptr;
    void* life_context_ = nullptr;
};

} // namespace tappet
