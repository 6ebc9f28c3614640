// What a guardian writes to Modbus servers of which some are dead: the live ones wait for none of them.
#include "drivers/hardware/open.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/sleep.hpp"
#include "tests/drivers/modbus/raw_server.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <optional>
#include <vector>

namespace tappet {
namespace {

using modbus::Manner;
using modbus::RawServer;

constexpr std::array<std::uint16_t, 1> safe_word{7};
constexpr std::array<modbus::SafeWrite, 2> requests{
    modbus::SafeWrite{{modbus::Table::holding_registers, 3, 1}, 0},
    modbus::SafeWrite{{modbus::Table::holding_registers, 9, 1}, 0}};
constexpr std::size_t last = 3;

std::size_t write_safe(std::span<SafeServer> to, Duration within, const Meanwhile& meanwhile) {
    std::vector<SafeLine> lines(to.size());
    return write_safe_registers(to, lines, within, meanwhile);
}

/// Four servers over Ethernet, behind one gateway.
struct SafeRegisters : testing::Test {
    std::array<RawServer, last + 1> servers{RawServer{RawServer::Line::tcp}, RawServer{RawServer::Line::tcp},
                                            RawServer{RawServer::Line::tcp}, RawServer{RawServer::Line::tcp}};
    std::array<modbus::LibmodbusTransport, last + 1> transports{};
    std::array<SafeServer, last + 1> to{};

    void open(Duration answer_within) {
        for (std::size_t i = 0; i <= last; ++i) {
            EXPECT_TRUE(transports[i].open(
                {.line = modbus::Tcp{"127.0.0.1", servers[i].port()}, .answer_within = answer_within}));
            to[i] = {&transports[i], {requests, safe_word}};
        }
    }
    void all_but_the_last_are_silent() {
        for (std::size_t i = 0; i < last; ++i) servers[i].manner = Manner::silent;
    }
};

TEST_F(SafeRegisters, reach_every_server_that_answers) {
    open(30s); // no host is so busy
    EXPECT_EQ(write_safe(to, 1h, {}), 0u);
    for (const RawServer& server : servers) {
        const modbus::Bytes request = server.last_request();
        ASSERT_GE(request.size(), 15u);
        EXPECT_EQ(request[9], 9) << "its second";
        EXPECT_EQ(request[14], 7);
    }
}

TEST_F(SafeRegisters, reach_every_server_of_several_lines) {
    open(30s);
    for (std::size_t i = 0; i <= last; ++i) to[i].at = i % 2 == 0 ? "one gateway" : "another one";
    EXPECT_EQ(write_safe(to, 1h, {}), 0u);
    for (const RawServer& server : servers) {
        EXPECT_EQ(server.requests(), 2);
        EXPECT_EQ(server.last_request()[9], 9) << "its second";
    }
}

TEST_F(SafeRegisters, reach_a_live_server_before_a_dead_one_is_asked_again) {
    open(300ms);
    all_but_the_last_are_silent();
    std::atomic<int> asked_before = 0; // how often the first, until the last was
    servers[last].on_request([&](int number, const modbus::Bytes&) {
        if (number == 1) asked_before = servers[0].requests();
    });
    EXPECT_EQ(write_safe(to, 1h, {}), last);
    EXPECT_LE(asked_before, 2) << "one; or two on a host so busy that the live one was late";
    EXPECT_TRUE(to[last].is_safe);
}

TEST_F(SafeRegisters, are_given_up_when_their_time_is_over) {
    open(6s);
    all_but_the_last_are_silent();
    const Time begin = os::Clock::monotonic();
    EXPECT_EQ(write_safe(to, 500ms, {}), last);
    EXPECT_LT(os::Clock::monotonic() - begin, 6s) << "no server is waited for beyond it";
    EXPECT_TRUE(to[last].is_safe);
}

TEST_F(SafeRegisters, that_a_server_refuses_keep_none_behind_them_from_it) {
    open(30s);
    servers[0].manner = Manner::exception;
    EXPECT_EQ(write_safe(to, 1h, {}), 1u);
    EXPECT_EQ(servers[0].last_request()[9], 9) << "its second";
    EXPECT_FALSE(to[0].is_safe);
}

/// Silent servers on TCP, and behind them a serial one that answers.
struct BehindSilentServers : testing::Test {
    bool comes_to_the_serial_one(std::size_t silent, Duration answer_within, Duration within) {
        std::array tcp{RawServer{RawServer::Line::tcp}, RawServer{RawServer::Line::tcp},
                       RawServer{RawServer::Line::tcp}};
        RawServer serial{RawServer::Line::serial};
        std::array<modbus::LibmodbusTransport, 4> transports{};
        std::array<SafeServer, 4> to{};
        for (std::size_t i = 0; i < silent; ++i) {
            tcp[i].manner = Manner::silent;
            EXPECT_TRUE(transports[i].open(
                {.line = modbus::Tcp{"127.0.0.1", tcp[i].port()}, .answer_within = answer_within}));
            to[i] = {&transports[i], {requests, safe_word}};
        }
        EXPECT_TRUE(transports[3].open(
            {.line = modbus::Serial{serial.terminal(), 115200, 'N', 1}, .answer_within = 300ms}));
        to[silent] = {&transports[3], {requests, safe_word}};
        EXPECT_EQ(write_safe(std::span{to}.first(silent + 1), within, {}), silent);
        return to[silent].is_safe;
    }
};

TEST_F(BehindSilentServers, a_server_has_its_share_of_the_time) {
    EXPECT_TRUE(comes_to_the_serial_one(1, 3s, 3s));
    EXPECT_TRUE(comes_to_the_serial_one(3, 1200ms, 3s));
}

TEST(SilentServers, are_all_asked_though_quick_attempts_would_take_all_the_time) {
    std::array<std::optional<RawServer>, 12> servers;
    std::array<modbus::LibmodbusTransport, servers.size()> transports{};
    std::array<SafeServer, servers.size()> to{};
    for (std::size_t i = 0; i < servers.size(); ++i) {
        servers[i].emplace(RawServer::Line::tcp).manner = Manner::silent;
        EXPECT_TRUE(
            transports[i].open({.line = modbus::Tcp{"127.0.0.1", servers[i]->port()}, .answer_within = 2s}));
        to[i] = {&transports[i], {requests, safe_word}};
    }
    EXPECT_EQ(write_safe(to, 400ms, {}), servers.size());
    const Time until = os::Clock::monotonic() + 5s; // for what was asked and is not yet read
    for (const auto& server : servers) {
        while (server->last_request().empty() && os::Clock::monotonic() < until) os::sleep_for(1ms);
        EXPECT_FALSE(server->last_request().empty());
    }
}

/// Two silent servers and one that needs 600 ms for its answer.
TEST(SlowServer, is_made_safe_wherever_it_stands) {
    for (const std::size_t place : {0u, 2u}) {
        std::array servers{RawServer{RawServer::Line::tcp}, RawServer{RawServer::Line::tcp},
                           RawServer{RawServer::Line::tcp}};
        std::array<modbus::LibmodbusTransport, 3> transports{};
        std::array<SafeServer, 3> to{};
        for (std::size_t i = 0; i < to.size(); ++i) {
            servers[i].manner = i == place ? Manner::dribble : Manner::silent;
            EXPECT_TRUE(transports[i].open(
                {.line = modbus::Tcp{"127.0.0.1", servers[i].port()}, .answer_within = 2s}));
            to[i] = {&transports[i], {std::span{requests}.first(1), safe_word}};
        }
        EXPECT_EQ(write_safe(to, 3s, {}), 2u);
        EXPECT_TRUE(to[place].is_safe) << "as server " << place;
    }
}

/// Answers that take 600 ms each, and as many of them as there is time for; three lines are silent meanwhile.
TEST(SilentServers, take_no_time_of_another_line) {
    for (const std::size_t place : {0u, 3u}) {
        std::array servers{RawServer{RawServer::Line::tcp}, RawServer{RawServer::Line::tcp},
                           RawServer{RawServer::Line::tcp}, RawServer{RawServer::Line::tcp}};
        std::array<modbus::LibmodbusTransport, 4> transports{};
        std::array<SafeServer, 4> to{};
        const std::array many{requests[0], requests[1], requests[0], requests[1]};
        const std::array<std::string_view, 4> at{"a", "b", "c", "d"};
        for (std::size_t i = 0; i < to.size(); ++i) {
            servers[i].manner = i == place ? Manner::dribble : Manner::silent;
            EXPECT_TRUE(transports[i].open(
                {.line = modbus::Tcp{"127.0.0.1", servers[i].port()}, .answer_within = 10s}));
            to[i] = {&transports[i], {many, safe_word}, at[i]};
        }
        const Time begin = os::Clock::monotonic();
        int steps = 0;
        EXPECT_EQ(write_safe(to, 4s, {&steps, [](void* of) noexcept { ++*static_cast<int*>(of); }}), 3u);
        EXPECT_LT(os::Clock::monotonic() - begin, 6s) << "all of them wait at the same time";
        EXPECT_TRUE(to[place].is_safe) << "as server " << place;
        EXPECT_GE(steps, 10) << "whoever kicks a watchdog meanwhile";
    }
}

TEST(SilentLine, takes_no_longer_than_all_servers_may) {
    RawServer serial{RawServer::Line::serial};
    serial.manner = Manner::silent;
    modbus::LibmodbusTransport transport;
    EXPECT_TRUE(
        transport.open({.line = modbus::Serial{serial.terminal(), 115200, 'N', 1}, .answer_within = 2s}));
    std::array to{SafeServer{&transport, {requests, safe_word}}};
    const Time begin = os::Clock::monotonic();
    EXPECT_EQ(write_safe(to, 3s, {}), 1u);
    // Without a bound on the line's own rest it would be another second.
    EXPECT_LT(os::Clock::monotonic() - begin, 3600ms);
}

/// Each answer takes 600 ms; four of them are more than half of the time.
TEST(ServerWithManyRequests, goes_on_where_its_share_of_the_time_ended) {
    std::array servers{RawServer{RawServer::Line::tcp}, RawServer{RawServer::Line::tcp}};
    std::array<modbus::LibmodbusTransport, 2> transports{};
    std::array<SafeServer, 2> to{};
    const std::array many{requests[0], requests[1], requests[0], requests[1]};
    for (std::size_t i = 0; i < to.size(); ++i) {
        servers[i].manner = Manner::dribble;
        EXPECT_TRUE(
            transports[i].open({.line = modbus::Tcp{"127.0.0.1", servers[i].port()}, .answer_within = 2s}));
        to[i] = {&transports[i], {std::span{many}.first(i == 0 ? 4 : 1), safe_word}};
    }
    EXPECT_EQ(write_safe(to, 4500ms, {}), 0u);
}

/// It takes its first request, and closes the connection at its second one, as one that starts anew.
TEST(Restarted, server_is_told_all_again) {
    RawServer server{RawServer::Line::tcp};
    modbus::LibmodbusTransport transport;
    EXPECT_TRUE(transport.open({.line = modbus::Tcp{"127.0.0.1", server.port()}, .answer_within = 2s}));
    std::array to{SafeServer{&transport, {requests, safe_word}}};
    server.on_request([&server](int number, const modbus::Bytes&) {
        server.manner = number == 2 ? Manner::close : Manner::right;
    });
    EXPECT_EQ(write_safe(to, 30s, {}), 0u);
    EXPECT_EQ(server.last_request()[9], 3) << "its first one, once more";
}

/// It refuses everything for 150 ms.
TEST(BusyServer, is_asked_again_when_it_is_ready) {
    RawServer server{RawServer::Line::tcp};
    server.manner = Manner::exception;
    modbus::LibmodbusTransport transport;
    EXPECT_TRUE(transport.open({.line = modbus::Tcp{"127.0.0.1", server.port()}, .answer_within = 2s}));
    std::array to{SafeServer{&transport, {requests, safe_word}}};
    const Time ready = os::Clock::monotonic() + 150ms;
    server.on_request([&server, ready](int, const modbus::Bytes&) {
        if (os::Clock::monotonic() >= ready) server.manner = Manner::right;
    });
    EXPECT_EQ(write_safe(to, 30s, {}), 0u);
}

} // namespace
} // namespace tappet
