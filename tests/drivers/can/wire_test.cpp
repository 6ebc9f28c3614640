// Linux's frames, filters and error frames, as the machine reads them.
#include "drivers/can/wire.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

/// The kernel's own rule for a filter (net/can/af_can.c).
bool passes(const can_filter& filter, std::uint32_t can_id) {
    return (can_id & filter.can_mask) == (filter.can_id & filter.can_mask);
}

TEST(Filter, passes_exactly_one_standard_identifier) {
    const can_filter filter = wire::exactly({0x181, false});
    EXPECT_EQ(filter.can_mask, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK)
        << "the mask of the kernel's fast path";
    EXPECT_TRUE(passes(filter, 0x181));
    EXPECT_FALSE(passes(filter, 0x182));
    EXPECT_FALSE(passes(filter, 0x181 | CAN_EFF_FLAG));
    EXPECT_FALSE(passes(filter, 0x181 | CAN_RTR_FLAG));
    EXPECT_FALSE(passes(filter, 0x18FF'0181 | CAN_EFF_FLAG));
}

TEST(Filter, passes_exactly_one_extended_identifier) {
    const can_filter filter = wire::exactly({0x18FF'0102, true});
    EXPECT_TRUE(passes(filter, 0x18FF'0102 | CAN_EFF_FLAG));
    EXPECT_FALSE(passes(filter, 0x102));
    EXPECT_FALSE(passes(filter, 0x18FF'0102 | CAN_EFF_FLAG | CAN_RTR_FLAG));
}

Frame back_from(const Frame& f) {
    canfd_frame raw;
    wire::encode(f, raw);
    Frame back;
    EXPECT_TRUE(wire::decode(raw, wire::bytes_of(f), State::active, back));
    return back;
}
Frame numbered(std::uint8_t length) {
    Frame f{.id = 0x123, .length = length};
    for (std::size_t i = 0; i < length; ++i) f.data[i] = static_cast<std::uint8_t>(i + 1);
    return f;
}

TEST(Wire, carries_frames_both_ways) {
    for (const bool is_extended : {false, true})
        for (const bool is_remote : {false, true}) {
            Frame f = numbered(8);
            f.extended = is_extended;
            f.remote = is_remote;
            EXPECT_EQ(wire::bytes_of(f), 16u);
            EXPECT_EQ(back_from(f), f);
        }
}

TEST(Wire, carries_can_fd_frames_of_every_length) {
    for (const int length : {0, 1, 8, 12, 16, 20, 24, 32, 48, 64})
        for (const Format format : {Format::flexible, Format::flexible_faster}) {
            Frame f = numbered(static_cast<std::uint8_t>(length));
            set_format(f, format);
            EXPECT_EQ(wire::bytes_of(f), 72u);
            EXPECT_EQ(back_from(f), f) << length;
        }
}

TEST(Wire, reports_that_the_sender_is_error_passive) {
    canfd_frame raw{};
    raw.len = 8;
    raw.flags = CANFD_ESI;
    Frame f;
    ASSERT_TRUE(wire::decode(raw, CANFD_MTU, State::active, f));
    EXPECT_TRUE(f.error_state_indicator);
    EXPECT_FALSE(f.bit_rate_switch);
}

TEST(Wire, ignores_the_flags_of_a_classical_frame) { // that byte is padding there
    canfd_frame raw{};
    raw.len = 8;
    raw.flags = 0xFF;
    Frame f;
    ASSERT_TRUE(wire::decode(raw, CAN_MTU, State::active, f));
    EXPECT_EQ(format_of(f), Format::classical);
    EXPECT_FALSE(f.error_state_indicator);
}

TEST(Wire, refuses_a_length_that_does_not_exist) {
    for (const auto& [bytes, length] : {std::pair<std::size_t, int>{CAN_MTU, 9},
                                        {CANFD_MTU, 9},
                                        {CANFD_MTU, 63},
                                        {CANFD_MTU, 65},
                                        {CAN_MTU - 1, 8},
                                        {CANFD_MTU + 1, 8},
                                        {0, 0}}) {
        canfd_frame raw{};
        raw.len = static_cast<std::uint8_t>(length);
        Frame f;
        EXPECT_FALSE(wire::decode(raw, bytes, State::active, f)) << bytes << ", " << length;
    }
}

TEST(ErrorFrame, reports_bus_off) {
    canfd_frame raw{};
    raw.can_id = 0x2000'0040; // as vcan passes it when it is injected
    raw.len = 8;
    EXPECT_EQ(wire::decode_error(raw, State::passive).state, State::bus_off);
}

TEST(ErrorFrame, reports_the_error_state_and_keeps_it_when_unmentioned) {
    canfd_frame raw{};
    raw.can_id = CAN_ERR_FLAG | CAN_ERR_CRTL;
    raw.len = 8;
    raw.data[6] = 130;
    EXPECT_EQ(wire::decode_error(raw, State::warning).state, State::warning);
    raw.data[1] = CAN_ERR_CRTL_RX_WARNING;
    EXPECT_EQ(wire::decode_error(raw, State::active).state, State::warning);
    raw.data[1] = CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_TX_WARNING;
    EXPECT_EQ(wire::decode_error(raw, State::active).state, State::passive);
    EXPECT_EQ(wire::decode_error(raw, State::active).transmit_errors, 130);
    raw.data[1] = CAN_ERR_CRTL_ACTIVE;
    EXPECT_EQ(wire::decode_error(raw, State::passive).state, State::active);
    raw.data[1] = CAN_ERR_CRTL_RX_OVERFLOW;
    EXPECT_TRUE(wire::decode_error(raw, State::active).overrun);
}

TEST(ErrorFrame, is_not_requested_for_single_bus_errors) {
    EXPECT_EQ(wire::error_mask & (CAN_ERR_BUSERROR | CAN_ERR_PROT | CAN_ERR_ACK | CAN_ERR_LOSTARB), 0u);
}

} // namespace
} // namespace tappet::can
