// SPDX-License-Identifier: Apache-2.0
// A thread for component functions without a time limit, so that the supervisor waits for none of them.
#pragma once

#include "kernel/os/thread.hpp"
#include "kernel/os/waiter.hpp"

#include <atomic>
#include <expected>
#include <span>
#include <string_view>

namespace tappet {

/// Created before arming, below every real-time thread. Not real-time; used by the supervisor, except for the
/// work that it runs.
class MakersThread {
public:
    MakersThread() = default;
    MakersThread(const MakersThread&) = delete;
    MakersThread& operator=(const MakersThread&) = delete;

    /// Creates the thread. `work` runs on it after each wake(). The error names the cure. `stack` must
    /// outlive the thread.
    std::expected<void, Sentence> create(std::string_view name, std::span<std::byte> stack,
                                         void (*work)(void*), void* context);
    void wake() noexcept { waiter_.wake(); }
    /// Whether a contract was broken on it: it runs nothing any more.
    [[nodiscard]] bool is_lost() const noexcept { return is_lost_.load(std::memory_order_acquire); }
    /// Ends it, or abandons it when it does not end in time.
    void end(int milliseconds) noexcept;

    /// Marks the calling makers' thread as lost after a broken contract; does nothing on any other thread.
    /// Real-time.
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
