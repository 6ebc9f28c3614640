// Ports: the results of reading an input, with both ends in one activity and across two. Row values and the
// order of buffers are tested for any type in tests/kernel/machine/instance/flow_test.cpp.
#include "tests/kernel/component/port_rig.hpp"
#include "tests/kernel/exchange/placed.hpp"

namespace {

using namespace tappet;

using Ports = PortsOfEachTopology;
INSTANTIATE_TEST_SUITE_P(, Ports, testing::Bool(), topology);

TEST_P(Ports, report_a_never_written_value_and_give_its_default) {
    EXPECT_EQ(read(), (Read{Flow::never_written, 0.0}));
}

TEST_P(Ports, report_a_value_as_fresh_once_and_then_as_old) {
    output.write(2.5);
    EXPECT_EQ(read(), (Read{Flow::fresh, 2.5}));
    EXPECT_EQ(read(), (Read{Flow::old, 2.5}));
    output.write(2.5); // a write of the same value is also fresh
    EXPECT_EQ(input.read(value), Flow::fresh);
}

TEST_P(Ports, keep_the_last_of_several_writes) {
    for (double each : {1.0, 2.0, 3.0}) output.write(each);
    EXPECT_EQ(input.get(), 3.0);
    EXPECT_EQ(output.last(), 3.0);
}

TEST_P(Ports, carry_the_time_stamp_of_the_value) {
    now = at_ns(1000);
    output.write(1.0);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.stamp(), at_ns(1000));
    output.write(1.0, at_ns(700)); // a sample taken before this cycle
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.stamp(), at_ns(700));
}

TEST_P(Ports, keep_freshness_when_only_queried) {
    output.write(1.0);
    EXPECT_EQ(input.flow(), Flow::fresh);
    EXPECT_EQ(input.flow(), Flow::fresh);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.flow(), Flow::old);
}

TEST_P(Ports, hold_a_stale_value_and_report_it_as_stale) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(7.0);
    now = at_ns(0) + 4ms;
    EXPECT_EQ(input.read(value), Flow::fresh) << "as old as it may be";
    now = at_ns(0) + 4ms + 1ns;
    EXPECT_EQ(read(), (Read{Flow::stale, 7.0}));
}

TEST_P(Ports, report_a_far_future_value_as_stale) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(7.0, at_ns(0) + 900ms);
    EXPECT_EQ(input.read(value), Flow::fresh) << "a cycle of the reader may be a long one";
    output.write(8.0, at_ns(0) + 1h);
    EXPECT_EQ(input.read(value), Flow::stale);
    output.write(9.0, never);
    EXPECT_EQ(input.read(value), Flow::stale);
}

TEST_P(Ports, keep_a_far_future_value_stale) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(9.0, at_ns(0) + 5s);
    for (const Duration each : {Duration{1ms}, Duration{4s}, Duration{5s}, Duration{6s}}) {
        now = at_ns(0) + each;
        EXPECT_EQ(input.read(value), Flow::stale) << each.count();
    }
}

TEST_P(Ports, count_age_from_the_first_read_at_the_latest) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(9.0, at_ns(0) + 990ms);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.claimed_stamp(), at_ns(0) + 990ms) << "of two inputs of one writer it is the same";
    now = at_ns(0) + 5ms;
    EXPECT_EQ(input.read(value), Flow::stale);
}

TEST_P(Ports, age_a_future_stamp_although_it_is_written_again) {
    port.set_policy(&input, {.max_age = 4ms});
    for (int ms = 0; ms <= 5; ++ms) {
        now = at_ns(0) + ms * 1ms;
        output.write(9.0, at_ns(0) + 900ms);
        EXPECT_EQ(input.read(value), ms <= 4 ? Flow::fresh : Flow::stale) << ms;
    }
}

TEST_P(Ports, accept_a_stamp_that_an_earlier_value_already_claimed) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(9.0, at_ns(0) + 100ms);
    EXPECT_EQ(input.read(value), Flow::fresh);
    now = at_ns(0) + 100ms;
    output.write(10.0);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.stamp(), at_ns(0) + 100ms);
}

TEST_P(Ports, never_report_staleness_without_a_maximum_age) {
    output.write(7.0);
    now = at_ns(0) + 10h;
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.read(value), Flow::old);
}

TEST_P(Ports, wake_the_reader_once_for_each_write) {
    int wakes = 0;
    port.set_waker(&output,
                   {[](void* count) noexcept TAPPET_REALTIME { ++*static_cast<int*>(count); }, &wakes});
    output.write(1.0);
    output.write(1.0);
    EXPECT_EQ(wakes, 2);
}

TEST(Port, stays_unwritten_when_no_row_connects_it) {
    Input<int> input;
    EXPECT_FALSE(input.connected());
    int value = 9;
    EXPECT_EQ(input.read(value), Flow::never_written);
    EXPECT_EQ(value, 0);
}

TEST(Port, feeds_readers_in_its_own_and_other_activities) {
    LinkedPorts<int> ports{true};
    Input<int> near;
    ports.port.link_local(&near, &ports.output, nullptr);
    ports.output.write(3);
    EXPECT_EQ(near.get(), 3);
    EXPECT_EQ(ports.input.get(), 3);
}

/// A ring between two ports, as start-up places it.
struct BufferRow {
    static constexpr const BufferOperations& operations = PortAccess::buffer<int>;
    static_assert(operations.ring_align <= 128);

    BufferRow(bool crosses, BufferOutput<int>& from, BufferInput<int>& to, std::size_t capacity,
              Overflow overflow)
        : across{crosses}, memory{operations.ring_bytes(capacity, across)} {
        operations.link(&from, &to, memory.data(), capacity, overflow, across);
    }
    [[nodiscard]] std::size_t lost() { return operations.lost(memory.data(), across); }

    bool across;
    LineMemory memory;
};

std::vector<int> drain(BufferInput<int>& input) {
    std::vector<int> all;
    for (int value = 0; input.pop(value);) all.push_back(value);
    return all;
}

class BufferPort : public testing::TestWithParam<bool> {};

INSTANTIATE_TEST_SUITE_P(, BufferPort, testing::Bool(), topology);

TEST_P(BufferPort, rejects_and_counts_values_when_full) {
    BufferOutput<int> output;
    BufferInput<int> input;
    BufferRow row{GetParam(), output, input, 2, Overflow::reject};
    EXPECT_TRUE(output.push(1));
    EXPECT_TRUE(output.push(2));
    EXPECT_FALSE(output.push(3));
    EXPECT_EQ(row.lost(), 1u);
    EXPECT_EQ(drain(input), (std::vector{1, 2}));
}

TEST_P(BufferPort, gives_every_reader_of_one_output_every_value) {
    BufferOutput<int> output;
    BufferInput<int> fast, slow;
    BufferRow first{GetParam(), output, fast, 4, Overflow::reject};
    BufferRow second{GetParam(), output, slow, 1, Overflow::reject};
    EXPECT_TRUE(output.push(1));
    EXPECT_FALSE(output.push(2)) << "the slow reader's row is full";
    EXPECT_EQ(drain(fast), (std::vector{1, 2}));
    EXPECT_EQ(drain(slow), (std::vector{1}));
    EXPECT_EQ(first.lost(), 0u);
    EXPECT_EQ(second.lost(), 1u);
}

TEST(UnconnectedBufferPort, accepts_values_and_gives_none) {
    BufferOutput<int> output;
    BufferInput<int> input;
    EXPECT_TRUE(output.push(1));
    EXPECT_EQ(drain(input), std::vector<int>{});
}

} // namespace
