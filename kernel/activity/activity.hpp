// An activity (thesis 4.2.2): an engine and the thread that runs it, from start to stop, under real time.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/os/faults.hpp"
#include "kernel/os/thread.hpp"

#include <atomic>
#include <expected>
#include <span>

namespace tappet {

/// The thread of an activity is created once, before arming, and kept: between a stop and the next start it
/// waits. Start, cycles and stop of the engine run on it, and on no other thread. Not real-time except for
/// the code that the thread runs. One thread calls these functions, the supervisor's, which waits for no
/// function of a component.
class Activity {
public:
    /// parked: it broke a contract, and waits for the request to stop.
    enum class State : std::uint8_t { inactive, starting, waiting, running, parked, stopped };

    Activity() = default;
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;

    /// Creates the thread, which waits for start(). `stack` is painted and touched here.
    std::expected<void, Sentence> create(Engine& engine, const os::Clock& clock, int priority, int processor,
                                         std::span<std::byte> stack);
    /// Lets the thread start its engine, for the first time or again.
    void start() noexcept;
    [[nodiscard]] bool is_started_within(int milliseconds) const noexcept {
        return wait_for(State::waiting, milliseconds);
    }
    /// Ends the cycles and makes the engine stop on its own thread, which then waits for the next start.
    /// Until `ends_by` its behaviours may run to their ends. A loop that blocks also needs break_loop().
    void ask_to_stop(Time ends_by) noexcept;
    /// Longest time for the end of its behaviours; more than Engine::end_limit.
    static constexpr Duration end_within = 300ms;
    static_assert(Engine::end_limit < end_within, "who is asked in time has all of the limit");
    /// Returns whether break_loop() must be called to end its component's loop.
    [[nodiscard]] bool has_loop_to_break() const noexcept {
        return engine_->looping() != nullptr && engine_->looping()->type->break_loop != nullptr;
    }
    /// Runs the component's break_loop(), which may take any time: not on the supervisor's thread.
    void break_loop() const {
        const EnginePart& part = *engine_->looping();
        part.type->break_loop(part.component_);
    }
    /// Returns true when its outputs are safe and its thread waits, or it never ran. False: it may still
    /// write.
    [[nodiscard]] bool is_stopped_within(int milliseconds) const noexcept;
    /// Returns whether it broke a contract: then its thread starts nothing any more.
    [[nodiscard]] bool is_lost() const noexcept { return is_lost_.load(std::memory_order_acquire); }
    /// Ends the thread of an activity that is stopped, or never started. Returns whether it ended.
    [[nodiscard]] bool end(int milliseconds) noexcept;
    /// Abandons an activity that does not stop. Its engine's stop runs nowhere; if its thread returns, it
    /// ends. The caller that makes its outputs safe must end the process.
    void give_up() noexcept {
        engine_stop_claimed_.store(true, std::memory_order_release);
        abandon();
    }
    /// Stops waiting for its thread.
    void abandon() noexcept {
        ended_.store(true, std::memory_order_release);
        thread_.abandon();
    }
    /// Parks its own thread, which must not go on after a broken contract: it waits for the stop, leaves the
    /// safe values, and sleeps for ever. Real-time.
    [[noreturn]] void park() noexcept TAPPET_REALTIME;
    /// As park(), for a thread without activity.
    [[noreturn]] static void sleep_for_ever() noexcept TAPPET_REALTIME;

    [[nodiscard]] State state() const noexcept TAPPET_REALTIME {
        return state_.load(std::memory_order_acquire);
    }
    [[nodiscard]] Engine& engine() const noexcept TAPPET_REALTIME { return *engine_; }
    /// Returns the page faults of its thread, from each first cycle to the stop; complete when stopped.
    [[nodiscard]] os::PageFaults page_faults() const noexcept { return faults_; }
    [[nodiscard]] std::size_t stack_bytes() const noexcept { return plan_.stack.size(); }

    /// Returns the activity of the calling thread; null outside. Real-time.
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
    /// Returns true once: then the caller, its own thread, runs the engine's stop.
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
    bool stopped_its_engine_ = false; // of its own thread
    os::PageFaults faults_{};
};

} // namespace tappet
