// A blocking loop under virtual time. It has a thread of its own, but only one of it and the world runs, in
// turns, so that every run is the same.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/os/thread.hpp"

#include <expected>
#include <span>

namespace tappet {

/// Runs the one looping component of an engine. Called by the world's thread. Not real-time.
class VirtualLoop {
public:
    VirtualLoop(Engine& engine, const os::Clock& clock, std::span<std::byte> stack) noexcept;
    ~VirtualLoop();
    VirtualLoop(const VirtualLoop&) = delete;
    VirtualLoop& operator=(const VirtualLoop&) = delete;

    /// Serves the engine, and lets the loop run until it waits or returns.
    void run(bool woken) noexcept;
    /// Makes the loop return. Call it before the engine's stop.
    void break_off() noexcept;
    [[nodiscard]] Time next_wake() const noexcept;

private:
    static constexpr int most_waits_after_the_end = 1000;

    void live() noexcept;
    void resume(bool woken) noexcept;
    [[nodiscard]] bool wait(Duration time) noexcept;
    [[nodiscard]] bool serve() noexcept;
    static void take_turn(os::Waiter& turn) noexcept {
        while (!turn.wait(never)) {
        }
    }

    Engine& engine_;
    const os::Clock& clock_;
    const EnginePart& part_;
    os::ThreadPlan plan_{};
    os::Thread thread_{};
    os::Waiter loops_turn_{};
    os::Waiter worlds_turn_{};
    // The thread that has the turn reads and writes these.
    bool in_loop_ = false;
    bool woken_ = false;
    bool ends_ = false;   ///< the loop must return
    bool ending_ = false; ///< the thread must end
    Time wakes_at_ = never;
};

} // namespace tappet
