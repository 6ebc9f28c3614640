// Frames that carry a clock: they have the layout of the standard, decode as they were encoded, and corrupted
// ones are refused.
#include "drivers/can/clock_frames.hpp"
#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

constexpr auto row = [] {
    ClockRow told = clock(standard(0x090), every(100ms), 5);
    for (std::uint8_t i = 0; i < 16; ++i) {
        told.sync_ids[i] = static_cast<std::uint8_t>(0x40 + i);
        told.follow_up_ids[i] = static_cast<std::uint8_t>(0x60 + i);
    }
    return told;
}();
static_assert(clock_fault(row).empty());
static_assert(clock_fault(clock(standard(0x800), every(100ms))).view() ==
              "the clock's identifier 2048 is out of range: give it another");
static_assert(clock_fault(clock(standard(1), every(9ms))).view() ==
              "the clock is sent every 9 ms: write every(..) from 10 ms to 10 s");
static_assert(!clock_fault(clock(standard(1), every(11s))).empty());
static_assert(!clock_fault(clock(standard(1), on_demand(100ms))).empty());
static_assert(clock_fault(clock(standard(1), every(100ms, 26ms))).view() ==
              "the clock's teller may be late by 26 ms: write at most a quarter of its period");
static_assert(clock_fault(clock(standard(1), every(100ms), 16)).view() ==
              "the clock's domain is 16: write one from 0 to 15");

constexpr ClockFrame sync{.kind = ClockFrame::Kind::sync, .sequence = 7, .number = 0x01020304};
constexpr ClockFrame follow_up{.kind = ClockFrame::Kind::follow_up,
                               .sequence = 7,
                               .number = 999'999'999, // 3B9AC9FFh
                               .seconds_more = 2};

TEST(ClockFrames, have_the_layout_of_the_standard) {
    const Frame first = encode(row, sync);
    EXPECT_EQ(first.id, 0x090u);
    EXPECT_EQ(first.length, 8);
    const std::array<std::uint8_t, 8> summed_first{0x57, 0x00, 1, 2, 3, 4, 0x47};
    EXPECT_EQ(first.data[0], 0x20);
    EXPECT_EQ(first.data[1], crc8_2f.of(std::span{summed_first}.first(7)));
    EXPECT_EQ(first.data[2], 0x57) << "domain and sequence";
    EXPECT_EQ(first.data[3], 0x00);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(first.data[4 + i], i + 1) << "the highest byte first";
    const Frame second = encode(row, follow_up);
    const std::array<std::uint8_t, 7> summed_second{0x57, 0x02, 0x3B, 0x9A, 0xC9, 0xFF, 0x67};
    EXPECT_EQ(second.data[0], 0x28);
    EXPECT_EQ(second.data[1], crc8_2f.of(summed_second));
    EXPECT_EQ(second.data[3], 0x02) << "whole seconds";
    EXPECT_EQ(second.data[4], 0x3B);
    EXPECT_EQ(second.data[7], 0xFF);
}

TEST(ClockFrames, decode_as_they_were_encoded) {
    Random random{1};
    for (int i = 0; i < 10'000; ++i) {
        ClockFrame told;
        told.kind = random.one_in(2) ? ClockFrame::Kind::sync : ClockFrame::Kind::follow_up;
        told.sequence = static_cast<std::uint8_t>(random.below(16));
        const bool is_sync = told.kind == ClockFrame::Kind::sync;
        told.number = static_cast<std::uint32_t>(random.below(is_sync ? 1ULL << 32 : 1'000'000'000));
        if (!is_sync) told.seconds_more = static_cast<std::uint8_t>(random.below(4));
        ClockFrame read;
        ASSERT_EQ(decode(row, encode(row, told), read), ClockRead::told);
        ASSERT_EQ(read, told);
    }
}

TEST(ClockFrames, ignore_foreign_frames) {
    ClockFrame read;
    const Frame good = encode(row, sync);
    Frame other = good, extended = good, remote = good, offset = good;
    other.id = 0x091;
    extended.extended = true;
    remote.remote = true;
    offset.data[0] = 0x34; // an offset's
    ClockRow neighbour = row;
    neighbour.domain = 6;
    for (const auto& [what, frame] : {std::pair{"identifier", other},
                                      {"format", extended},
                                      {"remote", remote},
                                      {"kind", offset},
                                      {"domain", encode(neighbour, sync)}})
        EXPECT_EQ(decode(row, frame, read), ClockRead::foreign) << what;
}

TEST(ClockFrames, are_wrong_when_corrupted_truncated_or_unsecured) {
    for (const ClockFrame& told : {sync, follow_up}) {
        const Frame good = encode(row, told);
        ClockFrame read;
        for (std::size_t one = 0; one < 64; ++one)
            for (std::size_t other = 0; other <= one; ++other) {
                Frame spoilt = good;
                spoilt.data[one / 8] = static_cast<std::uint8_t>(spoilt.data[one / 8] ^ 1U << one % 8);
                if (other != one)
                    spoilt.data[other / 8] =
                        static_cast<std::uint8_t>(spoilt.data[other / 8] ^ 1U << other % 8);
                ASSERT_NE(decode(row, spoilt, read), ClockRead::told) << "bits " << one << " and " << other;
            }
        for (std::uint8_t length = 0; length < 8; ++length) {
            Frame cut = good;
            cut.length = length;
            EXPECT_EQ(decode(row, cut, read), ClockRead::wrong);
        }
        Frame unsecured = good;
        unsecured.data[0] = static_cast<std::uint8_t>(unsecured.data[0] - 0x10);
        EXPECT_EQ(decode(row, unsecured, read), ClockRead::wrong);
        ClockRow stranger = row;
        stranger.sync_ids[7] = stranger.follow_up_ids[7] = 0;
        EXPECT_EQ(decode(stranger, good, read), ClockRead::wrong) << "of another connection";
    }
    ClockFrame read;
    ClockFrame too_much = follow_up;
    too_much.number = 1'000'000'000;
    EXPECT_EQ(decode(row, encode(row, too_much), read), ClockRead::wrong);
}

TEST(ClockFrames, are_part_of_the_bus_analysis) {
    constexpr auto& sent = clock_frames<row, Direction::transmit>;
    EXPECT_EQ(sent.frames[0].apart, 100ms);
    EXPECT_EQ(sent.frames[1].apart, 75ms) << "a FUP leaves within a quarter of the period";
    EXPECT_EQ(sent.frames[0].every, 0ms) << "on no grid";
    constexpr auto& heard = clock_frames<row, Direction::receive>;
    EXPECT_TRUE(heard.takes(encode(row, sync)));
    EXPECT_TRUE(heard.takes(encode(row, follow_up)));
    constexpr auto all = together(heard, no_services);
    EXPECT_EQ(all.frames.size(), 2u);
    EXPECT_EQ(all.frames[1].identifier, standard(0x090));
}

} // namespace
} // namespace tappet::can
