// Opening a CAN interface that cannot work: each refusal names the place, the fault and the cure. The rest is
// tested on the bench.
#include "drivers/can/socket_can.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tappet::can {
namespace {

std::string refusal(std::string_view interface) {
    SocketCan can;
    const auto opened = can.open({.interface = interface});
    EXPECT_FALSE(opened) << interface;
    EXPECT_FALSE(can.is_open());
    return opened ? "" : std::string{opened.error().view()};
}

TEST(SocketCan, refuses_a_missing_interface_and_says_how_to_create_it) {
    EXPECT_EQ(refusal("can77"),
              "CAN interface \"can77\" does not exist: create it (ip link add dev can77 type vcan, or load "
              "its controller's driver) or name another in the board");
}

TEST(SocketCan, refuses_impossible_interface_names) {
    EXPECT_NE(refusal("").find("1 to 15 characters"), std::string::npos);
    EXPECT_NE(refusal("can-with-a-long-name").find("1 to 15 characters"), std::string::npos);
}

TEST(SocketCan, refuses_an_interface_that_is_not_a_can_bus) {
    EXPECT_EQ(
        refusal("lo"),
        "CAN interface \"lo\" is not a CAN interface; name another in the board (ip link show type can)");
}

TEST(SocketCan, refuses_a_bit_rate_other_than_that_of_the_board) {
    SocketCan can;
    const Link link{.index = 7, .up = true, .bit_rate = 500'000};
    const auto opened = can.open({.interface = "can0", .bit_rate = 250'000}, link);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().view(),
              "CAN interface \"can0\" runs at 500000 bit/s, the board says 250000: correct one of them "
              "(ip link set can0 type can bitrate ...)");
    EXPECT_FALSE(can.is_open()) << "nothing stays open";
}

TEST(SocketCan, does_nothing_while_it_is_closed) {
    constexpr std::array sends{Identifier{1, false}};
    SocketCan can;
    EXPECT_FALSE(can.open({.interface = "can77", .transmit = sends}));
    Frame f;
    EXPECT_EQ(can.receive(f).what, Received::none);
    can.service(Time{1ms});
    EXPECT_EQ(can.counters().sent, 0u);
    EXPECT_EQ(can.restart(), Restart::not_needed);
}

} // namespace
} // namespace tappet::can
