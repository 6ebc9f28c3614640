// Response times of frames against published examples and figures, and the share of this machine's queue.
#include "drivers/can/bus_analysis.hpp"

#include "drivers/can/frame_time.hpp"
#include "drivers/can/transmitter.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace tappet::can {
namespace {

constexpr std::int64_t us = 1'000, ms = 1'000'000;
constexpr Response worst(std::int64_t ns) { return {true, ns}; }

constexpr std::int64_t classical_ns(unsigned bytes, std::int64_t rate, bool extended = false) {
    return frame_time_ns(Format::classical, extended, bytes, {rate, 0});
}
constexpr std::int64_t flexible_us(unsigned bytes, std::int64_t rate, std::int64_t data_rate) {
    return frame_time_ns(Format::flexible_faster, false, bytes, {rate, data_rate}) / us;
}
constexpr FrameTiming of_others(std::int64_t wire_ns, std::int64_t period_ns) {
    return {.wire_ns = wire_ns, .period_ns = period_ns, .deadline_ns = period_ns};
}
constexpr FrameTiming ours(std::int64_t wire_ns, std::int64_t period_ns) {
    return {.wire_ns = wire_ns, .period_ns = period_ns, .deadline_ns = period_ns, .own = true};
}

// Davis, Burns, Bril and Lukkien 2007: three frames of 7 bytes at 125 kbit/s.
constexpr std::array three_frames{of_others(1 * ms, 5 * ms / 2), of_others(1 * ms, 7 * ms / 2),
                                  of_others(1 * ms, 7 * ms / 2)};
constexpr BusAnalysis three{three_frames, {.bit_ns = 8 * us}};
static_assert(classical_ns(7, 125'000) == 1 * ms);
static_assert(three.of(0).response == worst(2 * ms));
static_assert(three.of(1).response == worst(3 * ms));
static_assert(three.of(2).response == worst(7 * ms / 2),
              "its second instance is the worst, which the analysis of 1994 did not look at");
static_assert(three.of(1).response.within(13 * ms / 4) && !three.of(2).response.within(13 * ms / 4));

TEST(FrameTime, is_right_for_classical_frames) {
    EXPECT_EQ(classical_ns(0, 1'000'000), 55 * us);
    EXPECT_EQ(classical_ns(8, 1'000'000), 135 * us);
    EXPECT_EQ(classical_ns(0, 1'000'000, true), 80 * us);
    EXPECT_EQ(classical_ns(8, 1'000'000, true), 160 * us);
    EXPECT_EQ(classical_ns(8, 500'000), 270 * us);
    EXPECT_EQ(classical_ns(0, 300'000), 183'334) << "rounded up where the rate does not divide a second";
}

// From ISO 11898-1, by an exhaustive search over all stuffings.
TEST(FrameTime, is_right_for_can_fd_frames) {
    EXPECT_EQ(flexible_us(8, 500'000, 2'000'000), 120) << "and a half";
    EXPECT_EQ(flexible_us(32, 500'000, 2'000'000), 243);
    EXPECT_EQ(flexible_us(64, 500'000, 2'000'000), 403);
    EXPECT_EQ(flexible_us(64, 1'000'000, 5'000'000), 167) << "167.6";
    EXPECT_EQ(flexible_us(9, 500'000, 2'000'000), flexible_us(12, 500'000, 2'000'000)) << "padded";
    // In bits of one rate: 32 + 33 + 5 + 640, and at 48 bytes one more of stuffing.
    EXPECT_EQ(frame_time_ns(Format::flexible, false, 64, {1'000'000, 0}), 710 * us);
    EXPECT_EQ(frame_time_ns(Format::flexible, true, 64, {1'000'000, 0}), 733 * us);
    EXPECT_EQ(frame_time_ns(Format::flexible, false, 48, {1'000'000, 0}), (32 + 33 + 5 + 480 + 1) * us);
}

TEST(FrameTime, is_negative_for_impossible_frames) {
    EXPECT_EQ(classical_ns(9, 500'000), -1);
    EXPECT_EQ(classical_ns(8, 0), -1);
    EXPECT_EQ(classical_ns(8, -500'000), -1);
    EXPECT_EQ(frame_time_ns(Format::flexible, false, 65, {500'000, 0}), -1);
    EXPECT_EQ(frame_time_ns(Format::flexible_faster, false, 8, {500'000, 0}), -1) << "no data bit rate";
}

// Rox and Ernst 2010.
TEST(BusAnalysis, agrees_with_a_published_bus) {
    const std::array frames{of_others(976 * us, 15 * ms), of_others(736 * us, 30 * ms),
                            of_others(1056 * us, 75 * ms), of_others(1056 * us, 40 * ms),
                            of_others(736 * us, 15 * ms)};
    const BusAnalysis bus{frames, {.bit_ns = 1 * us}};
    const std::array expected{2032, 2768, 3824, 4560, 4560};
    for (std::size_t i = 0; i < frames.size(); ++i)
        EXPECT_EQ(bus.of(i).response, worst(expected[i] * us)) << i;
}

// The frames of PSA's benchmark at 250 kbit/s: bytes and periods.
TEST(BusAnalysis, agrees_with_the_psa_benchmark_with_and_without_an_error) {
    constexpr std::array<std::array<int, 2>, 12> rows{{{8, 10},
                                                       {3, 14},
                                                       {3, 20},
                                                       {2, 15},
                                                       {5, 20},
                                                       {5, 40},
                                                       {4, 15},
                                                       {5, 50},
                                                       {4, 20},
                                                       {7, 100},
                                                       {5, 50},
                                                       {1, 100}}};
    constexpr std::array expected{1040, 1380, 1720, 2020, 2440, 2860, 3240, 3660, 4040, 4460, 4720, 4720};
    std::vector<FrameTiming> frames;
    for (const auto& [bytes, period] : rows)
        frames.push_back(of_others(classical_ns(static_cast<unsigned>(bytes), 250'000), period * ms));
    const BusAnalysis bus{frames, {.bit_ns = 4 * us}};
    for (std::size_t i = 0; i < frames.size(); ++i)
        EXPECT_EQ(bus.of(i).response, worst(expected[i] * us)) << i;
    const BusAnalysis disturbed{frames, {.bit_ns = 4 * us, .errors = 1}};
    EXPECT_EQ(disturbed.of(0).response, worst(1704 * us));
    EXPECT_EQ(disturbed.of(11).response, worst(5384 * us));
    EXPECT_EQ(disturbed.of(11).largest, Part::errors);
}

TEST(BusAnalysis, counts_another_error_after_each_error_interval) {
    const std::array frames{of_others(100 * us, 1 * ms), of_others(400 * us, 2 * ms)};
    const auto at = [&](std::int64_t every_ns) {
        return BusAnalysis{frames, {.bit_ns = 1 * us, .errors = 1, .errors_every_ns = every_ns}}
            .of(1)
            .response;
    };
    EXPECT_EQ(at(100 * ms), worst(100 * us + 400 * us + 431 * us));
    EXPECT_EQ(at(800 * us), worst(100 * us + 400 * us + 2 * 431 * us));
    EXPECT_FALSE(at(431 * us).bounded);
}

TEST(BusAnalysis, blocks_the_most_urgent_frame_by_the_longest_less_urgent_one) {
    const std::array frames{of_others(55 * us, ms), of_others(65 * us, ms), of_others(160 * us, ms)};
    const FrameResponse found = BusAnalysis{frames, {.bit_ns = 1 * us}}.of(0);
    EXPECT_EQ(found.response, worst(215 * us));
    EXPECT_EQ(found.largest, Part::blocking);
    EXPECT_EQ(found.of, 2u);
    EXPECT_EQ(found.largest_ns, 160 * us);
}

TEST(BusAnalysis, does_not_block_the_least_urgent_frame_but_counts_its_jitter) {
    std::array frames{of_others(135 * us, ms), of_others(135 * us, ms)};
    EXPECT_EQ((BusAnalysis{frames, {.bit_ns = 1 * us}}.of(1).response), worst(270 * us));
    frames[1].jitter_ns = 40 * us;
    EXPECT_EQ((BusAnalysis{frames, {.bit_ns = 1 * us}}.of(1).response), worst(310 * us));
}

// At 500 kbit/s, 8 bytes each: our most urgent and our least urgent frame, four of others in between. In the
// order of identifiers the first would take 540 us.
TEST(BusAnalysis, delays_own_frames_by_those_in_flight_and_overtaking_ones) {
    std::vector frames(6, of_others(270 * us, 10 * ms));
    frames.front() = frames.back() = ours(270 * us, 10 * ms);
    const BusAnalysis bus{frames, {.bit_ns = 2 * us, .in_flight = 4}};
    EXPECT_EQ(bus.of(0).response, worst(1890 * us));
    EXPECT_EQ(bus.of(5).response, worst(1890 * us));
    frames.front().own = frames.back().own = false;
    EXPECT_EQ((BusAnalysis{frames, {.bit_ns = 2 * us}}.of(0).response), worst(540 * us));
}

TEST(BusAnalysis, counts_an_error_that_destroys_an_own_frame_in_flight) {
    const std::array frames{ours(100 * us, 10 * ms), ours(400 * us, 10 * ms)};
    const BusAnalysis bus{frames, {.bit_ns = 1 * us, .errors = 1}};
    EXPECT_EQ(bus.of(0).response, worst(100 * us + 400 * us + 431 * us + 100 * us));
}

TEST(BusAnalysis, ignores_own_frames_on_one_grid_that_are_already_sent) {
    std::vector frames(6, of_others(270 * us, 10 * ms));
    frames.front() = frames.back() = ours(270 * us, 10 * ms);
    frames.front().on_grid = frames.back().on_grid = true;
    const BusAnalysis bus{frames, {.bit_ns = 2 * us, .in_flight = 4}};
    EXPECT_EQ(bus.of(0).response, worst(540 * us)) << "the other one was through within the period";
    frames.front().period_ns = 3 * ms;
    EXPECT_EQ((BusAnalysis{frames, {.bit_ns = 2 * us, .in_flight = 4}}.of(0).response), worst(1890 * us))
        << "periods of 3 and 10 ms meet within 1 ms";
}

TEST(BusAnalysis, counts_the_queueing_of_own_frames_as_jitter_for_others) {
    // Released each 2 ms, but up to 670 us late: two of them may come within 1.5 ms.
    std::vector frames{ours(270 * us, 2 * ms),       of_others(400 * us, 50 * ms),
                       of_others(400 * us, 50 * ms), of_others(400 * us, 50 * ms),
                       ours(400 * us, 50 * ms),      of_others(400 * us, 50 * ms)};
    const Response late = BusAnalysis{frames, {.bit_ns = 2 * us, .in_flight = 4}}.of(3).response;
    for (FrameTiming& frame : frames) frame.own = false;
    const Response in_order = BusAnalysis{frames, {.bit_ns = 2 * us}}.of(3).response;
    EXPECT_EQ(late.worst_ns - in_order.worst_ns, 270 * us);
}

TEST(BusAnalysis, counts_the_time_until_more_own_frames_are_handed_over) {
    const std::array frames{ours(100 * us, 10 * ms), ours(100 * us, 10 * ms), ours(100 * us, 10 * ms),
                            of_others(200 * us, 10 * ms)};
    const auto third = [&](std::int64_t in_flight, std::int64_t hand_over_ns) {
        return BusAnalysis{frames, {.bit_ns = 1 * us, .in_flight = in_flight, .hand_over_ns = hand_over_ns}}
            .of(2)
            .response;
    };
    EXPECT_EQ(third(2, 80 * us), worst(500 * us)) << "handed over while the second is on the wire, unstuffed";
    EXPECT_EQ(third(2, 100 * us), worst(700 * us)) << "the frame of others, as the second may be unstuffed";
    EXPECT_EQ(third(2, 150 * us), worst(750 * us)) << "an idle bus for 50 us, and then the frame of others";
    EXPECT_EQ(frames_in_flight(150us, 100us), 3u);
    EXPECT_EQ(frames_in_flight(0us, 100us), 2u);
    EXPECT_EQ(frames_in_flight(100ms, 100us), most_in_flight);
}

TEST(BusAnalysis, is_unbounded_on_an_overloaded_bus) {
    for (const bool own : {false, true}) {
        std::vector frames(2, of_others(135 * us, 250 * us));
        frames[1].own = own;
        EXPECT_FALSE((BusAnalysis{frames, {.bit_ns = 1 * us}}.of(1).response.bounded));
    }
}

TEST(BusAnalysis, refuses_invalid_timings) {
    const auto bounded = [](FrameTiming frame, BusTiming bus) {
        return BusAnalysis{std::array{frame}, bus}.of(0).response.bounded;
    };
    constexpr BusTiming bus{.bit_ns = 1 * us};
    constexpr std::int64_t huge = std::numeric_limits<std::int64_t>::max();
    EXPECT_TRUE(bounded(of_others(135 * us, ms), bus));
    EXPECT_FALSE((BusAnalysis{{}, bus}.of(0).response.bounded));
    EXPECT_FALSE(bounded(of_others(135 * us, ms), {}));
    EXPECT_FALSE(bounded(of_others(-1, ms), bus));
    EXPECT_FALSE(bounded(of_others(135 * us, 0), bus));
    EXPECT_FALSE(bounded({.wire_ns = 135 * us, .period_ns = ms, .jitter_ns = -1}, bus));
    EXPECT_FALSE(bounded({.wire_ns = 135 * us, .period_ns = huge, .jitter_ns = huge}, bus));
    EXPECT_FALSE(bounded(of_others(135 * us, ms), {.bit_ns = 1 * us, .in_flight = 0}));
    EXPECT_FALSE(bounded(of_others(135 * us, ms), {.bit_ns = 1 * us, .errors = 1, .errors_every_ns = 0}));
    const std::vector too_many(most_traffic_rows + 1, of_others(1 * us, 100 * ms));
    EXPECT_FALSE((BusAnalysis{too_many, bus}.of(0).response.bounded));
}

} // namespace
} // namespace tappet::can
