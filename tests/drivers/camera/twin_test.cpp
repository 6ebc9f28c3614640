// The border of a camera: good frames in order with their times, and each fault refused and counted once.
#include "drivers/camera/pixels.hpp"
#include "drivers/camera/twin.hpp"

#include <gtest/gtest.h>

namespace tappet::camera {
namespace {

constexpr Size size{4, 2};
using Shown = Image<size.columns, size.rows>;
Shown grey(int value) {
    Shown image;
    const auto part = static_cast<std::uint8_t>(value);
    image.pixels.fill({part, part, part});
    return image;
}

struct Wire : testing::Test {
    Wire() { twin.open(size); }
    void show(int value) { EXPECT_TRUE(twin.show(grey(value).pixels, now += 10ms)); }
    Taken take() { return twin.take(frame, now - 1s, now); }
    /// The value of the next good frame; -1: none.
    int taken() {
        if (take() != Taken::frame) return -1;
        Shown image;
        decode(frame, size, image.pixels);
        EXPECT_TRUE(twin.give_back());
        EXPECT_EQ(image.pixels, grey(image.pixels[0].red).pixels);
        return image.pixels[0].red;
    }
    Twin twin;
    Frame frame{};
    Time now{100s};
};

TEST_F(Wire, delivers_images_in_order_with_their_times) {
    EXPECT_EQ(take(), Taken::nothing);
    show(1);
    show(2);
    EXPECT_EQ(taken(), 1);
    EXPECT_EQ(frame.stamp, now - 10ms);
    EXPECT_EQ(taken(), 2);
    EXPECT_EQ(frame.stamp, now);
    EXPECT_EQ(take(), Taken::nothing);
    EXPECT_EQ(twin.counters(), (Counters{.frames = 2}));
}

TEST_F(Wire, refuses_an_image_of_another_size) {
    const Shown image = grey(1);
    EXPECT_FALSE(twin.show(std::span{image.pixels}.first(7), now));
    EXPECT_EQ(take(), Taken::nothing);
}

TEST_F(Wire, counts_images_lost_between_two_others) {
    show(1);
    EXPECT_EQ(taken(), 1);
    twin.faults().lose_next = 2;
    for (const int value : {2, 3, 4}) show(value);
    EXPECT_EQ(taken(), 4);
    EXPECT_EQ(twin.counters(), (Counters{.frames = 2, .lost = 2}));
}

TEST_F(Wire, loses_the_images_for_which_no_buffer_is_free) {
    for (int value = 0; value < 10; ++value) show(value);
    for (int value = 0; value < 4; ++value) EXPECT_EQ(taken(), value);
    EXPECT_EQ(taken(), -1);
    show(20);
    EXPECT_EQ(taken(), 20);
    EXPECT_EQ(twin.counters(), (Counters{.frames = 5, .lost = 6}));
}

TEST_F(Wire, refuses_flawed_and_incomplete_images) {
    twin.faults().flaw_next = 1;
    show(1);
    EXPECT_EQ(take(), Taken::refused);
    twin.faults().cut_next = 1;
    show(2);
    EXPECT_EQ(take(), Taken::refused);
    show(3);
    EXPECT_EQ(taken(), 3);
    EXPECT_EQ(twin.counters(), (Counters{.frames = 1, .flawed = 2})) << "and does not count them as lost";
}

TEST_F(Wire, refuses_a_repeated_image) {
    show(1);
    EXPECT_EQ(taken(), 1);
    twin.faults().repeat_next = 1;
    show(2);
    EXPECT_EQ(taken(), 2);
    EXPECT_EQ(take(), Taken::refused) << "the same number";
    EXPECT_TRUE(twin.show(grey(3).pixels, now));
    EXPECT_EQ(take(), Taken::refused) << "the same time";
    show(4);
    EXPECT_EQ(taken(), 4);
    EXPECT_EQ(twin.counters(), (Counters{.frames = 3, .repeated = 2}));
}

TEST_F(Wire, refuses_a_late_image_and_one_of_the_future) {
    show(1);
    EXPECT_EQ(twin.take(frame, now + 1ns, now + 1ns), Taken::refused);
    EXPECT_TRUE(twin.show(grey(2).pixels, now + 1h));
    EXPECT_EQ(take(), Taken::refused);
    show(3);
    EXPECT_EQ(taken(), 3) << "a time of the future does not make all others early";
    EXPECT_EQ(twin.counters(), (Counters{.frames = 1, .flawed = 1, .late = 1}));
}

TEST_F(Wire, corrects_a_time_that_is_ahead_by_the_error_of_a_conversion) {
    EXPECT_TRUE(twin.show(grey(1).pixels, now + CheckedFrames::ahead_at_most));
    EXPECT_EQ(taken(), 1);
    EXPECT_EQ(frame.stamp, now);
    now += 1ms;
    EXPECT_TRUE(twin.show(grey(2).pixels, now + CheckedFrames::ahead_at_most + 1ns));
    EXPECT_EQ(take(), Taken::refused);
}

TEST_F(Wire, begins_anew_without_what_arrived_before) {
    show(1);
    EXPECT_EQ(taken(), 1);
    for (int value = 2; value < 10; ++value) show(value);
    twin.begin_anew();
    EXPECT_EQ(take(), Taken::nothing);
    show(10);
    EXPECT_EQ(taken(), 10);
    EXPECT_EQ(twin.counters().lost, 0u) << "nobody wanted them";
}

TEST_F(Wire, fails_each_call_while_it_is_unplugged) {
    int calls = 0;
    twin.set_listener([](void* count) noexcept TAPPET_REALTIME { ++*static_cast<int*>(count); }, &calls);
    show(1);
    twin.deliver();
    twin.deliver();
    EXPECT_EQ(calls, 1);
    ASSERT_EQ(take(), Taken::frame);
    twin.set_removed(true);
    twin.deliver();
    EXPECT_EQ(calls, 2) << "as a descriptor hangs up";
    EXPECT_FALSE(twin.give_back());
    EXPECT_EQ(take(), Taken::failed);
    show(2);
    twin.set_removed(false);
    show(3);
    EXPECT_EQ(taken(), 3);
    EXPECT_EQ(twin.counters(), (Counters{.frames = 2, .lost = 1, .failures = 2}));
}

TEST_F(Wire, loses_by_its_seed) {
    twin.faults().lose_one_in = 3;
    int got = 0;
    for (int i = 0; i < 300; ++i) {
        show(i % 250);
        got += taken() >= 0 ? 1 : 0;
    }
    EXPECT_GT(got, 150);
    EXPECT_LT(got, 250);
}

} // namespace
} // namespace tappet::camera
