// Ports: what reading an input tells, with both ends in one activity and across two, and what a stale value
// becomes.
#include "kernel/component/facet.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace {

using namespace tappet;

/// An output and an input, linked as start-up links them; each with the clock of its activity.
template <class T> struct Link {
    Output<T> output;
    Input<T> input;
    Time written_at = at_ns(0);
    Time read_at = at_ns(0);
    static constexpr const PortOperations& port = PortAccess::data<T>;

    explicit Link(bool across) {
        port.set_clock(&output, false, &written_at);
        port.set_clock(&input, true, &read_at);
        if (!across) {
            port.link_local(&input, &output, nullptr);
            return;
        }
        EXPECT_LE(port.shared_bytes, sizeof memory_);
        port.place_shared(&output, memory_.data());
        port.link_shared(&input, &output, nullptr);
    }
    void at(Time now) { written_at = read_at = now; }

private:
    alignas(512) std::array<std::byte, 8192> memory_{};
};

/// Both topologies behave alike; only the memory between them differs.
class Ports : public testing::TestWithParam<bool> {
protected:
    Link<double> link{GetParam()};
    double value = -1;
};

INSTANTIATE_TEST_SUITE_P(, Ports, testing::Bool(), [](const auto& each) {
    return each.param ? "across_activities" : "inside_one_activity";
});

TEST_P(Ports, tell_a_value_that_was_never_written_and_give_its_default) {
    EXPECT_EQ(link.input.read(value), Flow::never_written);
    EXPECT_EQ(value, 0.0);
}

TEST_P(Ports, tell_a_fresh_value_once_and_an_old_one_afterwards) {
    link.output.write(2.5);
    EXPECT_EQ(link.input.read(value), Flow::fresh);
    EXPECT_EQ(value, 2.5);
    EXPECT_EQ(link.input.read(value), Flow::old);
    EXPECT_EQ(value, 2.5);
    link.output.write(2.5); // the same value is news all the same
    EXPECT_EQ(link.input.read(value), Flow::fresh);
}

TEST_P(Ports, give_the_last_of_several_writes) {
    for (double each : {1.0, 2.0, 3.0}) link.output.write(each);
    EXPECT_EQ(link.input.get(), 3.0);
    EXPECT_EQ(link.output.last(), 3.0);
}

TEST_P(Ports, carry_the_time_at_which_the_value_was_true) {
    link.at(at_ns(1000));
    link.output.write(1.0);
    EXPECT_EQ(link.input.read(value), Flow::fresh);
    EXPECT_EQ(link.input.stamp(), at_ns(1000));
    link.output.write(1.0, at_ns(700)); // a sample that was taken before this cycle
    EXPECT_EQ(link.input.read(value), Flow::fresh);
    EXPECT_EQ(link.input.stamp(), at_ns(700));
}

TEST_P(Ports, do_not_spend_freshness_when_only_asked_about_it) {
    link.output.write(1.0);
    EXPECT_EQ(link.input.flow(), Flow::fresh);
    EXPECT_EQ(link.input.flow(), Flow::fresh);
    EXPECT_EQ(link.input.read(value), Flow::fresh);
    EXPECT_EQ(link.input.flow(), Flow::old);
}

TEST_P(Ports, hold_a_stale_value_and_say_so) {
    link.port.set_policy(&link.input, {.max_age = 4ms});
    link.output.write(7.0);
    link.at(at_ns(0) + 4ms);
    EXPECT_EQ(link.input.read(value), Flow::fresh) << "as old as it may be";
    link.at(at_ns(0) + 4ms + 1ns);
    EXPECT_EQ(link.input.read(value), Flow::stale);
    EXPECT_EQ(value, 7.0);
}

TEST_P(Ports, call_a_value_stale_that_is_of_a_far_future) {
    link.port.set_policy(&link.input, {.max_age = 4ms});
    link.output.write(7.0, at_ns(0) + 900ms);
    EXPECT_EQ(link.input.read(value), Flow::fresh) << "a cycle of the reader may be a long one";
    link.output.write(8.0, at_ns(0) + 1h);
    EXPECT_EQ(link.input.read(value), Flow::stale);
    link.output.write(9.0, never);
    EXPECT_EQ(link.input.read(value), Flow::stale);
}

RowValue number(double value) { return {.given = true, .number = value}; }

TEST_P(Ports, keep_a_value_stale_that_is_of_a_far_future) {
    link.port.set_policy(&link.input, {.max_age = 4ms});
    link.output.write(9.0, at_ns(0) + 5s);
    for (const Duration each : {Duration{1ms}, Duration{4s}, Duration{5s}, Duration{6s}}) {
        link.at(at_ns(0) + each);
        EXPECT_EQ(link.input.read(value), Flow::stale) << each.count();
    }
}

TEST_P(Ports, count_the_age_of_a_value_from_its_first_sight_at_the_latest) {
    link.port.set_policy(&link.input, {.max_age = 4ms});
    link.output.write(9.0, at_ns(0) + 990ms);
    EXPECT_EQ(link.input.read(value), Flow::fresh);
    EXPECT_EQ(link.input.claimed_stamp(), at_ns(0) + 990ms) << "of two inputs of one writer it is the same";
    link.at(at_ns(0) + 5ms);
    EXPECT_EQ(link.input.read(value), Flow::stale);
}

TEST_P(Ports, believe_a_time_ahead_no_longer_when_it_is_written_again) {
    link.port.set_policy(&link.input, {.max_age = 4ms});
    for (int ms = 0; ms <= 5; ++ms) {
        link.at(at_ns(0) + ms * 1ms);
        link.output.write(9.0, at_ns(0) + 900ms);
        EXPECT_EQ(link.input.read(value), ms <= 4 ? Flow::fresh : Flow::stale) << ms;
    }
}

TEST_P(Ports, take_the_time_of_a_value_for_its_own_that_another_one_claimed_before) {
    link.port.set_policy(&link.input, {.max_age = 4ms});
    link.output.write(9.0, at_ns(0) + 100ms);
    EXPECT_EQ(link.input.read(value), Flow::fresh);
    link.at(at_ns(0) + 100ms);
    link.output.write(10.0);
    EXPECT_EQ(link.input.read(value), Flow::fresh);
    EXPECT_EQ(link.input.stamp(), at_ns(0) + 100ms);
}

TEST_P(Ports, give_the_substitute_for_a_stale_or_a_never_written_value) {
    link.port.set_policy(&link.input,
                         {.max_age = 4ms, .when_stale = WhenStale::substitute, .substitute = number(-5)});
    EXPECT_EQ(link.input.read(value), Flow::never_written);
    EXPECT_EQ(value, -5.0);
    link.output.write(7.0);
    EXPECT_EQ(link.input.get(), 7.0);
    link.at(at_ns(0) + 5ms);
    EXPECT_EQ(link.input.read(value), Flow::stale);
    EXPECT_EQ(value, -5.0);
    link.output.write(8.0);
    EXPECT_EQ(link.input.read(value), Flow::fresh);
    EXPECT_EQ(value, 8.0);
}

TEST_P(Ports, give_what_the_row_gives_before_the_first_value_and_the_substitute_only_when_it_is_stale) {
    static const double constant = 11;
    link.port.set_policy(&link.input,
                         {.max_age = 4ms,
                          .when_stale = WhenStale::substitute,
                          .substitute = number(-5),
                          .before_first = {.given = true, .constant = &constant, .type = type_id<double>}});
    EXPECT_EQ(link.input.read(value), Flow::never_written);
    EXPECT_EQ(value, 11.0);
    link.output.write(7.0);
    link.at(at_ns(0) + 5ms);
    EXPECT_EQ(link.input.read(value), Flow::stale);
    EXPECT_EQ(value, -5.0);
}

TEST_P(Ports, never_call_a_value_stale_whose_row_states_no_age) {
    link.output.write(7.0);
    link.at(at_ns(0) + 10h);
    EXPECT_EQ(link.input.read(value), Flow::fresh);
    EXPECT_EQ(link.input.read(value), Flow::old);
}

TEST_P(Ports, wake_the_reader_once_for_each_write) {
    int wakes = 0;
    link.port.set_waker(&link.output,
                        {[](void* count) noexcept TAPPET_REALTIME { ++*static_cast<int*>(count); }, &wakes});
    link.output.write(1.0);
    link.output.write(1.0);
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
    Link<int> link{true};
    Input<int> near;
    link.port.link_local(&near, &link.output, nullptr);
    link.output.write(3);
    EXPECT_EQ(near.get(), 3);
    EXPECT_EQ(link.input.get(), 3);
}

/// A ring between two ports, as start-up places it.
struct BufferRow {
    BufferRow(bool crosses, BufferOutput<int>& from, BufferInput<int>& to, std::size_t capacity,
              Overflow overflow)
        : across{crosses} {
        const BufferOperations& operations = PortAccess::buffer<int>;
        const std::size_t bytes = operations.ring_bytes(capacity, across);
        memory.reset(static_cast<std::byte*>(::operator new(bytes, std::align_val_t{operations.ring_align})));
        operations.link(&from, &to, memory.get(), capacity, overflow, across);
    }
    [[nodiscard]] std::size_t lost() const { return PortAccess::buffer<int>.lost(memory.get(), across); }
    bool across;
    struct Free {
        void operator()(std::byte* p) const {
            ::operator delete(p, std::align_val_t{PortAccess::buffer<int>.ring_align});
        }
    };
    std::unique_ptr<std::byte, Free> memory;
};

std::vector<int> drain(BufferInput<int>& input) {
    std::vector<int> all;
    for (int value = 0; input.pop(value);) all.push_back(value);
    return all;
}

class BufferPort : public testing::TestWithParam<bool> {};

INSTANTIATE_TEST_SUITE_P(, BufferPort, testing::Bool(), [](const auto& each) {
    return each.param ? "across_activities" : "inside_one_activity";
});

TEST_P(BufferPort, gives_every_value_in_order) {
    BufferOutput<int> output;
    BufferInput<int> input;
    const BufferRow row{GetParam(), output, input, 4, Overflow::reject};
    for (int value : {1, 2, 3}) EXPECT_TRUE(output.push(value));
    EXPECT_EQ(drain(input), (std::vector{1, 2, 3}));
    EXPECT_EQ(drain(input), std::vector<int>{});
}

TEST_P(BufferPort, rejects_and_counts_what_has_no_room) {
    BufferOutput<int> output;
    BufferInput<int> input;
    const BufferRow row{GetParam(), output, input, 2, Overflow::reject};
    EXPECT_TRUE(output.push(1));
    EXPECT_TRUE(output.push(2));
    EXPECT_FALSE(output.push(3));
    EXPECT_EQ(row.lost(), 1u);
    EXPECT_EQ(drain(input), (std::vector{1, 2}));
}

TEST_P(BufferPort, keeps_the_writers_of_one_input_apart) {
    BufferOutput<int> one, other;
    BufferInput<int> input;
    const BufferRow first{GetParam(), one, input, 2, Overflow::reject};
    const BufferRow second{GetParam(), other, input, 2, Overflow::reject};
    EXPECT_TRUE(other.push(20));
    EXPECT_TRUE(one.push(10));
    EXPECT_TRUE(one.push(11));
    EXPECT_FALSE(one.push(12)) << "full, and the other writer's row is not";
    EXPECT_TRUE(other.push(21));
    EXPECT_EQ(drain(input), (std::vector{10, 11, 20, 21}));
}

TEST_P(BufferPort, gives_every_reader_of_one_output_every_value) {
    BufferOutput<int> output;
    BufferInput<int> fast, slow;
    const BufferRow first{GetParam(), output, fast, 4, Overflow::reject};
    const BufferRow second{GetParam(), output, slow, 1, Overflow::reject};
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
