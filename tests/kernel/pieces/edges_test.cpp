// Edges, their counters, and outputs that are written on change.
#include "kernel/component/facet.hpp"
#include "kernel/pieces/changed.hpp"
#include "kernel/pieces/edges.hpp"

#include <gtest/gtest.h>

namespace tappet {
namespace {

/// The results of an edge, value by value: '#' true, '.' false.
template <class Edge>
std::string told(Edge& edge, std::string_view input) {
    std::string answers;
    for (const char each : input) answers += edge(each == '#') ? '#' : '.';
    return answers;
}

TEST(RisingEdge, is_true_once_for_each_change_to_true) {
    RisingEdge rises;
    EXPECT_EQ(told(rises, ".##.#"), ".#..#");
}

TEST(RisingEdge, ignores_a_button_held_at_the_start) {
    RisingEdge rises;
    EXPECT_EQ(told(rises, "#.#"), "..#");
    rises.reset();
    EXPECT_EQ(told(rises, "#"), ".");
}

TEST(FallingEdge, is_true_once_for_each_change_to_false_after_the_first_value) {
    FallingEdge falls;
    EXPECT_EQ(told(falls, ".#.."), "..#.");
    falls.reset();
    EXPECT_EQ(told(falls, "."), ".");
}

template <class Counter>
void press(Counter& counter, int times) {
    for (int i = 0; i < times; ++i) {
        counter(false);
        counter(true);
        counter(true);
    }
}

TEST(UpCounter, counts_edges_and_reports_its_preset) {
    UpCounter counter{3};
    press(counter, 2);
    EXPECT_EQ(counter.value(), 2);
    EXPECT_FALSE(counter.reached());
    press(counter, 2);
    EXPECT_EQ(counter.value(), 4) << "it counts on";
    EXPECT_TRUE(counter.reached());
    counter.reset();
    EXPECT_FALSE(counter(true)) << "an input that stays true is no new edge";
    EXPECT_EQ(counter.value(), 0);
}

TEST(DownCounter, stops_at_zero) {
    DownCounter counter{2};
    press(counter, 1);
    EXPECT_FALSE(counter.used_up());
    press(counter, 5);
    EXPECT_TRUE(counter.used_up());
    EXPECT_EQ(counter.value(), 0);
    counter.reset();
    EXPECT_EQ(counter.value(), 2);
}

TEST(UpDownCounter, keeps_its_value_when_both_inputs_count_at_once) {
    UpDownCounter counter{1};
    counter(false, false);
    counter(true, true);
    EXPECT_EQ(counter.value(), 0);
    EXPECT_TRUE(counter.used_up());
    counter(false, false);
    counter(true, false);
    EXPECT_TRUE(counter.reached());
    counter(true, true);
    counter(true, false);
    EXPECT_EQ(counter.value(), 0);
    counter.load(std::numeric_limits<std::int64_t>::min());
    counter(true, true);
    EXPECT_EQ(counter.value(), std::numeric_limits<std::int64_t>::min()) << "it does not wrap round";
}

TEST(Changed, writes_the_first_value_and_then_only_changes) {
    Output<int> output;
    Changed<int> changed;
    EXPECT_EQ(output.last(), 0);
    const auto writes = [&] { return *PortAccess::data<int>.places(&output, false).writes; };
    changed.write(output, 0);
    EXPECT_EQ(writes(), 1u) << "nobody knew that it is 0";
    changed.write(output, 0);
    EXPECT_EQ(writes(), 1u);
    changed.write(output, 7);
    EXPECT_EQ(writes(), 2u);
    EXPECT_EQ(output.last(), 7);
}

} // namespace
} // namespace tappet
