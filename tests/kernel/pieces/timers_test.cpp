// Truth values delayed in time, cycle by cycle.
#include "kernel/pieces/timers.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace tappet {
namespace {

/// The results of a piece in cycles of 1 ms: '#' true, '.' false.
template <class Piece>
std::string heard(Piece& piece, Duration time, std::string_view input) {
    static Time now{};
    std::string answers;
    for (const char each : input) answers += piece(each == '#', time, now += 1ms) ? '#' : '.';
    return answers;
}

TEST(OnDelay, is_true_after_its_input_was_true_for_its_time) {
    OnDelay delay;
    EXPECT_EQ(heard(delay, 3ms, "..##..######.."), ".........###..");
    EXPECT_EQ(heard(delay, 0ms, ".#."), ".#.") << "without a delay it is its input";
}

TEST(OnDelay, reports_elapsed_time_and_restarts_after_a_reset) {
    OnDelay delay;
    const Time begin{5ms};
    EXPECT_EQ(delay.elapsed(begin), 0ms);
    EXPECT_FALSE(delay(true, 3ms, begin));
    EXPECT_EQ(delay.elapsed(begin + 2ms), 2ms);
    delay.reset();
    EXPECT_FALSE(delay(true, 3ms, begin + 4ms));
    EXPECT_TRUE(delay(true, 3ms, begin + 7ms));
}

TEST(OffDelay, stays_true_for_its_time_after_its_input) {
    OffDelay delay;
    EXPECT_EQ(heard(delay, 3ms, "..#......##.##...."), "..####...########.");
    delay.reset();
    EXPECT_EQ(heard(delay, 3ms, "..."), "...");
}

TEST(Pulse, has_its_length_whatever_the_input_does) {
    Pulse pulse;
    EXPECT_EQ(heard(pulse, 3ms, "..#...#.#.#..#######.."), "..###.###.######......");
}

TEST(Pulse, does_not_start_for_an_initially_true_input_or_zero_length) {
    Pulse pulse;
    EXPECT_EQ(heard(pulse, 3ms, "###.#..."), "....###.");
    EXPECT_EQ(heard(pulse, 0ms, ".#.#"), "....");
}

TEST(Debounced, accepts_the_first_value_at_once_and_later_values_when_stable) {
    Debounced contact;
    EXPECT_EQ(heard(contact, 3ms, "##.#.#..."), "#########");
    EXPECT_EQ(heard(contact, 3ms, ".#.##.####"), ".........#");
    EXPECT_EQ(heard(contact, 3ms, "#"), "#");
    contact.reset();
    EXPECT_EQ(heard(contact, 3ms, "."), ".");
}

} // namespace
} // namespace tappet
