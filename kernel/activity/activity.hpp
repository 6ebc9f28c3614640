// An activity (thesis 4.2.2): an engine and the thread that runs it, from start to stop, under real time.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/os/faults.hpp"
#include "kernel/os/thread.hpp"

#include <atomic>
#include <expected>
#include <span>

namespace tappet {

/// Its thread is created once, before arming, and kept: between a stop and the next start it waits. Start,
/// cycles and stop of the engine run on it; initialise and finalise are the starter's and the stopper's. Not
/// real-time but for what the thread does; called by one thread, the supervisor's.
class Activity {
public:
    enum class State : std::uint8_t { inactive, starting, waiting, running, stopped, parked };

    Activity() = default;
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;

    /// `stack` is painted and touched here. The thread waits for start().
    std::expected<void, Sentence> create(Engine& engine, const os::Clock& clock, int priority, int processor,
                                         std::span<std::byte> stack);
    /// Lets the thread start its engine, for the first time or again; true when that is done within
    /// `milliseconds`.
    [[nodiscard]] bool start(int milliseconds) noexcept;
    /// Ends the cycles and lets the engine stop on its own thread, which then waits to be started again.
    /// False when it did not within `milliseconds`: its thread hangs, and whoever called may claim the
    /// engine's stop and run it.
    [[nodiscard]] bool stop(int milliseconds) noexcept {
        ask_to_stop();
        return is_stopped_within(milliseconds);
    }
    /// From here on its behaviours may come to their ends, not later than `end_within`: the same in two
    /// steps.
    void ask_to_stop() noexcept;
    static constexpr Duration end_within = 300ms;
    static_assert(Engine::end_limit < end_within, "who is asked in time has all of the limit");
    [[nodiscard]] bool is_stopped_within(int milliseconds) const noexcept;
    /// Ends the thread of an activity that is stopped, or never started; false when it does not end.
    [[nodiscard]] bool end(int milliseconds) noexcept;
    /// True once, for the one who then runs the engine's stop: its own thread, or whoever gave that up.
    /// Real-time.
    [[nodiscard]] bool claim_engine_stop() noexcept TAPPET_REALTIME {
        return !engine_stop_claimed_.exchange(true, std::memory_order_acq_rel);
    }
    /// After a stop that failed: nobody waits for its thread any more, which ends should it ever come back.
    void abandon() noexcept {
        ended_.store(true, std::memory_order_release);
        thread_.abandon();
    }
    /// For a thread that must not go on (a broken contract): it says so and sleeps for ever. Real-time.
    [[noreturn]] void park() noexcept TAPPET_REALTIME;
    /// The same for a thread that is no activity's.
    [[noreturn]] static void sleep_for_ever() noexcept TAPPET_REALTIME;

    [[nodiscard]] State state() const noexcept TAPPET_REALTIME {
        return state_.load(std::memory_order_acquire);
    }
    [[nodiscard]] Engine& engine() const noexcept TAPPET_REALTIME { return *engine_; }
    /// Page faults of its thread from each first cycle to the stop; complete when stopped.
    [[nodiscard]] os::PageFaults page_faults() const noexcept { return faults_; }
    [[nodiscard]] std::size_t stack_bytes() const noexcept { return plan_.stack.size(); }

    /// The activity of the calling thread; null outside. Real-time.
    [[nodiscard]] static Activity* current() noexcept TAPPET_REALTIME;

private:
    static void enter(void* self) noexcept;
    void live() noexcept;
    void end() noexcept TAPPET_REALTIME;
    void cycles() noexcept TAPPET_REALTIME;
    void run_once() noexcept;
    void loop(const EnginePart& part);
    [[nodiscard]] bool goes_on() const noexcept TAPPET_REALTIME {
        return !stop_asked_.load(std::memory_order_acquire);
    }
    bool sleep_until(Time time) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool wait_for(State wanted, int milliseconds) const noexcept;

    Engine* engine_ = nullptr;
    const os::Clock* clock_ = nullptr;
    os::ThreadPlan plan_{};
    os::Thread thread_{};
    std::atomic<State> state_{State::inactive};
    std::atomic<bool> released_{false};
    std::atomic<bool> stop_asked_{false};
    std::atomic<std::int64_t> ends_by_ns_{0}; ///< written before stop_asked_
    std::atomic<bool> ended_{false};
    std::atomic<bool> engine_stop_claimed_{false};
    bool stopped_its_engine_ = false; // its own thread's
    os::PageFaults faults_{};
};

} // namespace tappet
