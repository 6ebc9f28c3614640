// The twins between two threads, as in the host world under real time: nothing is lost or torn.
#include "drivers/can/twin_bus.hpp"
#include "drivers/gpio/twin.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tappet {
namespace {

TEST(Ring, hands_every_item_over_in_order_between_two_threads) {
    twin::Ring<std::uint64_t, 64> ring;
    constexpr std::uint64_t items = 200'000;
    std::thread writer{[&] {
        for (std::uint64_t i = 0; i < items;)
            if (ring.push(i))
                ++i;
            else
                std::this_thread::yield();
    }};
    std::uint64_t wrong = 0;
    for (std::uint64_t i = 0; i < items;) {
        std::uint64_t item = 0;
        if (!ring.pop(item)) {
            std::this_thread::yield();
            continue;
        }
        if (item != i) ++wrong;
        ++i;
    }
    writer.join();
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(ring.size(), 0u);
}

TEST(CanTwin, carries_frames_between_the_threads_of_machine_and_bus) {
    static constexpr std::array from_machine{can::Identifier{0x201, false}};
    static constexpr std::array from_plant{can::Identifier{0x181, false}};
    can::TwinBus bus{1};
    can::Twin machine, plant;
    can::Settings settings{.interface = "machine", .receive = from_plant, .transmit = from_machine};
    settings.max_age = 10s, settings.confirm_within = 60s;
    ASSERT_TRUE(machine.open(settings));
    settings.interface = "plant";
    std::swap(settings.receive, settings.transmit);
    ASSERT_TRUE(plant.open(settings));
    ASSERT_TRUE(bus.attach(machine) && bus.attach(plant));
    constexpr std::uint64_t frames = 20'000;
    std::atomic<std::int64_t> clock_ms{1};
    std::atomic<bool> done{false};
    std::uint64_t echoed = 0;
    std::thread world{[&] { // the plant answers each frame with its contents
        while (!done) {
            const Time now{1ms * clock_ms.fetch_add(1)};
            can::Frame f;
            while (plant.receive(f).what == can::Received::frame) {
                f.id = 0x181;
                f.stamp = now;
                plant.send(f, can::Keep::every);
            }
            plant.service(now);
            bus.deliver_until(now);
            std::this_thread::yield();
        }
    }};
    std::uint64_t wrong = 0;
    for (std::uint64_t i = 0; i < frames;) {
        can::Frame f{.id = 0x201, .length = 8, .stamp = Time{1ms * clock_ms.load()}};
        for (std::size_t b = 0; b < 8; ++b) f.data[b] = static_cast<std::uint8_t>(i >> (b % 3 * 8));
        const auto sent = f.data;
        machine.send(f, can::Keep::every);
        machine.service(f.stamp);
        while (machine.receive(f).what != can::Received::frame) std::this_thread::yield();
        if (f.data != sent) ++wrong;
        ++echoed;
        ++i;
    }
    done = true;
    world.join();
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(echoed, frames);
    EXPECT_EQ(machine.counters().lost_in_kernel, 0u);
}

TEST(GpioTwin, counts_every_edge_between_two_threads) {
    static constexpr std::array lines{gpio::Line{.name = "a", .offset = 0},
                                      gpio::Line{.name = "b", .offset = 1},
                                      gpio::Line{.name = "out", .offset = 2, .role = gpio::Role::output}};
    gpio::Twin twin;
    ASSERT_TRUE(twin.open({.chip = "loom", .lines = lines}));
    constexpr int changes = 50'000;
    std::atomic<bool> done{false};
    std::thread plant{[&] {
        for (int i = 0; i < changes; ++i) {
            const Time at{1us * (i + 1)};
            twin.drive(static_cast<std::size_t>(i % 2), i % 4 < 2, at);
            twin.deliver_until(at);
            if ((twin.outputs() & 3u) != 0) break; // the machine never drives inputs
        }
        done = true;
    }};
    std::array<gpio::Edge, 32> edges{};
    Time last{};
    std::uint64_t disorder = 0;
    for (bool more = true; more;) {
        more = !done;
        for (std::size_t n = twin.read_edges(edges).count; n != 0; n = twin.read_edges(edges).count)
            for (std::size_t i = 0; i < n; ++i) {
                if (edges[i].stamp <= last) ++disorder;
                last = edges[i].stamp;
            }
        twin.write(4, last.time_since_epoch().count() % 2 == 0 ? 4 : 0);
    }
    plant.join();
    EXPECT_EQ(disorder, 0u);
    twin.drive(0, true, Time{10s});
    twin.drive(0, false, Time{11s});
    twin.deliver_until(Time{12s});
    const auto tail = twin.read_edges(edges).count;
    EXPECT_GE(tail, 1u);
    EXPECT_EQ(twin.counters().edges + twin.counters().missed, static_cast<std::uint64_t>(changes) + tail);
}

} // namespace
} // namespace tappet
