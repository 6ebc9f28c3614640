// The kernel's description of a CAN interface, and the interfaces on which a machine may send.
#include "drivers/can/link.hpp"
#include "drivers/can/netlink.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <linux/can/netlink.h>
#include <net/if.h>
#include <net/if_arp.h>

namespace tappet::can {
namespace {

using Bytes = std::vector<std::byte>;

template <class T> Bytes bytes_of(const T& object) {
    Bytes bytes(sizeof object);
    std::memcpy(bytes.data(), &object, sizeof object);
    return bytes;
}
Bytes attribute(int type, const Bytes& payload) {
    rtattr head{};
    head.rta_type = static_cast<unsigned short>(type);
    head.rta_len = static_cast<unsigned short>(sizeof head + payload.size());
    Bytes all = bytes_of(head);
    all.insert(all.end(), payload.begin(), payload.end());
    all.resize((all.size() + 3) & ~std::size_t{3});
    return all;
}
Bytes joined(const std::vector<Bytes>& pieces) {
    Bytes all;
    for (const Bytes& each : pieces) all.insert(all.end(), each.begin(), each.end());
    return all;
}
Bytes text(std::string_view characters) {
    Bytes bytes(characters.size() + 1);
    std::memcpy(bytes.data(), characters.data(), characters.size());
    return bytes;
}

struct Controller {
    const char* kind = "can";
    std::uint32_t state = CAN_STATE_ERROR_ACTIVE;
    std::uint32_t bit_rate = 500'000;
    std::uint32_t restart_ms = 0;
    std::uint32_t data_bit_rate = 0; ///< not 0: it is set to CAN FD
    unsigned flags = IFF_UP;
    unsigned short type = ARPHRD_CAN;
};

/// As the kernel answers RTM_GETLINK (rtnetlink(7), linux/can/netlink.h).
Bytes answer(const Controller& of, std::uint32_t sequence = 1) {
    can_bittiming timing{};
    timing.bitrate = of.bit_rate;
    can_bittiming fast{};
    fast.bitrate = of.data_bit_rate;
    const std::uint32_t mtu = of.data_bit_rate == 0 ? 16 : 72;
    const Bytes data = joined({attribute(IFLA_CAN_BITTIMING, bytes_of(timing)),
                               attribute(IFLA_CAN_DATA_BITTIMING, bytes_of(fast)),
                               attribute(IFLA_CAN_STATE, bytes_of(of.state)),
                               attribute(IFLA_CAN_RESTART_MS, bytes_of(of.restart_ms))});
    const Bytes info = joined({attribute(IFLA_INFO_KIND, text(of.kind)), attribute(IFLA_INFO_DATA, data)});
    ifinfomsg interface{};
    interface.ifi_type = of.type;
    interface.ifi_index = 7;
    interface.ifi_flags = of.flags;
    Bytes body = joined({bytes_of(interface), attribute(IFLA_IFNAME, text("can0")),
                         attribute(IFLA_MTU, bytes_of(mtu)), attribute(IFLA_LINKINFO, info)});
    nlmsghdr head{};
    head.nlmsg_len = static_cast<std::uint32_t>(sizeof head + body.size());
    head.nlmsg_type = RTM_NEWLINK;
    head.nlmsg_seq = sequence;
    return joined({bytes_of(head), body});
}
Link link_of(const Controller& controller) {
    const auto link = read_link("can0", answer(controller));
    EXPECT_TRUE(link) << link.error().view();
    return link.value_or(Link{});
}
std::string refusal(const Controller& controller, std::uint32_t bit_rate = 500'000,
                    std::uint32_t data_bit_rate = 0, bool takes_fd = false) {
    const auto good = fit(link_of(controller), "can0",
                          {.bit_rate = bit_rate, .data_bit_rate = data_bit_rate, .takes_fd = takes_fd});
    return good ? "" : std::string{good.error().view()};
}

TEST(CanLink, knows_the_state_of_the_controller_before_the_first_frame) {
    EXPECT_EQ(link_of({.state = CAN_STATE_ERROR_ACTIVE}).state, State::active);
    EXPECT_EQ(link_of({.state = CAN_STATE_ERROR_WARNING}).state, State::warning);
    EXPECT_EQ(link_of({.state = CAN_STATE_ERROR_PASSIVE}).state, State::passive);
    EXPECT_EQ(link_of({.state = CAN_STATE_BUS_OFF}).state, State::bus_off);
    EXPECT_EQ(link_of({.state = CAN_STATE_STOPPED}).state, State::down);
    EXPECT_EQ(link_of({.state = CAN_STATE_SLEEPING}).state, State::down);
}

TEST(CanLink, knows_the_settings_of_the_interface) {
    const Link link = link_of({.bit_rate = 125'000, .restart_ms = 100});
    EXPECT_EQ(link.index, 7);
    EXPECT_TRUE(link.up);
    EXPECT_FALSE(link.is_virtual);
    EXPECT_EQ(link.bit_rate, 125'000u);
    EXPECT_EQ(link.restart_ms, 100u);
    EXPECT_FALSE(link_of({.flags = 0}).up);
    EXPECT_TRUE(link_of({.kind = "vcan"}).is_virtual);
}

TEST(CanLink, refuses_other_interfaces_and_answers_that_are_too_short) {
    EXPECT_FALSE(read_link("eth0", answer({.type = ARPHRD_ETHER})));
    const Bytes whole = answer({});
    EXPECT_FALSE(read_link("can0", std::span{whole}.first(20)));
    for (std::size_t n = 32; n < whole.size(); ++n) // truncated anywhere else it says less, and nothing wrong
        EXPECT_TRUE(read_link("can0", std::span{whole}.first(n))) << n;
}

TEST(CanLink, fits_when_its_controller_runs_at_the_rate_of_the_board) {
    EXPECT_EQ(refusal({}), "");
    EXPECT_EQ(refusal({.state = CAN_STATE_ERROR_PASSIVE}), "") << "as alone on a bus whose nodes are off";
    EXPECT_EQ(
        refusal({}, 250'000),
        "CAN interface \"can0\" runs at 500000 bit/s, the board says 250000: correct one of them (ip link "
        "set can0 type can bitrate ...)");
    EXPECT_NE(refusal({}, 0).find("the board says it"), std::string::npos);
}

TEST(CanLink, skips_the_bit_rate_of_a_virtual_interface) {
    EXPECT_EQ(refusal({.kind = "vcan", .bit_rate = 0}), "");
}

TEST(CanLink, knows_whether_and_at_which_bit_rate_it_accepts_can_fd) {
    const Link link = link_of({.data_bit_rate = 2'000'000});
    EXPECT_EQ(link.mtu, 72u);
    EXPECT_EQ(link.data_bit_rate, 2'000'000u);
    EXPECT_TRUE(link.takes_fd());
    EXPECT_FALSE(link_of({}).takes_fd());
}

TEST(CanLink, fits_a_can_fd_map_when_it_is_set_to_can_fd) {
    EXPECT_EQ(refusal({.data_bit_rate = 2'000'000}, 500'000, 2'000'000, true), "");
    EXPECT_EQ(refusal({.kind = "vcan", .data_bit_rate = 1}, 500'000, 2'000'000, true), "");
    EXPECT_EQ(refusal({}, 500'000, 2'000'000, true),
              "CAN interface \"can0\" carries classical frames only (mtu 16, of CAN FD 72), and its bus has "
              "CAN FD: set it down, and up again after ip link set can0 type can bitrate ... dbitrate ... fd "
              "on; its controller must be one for CAN FD");
    EXPECT_EQ(refusal({.kind = "vcan"}, 500'000, 2'000'000, true),
              "CAN interface \"can0\" carries classical frames only (mtu 16, of CAN FD 72), and its bus has "
              "CAN FD: set it down, and up again after ip link set can0 mtu 72");
    EXPECT_EQ(refusal({.data_bit_rate = 1'000'000}, 500'000, 2'000'000, true),
              "CAN interface \"can0\" runs at 1000000 bit/s in CAN FD's data phase, the board says 2000000: "
              "correct one of them (ip link set can0 type can dbitrate ... fd on)");
    EXPECT_NE(refusal({.data_bit_rate = 2'000'000}, 500'000, 0, true).find("without its data bit rate"),
              std::string::npos);
}

TEST(CanLink, is_set_to_can_fd_by_the_board_even_for_classical_frames) {
    EXPECT_NE(refusal({}, 500'000, 2'000'000).find("carries classical frames only"), std::string::npos)
        << "its controller would spoil the others' frames";
    EXPECT_EQ(refusal({.kind = "vcan"}, 500'000, 2'000'000), "");
    EXPECT_EQ(refusal({.data_bit_rate = 2'000'000}), "") << "more than is asked for";
}

TEST(CanLink, does_not_fit_while_its_controller_is_bus_off) {
    EXPECT_EQ(
        refusal({.state = CAN_STATE_BUS_OFF}),
        "CAN interface \"can0\" is bus-off: look at its wiring and at the other nodes' power, then restart "
        "it (ip link set can0 down, and up)");
    EXPECT_NE(refusal({.state = CAN_STATE_STOPPED}).find("is stopped"), std::string::npos);
    EXPECT_NE(refusal({.flags = 0}).find("is down: set it up"), std::string::npos);
    EXPECT_NE(refusal({.restart_ms = 100}).find("set restart-ms 0"), std::string::npos);
}

constexpr std::uint32_t kernel = 0, asked = 5;

TEST(Netlink, accepts_the_answer_of_the_kernel_to_its_own_request) {
    const NetlinkAnswer taken = judge(answer({}, asked), kernel, false, asked);
    EXPECT_TRUE(taken.ours);
    EXPECT_EQ(taken.error, 0);
}

TEST(Netlink, ignores_answers_of_other_processes_and_to_other_requests) {
    EXPECT_FALSE(judge(answer({}, asked), 4711, false, asked).ours);
    EXPECT_FALSE(judge(answer({}, asked - 1), kernel, false, asked).ours);
    EXPECT_FALSE(judge({}, kernel, false, asked).ours);
}

TEST(Netlink, treats_a_truncated_answer_as_an_error) {
    EXPECT_EQ(judge(answer({}, asked), kernel, true, asked).error, EMSGSIZE);
    const Bytes whole = answer({}, asked);
    const NetlinkAnswer taken = judge(std::span{whole}.first(whole.size() - 4), kernel, false, asked);
    EXPECT_TRUE(taken.ours);
    EXPECT_EQ(taken.error, EPROTO);
}

TEST(Netlink, distinguishes_a_refusal_of_the_kernel_from_an_acknowledgement) {
    nlmsghdr head{};
    head.nlmsg_type = NLMSG_ERROR;
    head.nlmsg_seq = asked;
    nlmsgerr error{};
    head.nlmsg_len = sizeof head + sizeof error;
    EXPECT_EQ(judge(joined({bytes_of(head), bytes_of(error)}), kernel, false, asked).error, 0);
    error.error = -EPERM;
    EXPECT_EQ(judge(joined({bytes_of(head), bytes_of(error)}), kernel, false, asked).error, EPERM);
}

TEST(Netlink, asks_the_running_kernel) {
    Netlink netlink;
    ifinfomsg what{};
    what.ifi_index = static_cast<int>(::if_nametoindex("lo"));
    for (int round = 0; round < 3; ++round) {
        ASSERT_EQ(netlink.ask(what, RTM_GETLINK, 0), 0);
        EXPECT_FALSE(read_link("lo", netlink.data())) << "it is no CAN interface";
    }
    what.ifi_index = 0x7FFF'FFF0;
    EXPECT_EQ(netlink.ask(what, RTM_GETLINK, 0), ENODEV);
}

} // namespace
} // namespace tappet::can
