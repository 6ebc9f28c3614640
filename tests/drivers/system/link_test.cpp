// Two machines on one wire: messages arrive as if they were local, and losses are known.
#include "tests/drivers/system/pair_run.hpp"

#include <gtest/gtest.h>

namespace tappet::pair {
namespace {

struct LinkTest : testing::Test, PairRun<> {
    void SetUp() override {
        start(0ms);
        ASSERT_TRUE(run.run_until(
            [&] { return giver().other_is_there.get() && taker().other_is_there.get(); }, 200ms));
        ASSERT_TRUE(run.run_for(200ms)); // each row was sent
    }
    systems::Link<pair, 0>& from() { return *run.instance(0).find<systems::Link<pair, 0>>("wire"); }
    systems::Link<pair, 1>& to() { return *run.instance(1).find<systems::Link<pair, 1>>("wire"); }

    /// Requests the change and expects it done within the time.
    void change(std::size_t node, std::string_view component, LifeChange change, Duration within) {
        MachineInstance& there = run.instance(node);
        const std::size_t part = find_component(there.machine().table, component);
        const LifeTicket ticket = there.life().ask_component(part, change);
        run.run_for(within);
        ASSERT_EQ(there.life().answer_of_component(part, ticket).outcome, LifeOutcome::done);
    }
};

TEST_F(LinkTest, transfers_a_value_in_the_bits_of_its_row) {
    giver().tells = 123.456;
    run.run_for(30ms);
    double value = 0;
    EXPECT_EQ(taker().level.read(value), Flow::fresh);
    EXPECT_DOUBLE_EQ(value, 123.5);
    giver().tells = 1e9;
    run.run_for(30ms);
    EXPECT_DOUBLE_EQ(taker().level.get(), 838860.7) << "the last one that fits";
}

TEST_F(LinkTest, a_value_becomes_stale_when_its_node_is_lost) {
    run.run_for(30ms);
    EXPECT_TRUE(taker().level.good());
    run.kill(0);
    run.run_for(100ms);
    EXPECT_EQ(taker().level.flow(), Flow::stale);
    EXPECT_FALSE(taker().other_is_there.get());
}

TEST_F(LinkTest, a_hidden_value_is_stale_at_the_receiver_when_its_writer_stops) {
    giver().tells = 80;
    run.run_for(30ms);
    MachineInstance& here = run.instance(0);
    const MachineView& table = here.machine().table;
    End end{find_component(table, "wire"), 0};
    const auto facets = table.components[end.component].type->facets;
    while (facets[end.facet].kind != FacetKind::input || facets[end.facet].type != type_id<double>)
        ++end.facet;
    const double still = 0;
    ASSERT_TRUE(
        facets[end.facet].port->force(here.place_of(end), true, reinterpret_cast<const std::byte*>(&still)));
    run.run_for(30ms);
    EXPECT_EQ(taker().level.get(), 0);
    static_cast<void>(here.life().ask_component(find_component(table, "giver"), LifeChange::stop));
    run.run_for(30ms);
    EXPECT_EQ(taker().level.flow(), Flow::stale);
}

TEST_F(LinkTest, delivers_each_event_once_and_in_order) {
    for (int i = 1; i <= 20; ++i) {
        giver().to_send.push_back(i);
        run.run_for(50ms);
    }
    std::vector<std::int32_t> all(20);
    for (int i = 0; i < 20; ++i) all[static_cast<std::size_t>(i)] = i + 1;
    EXPECT_EQ(taker().got, all);
    EXPECT_EQ(from().sent(1), (SendCounts{.offered = 20, .delivered = 20}));
    EXPECT_EQ(to().served(1), (ReceiveCounts{.served = 20}));
}

TEST_F(LinkTest, a_command_runs_to_completion) {
    giver().asks = 21;
    taker().busy_for = 3;
    giver().states.clear();
    run.run_for(200ms);
    EXPECT_EQ(giver().doubled.state(), CommandState::done);
    EXPECT_EQ(giver().doubled.result<0>(), 42);
    EXPECT_EQ(giver().states.back(), CommandState::done);
}

TEST_F(LinkTest, a_command_fails_when_the_receiver_refuses_it) {
    giver().asks = 1;
    taker().refuses = true;
    run.run_for(200ms);
    EXPECT_EQ(giver().doubled.state(), CommandState::failed);
}

TEST_F(LinkTest, a_command_fails_when_its_node_dies) {
    giver().asks = 1;
    taker().busy_for = 1000;
    run.run_for(50ms);
    EXPECT_EQ(giver().doubled.state(), CommandState::executing);
    run.kill(1);
    run.run_for(100ms);
    EXPECT_EQ(giver().doubled.state(), CommandState::failed);
}

TEST(LinkAlone, connects_to_a_node_that_starts_later) {
    PairRun both;
    SystemRun& run = both.run;
    ASSERT_TRUE(run.start(0)); // nobody acknowledges
    run.run_for(5s);
    EXPECT_TRUE(can::faulted(run.end(0).state()));
    ASSERT_TRUE(run.start(1));
    run.run_for(5s);
    EXPECT_TRUE(both.giver().other_is_there.get());
    EXPECT_TRUE(both.taker().other_is_there.get());
}

TEST_F(LinkTest, an_unheard_node_reports_all_others_absent) {
    run.wire().bus_off(run.twin(0));
    run.run_for(100ms);
    EXPECT_FALSE(giver().other_is_there.get()) << "it hears the other one, but is not heard";
    EXPECT_FALSE(taker().other_is_there.get());
    run.run_for(5s);
    EXPECT_TRUE(giver().other_is_there.get() && taker().other_is_there.get()) << "it was restarted";
}

TEST_F(LinkTest, a_node_that_stops_its_link_reports_all_others_absent) {
    ASSERT_TRUE(giver().other_is_there.get());
    change(0, "wire", LifeChange::stop, 20ms);
    EXPECT_FALSE(giver().other_is_there.get());
    EXPECT_FALSE(taker().other_is_there.get());
    change(0, "wire", LifeChange::start, 1s);
    EXPECT_TRUE(giver().other_is_there.get() && taker().other_is_there.get());
}

TEST_F(LinkTest, an_event_to_an_absent_node_is_reported_lost) {
    run.kill(1);
    giver().to_send = {7};
    run.run_for(60ms);
    EXPECT_EQ(giver().losses, 1);
}

TEST_F(LinkTest, an_event_to_a_stopped_component_is_delivered_and_dropped) {
    change(1, "taker", LifeChange::stop, 20ms);
    giver().to_send = {7};
    giver().asks = 1;
    run.run_for(60ms);
    EXPECT_EQ(from().sent(1), (SendCounts{.offered = 1, .delivered = 1}));
    EXPECT_EQ(giver().losses, 0) << "its node took it up";
    EXPECT_EQ(giver().doubled.state(), CommandState::failed) << "a command says that it was rejected there";

    change(1, "taker", LifeChange::start, 20ms);
    giver().to_send = {8};
    run.run_for(60ms);
    EXPECT_EQ(taker().got, (std::vector<std::int32_t>{8}));
}

} // namespace
} // namespace tappet::pair
