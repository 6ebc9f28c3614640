// Valid frames, classical and CAN FD, and their time on the wire.
#include "drivers/can/frame_time.hpp"

#include <gtest/gtest.h>

#include <set>

namespace tappet::can {
namespace {

Frame of_length(unsigned length, bool fd = true) {
    return {.id = 0x123, .fd = fd, .length = static_cast<std::uint8_t>(length)};
}

TEST(Frame, allows_only_the_lengths_of_its_format) {
    const std::set<unsigned> lengths{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
    for (unsigned length = 0; length < 256; ++length) {
        EXPECT_EQ(valid(of_length(length)), lengths.contains(length)) << length;
        EXPECT_EQ(valid(of_length(length, false)), length <= 8) << length;
    }
}

TEST(Frame, refuses_remote_can_fd_and_fast_classical_frames) {
    Frame f = of_length(8);
    f.remote = true;
    EXPECT_FALSE(valid(f));
    f.fd = false;
    EXPECT_TRUE(valid(f));
    f.remote = false;
    f.bit_rate_switch = true;
    EXPECT_FALSE(valid(f));
    f.fd = true;
    EXPECT_TRUE(valid(f));
    f.id = 0x800;
    EXPECT_FALSE(valid(f));
}

TEST(Frame, keeps_its_format) {
    for (const Format format : {Format::classical, Format::flexible, Format::flexible_faster}) {
        Frame f;
        set_format(f, format);
        EXPECT_EQ(format_of(f), format);
    }
}

TEST(FrameTime, depends_on_format_kind_and_length) {
    constexpr BitRates rates{1'000'000'000, 0}; // a bit takes 1 ns
    Frame f = of_length(8, false);
    EXPECT_EQ(frame_time_ns(f, rates), 135); // Davis et al. 2007: 55 + 10 n for 11-bit identifiers
    f.extended = true;
    EXPECT_EQ(frame_time_ns(f, rates), 160); // 80 + 10 n for 29-bit identifiers
    f.extended = false;
    f.remote = true;
    EXPECT_EQ(frame_time_ns(f, rates), 55) << "its length is only asked for";
    f = of_length(64);
    EXPECT_EQ(frame_time_ns(f, {500'000, 2'000'000}), 1'420'000) << "710 bits, all of them slow";
    f.bit_rate_switch = true;
    EXPECT_EQ(frame_time_ns(f, {500'000, 2'000'000}), 403'000) << "32 slow ones, 678 fast ones";
}

} // namespace
} // namespace tappet::can
