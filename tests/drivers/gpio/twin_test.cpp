// Digital lines: edges with their numbers and times, detected gaps, safe outputs, and every fault of a line.
#include "drivers/gpio/twin.hpp"

#include <gtest/gtest.h>

#include <array>

namespace tappet::gpio {
namespace {

constexpr std::array loom_lines{
    Line{.name = "drop_wire", .offset = 3},
    Line{.name = "detector", .offset = 5},
    Line{.name = "button", .offset = 9, .debounce = 5ms},
    Line{.name = "lamp", .offset = 1, .role = Role::output},
    Line{.name = "brake", .offset = 2, .role = Role::output, .safe_value = true},
};
constexpr std::size_t drop_wire = 0, detector = 1, button = 2, lamp = 3, brake = 4;
constexpr Mask bit(std::size_t line) { return Mask{1} << line; }

struct GpioTwin : testing::Test {
    GpioTwin() { EXPECT_TRUE(twin.open({.chip = "loom", .lines = loom_lines})); }
    EdgeBatch read() { return twin.read_edges(edges); }
    void change(std::size_t line, bool level, Time at) {
        ASSERT_TRUE(twin.drive(line, level, at));
        twin.deliver_until(at);
    }
    Twin twin;
    std::array<Edge, 64> edges{};
};

TEST_F(GpioTwin, delivers_edges_in_order_with_number_and_time) {
    twin.drive(drop_wire, true, Time{1ms});
    twin.drive(detector, true, Time{2ms});
    twin.drive(drop_wire, false, Time{3ms});
    twin.deliver_until(Time{10ms});
    const EdgeBatch batch = read();
    ASSERT_EQ(batch.count, 3u);
    EXPECT_EQ(batch.gap.missed, 0u);
    EXPECT_EQ(edges[0], (Edge{.line = drop_wire, .rising = true, .stamp = Time{1ms}, .seqno = 1}));
    EXPECT_EQ(edges[1], (Edge{.line = detector, .rising = true, .stamp = Time{2ms}, .seqno = 2}));
    EXPECT_EQ(edges[2], (Edge{.line = drop_wire, .rising = false, .stamp = Time{3ms}, .seqno = 3}));
    EXPECT_EQ(twin.levels().mask, bit(detector) | bit(brake));
}

TEST_F(GpioTwin, reports_no_edge_while_the_level_stays) {
    change(drop_wire, false, Time{1ms});
    EXPECT_EQ(read().count, 0u);
}

TEST_F(GpioTwin, keeps_the_remaining_edges_for_the_next_read) {
    for (int i = 0; i < 10; ++i) {
        const Time at{1ms * (i + 1)};
        twin.drive(drop_wire, i % 2 == 0, at);
    }
    twin.deliver_until(Time{1s});
    EXPECT_EQ(twin.read_edges(std::span{edges}.first(7)).count, 7u);
    EXPECT_EQ(twin.read_edges(std::span{edges}.first(7)).count, 3u);
    EXPECT_EQ(twin.counters().missed, 0u);
}

TEST_F(GpioTwin, notices_lost_edges_and_reads_the_levels_again) {
    twin.faults(drop_wire).lose_next = 3;
    for (int i = 0; i < 3; ++i) twin.drive(drop_wire, i % 2 == 0, Time{1ms * (i + 1)});
    change(detector, true, Time{5ms});
    const EdgeBatch batch = read();
    ASSERT_EQ(batch.count, 1u);
    EXPECT_EQ(edges[0].missed, 3u);
    EXPECT_EQ(batch.gap.missed, 3u);
    EXPECT_TRUE(batch.gap.levels_known);
    EXPECT_EQ(batch.gap.levels & (bit(drop_wire) | bit(detector)), bit(drop_wire) | bit(detector));
    EXPECT_EQ(twin.counters().missed, 3u);
    EXPECT_EQ(twin.counters().gaps, 1u);
}

TEST_F(GpioTwin, notices_that_its_buffer_overflowed) {
    Time at{1ms};
    for (std::size_t i = 0; i < Twin::event_buffer + 50; ++i, at += 1ms) {
        change(drop_wire, i % 2 == 0, at);
    }
    std::uint64_t got = 0;
    for (std::size_t n = read().count; n != 0; n = read().count) got += n;
    EXPECT_EQ(got, Twin::event_buffer);
    change(detector, true, at);
    EXPECT_EQ(read().gap.missed, 50u);
}

TEST_F(GpioTwin, delivers_every_bounce_of_a_line_without_debounce) {
    twin.faults(drop_wire).bounces = 3;
    twin.drive(drop_wire, true, Time{1ms});
    twin.deliver_until(Time{50ms});
    EXPECT_EQ(read().count, 7u);
}

TEST_F(GpioTwin, suppresses_bounces_shorter_than_the_debounce_time) {
    twin.faults(button).bounces = 5;
    twin.drive(button, true, Time{10ms});
    twin.deliver_until(Time{16ms});
    EXPECT_EQ(read().count, 0u) << "the last bounce was at 12 ms";
    twin.deliver_until(Time{17ms});
    ASSERT_EQ(read().count, 1u);
    EXPECT_EQ(edges[0].stamp, Time{17ms});
    EXPECT_TRUE(edges[0].rising);
}

TEST_F(GpioTwin, suppresses_a_pulse_shorter_than_the_debounce_time) {
    twin.drive(button, true, Time{10ms});
    twin.drive(button, false, Time{14ms});
    twin.deliver_until(Time{1s});
    EXPECT_EQ(read().count, 0u);
}

TEST_F(GpioTwin, stays_at_the_level_where_it_is_stuck) {
    twin.stick(detector, true, Time{1ms});
    twin.drive(detector, false, Time{2ms});
    twin.deliver_until(Time{3ms});
    EXPECT_EQ(read().count, 1u);
    EXPECT_NE(twin.levels().mask & bit(detector), 0u);
    twin.release(detector, Time{4ms});
    twin.deliver_until(Time{4ms});
    ASSERT_EQ(read().count, 1u) << "it is what it was driven to meanwhile";
    EXPECT_FALSE(edges[0].rising);
    EXPECT_EQ(edges[0].stamp, Time{4ms});
}

TEST_F(GpioTwin, delivers_late_edges_in_order_with_the_right_stamp) {
    twin.faults(drop_wire).delay = 8ms;
    twin.drive(drop_wire, true, Time{1ms});
    twin.drive(detector, true, Time{2ms});
    twin.deliver_until(Time{8ms});
    EXPECT_EQ(read().count, 0u);
    twin.deliver_until(Time{9ms});
    ASSERT_EQ(read().count, 2u);
    EXPECT_EQ(edges[0].stamp, Time{1ms});
    EXPECT_EQ(edges[1].stamp, Time{2ms});
    EXPECT_EQ(twin.counters().missed, 0u);
}

TEST_F(GpioTwin, writes_only_outputs_and_all_at_once) {
    EXPECT_EQ(twin.outputs(), bit(brake)) << "safe values from the start";
    EXPECT_TRUE(twin.write(bit(lamp) | bit(brake) | bit(drop_wire), bit(lamp) | bit(drop_wire)));
    EXPECT_EQ(twin.outputs(), bit(lamp));
    EXPECT_TRUE(twin.make_safe());
    EXPECT_EQ(twin.outputs(), bit(brake));
}

TEST_F(GpioTwin, refuses_to_let_the_plant_drive_outputs_or_missing_lines) {
    EXPECT_FALSE(twin.drive(lamp, true, Time{1ms}));
    EXPECT_FALSE(twin.drive(5, true, Time{1ms}));
}

TEST_F(GpioTwin, calls_its_listener_once_per_delivery_with_edges) {
    int calls = 0;
    twin.set_listener([](void* n) noexcept TAPPET_REALTIME { ++*static_cast<int*>(n); }, &calls);
    twin.deliver_until(Time{1ms});
    EXPECT_EQ(calls, 0);
    twin.drive(drop_wire, true, Time{2ms});
    change(detector, true, Time{2ms});
    EXPECT_EQ(calls, 1);
}

TEST_F(GpioTwin, counts_every_edge_under_random_losses) {
    twin.faults(drop_wire).lose_one_in = 4;
    std::uint64_t driven = 0;
    for (Time at{1ms}; at < Time{1s}; at += 1ms, ++driven) {
        change(drop_wire, driven % 2 == 0, at);
        read();
    }
    change(detector, true, Time{2s});
    read();
    EXPECT_EQ(twin.counters().edges + twin.counters().missed, driven + 1);
    EXPECT_GT(twin.counters().missed, 0u);
}

TEST(EdgeSequence, survives_the_wrap_of_the_kernels_counter) {
    EdgeSequence sequence;
    EXPECT_EQ(sequence.missed_before(0xFFFFFFFFu), 0xFFFFFFFEu);
    EXPECT_EQ(sequence.missed_before(0), 0u);
    EXPECT_EQ(sequence.missed_before(2), 1u);
}

std::string refusal(std::span<const Line> lines) {
    Twin twin;
    const auto opened = twin.open({.chip = "loom", .lines = lines});
    return opened ? "" : std::string{opened.error().view()};
}

TEST(GpioPlan, refuses_a_single_line_because_its_losses_are_invisible) {
    EXPECT_EQ(refusal(std::span{loom_lines}.first(1)),
              "GPIO chip \"loom\": fewer than two lines are requested, and lost edges of a single line are "
              "invisible; add another line, used or not");
}

TEST(GpioPlan, refuses_two_names_for_the_same_line) {
    constexpr std::array twice{Line{.name = "a", .offset = 4}, Line{.name = "b", .offset = 4}};
    EXPECT_EQ(refusal(twice), "GPIO chip \"loom\": lines \"a\" and \"b\" are both line 4; correct the board");
}

TEST(GpioPlan, refuses_too_many_lines_and_impossible_debounce_times) {
    std::array<Line, 65> many{};
    for (unsigned i = 0; i < many.size(); ++i) many[i].offset = i;
    EXPECT_NE(refusal(many), "");
    constexpr std::array slow{Line{.name = "a", .offset = 1, .debounce = 2s}, Line{.name = "b", .offset = 2}};
    EXPECT_NE(refusal(slow), "");
}

TEST_F(GpioTwin, refuses_every_call_unchanged_while_its_chip_is_removed) {
    EXPECT_TRUE(twin.write(bit(lamp), bit(lamp)));
    const Mask before = twin.outputs();
    twin.set_removed(true);
    change(drop_wire, true, Time{1ms});
    EXPECT_FALSE(twin.write(bit(lamp), 0));
    EXPECT_FALSE(twin.make_safe());
    EXPECT_FALSE(twin.levels().known);
    EXPECT_EQ(read().count, 0u);
    EXPECT_EQ(twin.counters().failures, 4u);
    EXPECT_EQ(twin.outputs(), before);
    twin.set_removed(false);
    EXPECT_TRUE(twin.make_safe());
    EXPECT_EQ(twin.outputs(), bit(brake));
    EXPECT_TRUE(twin.levels().known);
}

TEST_F(GpioTwin, calls_its_listener_when_its_chip_is_removed) {
    int calls = 0;
    twin.set_listener([](void* n) noexcept TAPPET_REALTIME { ++*static_cast<int*>(n); }, &calls);
    twin.set_removed(true);
    twin.deliver_until(Time{1ms});
    EXPECT_EQ(calls, 1);
}

} // namespace
} // namespace tappet::gpio
