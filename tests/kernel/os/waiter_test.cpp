// The wait of an activity: events that end it, and events that do not.
#include "kernel/os/waiter.hpp"

#include "kernel/os/clock.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::os {
namespace {

/// A device that is ready until it is read.
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

void expect_sleeps_until_it_is_woken(Waiter& waiter) {
    std::atomic<bool> returned{false};
    std::thread sleeper{[&] {
        waiter.wait_for_wake();
        returned = true;
    }};
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(returned);
    waiter.wake();
    sleeper.join();
    EXPECT_TRUE(returned);
}

TEST(Waiter, returns_for_a_device_that_is_ready) {
    const ReadyDevice device;
    Waiter waiter;
    ASSERT_TRUE(waiter.watch(device.ends[0]));
    EXPECT_TRUE(waiter.wait(never));
}

TEST(Waiter, ignores_a_ready_device_that_it_does_not_watch) {
    const ReadyDevice device, other;
    Waiter waiter;
    ASSERT_TRUE(waiter.watch(device.ends[0]));
    waiter.heed(device.ends[0], false);
    EXPECT_FALSE(waiter.wait(Clock::monotonic() + 1ms));
    ASSERT_TRUE(waiter.watch(other.ends[0]));
    EXPECT_TRUE(waiter.wait(never)) << "the others are watched as before";
    waiter.heed(other.ends[0], false);
    EXPECT_FALSE(waiter.wait(Clock::monotonic() + 1ms));
    waiter.heed(device.ends[0], true);
    EXPECT_TRUE(waiter.wait(never));
}

TEST(Waiter, ignores_a_device_whose_driver_is_not_served) {
    const ReadyDevice first, second;
    Waiter waiter;
    waiter.watch_for(0);
    ASSERT_TRUE(waiter.watch(first.ends[0]));
    waiter.serve(0, false);
    EXPECT_FALSE(waiter.wait(Clock::monotonic() + 1ms));
    waiter.watch_for(7);
    ASSERT_TRUE(waiter.watch(second.ends[0]));
    EXPECT_TRUE(waiter.wait(never)) << "another driver's";
    waiter.serve(7, false);
    EXPECT_FALSE(waiter.wait(Clock::monotonic() + 1ms));
    waiter.serve(0, true);
    EXPECT_TRUE(waiter.wait(never));
}

TEST(Waiter, ignores_a_ready_device_while_it_waits_for_a_wake_only) {
    const ReadyDevice device;
    Waiter waiter;
    ASSERT_TRUE(waiter.watch(device.ends[0]));
    expect_sleeps_until_it_is_woken(waiter);
    EXPECT_TRUE(waiter.wait(never)) << "the device has not been forgotten";
}

TEST(Waiter, returns_once_without_spinning_when_a_device_hangs_up) {
    ReadyDevice gone;
    char taken = 0;
    ASSERT_EQ(::read(gone.ends[0], &taken, 1), 1);
    ::close(std::exchange(gone.ends[1], -1));
    Waiter waiter;
    ASSERT_TRUE(waiter.watch(gone.ends[0]));
    int returns = 0;
    for (int i = 0; i < 50; ++i) returns += waiter.wait(Clock::monotonic() + 1ms) ? 1 : 0;
    EXPECT_EQ(returns, 1);
    const ReadyDevice other;
    ASSERT_TRUE(waiter.watch(other.ends[0]));
    EXPECT_TRUE(waiter.wait(never)) << "the others are watched as before";
    waiter.wake();
    EXPECT_TRUE(waiter.wait(never));
}

/// A loopback socket, alone or connected to another's port.
struct Datagrams {
    int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    Datagrams() {
        sockaddr_in anywhere = at(0);
        EXPECT_EQ(::bind(descriptor, reinterpret_cast<sockaddr*>(&anywhere), sizeof anywhere), 0);
    }
    ~Datagrams() { ::close(descriptor); }
    Datagrams(const Datagrams&) = delete;
    Datagrams& operator=(const Datagrams&) = delete;
    static sockaddr_in at(std::uint16_t port_in_network_order) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = port_in_network_order;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        return address;
    }
    [[nodiscard]] std::uint16_t port() const {
        sockaddr_in own{};
        socklen_t size = sizeof own;
        EXPECT_EQ(::getsockname(descriptor, reinterpret_cast<sockaddr*>(&own), &size), 0);
        return own.sin_port;
    }
    void connect_to(std::uint16_t port) const {
        sockaddr_in address = at(port);
        EXPECT_EQ(::connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    }
};

TEST(Waiter, watches_a_device_again_after_its_driver_read_the_error) {
    const Datagrams device; // like a CAN socket whose interface goes down and up again
    {
        const Datagrams nobody;
        device.connect_to(nobody.port());
    }
    ASSERT_EQ(::send(device.descriptor, "x", 1, 0), 1); // refused: the socket keeps it as an error
    Waiter waiter;
    ASSERT_TRUE(waiter.watch(device.descriptor));
    EXPECT_TRUE(waiter.wait(never));
    EXPECT_FALSE(waiter.wait(Clock::monotonic() + 1ms)) << "nobody took it";
    int told = 0;
    socklen_t size = sizeof told;
    ASSERT_EQ(::getsockopt(device.descriptor, SOL_SOCKET, SO_ERROR, &told, &size), 0);
    ASSERT_EQ(told, ECONNREFUSED);
    EXPECT_FALSE(waiter.wait(Clock::monotonic() + 1ms)) << "it has nothing to say";
    {
        const Datagrams other;
        device.connect_to(other.port());
        other.connect_to(device.port());
        ASSERT_EQ(::send(other.descriptor, "x", 1, 0), 1);
        EXPECT_TRUE(waiter.wait(never));
        char taken = 0;
        ASSERT_EQ(::recv(device.descriptor, &taken, 1, 0), 1);
    }
    ASSERT_EQ(::send(device.descriptor, "x", 1, 0), 1);
    EXPECT_TRUE(waiter.wait(Clock::monotonic() + 10s)) << "a new error is told anew";
}

TEST(Waiter, accepts_a_wake_that_came_before_the_wait) {
    for (const bool with_device : {false, true}) {
        const ReadyDevice device;
        Waiter waiter;
        ASSERT_TRUE(!with_device || waiter.watch(device.ends[0]));
        waiter.wake();
        waiter.wait_for_wake();
        EXPECT_FALSE(waiter.is_woken());
    }
}

TEST(Waiter, keeps_a_posted_wake_until_accepted_and_then_accepts_the_next) {
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

TEST(Waiter, wakes_up_after_each_post) {
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
    sleeper.join(); // it would hang after losing the last wake
    EXPECT_EQ(seen.load(), posts);
}

TEST(Waiter, sleeps_until_a_wake_without_devices) {
    Waiter waiter;
    expect_sleeps_until_it_is_woken(waiter);
}

} // namespace
} // namespace tappet::os
