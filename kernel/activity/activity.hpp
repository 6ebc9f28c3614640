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
/// cycles and stop of the engine run on it, and on no other thread. Not real-time but for what the thread
/// does; called by one thread, the supervisor's, which waits for no function of a component.
class Activity {
public:
    /// parked: it broke a contract, and waits to be asked to stop.
    enum class State : std::uint8_t { inactive, starting, waiting, running, parked, stopped };

    Activity() = default;
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;

    /// `stack` is painted and touched here. The thread waits for start().
    std::expected<void, Sentence> create(Engine& engine, const os::Clock& clock, int priority, int processor,
                                         std::span<std::byte> stack);
    /// Lets the thread start its engine, for the first time or again.
    void start() noexcept;
    [[nodiscard]] bool is_started_within(int milliseconds) const noexcept {
        return wait_for(State::waiting, milliseconds);
    }
    /// Ends the cycles and lets the engine stop on its own thread, which then waits to be started again. From
    /// here on its behaviours may come to their ends, not later than `ends_by`. A loop that blocks needs
    /// break_loop() beside it.
    void ask_to_stop(Time ends_by) noexcept;
    /// How long the end of its behaviours may take; more than Engine::end_limit.
    static constexpr Duration end_within = 300ms;
    static_assert(Engine::end_limit < end_within, "who is asked in time has all of the limit");
    /// Whether its component has to be told to come back from its loop.
    [[nodiscard]] bool has_loop_to_break() const noexcept {
        return engine_->looping() != nullptr && engine_->looping()->type->break_loop != nullptr;
    }
    /// A function of the component, which may take what time it likes: not on the supervisor's thread.
    void break_loop() const {
        const EnginePart& part = *engine_->looping();
        part.type->break_loop(part.component_);
    }
    /// Its outputs are safe, and its thread waits; or it never ran. False: it still may write.
    [[nodiscard]] bool is_stopped_within(int milliseconds) const noexcept;
    /// It broke a contract: its thread starts nothing any more.
    [[nodiscard]] bool is_lost() const noexcept { return is_lost_.load(std::memory_order_acquire); }
    /// Ends the thread of an activity that is stopped, or never started; false when it does not end.
    [[nodiscard]] bool end(int milliseconds) noexcept;
    /// Of one that does not stop: its engine's stop runs nowhere, not even should its thread come back, which
    /// then ends. Who makes its outputs safe has the process ended.
    void give_up() noexcept {
        engine_stop_claimed_.store(true, std::memory_order_release);
        abandon();
    }
    /// Nobody waits for its thread any more.
    void abandon() noexcept {
        ended_.store(true, std::memory_order_release);
        thread_.abandon();
    }
    /// For its own thread, which must not go on (a broken contract): it waits for the stop, leaves the safe
    /// values, and sleeps for ever. Real-time.
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
    [[nodiscard]] bool keeps_running() const noexcept TAPPET_REALTIME {
        return !stop_asked_.load(std::memory_order_acquire);
    }
    bool sleep_until(Time time) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool wait_for(State wanted, int milliseconds) const noexcept;
    /// True once: then the caller, its own thread, runs the engine's stop.
    [[nodiscard]] bool claim_engine_stop() noexcept TAPPET_REALTIME {
        return !engine_stop_claimed_.exchange(true, std::memory_order_acq_rel);
    }

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
    std::atomic<bool> is_lost_{false};
    bool stopped_its_engine_ = false; // its own thread's
    os::PageFaults faults_{};
};

} // namespace tappet
