// A thread with everything decided beforehand: stack, processor, priority, name.
#pragma once

#include "kernel/base/text.hpp"

#include <cstddef>
#include <expected>
#include <span>
#include <string_view>

#include <pthread.h>

namespace tappet::os {

struct ThreadPlan {
    std::string_view name;        ///< at most 15 characters are shown by the kernel
    int fifo_priority = 0;        ///< 1..99 SCHED_FIFO; 0 is SCHED_OTHER; or that of its starter
    int processor = -1;           ///< -1: any
    std::span<std::byte> stack{}; ///< 16 kB at least, aligned to 64; its stack_guard() is closed meanwhile
    void (*body)(void*) noexcept = nullptr;
    void* context = nullptr;
    static constexpr int as_its_starter = -1;
};

/// Not real-time: threads are started before arming and joined after the stop.
class Thread {
public:
    Thread() = default;
    Thread(const Thread&) = delete;
    Thread& operator=(const Thread&) = delete;
    ~Thread() { join(); }

    /// An error says what was refused and what cures it. What the plan leads to outlives the thread.
    std::expected<void, Sentence> start(const ThreadPlan& plan);
    /// True when it ended; waits for it.
    void join() noexcept;
    /// Waits at most `milliseconds`; false when it still runs.
    [[nodiscard]] bool join_within(int milliseconds) noexcept;
    /// Waits for it no more, not even in the destructor: it hangs, and only the process's end ends it.
    void abandon() noexcept;
    [[nodiscard]] bool running() const noexcept { return started_; }

private:
    void open_guard() noexcept;

    ThreadPlan plan_{};
    pthread_t handle_{};
    std::span<std::byte> guard_{};
    bool started_ = false;
};

} // namespace tappet::os
