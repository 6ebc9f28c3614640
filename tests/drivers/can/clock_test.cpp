// Evaluation of clock frames: which exchanges count, which do not, and which time is reported meanwhile.
#include "tests/drivers/can/clock_machines.hpp"
#include "tests/drivers/components/machine_rig.hpp"

#include <gtest/gtest.h>

namespace tappet::test {
namespace {

using Kind = can::ClockFrame::Kind;

TEST(ClockRows, are_part_of_the_proof_for_the_bus) {
    EXPECT_EQ(TellingBus::device_traffic.rows, 2u);
    EXPECT_EQ(ToldBus::device_traffic.rows, 2u);
    std::array<TrafficRow, 2> rows{};
    constexpr std::array at_125_kbit{bit_rate(125'000), bus_errors(0, 1s)};
    constexpr std::array at_1_kbit{bit_rate(1'000)};
    const DeviceUse slow{"can", at_125_kbit, 500us};
    EXPECT_EQ(TellingBus::analyse_traffic(slow, rows).view(), "");
    EXPECT_TRUE(rows[0].sent);
    EXPECT_EQ(rows[0].wire_time, 1080us) << "8 bytes, 135 bits";
    EXPECT_EQ(ToldBus::analyse_traffic(slow, rows).view(), "");
    EXPECT_FALSE(rows[1].sent);
    EXPECT_FALSE(TellingBus::analyse_traffic({"can", at_1_kbit, 500us}, rows).empty()) << "they fill the bus";
}

/// The master's clock is 1000 s ahead, and its stamps are exact.
struct ToldClock : MachineRig<fed_machine> {
    ToldClock() {
        EXPECT_TRUE(instance.configure({}));
        told = instance.find<Told>("clock");
        feeder = instance.find<ClockFeeder>("feeder");
        run(20ms);
    }

    void sync(unsigned sequence, Duration ago = 4ms) {
        through = clock.now() - ago;
        const auto seconds = to_ns(through + ahead) / 1'000'000'000;
        feed({.kind = Kind::sync,
              .sequence = static_cast<std::uint8_t>(sequence & 15U),
              .number = static_cast<std::uint32_t>(seconds)},
             through);
        base = Time{Duration{seconds * 1'000'000'000}};
    }
    void follow_up(unsigned sequence) {
        const std::int64_t ns = (through + ahead - base).count();
        feed({.kind = Kind::follow_up,
              .sequence = static_cast<std::uint8_t>(sequence & 15U),
              .number = static_cast<std::uint32_t>(ns % 1'000'000'000),
              .seconds_more = static_cast<std::uint8_t>(ns / 1'000'000'000)},
             clock.now());
    }
    void feed(const can::ClockFrame& content, Time stamp) {
        can::Frame frame = can::encode(clock_row, content);
        frame.stamp = stamp;
        feeder->to_give.push_back(frame);
    }
    void exchange(unsigned sequence) {
        sync(sequence);
        follow_up(sequence);
        run(100ms);
    }
    void expect_right() const {
        EXPECT_LE(std::abs((told->ahead.last() - ahead).count()), told->error.last().count());
    }

    Told* told = nullptr;
    ClockFeeder* feeder = nullptr;
    Duration ahead = 1000s + 250ms;
    Time through{}, base{};
};

TEST_F(ToldClock, is_unknown_before_the_first_exchange) {
    run(3s);
    EXPECT_FALSE(told->is_known.last());
    EXPECT_EQ(told->exchanges.last(), 0);
    EXPECT_EQ(instance.find<ClockWatcher>("watcher")->ahead.flow(), Flow::never_written);
}

TEST_F(ToldClock, knows_its_offset_and_the_error_bound) {
    exchange(1);
    EXPECT_TRUE(told->is_known.last());
    EXPECT_EQ(told->exchanges.last(), 1);
    expect_right();
    // Both stamps may be 100 us late, and 105 ms of 210 ppm are 22 us.
    EXPECT_GE(told->error.last(), 100us + 20us);
    EXPECT_LE(told->error.last(), 100us + 23us);
}

TEST_F(ToldClock, widens_its_error_without_exchanges_until_it_becomes_unknown) {
    exchange(1);
    const Duration before = told->error.last();
    run(800ms);
    EXPECT_NEAR(to_seconds(told->error.last() - before), 800e-3 * 210e-6, 1e-6);
    EXPECT_TRUE(told->is_known.last());
    run(200ms);
    EXPECT_FALSE(told->is_known.last());
    expect_right();
    exchange(2);
    EXPECT_TRUE(told->is_known.last());
    EXPECT_LT(told->error.last(), 130us);
}

TEST_F(ToldClock, can_join_at_any_time) {
    sync(7);
    feeder->to_give.clear(); // before the receiver joined
    follow_up(7);
    run(100ms);
    EXPECT_EQ(told->exchanges.last(), 0);
    EXPECT_EQ(told->discarded.last(), 1);
    exchange(8);
    EXPECT_EQ(told->exchanges.last(), 1);
    expect_right();
}

TEST_F(ToldClock, ignores_half_an_exchange) {
    exchange(1);
    sync(2); // its FUP is lost
    run(100ms);
    follow_up(3); // and the next SYNC
    run(100ms);
    EXPECT_EQ(told->exchanges.last(), 1);
    EXPECT_EQ(told->discarded.last(), 1) << "the SYNC and the FUP that do not belong together";
    exchange(4);
    EXPECT_EQ(told->exchanges.last(), 2);
    sync(5);
    run(100ms);
    exchange(6);
    EXPECT_EQ(told->exchanges.last(), 3);
    EXPECT_EQ(told->discarded.last(), 2);
    sync(7);
    follow_up(8);
    run(5ms);
    EXPECT_EQ(told->exchanges.last(), 3) << "of two exchanges, soon after one another";
    expect_right();
}

TEST_F(ToldClock, ignores_a_follow_up_that_is_a_full_sequence_late) {
    sync(1);
    run(1600ms);
    const Time old = through;
    through = clock.now();
    follow_up(1);
    run(5ms);
    EXPECT_EQ(told->exchanges.last(), 0) << old.time_since_epoch().count();
    EXPECT_EQ(told->discarded.last(), 1);
}

TEST_F(ToldClock, discards_an_exchange_with_a_duplicate_sync) {
    exchange(1);
    sync(2, 4ms);
    sync(2, 3ms); // the sender saw an error in the last bit, and its stamp belongs to the second SYNC
    follow_up(2);
    run(100ms);
    EXPECT_EQ(told->exchanges.last(), 1);
    expect_right();
    exchange(3);
    EXPECT_EQ(told->exchanges.last(), 2);
    follow_up(3);
    run(5ms);
    EXPECT_EQ(told->exchanges.last(), 2) << "a FUP that comes twice";
    expect_right();
}

TEST_F(ToldClock, starts_over_after_an_exchange_out_of_order) {
    exchange(1);
    exchange(5); // three were lost
    EXPECT_EQ(told->exchanges.last(), 2);
    exchange(10);
    EXPECT_EQ(told->exchanges.last(), 2) << "five steps";
    exchange(11);
    EXPECT_EQ(told->exchanges.last(), 3);
    exchange(9);
    EXPECT_EQ(told->exchanges.last(), 3) << "backwards";
    exchange(10);
    EXPECT_EQ(told->exchanges.last(), 4);
    for (unsigned i = 11; i < 50; ++i) exchange(i);
    EXPECT_EQ(told->exchanges.last(), 43) << "it turns at sixteen";
    expect_right();
}

TEST_F(ToldClock, follows_small_and_large_jumps_of_the_master_clock) {
    exchange(1);
    for (const Duration jump : {Duration{10s}, Duration{-500s}, Duration{190us}, Duration{-190us}}) {
        const std::int64_t exchanges = told->exchanges.last();
        ahead += jump;
        exchange(3); // out of order, mostly
        exchange(4);
        exchange(5);
        EXPECT_GT(told->exchanges.last(), exchanges);
        expect_right();
    }
    EXPECT_EQ(told->jumps.last(), 2) << "small ones cannot be told from what is not known";
}

TEST_F(ToldClock, ignores_corrupted_and_unsecured_frames) {
    exchange(1);
    for (const std::size_t of : {0U, 1U}) {
        sync(2);
        follow_up(2);
        feeder->to_give[of].data[6] ^= 4U;
        run(100ms);
    }
    sync(2);
    follow_up(2);
    feeder->to_give[0].data[0] = 0x10;
    feeder->to_give[1].length = 7;
    run(100ms);
    EXPECT_EQ(told->exchanges.last(), 1);
    EXPECT_EQ(told->invalid.last(), 4);
    expect_right();
    exchange(3);
    EXPECT_EQ(told->exchanges.last(), 2);
}

TEST_F(ToldClock, accepts_a_follow_up_seconds_after_its_base) {
    sync(1);
    base -= 3s;
    feeder->to_give.back() =
        can::encode(clock_row, {.kind = Kind::sync,
                                .sequence = 1,
                                .number = static_cast<std::uint32_t>(to_ns(base) / 1'000'000'000)});
    feeder->to_give.back().stamp = through;
    follow_up(1);
    run(5ms);
    EXPECT_EQ(told->exchanges.last(), 1);
    expect_right();
}

TEST_F(ToldClock, measures_the_average_rate_of_the_master_clock) {
    const Duration before = ahead;
    for (unsigned i = 1; i <= 50; ++i) {
        ahead = before + Duration{to_ns(clock.now()) / 20'000}; // 50 ppm
        exchange(i);
    }
    EXPECT_NEAR(told->rate.last(), 50e-6, told->rate_error.last());
    EXPECT_NEAR(told->rate.last(), 50e-6, 1e-6) << "its stamps are exact";
    EXPECT_NEAR(told->rate_error.last(), 100e-6, 5e-6) << "200 us over 2 s";
}

} // namespace
} // namespace tappet::test
