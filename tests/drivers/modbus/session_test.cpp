// The Modbus client under virtual time: polling, values with an age, and every fault of a server survived.
#include "drivers/modbus/session.hpp"
#include "drivers/modbus/twin.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

namespace tappet::modbus {
namespace {

constexpr auto map = register_map(read("climate", input_registers(0, 2), every(100ms),
                                       word("temperature", 0).as_signed().times(0.1), word("humidity", 1)),
                                  read("pump", discrete_inputs(4, 1), every(200ms), bit("running", 0)),
                                  write("setpoints", holding_registers(8, 2), every(1s), stale_after(3s),
                                        word("temperature", 0).safe(0), word("humidity", 1).safe(0)));
static_assert(map.fault.empty());
constexpr std::size_t temperature = map.value("climate.temperature");
constexpr std::size_t running = map.value("pump.running");
constexpr std::size_t wanted_temperature = map.value("setpoints.temperature");
constexpr std::size_t wanted_humidity = map.value("setpoints.humidity");

struct ModbusSession : testing::Test {
    ModbusSession() {
        server.set(Table::input_registers, 0, 215);
        server.set(Table::discrete_inputs, 4, 1);
    }
    /// Runs the client's activity up to `end`; each step takes as long as the server makes it.
    void run_until(Time end) {
        for (int guard = 0; now < end && guard < 1'000'000; ++guard) {
            const Time next = session.step(now);
            EXPECT_GE(next, now);
            now = next;
        }
        now = end;
    }
    void want(double degrees, double percent) {
        EXPECT_TRUE(session.set(wanted_temperature, degrees, now));
        EXPECT_TRUE(session.set(wanted_humidity, percent, now));
    }
    Twin server{300ms};
    Session<3, 5> session{map, server};
    Time now{};
};

TEST_F(ModbusSession, reports_a_lost_server_rather_than_a_refused_row) {
    run_until(Time{1s});
    EXPECT_EQ(session.trouble(), Trouble{});
    server.set_exception(6);
    server.inject(Fault::exception);
    run_until(Time{2s});
    EXPECT_EQ(session.trouble(), (Trouble{0, Outcome::exception, 6})) << "the first of both";
    server.inject(Fault::silent);
    run_until(Time{4s});
    EXPECT_EQ(session.trouble().outcome, Outcome::timeout);
    server.inject(Fault::none);
    run_until(Time{8s});
    EXPECT_EQ(session.trouble(), Trouble{});
}

TEST(ModbusSessionOfRealNumbers, keeps_the_last_good_value_instead_of_nan_or_infinity) {
    static constexpr auto meter =
        register_map(read("meter", input_registers(0, 2), every(100ms), float_word("flow", 0)));
    Twin server{300ms};
    std::array<Unsent, 1> by_register{};
    Session<1, 1> session{meter, server, {}, by_register};
    Time now{};
    const auto run = [&](Duration time) {
        for (const Time end = now + time; now < end;) now = session.step(now);
    };
    server.set(Table::input_registers, 0, 0x4020);
    run(1s);
    EXPECT_EQ(session.value(0).value, 2.5);
    const Time good = session.value(0).stamp;
    for (const unsigned word : {0x7FC0u, 0x7F80u, 0xFF80u}) {
        server.set(Table::input_registers, 0, static_cast<std::uint16_t>(word));
        run(1s);
        EXPECT_EQ(session.value(0).value, 2.5);
        EXPECT_EQ(session.value(0).quality, Quality::no_number);
    }
    EXPECT_LT(session.value(0).stamp - good, 200ms) << "it grows old";
    EXPECT_GT(session.counters().no_numbers, 20u);
    EXPECT_EQ(by_register[0].read().no_number, session.counters().no_numbers);
    server.set(Table::input_registers, 0, 0x4020);
    run(1s);
    EXPECT_EQ(session.value(0).quality, Quality::good);
}

TEST_F(ModbusSession, polls_its_rows_at_their_periods) {
    EXPECT_EQ(session.value(temperature).quality, Quality::never);
    run_until(Time{10s});
    EXPECT_EQ(session.value(temperature).value, 21.5);
    EXPECT_EQ(session.value(temperature).quality, Quality::good);
    EXPECT_LT(now - session.value(temperature).stamp, 110ms);
    EXPECT_EQ(session.value(running).value, 1.0);
    EXPECT_NEAR(static_cast<double>(session.counters().requests), 100 + 50, 3);
    EXPECT_EQ(session.counters().outages, 0u);
}

TEST_F(ModbusSession, writes_a_row_only_when_all_its_values_were_set) {
    run_until(Time{1s});
    EXPECT_TRUE(session.set(wanted_temperature, 22, now));
    run_until(Time{3s});
    EXPECT_EQ(server.get(Table::holding_registers, 8), 0);
    want(22, 60);
    run_until(now + 10ms);
    EXPECT_EQ(server.get(Table::holding_registers, 8), 22) << "a change goes out at once";
    EXPECT_EQ(server.get(Table::holding_registers, 9), 60);
}

TEST_F(ModbusSession, repeats_its_writes_until_they_become_stale) {
    want(22, 60);
    run_until(Time{100ms});
    server.set(Table::holding_registers, 8, 0); // the server restarted and forgot
    run_until(Time{2s});
    EXPECT_EQ(server.get(Table::holding_registers, 8), 22);
    run_until(Time{4s});
    server.set(Table::holding_registers, 8, 0);
    run_until(Time{8s});
    EXPECT_EQ(server.get(Table::holding_registers, 8), 0) << "nobody set it for more than 3 s";
}

TEST_F(ModbusSession, sends_no_stale_value_after_an_outage) {
    run_until(Time{1s});
    server.inject(Fault::down);
    run_until(Time{2s});
    want(22, 60);
    run_until(Time{12s});
    server.inject(Fault::none);
    run_until(Time{40s});
    EXPECT_FALSE(session.outage());
    EXPECT_EQ(server.get(Table::holding_registers, 8), 0);
    EXPECT_EQ(session.counters().dropped_stale, 2u);
}

TEST_F(ModbusSession, replaces_unsent_values_that_became_stale_by_safe_values) {
    for (const Fault fault : {Fault::down, Fault::silent, Fault::exception}) {
        SCOPED_TRACE(static_cast<int>(fault));
        want(22, 60);
        run_until(now + 1s);
        server.inject(fault);
        run_until(now + 1s);
        session.set(wanted_temperature, 30, now);
        run_until(now + 12s);
        ASSERT_EQ(server.get(Table::holding_registers, 8), 22);
        server.inject(Fault::none);
        run_until(now + 20s);
        EXPECT_EQ(server.get(Table::holding_registers, 8), 0);
        EXPECT_EQ(server.get(Table::holding_registers, 9), fault == Fault::exception ? 60 : 0)
            << "this one the server had, and has it still if it was not lost";
    }
    EXPECT_EQ(session.counters().dropped_stale, 5u);
}

TEST_F(ModbusSession, writes_a_new_value_together_with_an_old_one) {
    want(22, 60);
    run_until(Time{20s});
    session.set(wanted_humidity, 40, now);
    run_until(Time{21s});
    EXPECT_EQ(server.get(Table::holding_registers, 8), 22);
    EXPECT_EQ(server.get(Table::holding_registers, 9), 40);
    EXPECT_EQ(session.counters().dropped_stale, 0u);
}

TEST_F(ModbusSession, writes_no_stale_value_to_a_server_that_may_have_restarted) {
    want(90, 1);
    run_until(Time{20s});
    server.inject(Fault::down);
    run_until(Time{22s});
    for (const unsigned address : {8u, 9u}) server.set(Table::holding_registers, address, 7);
    server.inject(Fault::none);
    run_until(Time{30s});
    EXPECT_EQ(server.get(Table::holding_registers, 8), 7) << "nobody has said anything since";
    session.set(wanted_humidity, 2, now);
    run_until(Time{31s});
    EXPECT_EQ(server.get(Table::holding_registers, 8), 0) << "with the other one goes what is safe";
    EXPECT_EQ(server.get(Table::holding_registers, 9), 2);
    server.inject(Fault::down);
    run_until(Time{33s});
    server.set(Table::holding_registers, 9, 7);
    server.inject(Fault::none);
    for (; now < Time{40s}; run_until(now + 100ms)) session.set(wanted_humidity, 2, now);
    EXPECT_EQ(server.get(Table::holding_registers, 9), 2) << "it is still said";
}

TEST(ModbusSessionOfSilence, stops_writing_a_row_that_is_safe_by_silence) {
    static constexpr auto ramp = register_map(write("ramp", holding_registers(0, 2), every(1s),
                                                    stale_after(3s), word("speed", 0), word("torque", 1))
                                                  .safe_by_silence());
    static_assert(ramp.fault.empty());
    Twin server{300ms};
    Session<1, 2> session{ramp, server};
    session.set(0, 100, Time{});
    session.set(1, 5, Time{});
    Time now{};
    while (now < Time{10s}) now = session.step(now);
    const std::uint64_t requests = session.counters().requests;
    session.set(1, 6, now);
    for (const Time end = now + 10s; now < end;) now = session.step(now);
    EXPECT_EQ(session.counters().requests, requests) << "nobody says the speed any more";
    EXPECT_EQ(session.counters().dropped_stale, 1u);
}

TEST_F(ModbusSession, refuses_to_set_read_only_values_and_nan) {
    EXPECT_FALSE(session.set(temperature, 1, now));
    EXPECT_FALSE(session.set(wanted_temperature, 0.0 / 0.0 * 1.0, now));
}

TEST_F(ModbusSession, keeps_the_last_values_while_the_server_is_silent_and_recovers) {
    run_until(Time{1s});
    server.inject(Fault::silent);
    run_until(Time{11s});
    EXPECT_TRUE(session.outage());
    EXPECT_GT(now - session.value(temperature).stamp, 9s);
    EXPECT_EQ(session.value(temperature).value, 21.5) << "the last good value stays readable";
    EXPECT_GT(session.counters().timeouts, 3u);
    EXPECT_LT(session.counters().timeouts, 10u) << "the back-off doubles";
    server.inject(Fault::none);
    server.set(Table::input_registers, 0, 100);
    run_until(Time{25s});
    EXPECT_EQ(session.value(temperature).value, 10.0);
    EXPECT_EQ(session.value(temperature).quality, Quality::good);
    EXPECT_EQ(session.counters().outages, 1u);
    EXPECT_EQ(session.counters().outages_survived, 1u);
}

TEST_F(ModbusSession, backs_off_up_to_its_limit_when_refused) {
    server.inject(Fault::down);
    run_until(Time{100s});
    // 0.1 0.2 0.4 0.8 1.6 s are five waits of 3.1 s together, then one each 2 s.
    EXPECT_GE(session.counters().refused, 52u);
    EXPECT_LE(session.counters().refused, 56u);
    EXPECT_EQ(session.counters().requests, 0u);
    server.inject(Fault::none);
    run_until(Time{103s});
    EXPECT_TRUE(session.connected());
}

TEST_F(ModbusSession, never_takes_a_late_answer_for_the_next_one) {
    run_until(Time{1s});
    server.set_slow_by(400ms);
    server.inject(Fault::slow, 1);
    run_until(Time{3s});
    EXPECT_EQ(session.counters().timeouts, 1u);
    EXPECT_EQ(session.counters().garbled, 0u) << "the connection was made anew";
    EXPECT_EQ(session.value(temperature).value, 21.5);
    EXPECT_EQ(session.counters().outages_survived, 1u);
}

TEST_F(ModbusSession, waits_for_a_slow_answer_that_is_in_time) {
    server.set_slow_by(50ms);
    server.inject(Fault::slow);
    run_until(Time{2s});
    EXPECT_EQ(session.counters().timeouts, 0u);
    EXPECT_EQ(session.value(temperature).quality, Quality::good);
}

TEST_F(ModbusSession, marks_a_value_after_an_exception_and_stays_connected) {
    run_until(Time{1s});
    server.set_exception(6);
    server.inject(Fault::exception);
    run_until(Time{2s});
    EXPECT_EQ(session.value(temperature).quality, Quality::exception);
    EXPECT_EQ(session.value(temperature).exception, 6);
    EXPECT_EQ(session.value(temperature).value, 21.5);
    EXPECT_TRUE(session.connected());
    EXPECT_FALSE(session.outage());
    server.inject(Fault::none);
    run_until(Time{3s});
    EXPECT_EQ(session.value(temperature).quality, Quality::good);
}

TEST_F(ModbusSession, reports_an_address_that_the_server_does_not_have) {
    static constexpr auto far =
        register_map(read("far", holding_registers(Twin::size, 1), every(100ms), word("w", 0)));
    Twin other;
    Session<1, 1> far_client{far, other};
    Time t{};
    for (int i = 0; i < 10; ++i) t = far_client.step(t);
    EXPECT_EQ(far_client.value(0).quality, Quality::exception);
    EXPECT_EQ(far_client.value(0).exception, 2);
}

TEST_F(ModbusSession, reconnects_after_garbage_and_foreign_answers) {
    for (const Fault fault : {Fault::garbage_length, Fault::wrong_transaction}) {
        const auto before = session.counters();
        server.inject(fault, 1);
        run_until(now + 2s);
        EXPECT_EQ(session.counters().garbled, before.garbled + 1);
        EXPECT_EQ(session.counters().outages_survived, before.outages_survived + 1);
        EXPECT_EQ(session.value(temperature).quality, Quality::good);
    }
}

TEST_F(ModbusSession, keeps_reading_while_values_to_write_change_constantly) {
    run_until(Time{1s});
    for (int i = 0; i < 500; ++i) {
        want(i, i);
        run_until(now + 10ms);
    }
    EXPECT_LT(now - session.value(temperature).stamp, 150ms);
    EXPECT_EQ(session.value(temperature).quality, Quality::good);
}

TEST_F(ModbusSession, survives_random_faults) {
    Random random{11};
    constexpr Fault faults[] = {Fault::silent,         Fault::slow,
                                Fault::exception,      Fault::wrong_transaction,
                                Fault::garbage_length, Fault::down};
    for (int i = 0; i < 300; ++i) {
        server.set_slow_by(Duration{random.between(0, 600'000'000)});
        const auto which = random.below(6);
        const auto strikes = static_cast<std::uint32_t>(random.below(5));
        server.inject(faults[which], strikes);
        run_until(now + 300ms);
    }
    server.inject(Fault::none);
    run_until(now + 30s);
    EXPECT_FALSE(session.outage());
    EXPECT_EQ(session.value(temperature).quality, Quality::good);
    EXPECT_EQ(session.counters().outages, session.counters().outages_survived);
}

} // namespace
} // namespace tappet::modbus
