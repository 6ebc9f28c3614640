// Waiting for a thread's end: for the given time, whatever the wall clock shows.
#include "kernel/os/thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

namespace {

std::atomic<long> wall_clock_ahead_s{0};

} // namespace

/// Replaces the library's function, so that the test can set the wall clock.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
    const auto result = static_cast<int>(syscall(SYS_clock_gettime, clock, time));
    if (clock == CLOCK_REALTIME) time->tv_sec += wall_clock_ahead_s.load();
    return result;
}

namespace tappet::os {
namespace {

struct ThreadTest : testing::Test {
    std::atomic<bool> may_end{false};
    const ThreadPlan plan{.name = "worker",
                          .body =
                              [](void* flag) noexcept {
                                  while (!static_cast<std::atomic<bool>*>(flag)->load())
                                      std::this_thread::sleep_for(std::chrono::milliseconds(1));
                              },
                          .context = &may_end};
    Thread thread;

    ThreadTest() { EXPECT_TRUE(thread.start(plan)); }
    ~ThreadTest() override {
        may_end = true;
        wall_clock_ahead_s = 0;
    }
};

TEST_F(ThreadTest, waits_until_a_thread_ends) {
    may_end = true;
    EXPECT_TRUE(thread.join_within(60'000));
    EXPECT_FALSE(thread.running());
}

TEST_F(ThreadTest, waits_no_longer_than_the_given_time) {
    EXPECT_FALSE(thread.join_within(20));
    EXPECT_TRUE(thread.running());
    may_end = true;
    EXPECT_TRUE(thread.join_within(60'000));
}

TEST_F(ThreadTest, waits_the_given_time_although_the_wall_clock_was_set_back) {
    wall_clock_ahead_s = -3600;
    std::thread later{[this] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        may_end = true;
    }};
    EXPECT_TRUE(thread.join_within(60'000));
    later.join();
}

} // namespace
} // namespace tappet::os
