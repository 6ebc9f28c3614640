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
