// What a guardian writes to Modbus servers of which some are dead: the live ones wait for none of them.
#include "drivers/hardware/open.hpp"
#include "kernel/os/clock.hpp"
#include "tests/drivers/modbus/raw_server.hpp"

#include <gtest/gtest.h>

#include <array>

namespace tappet {
namespace {

using modbus::Manner;
using modbus::RawServer;

constexpr std::array<std::uint16_t, 1> safe_word{7};
constexpr std::array<modbus::SafeWrite, 2> requests{
    modbus::SafeWrite{{modbus::Table::holding_registers, 3, 1}, 0},
    modbus::SafeWrite{{modbus::Table::holding_registers, 9, 1}, 0}};
constexpr std::size_t last = 3;

/// Four servers over Ethernet.
struct SafeRegisters : testing::Test {
    std::array<RawServer, last + 1> servers{RawServer{RawServer::Line::tcp}, RawServer{RawServer::Line::tcp},
                                            RawServer{RawServer::Line::tcp}, RawServer{RawServer::Line::tcp}};
    std::array<modbus::LibmodbusTransport, last + 1> transports{};
    std::array<SafeServer, last + 1> to{};
    int steps = 0;                 // that were taken
    int steps_before_the_last = 0; // until the last server was asked

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
    std::size_t write(Duration within) {
        const Meanwhile count{this, [](void* of) noexcept {
                                  auto& test = *static_cast<SafeRegisters*>(of);
                                  ++test.steps;
                                  if (test.servers[last].last_request().empty())
                                      test.steps_before_the_last = test.steps;
                              }};
        return write_safe_registers(to, within, count);
    }
};

TEST_F(SafeRegisters, reach_every_server_that_answers) {
    open(30s); // no host is so busy
    EXPECT_EQ(write(1h), 0u);
    for (const RawServer& server : servers) {
        const modbus::Bytes request = server.last_request();
        ASSERT_GE(request.size(), 15u);
        EXPECT_EQ(request[9], 9) << "its second";
        EXPECT_EQ(request[14], 7);
    }
}

TEST_F(SafeRegisters, reach_a_live_server_before_a_dead_one_is_asked_again) {
    open(300ms);
    all_but_the_last_are_silent();
    EXPECT_EQ(write(1h), last);
    // Connect and one request for each dead one, two requests for the live one; once more on a host so busy
    // that the live one was late.
    EXPECT_LE(steps_before_the_last, 2 * (2 * static_cast<int>(last) + 2));
    EXPECT_TRUE(to[last].is_safe);
}

TEST_F(SafeRegisters, are_given_up_when_their_time_is_over) {
    open(6s);
    all_but_the_last_are_silent();
    const Time begin = os::Clock::monotonic();
    EXPECT_EQ(write(500ms), last);
    EXPECT_LT(os::Clock::monotonic() - begin, 6s) << "no server is waited for beyond it";
    EXPECT_TRUE(to[last].is_safe);
}

TEST_F(SafeRegisters, that_a_server_refuses_keep_none_behind_them_from_it) {
    open(30s);
    servers[0].manner = Manner::exception;
    EXPECT_EQ(write(1h), 1u);
    EXPECT_EQ(servers[0].last_request()[9], 9) << "its second";
    EXPECT_FALSE(to[0].is_safe);
}

} // namespace
} // namespace tappet
