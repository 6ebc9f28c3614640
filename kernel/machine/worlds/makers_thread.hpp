// SPDX-License-Identifier: Apache-2.0
// A thread for functions of components that may take what time they like, so that the supervisor waits for
// none.
#pragma once

#include "kernel/os/thread.hpp"
#include "kernel/os/waiter.hpp"

#include <atomic>
#include <expected>
#include <span>
#include <string_view>

namespace tappet {

/// Created before arming, below every real-time thread. Not real-time; the supervisor's but for what it runs.
class MakersThread {
public:
    MakersThread() = default;
    MakersThread(const MakersThread&) = delete;
    MakersThread& operator=(const MakersThread&) = delete;

    /// `work` runs there after each wake(). An error names the cure. `stack` outlives the thread.
    std::expected<void, Sentence> create(std::string_view name, std::span<std::byte> stack,
                                         void (*work)(void*), void* context);
    void wake() noexcept { waiter_.wake(); }
    /// A contract was broken there: nothing runs on it any more.
    [[nodiscard]] bool is_lost() const noexcept { return is_lost_.load(std::memory_order_acquire); }
    /// Ends it, or gives it up where it does not end in time.
    void end(int milliseconds) noexcept;

    /// For a thread whose contract is broken: nothing, unless it is such a one. Real-time.
    static void note_breach() noexcept TAPPET_REALTIME;

private:
    void live() noexcept;

    os::ThreadPlan plan_{};
    os::Thread thread_{};
    os::Waiter waiter_{};
    void (*work_)(void*) = nullptr;
    void* context_ = nullptr;
    std::atomic<bool> ended_{false};
    std::atomic<bool> is_lost_{false};
};

} // namespace tappet
