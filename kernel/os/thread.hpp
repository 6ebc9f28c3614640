// A thread whose stack, processor, priority and name are fixed beforehand.
#pragma once

#include "kernel/base/text.hpp"

#include <cstddef>
#include <expected>
#include <span>
#include <string_view>

#include <pthread.h>

namespace tappet::os {

struct ThreadPlan {
    std::string_view name;        ///< the kernel shows at most 15 characters
    int fifo_priority = 0;        ///< 1..99 SCHED_FIFO; 0: SCHED_OTHER, or that of its starter
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

    /// Starts the thread. An error names the refusal and its cure. The targets of the plan's pointers must
    /// outlive it.
    std::expected<void, Sentence> start(const ThreadPlan& plan);
    /// Waits until it has ended.
    void join() noexcept;
    /// Waits at most `milliseconds`. Returns false when it still runs.
    [[nodiscard]] bool join_within(int milliseconds) noexcept;
    /// Abandons a hung thread: nothing waits for it, not even the destructor. It ends with the process.
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
