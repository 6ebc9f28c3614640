// An activity (thesis 4.2.2): an engine and the thread that runs it, from start to stop, under real time.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/os/faults.hpp"
#include "kernel/os/thread.hpp"

#include <atomic>
#include <expected>
#include <span>

namespace tappet {

/// initialise and finalise run on the starter's thread, before and after the thread lives; start, cycles and
/// stop of the engine run on its own. Not real-time but for what the thread does.
class Activity {
public:
    enum class State : std::uint8_t { inactive, starting, waiting, running, stopping, stopped, parked };

    Activity() = default;
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;

    /// `stack` is painted and touched here. The thread waits for release().
    std::expected<void, Sentence> create(Engine& engine, const os::Clock& clock, int priority, int processor,
                                         std::span<std::byte> stack);
    /// Lets the thread start its engine; true when that is done within `milliseconds`.
    [[nodiscard]] bool release(int milliseconds) noexcept;
    /// Ends the cycles, lets the engine stop on its own thread, and joins it; false when it did not within
    /// `milliseconds`: its thread hangs, and whoever called may claim the engine's stop and run it.
    [[nodiscard]] bool stop(int milliseconds) noexcept;
    /// True once, for the one who then runs the engine's stop: its own thread, or whoever gave that up.
    /// Real-time.
    [[nodiscard]] bool claim_engine_stop() noexcept TAPPET_REALTIME {
        return !engine_stop_claimed_.exchange(true, std::memory_order_acq_rel);
    }
    /// After a stop that failed: nobody waits for its thread any more.
    void abandon() noexcept { thread_.abandon(); }
    /// For a thread that must not go on (a broken contract): it says so and sleeps for ever. Real-time.
    [[noreturn]] void park() noexcept TAPPET_REALTIME;

    [[nodiscard]] State state() const noexcept TAPPET_REALTIME {
        return state_.load(std::memory_order_acquire);
    }
    [[nodiscard]] Engine& engine() const noexcept TAPPET_REALTIME { return *engine_; }
    /// Page faults of its thread from its first cycle to its stop; complete when stopped.
    [[nodiscard]] os::PageFaults page_faults() const noexcept { return faults_; }
    [[nodiscard]] std::size_t stack_high_water_bytes() const noexcept;
    [[nodiscard]] std::size_t stack_bytes() const noexcept { return plan_.stack.size(); }

    /// The activity of the calling thread; null outside. Real-time.
    [[nodiscard]] static Activity* current() noexcept TAPPET_REALTIME;

private:
    static void enter(void* self) noexcept;
    void live() noexcept;
    void cycles() noexcept TAPPET_REALTIME;
    [[nodiscard]] bool wait_for(State wanted, int milliseconds) const noexcept;

    Engine* engine_ = nullptr;
    const os::Clock* clock_ = nullptr;
    os::ThreadPlan plan_{};
    os::Thread thread_{};
    std::atomic<State> state_{State::inactive};
    std::atomic<bool> released_{false};
    std::atomic<bool> stop_asked_{false};
    std::atomic<bool> engine_stop_claimed_{false};
    os::PageFaults faults_{};
};

} // namespace tappet
