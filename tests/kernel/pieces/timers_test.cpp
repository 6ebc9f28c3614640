// Truth values delayed in time, cycle by cycle.
#include "kernel/pieces/timers.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace tappet {
namespace {

/// What a piece answers in cycles of 1 ms: '#' true, '.' false.
template <class Piece>
std::string heard(Piece& piece, Duration time, std::string_view input) {
    static Time now{};
    std::string answers;
    for (const char each : input) answers += piece(each == '#', time, now += 1ms) ? '#' : '.';
    return answers;
}

TEST(OnDelay, is_true_when_its_input_was_true_for_so_long) {
    OnDelay delay;
    EXPECT_EQ(heard(delay, 3ms, "..##..######.."), ".........###..");
    EXPECT_EQ(heard(delay, 0ms, ".#."), ".#.") << "without a delay it is its input";
}

TEST(OnDelay, tells_how_long_and_begins_anew_after_a_reset) {
    OnDelay delay;
    const Time begin{5ms};
    EXPECT_EQ(delay.elapsed(begin), 0ms);
    EXPECT_FALSE(delay(true, 3ms, begin));
    EXPECT_EQ(delay.elapsed(begin + 2ms), 2ms);
    delay.reset();
    EXPECT_FALSE(delay(true, 3ms, begin + 4ms));
    EXPECT_TRUE(delay(true, 3ms, begin + 7ms));
}

TEST(OffDelay, stays_true_for_so_long_after_its_input) {
    OffDelay delay;
    EXPECT_EQ(heard(delay, 3ms, "..#......##.##...."), "..####...########.");
    delay.reset();
    EXPECT_EQ(heard(delay, 3ms, "..."), "...");
}

TEST(Pulse, has_its_length_whatever_the_input_does_meanwhile) {
    Pulse pulse;
    EXPECT_EQ(heard(pulse, 3ms, "..#...#.#.#..#######.."), "..###.###.######......");
}

TEST(Pulse, of_an_input_that_is_true_at_the_start_or_of_no_length_is_none) {
    Pulse pulse;
    EXPECT_EQ(heard(pulse, 3ms, "###.#..."), "....###.");
    EXPECT_EQ(heard(pulse, 0ms, ".#.#"), "....");
}

TEST(Debounced, believes_what_stays_and_the_first_value_at_once) {
    Debounced contact;
    EXPECT_EQ(heard(contact, 3ms, "##.#.#..."), "#########");
    EXPECT_EQ(heard(contact, 3ms, ".#.##.####"), ".........#");
    EXPECT_EQ(heard(contact, 3ms, "#"), "#");
    contact.reset();
    EXPECT_EQ(heard(contact, 3ms, "."), ".");
}

} // namespace
} // namespace tappet
