// The real world: every activity in a thread of its own, armed only when the box is fit for it, supervised,
// and stopped in a stated order.
#pragma once

#include "kernel/activity/activity.hpp"
#include "kernel/machine/instance.hpp"
#include "kernel/os/arming.hpp"
#include "kernel/os/latency.hpp"

#include <array>
#include <expected>
#include <string_view>

namespace tappet {

/// Life: configure -> arm -> start -> (supervise) -> stop. One at a time in a process. Called by one thread,
/// the supervisor's; not real-time.
class RealWorld {
public:
    /// How long an activity may take to start or to stop before its thread counts as hung.
    static constexpr int patience_ms = 500;

    /// The instance is configured and its clock is real.
    explicit RealWorld(MachineInstance& instance) noexcept;
    ~RealWorld();
    RealWorld(const RealWorld&) = delete;
    RealWorld& operator=(const RealWorld&) = delete;

    /// Starts the threads, which wait; then looks at everything the machine relies on, seals the heap and
    /// locks the memory. False: the report says why, on `file`, each reason with its cure; nothing has moved.
    [[nodiscard]] bool arm(os::ArmingReport& report, int file);

    /// Activities start in the table's order, each initialised on this thread. False: one did not, refusal()
    /// says why; the machine is stopped again.
    [[nodiscard]] bool start();
    [[nodiscard]] const Sentence& refusal() const noexcept { return refusal_; }

    /// Starts, stops or restarts one activity while the others run; initialise and finalise of its components
    /// run on this thread, its own thread is kept. Empty: done; else why not.
    [[nodiscard]] Sentence change_activity(std::size_t activity, LifeChange change);

    /// Sleeps until a stop is asked for, a signal (INT, TERM) came, or `time` passed; serves the requests to
    /// activities meanwhile. True while the machine runs.
    bool supervise(Duration time);

    /// Activities stop from the last row of the table to the first: list drivers first, so that the safe
    /// values of the others still reach the wires. Returns how many threads hung; their components were
    /// stopped in their place.
    int stop();

    [[nodiscard]] const Activity& activity(std::size_t index) const noexcept { return activities_[index]; }
    /// The broken contract that stopped the machine; empty when none did.
    [[nodiscard]] const Sentence& broken_contract() const noexcept { return breach_; }
    [[nodiscard]] std::uint64_t page_faults_in_real_time_threads() const noexcept;

private:
    static void on_breach(const struct Breach& breach) noexcept TAPPET_REALTIME;
    static void on_signal(int) noexcept;
    [[nodiscard]] ActivityControl control() noexcept;
    [[nodiscard]] bool stop_engine(std::size_t activity) noexcept;

    MachineInstance& instance_;
    std::array<Activity, checks::max_activities> activities_{};
    os::CpuDmaLatency latency_{};
    Sentence breach_{};
    Sentence refusal_{};
};

} // namespace tappet
