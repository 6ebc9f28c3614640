// Frames that wait to be sent: order, replacement, age, and the few frames that may be in flight.
#include "drivers/can/transmitter.hpp"

#include <gtest/gtest.h>

namespace tappet::can {
namespace {

Frame frame(std::uint32_t id, Time made = at_ns(0), std::uint8_t content = 0) {
    Frame f{.id = id, .length = 1};
    f.data[0] = content;
    f.stamp = made;
    return f;
}

TEST(Arbitration, lets_the_lower_identifier_win) {
    EXPECT_LT(arbitration(frame(0x100)), arbitration(frame(0x101)));
}

TEST(Arbitration, prefers_data_to_remote_and_standard_to_extended_frames) {
    Frame remote = frame(0x100);
    remote.remote = true;
    Frame long_one = frame(0x100u << 18);
    long_one.extended = true;
    Frame long_remote = long_one;
    long_remote.remote = true;
    EXPECT_LT(arbitration(frame(0x100)), arbitration(remote));
    EXPECT_LT(arbitration(remote), arbitration(long_one));
    EXPECT_LT(arbitration(long_one), arbitration(long_remote));
    EXPECT_LT(arbitration(long_remote), arbitration(frame(0x101)));
}

TEST(TransmitQueue, returns_frames_in_the_order_of_arbitration) {
    TransmitQueue queue;
    for (const std::uint32_t id : {0x300u, 0x100u, 0x200u})
        EXPECT_EQ(queue.push(frame(id), Keep::latest), Send::queued);
    for (const std::uint32_t id : {0x100u, 0x200u, 0x300u}) {
        ASSERT_NE(queue.front(), nullptr);
        EXPECT_EQ(queue.front()->id, id);
        queue.pop();
    }
    EXPECT_EQ(queue.front(), nullptr);
}

TEST(TransmitQueue, replaces_the_older_frame_of_a_cyclic_identifier) {
    TransmitQueue queue;
    EXPECT_EQ(queue.push(frame(0x201, at_ns(1), 1), Keep::latest), Send::queued);
    EXPECT_EQ(queue.push(frame(0x201, at_ns(2), 2), Keep::latest), Send::replaced);
    EXPECT_EQ(queue.size(), 1u);
    EXPECT_EQ(queue.front()->data[0], 2);
}

TEST(TransmitQueue, keeps_last_frames_at_the_end_and_in_order) {
    TransmitQueue queue;
    for (const std::uint32_t id : {0x205u, 0x80u, 0u})
        EXPECT_EQ(queue.push(frame(id, at_ns(1)), Keep::last), Send::queued);
    EXPECT_EQ(queue.push(frame(0x700, at_ns(1)), Keep::latest), Send::queued);
    EXPECT_EQ(queue.push(frame(0x701, at_ns(9)), Keep::latest), Send::queued);
    EXPECT_EQ(queue.drop_older(at_ns(5)), 1u);
    for (const std::uint32_t id : {0x701u, 0x205u, 0x80u, 0u}) {
        ASSERT_NE(queue.front(), nullptr);
        EXPECT_EQ(queue.front()->id, id);
        queue.pop();
    }
}

TEST(TransmitQueue, keeps_every_command_in_order) {
    TransmitQueue queue;
    for (const std::uint8_t command : {std::uint8_t{0x81}, std::uint8_t{0x01}, std::uint8_t{0x02}})
        EXPECT_EQ(queue.push(frame(0, at_ns(1), command), Keep::every), Send::queued);
    EXPECT_EQ(queue.push(frame(0x80), Keep::latest), Send::queued);
    for (const int command : {0x81, 0x01, 0x02}) {
        EXPECT_EQ(queue.front()->data[0], command);
        queue.pop();
    }
    EXPECT_EQ(queue.front()->id, 0x80u);
}

TEST(TransmitQueue, refuses_when_full_and_stays_in_order) {
    TransmitQueue queue;
    for (std::uint32_t i = 0; i < TransmitQueue::capacity; ++i)
        ASSERT_EQ(queue.push(frame(0x700 - i), Keep::latest), Send::queued);
    EXPECT_EQ(queue.push(frame(0x001), Keep::latest), Send::refused_full);
    EXPECT_EQ(queue.size(), TransmitQueue::capacity);
    EXPECT_EQ(queue.front()->id, 0x700u - 63u);
}

TEST(TransmitQueue, drops_older_frames_and_keeps_the_rest_in_order) {
    TransmitQueue queue;
    EXPECT_EQ(queue.push(frame(1, at_ns(10)), Keep::latest), Send::queued);
    EXPECT_EQ(queue.push(frame(2, at_ns(30)), Keep::latest), Send::queued);
    EXPECT_EQ(queue.push(frame(3, at_ns(20)), Keep::latest), Send::queued);
    EXPECT_EQ(queue.drop_older(at_ns(20)), 1u);
    EXPECT_EQ(queue.front()->id, 2u);
    EXPECT_EQ(queue.size(), 2u);
}

struct Sending : testing::Test {
    Sending() {
        Settings settings;
        settings.in_flight = 2;
        settings.max_age = 10ms;
        settings.confirm_within = 30ms;
        transmitter.configure(settings);
    }
    Transmitter transmitter;
    Counters count;
};

TEST_F(Sending, hands_over_at_most_as_many_frames_as_may_be_in_flight) {
    for (const std::uint32_t id : {1u, 2u, 3u}) transmitter.push(frame(id, at_ns(1)), Keep::latest, count);
    for (int i = 0; i < 2; ++i) {
        ASSERT_NE(transmitter.next(at_ns(1), count), nullptr);
        transmitter.handed_over(at_ns(1));
    }
    EXPECT_EQ(transmitter.next(at_ns(1), count), nullptr);
    transmitter.confirmed(at_ns(2), count);
    ASSERT_NE(transmitter.next(at_ns(2), count), nullptr);
    EXPECT_EQ(transmitter.next(at_ns(2), count)->id, 3u);
    EXPECT_EQ(count.sent, 1u);
}

TEST_F(Sending, never_hands_over_a_frame_older_than_its_age) {
    transmitter.push(frame(1, at_ns(0)), Keep::latest, count);
    EXPECT_NE(transmitter.next(Time{10ms}, count), nullptr);
    EXPECT_EQ(transmitter.next(Time{10ms + 1ns}, count), nullptr);
    EXPECT_EQ(count.dropped_stale, 1u);
}

TEST_F(Sending, refuses_frames_built_before_a_restart) {
    transmitter.restarted(Time{5ms}, count);
    EXPECT_EQ(transmitter.push(frame(1, Time{5ms}), Keep::latest, count), Send::refused_stale);
    EXPECT_EQ(transmitter.push(frame(1, Time{5ms + 1ns}), Keep::latest, count), Send::queued);
    EXPECT_EQ(count.refused, 1u);
}

TEST_F(Sending, notices_a_missing_acknowledgement_and_counts_a_late_one) {
    transmitter.push(frame(1, at_ns(0)), Keep::latest, count);
    ASSERT_NE(transmitter.next(at_ns(0), count), nullptr);
    transmitter.handed_over(at_ns(0));
    EXPECT_EQ(transmitter.next_timeout(), Time{30ms + 1ns});
    EXPECT_FALSE(transmitter.unacknowledged(Time{30ms}));
    EXPECT_TRUE(transmitter.unacknowledged(transmitter.next_timeout()));
    transmitter.confirmed(Time{40ms}, count);
    EXPECT_EQ(count.sent_late, 1u);
}

TEST_F(Sending, ignores_confirmations_from_before_a_restart) {
    transmitter.restarted(Time{5ms}, count);
    transmitter.push(frame(1, Time{6ms}), Keep::latest, count);
    ASSERT_NE(transmitter.next(Time{6ms}, count), nullptr);
    transmitter.handed_over(Time{6ms});
    transmitter.confirmed(Time{4ms}, count);
    EXPECT_EQ(count.sent, 0u);
    EXPECT_EQ(transmitter.in_flight(), 1u);
}

TEST_F(Sending, refuses_identifiers_and_lengths_that_do_not_exist) {
    EXPECT_EQ(transmitter.push(frame(0x800, at_ns(1)), Keep::latest, count), Send::refused_invalid);
    Frame f = frame(1, at_ns(1));
    f.length = 9;
    EXPECT_EQ(transmitter.push(f, Keep::latest, count), Send::refused_invalid);
    EXPECT_EQ(count.refused, 2u);
}

} // namespace
} // namespace tappet::can
