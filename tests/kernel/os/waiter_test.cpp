// The wait of an activity: what ends it, and what does not.
#include "kernel/os/waiter.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include <unistd.h>

namespace tappet::os {
namespace {

/// A device that has something to say until it is asked.
struct ReadyDevice {
    int ends[2] = {-1, -1};
    ReadyDevice() {
        if (::pipe(ends) != 0 || ::write(ends[1], "x", 1) != 1) ends[0] = -1;
    }
    ~ReadyDevice() {
        ::close(ends[0]);
        ::close(ends[1]);
    }
    ReadyDevice(const ReadyDevice&) = delete;
    ReadyDevice& operator=(const ReadyDevice&) = delete;
};

TEST(Waiter, returns_for_a_device_that_is_ready) {
    const ReadyDevice device;
    Waiter waiter;
    ASSERT_TRUE(waiter.watch(device.ends[0]));
    EXPECT_TRUE(waiter.wait(never));
}

TEST(Waiter, does_not_return_for_a_ready_device_while_it_waits_for_a_wake_alone) {
    const ReadyDevice device;
    Waiter waiter;
    ASSERT_TRUE(waiter.watch(device.ends[0]));
    std::atomic<bool> returned{false};
    std::thread sleeper{[&] {
        waiter.wait_for_wake();
        returned = true;
    }};
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(returned);
    waiter.wake();
    sleeper.join();
    EXPECT_TRUE(waiter.wait(never)) << "the device has not been forgotten";
}

TEST(Waiter, takes_a_wake_that_came_before_the_wait) {
    for (const bool with_device : {false, true}) {
        const ReadyDevice device;
        Waiter waiter;
        ASSERT_TRUE(!with_device || waiter.watch(device.ends[0]));
        waiter.wake();
        waiter.wait_for_wake();
        EXPECT_FALSE(waiter.is_woken());
    }
}

TEST(Waiter, keeps_a_wake_after_a_post_until_it_is_taken_and_then_takes_the_next) {
    Waiter waiter;
    for (int round = 0; round < 3; ++round) {
        EXPECT_FALSE(waiter.is_woken());
        waiter.wake_after_post();
        waiter.wake_after_post();
        EXPECT_TRUE(waiter.is_woken());
        EXPECT_TRUE(waiter.take());
        EXPECT_FALSE(waiter.take());
    }
}

TEST(Waiter, is_woken_out_of_its_sleep_after_each_post) {
    Waiter waiter;
    std::atomic<std::uint64_t> posted{0};
    std::atomic<std::uint64_t> seen{0};
    constexpr std::uint64_t posts = 2000;
    std::thread sleeper{[&] {
        while (seen.load() != posts) {
            waiter.wait_for_wake();
            seen.store(posted.load(std::memory_order_seq_cst));
        }
    }};
    for (std::uint64_t i = 0; i < posts; ++i) {
        posted.fetch_add(1, std::memory_order_seq_cst);
        waiter.wake_after_post();
        if (i % 64 == 0) // it sleeps now and then
            while (seen.load() <= i) std::this_thread::yield();
    }
    sleeper.join(); // it would hang if the last wake were lost
    EXPECT_EQ(seen.load(), posts);
}

TEST(Waiter, without_devices_sleeps_until_a_wake) {
    Waiter waiter;
    std::atomic<bool> returned{false};
    std::thread sleeper{[&] {
        waiter.wait_for_wake();
        returned = true;
    }};
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_FALSE(returned);
    waiter.wake();
    sleeper.join();
    EXPECT_TRUE(returned);
}

} // namespace
} // namespace tappet::os
