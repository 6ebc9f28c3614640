// A refused bus: the sentence names the frame, its bound, the largest part of it, and the cure.
#include "drivers/can/bus_traffic.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

struct BusUse {
    BusFacts bus;
    Duration response;
};
constexpr BusUse at(std::uint32_t bit_rate, unsigned errors = 0, Duration response = 0us) {
    return {{bit_rate, 0, errors, 100ms}, response};
}
constexpr auto heard(std::uint32_t id, std::string_view name, std::uint8_t length, Duration period,
                     Duration jitter = {}) {
    return receive(standard(id), name, bytes(length), every(period, jitter), signal("a", 0, 8));
}
constexpr auto sent(std::uint32_t id, std::string_view name, std::uint8_t length, Rate rate) {
    return transmit(standard(id), name, bytes(length), rate, signal("a", 0, 8).safe(0));
}
template <class... Rows> std::string refusal(const BusUse& use, const Rows&... rows) {
    const auto map = signal_map(rows...);
    EXPECT_EQ(map.fault.view(), "");
    return std::string{bus_traffic(map.frames, use.bus, use.response, {}).view()};
}

TEST(BusTraffic, lists_the_proven_frames_in_the_order_of_arbitration) {
    constexpr auto map =
        signal_map(heard(0x300, "slow", 8, 100ms), sent(0x201, "command", 6, every(2ms)),
                   heard(0x181, "status", 6, 2ms), sent(0x80, "sync", 0, on_demand(10ms)).safe_by_silence());
    static_assert(!map.fault.empty(), "no signal fits into no byte");
    constexpr auto good = signal_map(heard(0x300, "slow", 8, 100ms), sent(0x201, "command", 6, every(2ms)),
                                     heard(0x181, "status", 6, 2ms));
    std::array<TrafficRow, 3> rows{};
    EXPECT_EQ(bus_traffic(good.frames, at(500'000).bus, 0us, rows).view(), "");
    EXPECT_EQ(rows[0].name, "status");
    EXPECT_FALSE(rows[0].sent);
    EXPECT_EQ(rows[0].worst, 230us + 270us);
    EXPECT_EQ(rows[1].name, "command");
    EXPECT_TRUE(rows[1].sent);
    EXPECT_EQ(rows[1].wire_time, 230us);
    EXPECT_EQ(rows[1].worst, 270us + 230us + 230us);
    EXPECT_EQ(rows[2].name, "slow");
    EXPECT_EQ(rows[2].deadline, 100ms);
}

constexpr auto only_heard = signal_map(heard(0x181, "status", 6, 2ms));
static_assert(bus_traffic(only_heard.frames, at(500'000).bus, 100us, {}).empty(),
              "a machine that only listens");
static_assert(least_time_ns(1'000'001) == 800'000 && frames_in_flight(1s, Duration::max()) == 2);

TEST(BusTraffic, is_refused_with_the_largest_part_of_the_response) {
    EXPECT_EQ(refusal(at(125'000), heard(0x181, "a", 8, 1ms), heard(0x182, "b", 8, 10ms)),
              "frame \"a\" may never be sent: it and more urgent frames fill the bus, which all frames "
              "together load by 118 % at 125000 bit/s; send less often, or run the bus faster");
    EXPECT_EQ(
        refusal(at(125'000), heard(0x181, "a", 1, 1ms), heard(0x182, "b", 8, 100ms)),
        "frame \"a\" may take 1600 us but is due within 1000 us; the largest part, 1080 us, is \"b\", which "
        "may just have begun; shorten that, or lengthen the period");
    EXPECT_EQ(
        refusal(at(125'000, 0, 100us), sent(0x181, "a", 8, every(2ms))),
        "frame \"a\" may still wait when the next one follows, 2000 us later; the largest part, 1080 us, is "
        "its own time on the wire; lengthen its period, or run the bus faster than 125000 bit/s");
    EXPECT_EQ(
        refusal(at(500'000), heard(0x100, "busy", 8, 600us), heard(0x200, "b", 8, 800us),
                heard(0x300, "c", 8, 100ms)),
        "frame \"b\" may take 810 us but is due within 800 us; the largest part, 270 us, is \"busy\", which "
        "wins the bus before it; send that less often, or give this one a lower identifier");
    EXPECT_EQ(
        refusal(at(500'000), heard(0x100, "late", 8, 2ms, 1900us)),
        "frame \"late\" may take 2170 us but is due within 2000 us; the largest part, 1900 us, is how late "
        "it may enter its queue; shorten the response of the activity that drives the bus, or the "
        "jitter in its every(...)");
    EXPECT_EQ(refusal(at(500'000, 3), heard(0x100, "a", 8, 1ms)),
              "frame \"a\" may take 1266 us but is due within 1000 us; the largest part, 996 us, is caused "
              "by errors on the wire; lengthen the period, or state fewer errors with "
              "bus_errors(...) of the board's device");
    EXPECT_EQ(
        refusal(at(250'000, 0, 1ms), sent(0x100, "urgent", 1, every(3ms)),
                sent(0x200, "long", 8, on_demand(100ms)), sent(0x201, "longer", 8, on_demand(100ms)),
                sent(0x202, "longest", 8, on_demand(100ms)), sent(0x203, "more", 8, on_demand(100ms))),
        "frame \"urgent\" may still wait when the next one follows, 3000 us later; the largest part, 2160 "
        "us, is caused by less urgent frames of this machine that the controller holds already; shorten "
        "those, or lengthen the period");
}

TEST(BusTraffic, is_refused_when_the_machine_hands_frames_over_too_slowly) {
    constexpr std::array names{"b", "c", "d", "e", "f", "g", "h", "i", "j"};
    const std::string refused = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return refusal(at(1'000'000, 0, 8ms), sent(0x100, "a", 1, on_demand(100ms)),
                       sent(0x101 + I, names[I], 1, on_demand(100ms))...);
    }(std::make_index_sequence<names.size()>{});
    EXPECT_EQ(
        refused,
        "frame \"b\" may take 23805 us but is due within 20000 us; the largest part, 15090 us, is the time "
        "until the next frames follow those in flight; shorten the response of the activity "
        "that drives the bus");
}

TEST(BusTraffic, uses_both_bit_rates_for_can_fd_frames) {
    constexpr auto map = signal_map(
        receive(standard(0x181), "fast", fd_bytes(64), every(2ms), signal("a", 0, 8)),
        receive(standard(0x182), "slow", fd_bytes(64).in_one_rate(), every(10ms), signal("a", 0, 8)),
        receive(standard(0x183), "old", bytes(8), every(10ms), signal("a", 0, 8)));
    std::array<TrafficRow, 3> rows{};
    EXPECT_EQ(bus_traffic(map.frames, {500'000, 2'000'000, 0, 100ms}, 0us, rows).view(), "");
    EXPECT_EQ(rows[0].wire_time, 403us);
    EXPECT_EQ(rows[0].worst, 1420us + 403us);
    EXPECT_EQ(rows[1].wire_time, 1420us);
    EXPECT_EQ(rows[2].wire_time, 270us);
    const auto often = receive(standard(0x181), "fast", fd_bytes(64), every(700us), signal("a", 0, 8));
    EXPECT_EQ(refusal({{250'000, 2'000'000, 0, 100ms}, 0us}, often), "") << "128 us and 339 us";
    EXPECT_EQ(refusal({{500'000, 1'000'000, 0, 100ms}, 0us}, often),
              "frame \"fast\" may never be sent: it and more urgent frames fill the bus, which all "
              "frames together load by 106 % at 500000 bit/s; send less often, or run the bus faster");
}
TEST(BusTraffic, is_refused_for_can_fd_frames_without_a_data_bit_rate) {
    for (const Bytes length : {fd_bytes(8), fd_bytes(8).in_one_rate()})
        EXPECT_EQ(refusal(at(500'000), receive(standard(1), "scan", length, every(10ms), signal("a", 0, 8))),
                  "frame \"scan\" is CAN FD, but the board states no bit rate for CAN FD's data phase; add "
                  "it to the "
                  "device's row, bit_rate(500000, 2'000'000), or make the frame a classical one, bytes(8)");
}

TEST(BusTraffic, is_refused_when_a_sent_frame_may_become_too_old) {
    const std::string refused = refusal(at(10'000), sent(0x100, "slow", 8, every(100ms)));
    EXPECT_TRUE(refused.starts_with("frame \"slow\" may take 27000 us but is due within 20000 us"))
        << refused;
}

} // namespace
} // namespace tappet::can
