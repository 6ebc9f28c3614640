// A Modbus server as a component: values with their age, outages, back-off, and which activities it delays.
#include "tests/drivers/components/forced_port.hpp"
#include "tests/drivers/components/utility_machine.hpp"

namespace tappet::test {
namespace {

TEST_F(SubstitutedPump, receives_the_substitute_of_its_row_for_a_stale_value) {
    reader->pump_next = 1; // once
    run_until(1150ms);
    EXPECT_TRUE(pump_runs());
    run_until(1500ms);
    EXPECT_FALSE(pump_runs());
    run_until(18s);
    twin.set(modbus::Table::coils, 0, 1); // by another client
    run_until(20s);
    EXPECT_FALSE(pump_runs()) << "it is true now, and said again";
    reader->pump_next = 1;
    run_until(20'150ms);
    EXPECT_TRUE(pump_runs());
}

TEST_F(Utility, stamps_values_with_the_time_of_their_answer) {
    EXPECT_DOUBLE_EQ(reader->value, -5.5);
    EXPECT_LE(reader->age, 100ms + 50ms) << "its period and the activity's";
    EXPECT_TRUE(reader->connected.get());
    EXPECT_EQ(reader->outages.get(), 0);
    EXPECT_EQ(reader->lost, 0);
    EXPECT_GE(server->counters().answers, 9u);
    EXPECT_LE(reader->fresh, server->counters().answers) << "one answer is fresh once";
}

TEST_F(Utility, writes_a_change_soon_and_nothing_that_was_never_set) {
    const auto before = server->counters().requests;
    EXPECT_FALSE(pump_runs());
    reader->pump_next = 1;
    run_until(1060ms);
    EXPECT_TRUE(pump_runs());
    EXPECT_GE(server->counters().requests, before + 1);
}

TEST_F(Utility, counts_by_register_what_it_did_not_write_as_it_was_set) {
    const auto of_pump = [this] {
        Unsent of;
        instance.each_unsent([&](std::string_view, const Facet& row, const Unsent& each) {
            EXPECT_EQ(row.name, "pump.on");
            of = each;
        });
        return of;
    };
    start_the_pump();
    EXPECT_EQ(of_pump().clamped, 0u);
    reader->pump_next = 5;
    run(1s);
    EXPECT_EQ(of_pump().clamped, 1u);
    change_server(LifeChange::restart);
    EXPECT_GE(of_pump().clamped, 1u) << "a client that starts again keeps its counts";
    EXPECT_EQ(server->out_of_range.last(), static_cast<std::int64_t>(of_pump().clamped));
}

TEST_F(Utility, reads_and_writes_in_one_cycle_when_both_are_due) {
    run_until(1020ms);
    reader->pump_next = 1;
    const auto before = server->counters().answers;
    run_until(1120ms); // two cycles
    EXPECT_TRUE(pump_runs());
    EXPECT_GE(server->counters().answers - before, 2u);
}

TEST_F(Utility, lets_the_age_grow_while_the_server_is_silent) {
    twin.inject(modbus::Fault::silent);
    const double last = reader->value;
    twin.set(modbus::Table::input_registers, 0, 999);
    run_until(1400ms);
    EXPECT_GT(reader->age, 300ms);
    EXPECT_NE(reader->flow, Flow::stale);
    run_until(3s);
    EXPECT_GT(reader->age, 1900ms);
    EXPECT_EQ(reader->flow, Flow::stale);
    EXPECT_EQ(reader->value, last) << "the row says hold";
    EXPECT_FALSE(reader->connected.get());
    EXPECT_EQ(reader->outages.get(), 1);
    EXPECT_EQ(reader->lost, 1) << "told once";
    EXPECT_EQ(reader->back, 0);
}

TEST_F(Utility, reconnects_and_reads_fresh_values) {
    twin.inject(modbus::Fault::down);
    run_until(5s);
    EXPECT_FALSE(reader->connected.get());
    twin.inject(modbus::Fault::none);
    twin.set(modbus::Table::input_registers, 0, 123);
    run_until(16s);
    EXPECT_TRUE(reader->connected.get());
    EXPECT_DOUBLE_EQ(reader->value, 12.3);
    EXPECT_LE(reader->age, 150ms);
    EXPECT_EQ(reader->survived.get(), 1);
    EXPECT_EQ(reader->lost, 1);
    EXPECT_EQ(reader->back, 1);
}

TEST_F(Utility, becomes_safe_when_its_writer_stopped_during_a_long_outage) {
    start_the_pump();
    twin.inject(modbus::Fault::down);
    change(1, LifeChange::stop);
    run_until(20s);
    ASSERT_TRUE(pump_runs());
    twin.inject(modbus::Fault::none);
    run_until(24s);
    EXPECT_FALSE(pump_runs());
}

TEST_F(Utility, reports_no_fresh_value_after_an_exception) {
    twin.inject(modbus::Fault::exception);
    run_until(3s);
    EXPECT_EQ(reader->flow, Flow::stale);
    EXPECT_GT(reader->age, 1900ms);
    EXPECT_TRUE(reader->connected.get()) << "it does answer";
}

TEST_F(Utility, names_a_refused_row_and_its_exception_until_it_is_answered) {
    const auto reason = [this] { return server->reason.last().view(); };
    run_until(1s);
    EXPECT_EQ(reason(), "");
    twin.set_exception(2);
    twin.inject(modbus::Fault::exception);
    run_until(2s);
    EXPECT_EQ(reason(),
              "row \"unit\": the server refuses it, exception 2 (illegal data address); correct the "
              "map, or the server");
    twin.inject(modbus::Fault::none);
    run_until(3s);
    EXPECT_EQ(reason(), "");
    twin.set_exception(99);
    twin.inject(modbus::Fault::exception);
    run_until(4s);
    EXPECT_EQ(reason(), "row \"unit\": the server refuses it, exception 99 (a code of the device's own); "
                        "correct the map, or the server");
}

TEST_F(Utility, reports_why_the_server_is_lost_until_it_is_back) {
    const std::pair<modbus::Fault, std::string_view> reasons[]{
        {modbus::Fault::silent,
         "row \"unit\": no answer in time; look at the server's supply, its unit and the line's setting"},
        {modbus::Fault::garbage_length, "row \"unit\": the reply does not match the request; look at the "
                                        "line's setting, its cable and its ends"},
        {modbus::Fault::down, "row \"unit\": no connection; look at the server's address, supply and cable"}};
    for (const auto& [fault, reason] : reasons) {
        run(2s);
        EXPECT_EQ(server->reason.last().view(), "");
        twin.inject(fault);
        run(2s);
        EXPECT_EQ(server->reason.last().view(), reason);
        twin.inject(modbus::Fault::none);
        run(5s);
        EXPECT_EQ(server->reason.last().view(), "");
    }
}

TEST_F(Utility, waits_for_a_silent_server_only_once_per_cycle) {
    twin.inject(modbus::Fault::silent);
    reader->pump_next = 1;
    run_until(1100ms); // both rows are due
    EXPECT_EQ(server->counters().timeouts, 1u);
    EXPECT_EQ(reader->lost, 1);
}

TEST_F(Utility, keeps_its_back_off_even_with_a_long_period) {
    twin.inject(modbus::Fault::silent);
    const Time later = clock.now() + 200ms;
    server->work({later, later, 10s});
    EXPECT_EQ(server->counters().timeouts, 1u);
}

TEST_F(Utility, writes_the_latest_values_to_the_server_at_the_stop) {
    start_the_pump();
    world.stop();
    EXPECT_FALSE(pump_runs());
}

TEST_F(Utility, writes_the_safe_values_of_its_map_at_every_stop) {
    reader->leaves_safe = false;
    start_the_pump();
    change_server(LifeChange::stop);
    EXPECT_FALSE(pump_runs());
    EXPECT_FALSE(reader->connected.get()) << "nobody asks it any longer";
    run_until(3s);
    EXPECT_EQ(reader->lost, 1);
    change_server(LifeChange::start);
    run_until(4s);
    EXPECT_TRUE(reader->connected.get());
    EXPECT_EQ(reader->back, 1);
}

TEST_F(Utility, retries_its_safe_values_once_after_a_failed_request) {
    for (const modbus::Fault fault : {modbus::Fault::silent, modbus::Fault::exception}) {
        reader->leaves_safe = false;
        start_the_pump();
        twin.set_exception(6);
        twin.inject(fault, 1);
        change_server(LifeChange::stop);
        EXPECT_FALSE(pump_runs());
        change_server(LifeChange::start);
        run(1s);
    }
}

TEST_F(Utility, writes_its_safe_values_after_a_lost_answer) {
    start_the_pump();
    twin.inject(modbus::Fault::silent, 1);
    while (server->counters().timeouts == 0) run(10ms);
    change_server(LifeChange::stop);
    EXPECT_FALSE(pump_runs());
}

TEST_F(Utility, works_again_after_a_stop_and_a_start) {
    reader->pump_next = 1;
    run_until(1500ms);
    twin.inject(modbus::Fault::down);
    run_until(3s);
    twin.inject(modbus::Fault::none);
    run_until(8s);
    ASSERT_EQ(reader->survived.get(), 1);
    reader->pump_next = 1;
    run_until(8100ms);
    ASSERT_TRUE(pump_runs());
    change_server(LifeChange::stop);
    twin.set(modbus::Table::coils, 0, 0); // the server was switched off and on
    run_until(10s);
    EXPECT_FALSE(pump_runs());
    const auto fresh = reader->fresh;
    change_server(LifeChange::start);
    EXPECT_FALSE(reader->connected.get());
    EXPECT_EQ(reader->fresh, fresh) << "no value of before the stop";
    run_until(10200ms);
    EXPECT_TRUE(reader->connected.get());
    EXPECT_GT(reader->fresh, fresh);
    EXPECT_TRUE(pump_runs()) << "what is wanted is written again";
    EXPECT_EQ(reader->outages.get(), 0);
    EXPECT_EQ(reader->survived.get(), 0);
    EXPECT_EQ(reader->lost, 2);
    EXPECT_EQ(reader->back, 2);
}

TEST_F(Utility, writes_no_value_after_a_start_that_became_stale_before_it) {
    reader->pump_next = 1;
    run_until(1500ms);
    change_server(LifeChange::stop);
    twin.set(modbus::Table::coils, 0, 0);
    run_until(12s); // good for 5 s
    change_server(LifeChange::start);
    run_until(14s);
    EXPECT_TRUE(reader->connected.get());
    EXPECT_FALSE(pump_runs());
}

TEST_F(Utility, reports_an_outage_again_when_restarted_during_it) {
    start_the_pump(); // it starts alone only when each of its inputs was written
    twin.inject(modbus::Fault::down);
    run_until(3s);
    ASSERT_EQ(reader->lost, 1);
    change_server(LifeChange::restart);
    run_until(3100ms);
    EXPECT_EQ(reader->lost, 2);
    twin.inject(modbus::Fault::none);
    run_until(10s);
    EXPECT_EQ(reader->back, 1);
}

TEST_F(Utility, does_not_wait_for_a_silent_server_at_the_stop) {
    start_the_pump();
    twin.inject(modbus::Fault::silent);
    run_until(4s);
    clock.advance_to(clock.now() + 20s); // it would be polled again now
    const auto before = server->counters();
    world.stop();
    EXPECT_EQ(server->counters(), before);
    EXPECT_EQ(instance.life().left_unsafe(), "server");
}

TEST_F(Utility, writes_no_old_value_when_a_force_ends) {
    reader->pump_next = 1; // once; its row says how long that value is good
    run_until(20s);
    ForcedPort on{instance, "server.pump.on", FacetKind::input};
    on.to(0.0);
    run_until(30s);
    ASSERT_FALSE(pump_runs());
    on.release();
    run_until(31s);
    EXPECT_FALSE(pump_runs());
}

TEST_F(Utility, reports_an_unreached_server_until_a_stop_reaches_it) {
    start_the_pump();
    for (const modbus::Fault fault : {modbus::Fault::down, modbus::Fault::silent, modbus::Fault::exception}) {
        twin.set_exception(6);
        SCOPED_TRACE(static_cast<int>(fault));
        twin.inject(fault);
        stop_unheard("server");
        stop_unheard("server"); // the refusal is repeated
        twin.inject(modbus::Fault::none);
        change_server(LifeChange::restart);
        run(3s);
        change_server(LifeChange::stop);
        EXPECT_EQ(instance.life().left_unsafe(), "");
        change_server(LifeChange::start);
        run(3s);
    }
}

/// Longer than a time stamp may lie ahead of a cycle.
using SlowServer = MachineRig<utility_machine>;

TEST_F(SlowServer, provides_good_values) {
    modbus::Twin twin{3s, 1200ms};
    configure<modbus::Transport>("server", twin);
    const Reader& reader = *instance.find<Reader>("reader");
    int good = 0;
    for (Duration end = 10ms; end < 30s; end += 10ms) {
        run_until(end);
        good += reader.flow == Flow::fresh || reader.flow == Flow::old ? 1 : 0;
    }
    EXPECT_GT(good, 300); // of 3000: its row calls a value good for half a second
}

} // namespace
} // namespace tappet::test
