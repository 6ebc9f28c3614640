// A guardian writes to Modbus servers of which some are dead: no live server waits for a dead one.
#include "drivers/hardware/opened.hpp"
#include "drivers/modbus/real_server.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/sleep.hpp"
#include "tests/drivers/modbus/raw_server.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <optional>
#include <set>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace tappet {
namespace {

using modbus::Manner;
using modbus::RawServer;

constexpr std::array<std::uint16_t, 1> safe_word{7};
constexpr std::array<modbus::SafeWrite, 2> requests{
    modbus::SafeWrite{{modbus::Table::holding_registers, 3, 1}, 0},
    modbus::SafeWrite{{modbus::Table::holding_registers, 9, 1}, 0}};

/// Servers over Ethernet, and the device of each.
template <std::size_t count>
struct Servers {
    modbus::SafeWrites safe;
    std::array<std::optional<RawServer>, count> raw{};
    std::array<std::string, count> addresses{};
    std::array<modbus::RealServer, count> devices{};
    std::array<OpenedDevice, count> to{};

    explicit Servers(Duration answer_after, std::span<const modbus::SafeWrite> wanted = requests)
        : safe{wanted, safe_word, {}, {}} {
        const std::array bound{answer_within(answer_after)};
        for (std::size_t i = 0; i < count; ++i) {
            raw[i].emplace(RawServer::Line::tcp);
            addresses[i] = "127.0.0.1:" + std::to_string(raw[i]->port());
            EXPECT_TRUE(devices[i].open(
                {.address = addresses[i], .is_on_board = false, .bound = bound, .map = &safe}));
            to[i].device = &devices[i];
        }
    }
    void all_are_silent_but(std::size_t place, Manner manner = Manner::right) {
        for (std::size_t i = 0; i < count; ++i) raw[i]->manner = i == place ? manner : Manner::silent;
    }
};

TEST(SafeRegisters, reach_every_server_that_answers) {
    Servers<4> all{30s}; // no host is so busy
    EXPECT_EQ(make_safe_requests(all.to, 1h, {}), 0u);
    for (const auto& server : all.raw) {
        const modbus::Bytes request = server->last_request();
        ASSERT_GE(request.size(), 15u);
        EXPECT_EQ(request[9], 9) << "its second";
        EXPECT_EQ(request[14], 7);
        EXPECT_EQ(server->requests(), 2);
    }
}

/// Answers take 600 ms each; there are as many as the time allows.
TEST(SafeRegisters, reach_a_slow_server_among_silent_ones) {
    const std::array many{requests[0], requests[1], requests[0], requests[1]};
    for (const std::size_t place : {0u, 3u}) {
        Servers<4> all{10s, many};
        all.all_are_silent_but(place, Manner::dribble);
        const Time begin = os::Clock::monotonic();
        int kicks = 0;
        EXPECT_EQ(
            make_safe_requests(all.to, 4s, {&kicks, [](void* of) noexcept { ++*static_cast<int*>(of); }}),
            3u);
        EXPECT_LT(os::Clock::monotonic() - begin, 6s) << "all of them wait at the same time";
        EXPECT_TRUE(all.to[place].is_safe) << "as server " << place;
        EXPECT_GE(kicks, 10) << "whoever kicks a watchdog meanwhile";
    }
}

TEST(SafeRegisters, are_abandoned_when_their_time_is_over) {
    Servers<2> all{6s};
    all.all_are_silent_but(1);
    const Time begin = os::Clock::monotonic();
    EXPECT_EQ(make_safe_requests(all.to, 500ms, {}), 1u);
    EXPECT_LT(os::Clock::monotonic() - begin, 6s) << "no server is waited for beyond it";
    EXPECT_TRUE(all.to[1].is_safe);
}

TEST(SafeRegisters, are_written_though_the_server_refuses_earlier_ones) {
    Servers<1> all{30s};
    all.raw[0]->manner = Manner::exception;
    EXPECT_EQ(make_safe_requests(all.to, 500ms, {}), 1u);
    EXPECT_GE(all.raw[0]->requests(), 2);
    EXPECT_LT(all.raw[0]->requests(), 50) << "it rests between them";
}

/// Makes servers safe while the address space has no room for a thread's stack. One server is silent for
/// longer than its share. Returns whether all are safe and the watchdog was served.
bool are_safe_without_threads() {
    Servers<4> all{300ms};
    RawServer& late = *all.raw[0];
    const Time ready = os::Clock::monotonic() + 1200ms;
    late.on_request([&late, ready](int, const modbus::Bytes&) {
        late.manner = os::Clock::monotonic() < ready ? Manner::silent : Manner::right;
    });
    std::size_t pages = 0;
    std::ifstream{"/proc/self/statm"} >> pages;
    const rlimit full{pages * 4096 + (4u << 20u), RLIM_INFINITY};
    setrlimit(RLIMIT_AS, &full);
    int kicks = 0;
    const std::size_t left =
        make_safe_requests(all.to, 4s, {&kicks, [](void* of) noexcept { ++*static_cast<int*>(of); }});
    return left == 0 && kicks >= 4;
}

TEST(SafeRegistersDeathTest, reach_servers_without_a_thread) {
    std::size_t pages = 0;
    std::ifstream{"/proc/self/statm"} >> pages;
    if (pages > std::size_t{1} << 28u) GTEST_SKIP() << "a sanitizer has taken the address space";
    GTEST_FLAG_SET(death_test_style,
                   "threadsafe"); // a process of its own: no stack of an earlier thread is kept
    EXPECT_EXIT(_exit(are_safe_without_threads() ? 0 : 1), testing::ExitedWithCode(0), "");
}

TEST(SilentLine, delays_the_end_by_at_most_the_common_time_limit) {
    RawServer serial{RawServer::Line::serial};
    serial.manner = Manner::silent;
    const std::array bound{serial_line(115200, 'N', 1), answer_within(2s)};
    const modbus::SafeWrites safe{requests, safe_word, {}, {}};
    modbus::RealServer device;
    EXPECT_TRUE(device.open({.address = serial.terminal(), .bound = bound, .map = &safe}));
    std::array<OpenedDevice, 1> to{};
    to[0].device = &device;
    const Time begin = os::Clock::monotonic();
    EXPECT_EQ(make_safe_requests(to, 3s, {}), 1u);
    // Without a bound on the serial line's own rest it would take another second.
    EXPECT_LT(os::Clock::monotonic() - begin, 3600ms);
}

/// The server accepts its first request and closes the connection at the second one, as if it restarted.
TEST(Restarted, server_receives_all_requests_again) {
    Servers<1> all{2s};
    RawServer& server = *all.raw[0];
    server.on_request([&server](int number, const modbus::Bytes&) {
        server.manner = number == 2 ? Manner::close : Manner::right;
    });
    EXPECT_EQ(make_safe_requests(all.to, 30s, {}), 0u);
    EXPECT_EQ(server.last_request()[9], 3) << "its first one, once more";
}

/// The server confirms one request of each connection and closes it at the second one.
TEST(Restarted, server_receives_all_requests_over_short_connections) {
    std::array<modbus::SafeWrite, 40> many{};
    for (std::size_t i = 0; i < many.size(); ++i)
        many[i] = {{modbus::Table::holding_registers, static_cast<std::uint32_t>(i), 1}, 0};
    Servers<1> all{300ms, many};
    RawServer& server = *all.raw[0];
    std::set<int> told;
    server.on_request([&](int number, const modbus::Bytes& request) {
        server.manner = number % 2 == 0 ? Manner::close : Manner::right;
        if (number % 2 == 1) told.insert(request[9]);
    });
    EXPECT_EQ(make_safe_requests(all.to, 4s, {}), 1u) << "not on one connection";
    EXPECT_EQ(told.size(), many.size());
}

/// The server ignores the first request; an answer may take all the time there is.
TEST(BusyServer, receives_a_lost_request_again) {
    Servers<1> all{2s};
    RawServer& server = *all.raw[0];
    server.on_request([&server](int number, const modbus::Bytes&) {
        server.manner = number == 1 ? Manner::silent : Manner::right;
    });
    EXPECT_EQ(make_safe_requests(all.to, 2s, {}), 0u);
}

/// The server refuses everything, or closes each connection, for 2 s.
TEST(BusyServer, receives_requests_until_it_is_ready) {
    for (const Manner busy : {Manner::exception, Manner::close}) {
        Servers<1> all{2s};
        RawServer& server = *all.raw[0];
        const Time ready = os::Clock::monotonic() + 2s;
        server.on_request([&server, ready, busy](int, const modbus::Bytes&) {
            server.manner = os::Clock::monotonic() < ready ? busy : Manner::right;
        });
        EXPECT_EQ(make_safe_requests(all.to, 30s, {}), 0u);
    }
}

} // namespace
} // namespace tappet
