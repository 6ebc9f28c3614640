// The real world: every activity in a thread of its own, armed only when the box is fit for it, supervised,
// and stopped in a stated order.
#pragma once

#include "kernel/activity/activity.hpp"
#include "kernel/base/contract.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/os/arming.hpp"
#include "kernel/os/latency.hpp"

#include <array>
#include <atomic>
#include <expected>
#include <string_view>

namespace tappet {

/// Life: configure -> arm -> start -> (supervise) -> stop. One at a time in a process. Called by one thread,
/// the supervisor's; not real-time.
class RealWorld {
public:
    /// How long an activity may take to start or to stop before its thread counts as hung.
    static constexpr int patience_ms = 500;
    static_assert(Activity::end_within < patience_ms * 1ms, "who comes to an end does not hang");
    /// How long all activities that are not real-time, together, may hold up the stop of those that are: they
    /// may block. Who is not stopped by then is waited for when the others stand.
    static constexpr int grace_ms = 20;
    static constexpr std::size_t max_breaches = 8;

    /// Its clock is real; it is configured before it is armed.
    explicit RealWorld(MachineInstance& instance) noexcept;
    ~RealWorld();
    RealWorld(const RealWorld&) = delete;
    RealWorld& operator=(const RealWorld&) = delete;

    /// Starts the threads, which wait; then looks at everything the machine relies on, seals the heap and
    /// locks the memory. Nothing: the report says why, on `file`, each reason with its cure; nothing has
    /// moved.
    [[nodiscard]] std::optional<Armed> arm(os::ArmingReport& report, int file);

    /// Activities start in the table's order, each initialised on this thread. False: one did not, refusal()
    /// says why; the machine is stopped again.
    [[nodiscard]] bool start(Armed);
    [[nodiscard]] const Sentence& refusal() const noexcept { return refusal_; }

    /// Starts, stops or restarts one activity while the others run; initialise and finalise of its components
    /// run on this thread, its own thread is kept. Empty: done; else why not.
    [[nodiscard]] Sentence change_activity(std::size_t activity, LifeChange change);

    /// Sleeps until a stop is asked for, a signal that asks to end (see on_termination) came, or `time`
    /// passed; serves the requests to activities meanwhile. True while the machine runs.
    bool supervise(Duration time);

    /// Activities stop from the last row of the table to the first: list drivers first, so that the safe
    /// values of the others still reach the wires; who is not real-time and blocks holds nobody up for long.
    /// Returns how many threads hung; their components were stopped in their place.
    int stop();

    /// Of the last stop(), the one of a refused start included.
    [[nodiscard]] int hung() const noexcept { return hung_; }
    /// Called on the supervisor's thread before each change of an activity that somebody asked for.
    void before_changes(void* context, void (*call)(void* context)) noexcept {
        before_context_ = context;
        before_change_ = call;
    }

    [[nodiscard]] const Activity& activity(std::size_t index) const noexcept { return activities_[index]; }
    /// The first contract that was broken, be it what stopped the machine or not; empty when none was.
    [[nodiscard]] Sentence broken_contract() const noexcept {
        return breaches() == 0 ? Sentence{} : describe_breach(0);
    }
    /// Contracts broken since the start, during the stop too; of the first max_breaches each is kept.
    [[nodiscard]] std::size_t breaches() const noexcept { return breaches_.load(std::memory_order_acquire); }
    [[nodiscard]] Sentence describe_breach(std::size_t index) const noexcept;
    [[nodiscard]] std::uint64_t page_faults_in_real_time_threads() const noexcept;

private:
    static void on_breach(const ContractViolation& breach) noexcept TAPPET_REALTIME;
    void keep(const ContractViolation& breach) noexcept TAPPET_REALTIME;
    static void on_signal(int) noexcept;
    [[nodiscard]] ActivityControl control() noexcept;
    [[nodiscard]] bool stop_engine(std::size_t activity) noexcept;

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
    int hung_ = 0;
    void (*before_change_)(void*) = nullptr;
    void* before_context_ = nullptr;
};

} // namespace tappet
