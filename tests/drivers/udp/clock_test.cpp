// The offset of another clock: the reported bounds hold whatever the network does, however the clocks drift,
// and when the other one is set; invalid questions and answers are ignored.
#include "drivers/udp/peer_clock.hpp"
#include "drivers/udp/twin.hpp"
#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tappet::udp {
namespace {

Duration some(Random& random, Duration most) {
    return Duration{static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(most.count()) + 1))};
}
Duration part(Duration of, double factor) {
    return Duration{std::llround(factor * static_cast<double>(of.count()))};
}

class Exchange : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Exchange, bounds_the_offset_of_the_other_clock) {
    Random random{GetParam()};
    const Duration began = some(random, 100s) - 50s;
    const double drift = 100e-6 * (2.0 * random.unit() - 1.0);
    const auto ahead = [&](Time now) { return began + part(now - Time{}, drift); };
    ClockExchange known;
    Time now = Time{} + some(random, 1000s);
    Duration worst{};
    for (int i = 0; i < 1000; ++i) {
        ClockTimes times{.asked = now};
        now += 10us + some(random, 5ms);
        times.received = now + ahead(now);
        now += some(random, 1ms);
        times.answered = now + ahead(now);
        now += 10us + some(random, 5ms);
        times.got = now;
        known.take(times, 100e-6);
        ASSERT_TRUE(known.known());
        for (int looks = 0; looks < 3; ++looks) {
            const Duration wrong = known.ahead() - ahead(now);
            ASSERT_LE(std::abs(wrong.count()), known.error().count() + 1) << "at exchange " << i;
            now += some(random, 200ms);
            known.age(now, 100e-6);
        }
        if (i > 100) worst = std::max(worst, known.error());
    }
    EXPECT_EQ(known.jumps(), 0);
    EXPECT_LT(worst, 2ms) << "the shortest ways of many tell more than one exchange";
}

TEST_P(Exchange, detects_that_the_other_clock_was_set) {
    Random random{GetParam()};
    ClockExchange known;
    Duration ahead = 3s;
    Time now = Time{} + 10s;
    const auto exchange = [&] {
        const Time asked = now;
        const Time there = now + 100us + some(random, 1ms);
        now = there + 100us + some(random, 1ms);
        known.take({asked, there + ahead, there + ahead, now}, 0.0);
        now += 100ms;
    };
    for (int i = 0; i < 20; ++i) exchange();
    EXPECT_EQ(known.jumps(), 0);
    ahead += random.one_in(2) ? 1s : -1s;
    exchange();
    EXPECT_EQ(known.jumps(), 1);
    EXPECT_LE(std::abs((known.ahead() - ahead).count()), known.error().count());
}
INSTANTIATE_TEST_SUITE_P(seeds, Exchange, testing::Range<std::uint64_t>(1, 21));

TEST(ClockPacket, decodes_as_it_was_encoded_and_refuses_other_packets) {
    const clock_packet::Content content{7, Time{} + 1s, Time{} + 2s, Time{} + 3s};
    const auto packet = clock_packet::write(content);
    clock_packet::Content read;
    ASSERT_TRUE(clock_packet::read(packet, read));
    EXPECT_EQ(read.number, 7u);
    EXPECT_EQ(read.asked, content.asked);
    EXPECT_EQ(read.received, content.received);
    EXPECT_EQ(read.answered, content.answered);
    for (std::size_t size = 0; size < packet.size(); ++size)
        EXPECT_FALSE(clock_packet::read(std::span{packet}.first(size), read));
    auto bad = packet;
    bad[0] ^= std::byte{1};
    EXPECT_FALSE(clock_packet::read(bad, read));
}

TEST(ClockPacket, refuses_impossible_times) {
    for (const Time at : {Time::max(), Time::min(), Time{} + clock_packet::longest + 1ns}) {
        clock_packet::Content read;
        EXPECT_FALSE(clock_packet::read(clock_packet::write({7, Time{} + 1s, at, at}), read));
    }
}

/// Both components at twins between which the test carries datagrams.
struct Clocks : testing::Test {
    os::Clock clock{os::Clock::Kind::virtual_time};
    Twin asking, answering;
    PeerClock peer;
    ClockAnswers answers;
    std::array<ProvidedDevice, 1> of_peer{{{type_id<Device>, "time", static_cast<Device*>(&asking)}}};
    std::array<ProvidedDevice, 1> of_answers{{{type_id<Device>, "time", static_cast<Device*>(&answering)}}};

    Clocks() {
        tappet::Setup setup{.device_name = "time", .devices = of_peer, .clock = &clock};
        EXPECT_TRUE(peer.configure(setup).empty());
        setup.devices = of_answers;
        EXPECT_TRUE(answers.configure(setup).empty());
        peer.start(cycle());
        answers.start(cycle());
    }
    [[nodiscard]] Cycle cycle() {
        Cycle now;
        now.now = now.release = clock.now();
        return now;
    }
    void wait(Duration time) { clock.advance_to(clock.now() + time); }
    static bool carry(Twin& from, Twin& to) {
        std::array<std::byte, most_bytes> packet;
        const std::size_t size = from.hear(packet);
        return size != 0 && to.tell(std::span{packet}.first(size));
    }
    void exchange() {
        peer.step(cycle());
        wait(1ms);
        EXPECT_TRUE(carry(asking, answering));
        answers.step(cycle());
        wait(1ms);
        EXPECT_TRUE(carry(answering, asking));
        peer.step(cycle());
        wait(98ms);
    }
};

TEST_F(Clocks, report_their_offset_and_its_error) {
    exchange();
    EXPECT_EQ(peer.exchanges.last(), 1);
    EXPECT_LT(std::abs(peer.ahead.last().count()), 1000) << "there is one clock";
    EXPECT_GE(peer.error.last(), 1ms);
    EXPECT_LT(peer.error.last(), 1001us) << "half of the way there and back";
    const Duration before = peer.error.last();
    for (int i = 0; i < 10; ++i) {
        peer.step(cycle()); // nobody answers
        std::array<std::byte, most_bytes> packet;
        EXPECT_EQ(asking.hear(packet), clock_packet::bytes);
        wait(100ms);
    }
    EXPECT_EQ(peer.lost.last(), 9) << "the last one may still come";
    EXPECT_GT(peer.error.last(), before + 100us) << "it grows by what the clocks may drift";
    exchange();
    EXPECT_LT(peer.error.last(), 1001us);
}

TEST_F(Clocks, refuse_impossible_answers) {
    for (int i = 0; i < 3; ++i) exchange();
    const Duration ahead = peer.ahead.last(), error = peer.error.last();
    const auto answer = [&](Duration asked, Duration received, Duration answered) {
        peer.step(cycle());
        std::array<std::byte, most_bytes> packet;
        clock_packet::Content question;
        const std::size_t size = asking.hear(packet);
        ASSERT_TRUE(clock_packet::read(std::span{packet}.first(size), question));
        wait(1ms);
        ASSERT_TRUE(asking.tell(clock_packet::write(
            {question.number, question.asked + asked, clock.now() + received, clock.now() + answered})));
        wait(1ms);
        peer.step(cycle());
        wait(98ms);
    };
    answer(-77s, 0ms, 0ms); // to a question that was not asked then
    answer(0ms, 0ms, -5ms); // given before its question
    answer(0ms, -50s, 40s); // which took longer than its round trip
    EXPECT_EQ(peer.ahead.last(), ahead);
    EXPECT_GE(peer.error.last(), error);
    EXPECT_LT(peer.error.last(), error + 1ms) << "by what the clocks drift";
    EXPECT_EQ(peer.jumps.last(), 0);
}

TEST_F(Clocks, refuse_answers_to_other_requests_and_invalid_requests) {
    exchange();
    peer.step(cycle());
    std::array<std::byte, most_bytes> packet;
    ASSERT_EQ(asking.hear(packet), clock_packet::bytes);
    for (const std::uint32_t number : {0U, 1U, 3U, 99U}) // it waits for an answer to 2
        ASSERT_TRUE(asking.tell(
            clock_packet::write({number, clock.now() - 50s, clock.now() + 40s, clock.now() + 40s})));
    peer.step(cycle());
    peer.step(cycle());
    EXPECT_EQ(peer.exchanges.last(), 1);
    EXPECT_EQ(peer.jumps.last(), 0);
    ASSERT_TRUE(answering.tell(std::span{packet}.first(9)));
    ASSERT_TRUE(answering.tell(clock_packet::write({1, {}, {}, clock.now()}))); // an answer
    ASSERT_TRUE(answering.tell(std::span{packet}.first(clock_packet::bytes + 1)));
    answers.step(cycle());
    EXPECT_EQ(answers.answers.last(), 1);
    EXPECT_EQ(answers.invalid.last(), 3);
}

} // namespace
} // namespace tappet::udp
