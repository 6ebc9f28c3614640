// Ports: what reading an input tells, with both ends in one activity and across two. What a row gives in
// place of a value, and in what order buffers are read: tests/kernel/machine/instance/flow_test.cpp, for any
// type.
#include "tests/kernel/component/port_rig.hpp"
#include "tests/kernel/exchange/placed.hpp"

namespace {

using namespace tappet;

using Ports = PortsOfEachTopology;
INSTANTIATE_TEST_SUITE_P(, Ports, testing::Bool(), topology);

TEST_P(Ports, tell_a_value_that_was_never_written_and_give_its_default) {
    EXPECT_EQ(read(), (Read{Flow::never_written, 0.0}));
}

TEST_P(Ports, tell_a_fresh_value_once_and_an_old_one_afterwards) {
    output.write(2.5);
    EXPECT_EQ(read(), (Read{Flow::fresh, 2.5}));
    EXPECT_EQ(read(), (Read{Flow::old, 2.5}));
    output.write(2.5); // the same value is news all the same
    EXPECT_EQ(input.read(value), Flow::fresh);
}

TEST_P(Ports, give_the_last_of_several_writes) {
    for (double each : {1.0, 2.0, 3.0}) output.write(each);
    EXPECT_EQ(input.get(), 3.0);
    EXPECT_EQ(output.last(), 3.0);
}

TEST_P(Ports, carry_the_time_at_which_the_value_was_true) {
    now = at_ns(1000);
    output.write(1.0);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.stamp(), at_ns(1000));
    output.write(1.0, at_ns(700)); // a sample that was taken before this cycle
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.stamp(), at_ns(700));
}

TEST_P(Ports, do_not_spend_freshness_when_only_asked_about_it) {
    output.write(1.0);
    EXPECT_EQ(input.flow(), Flow::fresh);
    EXPECT_EQ(input.flow(), Flow::fresh);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.flow(), Flow::old);
}

TEST_P(Ports, hold_a_stale_value_and_say_so) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(7.0);
    now = at_ns(0) + 4ms;
    EXPECT_EQ(input.read(value), Flow::fresh) << "as old as it may be";
    now = at_ns(0) + 4ms + 1ns;
    EXPECT_EQ(read(), (Read{Flow::stale, 7.0}));
}

TEST_P(Ports, call_a_value_stale_that_is_of_a_far_future) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(7.0, at_ns(0) + 900ms);
    EXPECT_EQ(input.read(value), Flow::fresh) << "a cycle of the reader may be a long one";
    output.write(8.0, at_ns(0) + 1h);
    EXPECT_EQ(input.read(value), Flow::stale);
    output.write(9.0, never);
    EXPECT_EQ(input.read(value), Flow::stale);
}

TEST_P(Ports, keep_a_value_stale_that_is_of_a_far_future) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(9.0, at_ns(0) + 5s);
    for (const Duration each : {Duration{1ms}, Duration{4s}, Duration{5s}, Duration{6s}}) {
        now = at_ns(0) + each;
        EXPECT_EQ(input.read(value), Flow::stale) << each.count();
    }
}

TEST_P(Ports, count_the_age_of_a_value_from_its_first_sight_at_the_latest) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(9.0, at_ns(0) + 990ms);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.claimed_stamp(), at_ns(0) + 990ms) << "of two inputs of one writer it is the same";
    now = at_ns(0) + 5ms;
    EXPECT_EQ(input.read(value), Flow::stale);
}

TEST_P(Ports, believe_a_time_ahead_no_longer_when_it_is_written_again) {
    port.set_policy(&input, {.max_age = 4ms});
    for (int ms = 0; ms <= 5; ++ms) {
        now = at_ns(0) + ms * 1ms;
        output.write(9.0, at_ns(0) + 900ms);
        EXPECT_EQ(input.read(value), ms <= 4 ? Flow::fresh : Flow::stale) << ms;
    }
}

TEST_P(Ports, take_the_time_of_a_value_for_its_own_that_another_one_claimed_before) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(9.0, at_ns(0) + 100ms);
    EXPECT_EQ(input.read(value), Flow::fresh);
    now = at_ns(0) + 100ms;
    output.write(10.0);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(input.stamp(), at_ns(0) + 100ms);
}

TEST_P(Ports, never_call_a_value_stale_whose_row_states_no_age) {
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

TEST(Port, of_an_input_that_no_row_connects_is_never_written) {
    Input<int> input;
    EXPECT_FALSE(input.connected());
    int value = 9;
    EXPECT_EQ(input.read(value), Flow::never_written);
    EXPECT_EQ(value, 0);
}

TEST(Port, of_one_output_feeds_readers_in_its_own_activity_and_in_others) {
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

TEST_P(BufferPort, rejects_and_counts_what_has_no_room) {
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

TEST(UnconnectedBufferPort, without_a_row_takes_values_and_gives_none) {
    BufferOutput<int> output;
    BufferInput<int> input;
    EXPECT_TRUE(output.push(1));
    EXPECT_EQ(drain(input), std::vector<int>{});
}

} // namespace
