// The wait of an activity: for a time, a wake from another activity, or a device. One thread waits, any
// thread wakes.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <array>
#include <atomic>
#include <cstdint>

struct pollfd;

namespace tappet::os {

/// Waking is one atomic exchange and, only when the waiter sleeps, one system call. No wake is lost: a wake
/// before the wait makes the wait return at once.
class Waiter {
public:
    static constexpr std::size_t max_devices = 16;

    Waiter() = default;
    Waiter(const Waiter&) = delete;
    Waiter& operator=(const Waiter&) = delete;
    ~Waiter();

    /// Makes waits return for this file descriptor too. Not real-time; before the first wait. Returns false
    /// when there are too many. A descriptor that hangs up or has an error ends one wait, and no further one
    /// until its driver has taken it: otherwise a removed chip would make its activity spin at its priority.
    [[nodiscard]] bool watch(int descriptor) noexcept;
    /// Assigns later descriptors to this driver, a number below 64. Not real-time.
    void watch_for(std::uint32_t driver) noexcept { driver_ = driver; }
    /// Sets whether the driver's descriptors end waits; initially they do. While nobody reads a device, a
    /// thread that returns for each frame would spin at a real-time priority for ever. Its own thread.
    /// Real-time.
    void serve(std::uint32_t driver, bool is_served) noexcept TAPPET_REALTIME;
    /// Sets whether one watched descriptor ends waits; from watch() on it does. Its own thread. Real-time.
    void heed(int descriptor, bool wanted) noexcept TAPPET_REALTIME;

    /// Wakes the waiting thread, or the next wait. Real-time, from any thread.
    void wake() noexcept TAPPET_REALTIME;
    static void wake_thunk(void* waiter) noexcept TAPPET_REALTIME { static_cast<Waiter*>(waiter)->wake(); }
    /// As wake(), for callers that published the reason for the wake by an atomic read-modify-write in the
    /// single order of all such (seq_cst): a thread that was woken and has not looked yet needs no second
    /// exchange.
    void wake_after_post() noexcept TAPPET_REALTIME {
        if (state_.load(std::memory_order_seq_cst) != woken) wake(); // waiter.look
    }
    static void wake_after_post_thunk(void* waiter) noexcept TAPPET_REALTIME {
        static_cast<Waiter*>(waiter)->wake_after_post();
    }

    /// Returns true when woken since the last call, and resets the wake. For worlds that do not sleep.
    [[nodiscard]] bool take() noexcept TAPPET_REALTIME {
        return (state_.exchange(idle, std::memory_order_seq_cst) & woken) != 0; // waiter.take
    }
    [[nodiscard]] bool is_woken() const noexcept TAPPET_REALTIME {
        return (state_.load(std::memory_order_acquire) & woken) != 0; // no step: virtual time has one thread
    }

    /// Sleeps until `until` (CLOCK_MONOTONIC), a wake or a watched device. Returns true on the latter two.
    bool wait(Time until) noexcept TAPPET_REALTIME;
    /// Sleeps until `until` or a wake, and ignores devices. Returns true when woken.
    bool wait_without_devices(Time until) noexcept TAPPET_REALTIME;
    void wait_for_wake() noexcept TAPPET_REALTIME { static_cast<void>(wait_without_devices(never)); }

private:
    static constexpr std::uint32_t idle = 0, woken = 1, asleep = 2;

    /// Sleeps on the first `count` devices, and on the wake.
    bool wait_on_devices(std::size_t count, Time until) noexcept TAPPET_REALTIME;

    void leave_out_hung(pollfd* polled, std::size_t count) noexcept TAPPET_REALTIME;

    alignas(64) std::atomic<std::uint32_t> state_{idle};
    Bounded<int, max_devices> devices_{};
    std::uint32_t hung_ = 0; // a bit for each device: reported, and not taken since
    std::uint32_t unheeded_ = 0, unserved_ = 0;
    std::array<std::uint32_t, max_devices> drivers_{}; // the driver of each device
    std::uint32_t driver_ = 0;
    int wake_descriptor_ = -1; // an eventfd, created when the first device is watched
};

} // namespace tappet::os
