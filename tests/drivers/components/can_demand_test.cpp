// Frames on demand while their signals are forced, when a force ends, and with impossible times.
#include "tests/drivers/components/can_machine.hpp"
#include "tests/drivers/components/forced_port.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace tappet::test {
namespace {

using OnDemand = CanMachine;

TEST_F(OnDemand, sends_a_demand_once_though_a_force_or_the_machine_ends) {
    demand(1, 3);
    run_until(20ms);
    ASSERT_EQ(heard_of(0x000).size(), 1u);
    heard.clear();
    ForcedPort node{instance, "can.nmt.node", FacetKind::input};
    const auto force = [&] {
        node.to(std::int64_t{3});
        instance.engines()[0].waiter().wake();
    };
    force();
    run_until(40ms);
    node.release();
    instance.engines()[0].waiter().wake();
    run_until(60ms);
    EXPECT_TRUE(heard_of(0x000).empty());
    force();
    run_until(80ms);
    world.stop();
    carry(clock.now() + 1ms);
    EXPECT_TRUE(heard_of(0x000).empty());
}

/// Frames on demand while their signals are forced.
struct ForcedDemand : OnDemand {
    void force(std::string_view name, FacetKind kind, std::int64_t value) {
        forced.emplace(instance, name, kind).to(value);
        wait();
    }
    void release() {
        forced->release();
        wait();
    }
    void write(std::int64_t value) {
        master->sync_next = static_cast<int>(value);
        wait();
    }
    void wait() {
        instance.engines()[0].waiter().wake();
        run(20ms);
    }
    [[nodiscard]] std::vector<int> sent() {
        std::vector<int> values;
        for (const can::Frame& each : heard_of(0x080)) values.push_back(each.data[0]);
        return values;
    }
    std::optional<ForcedPort> forced;
};

TEST_F(ForcedDemand, returns_to_the_written_value_when_its_output_is_released) {
    write(1);
    force("master.sync", FacetKind::output, 99);
    write(0);
    release();
    EXPECT_EQ(sent().back(), 0);
}

TEST_F(ForcedDemand, returns_to_the_written_value_when_its_input_is_released) {
    write(7);
    force("can.sync.count", FacetKind::input, 99);
    release();
    EXPECT_EQ(sent(), (std::vector{7, 99, 7}));
}

/// A frame of two signals, of which one is forced.
struct HalfForced : ForcedDemand {
    void SetUp() override {
        demand_each_once();
        force("can.nmt.node", FacetKind::input, 7);
        heard.clear();
    }
    void demand_late(std::int64_t command, std::int64_t node) {
        demand(command, node);
        master->overrun = 10us; // the bus reads some time after the write
        wait();
    }
    [[nodiscard]] std::vector<std::pair<int, int>> demanded() {
        std::vector<std::pair<int, int>> all;
        for (const can::Frame& each : heard_of(0x000)) all.emplace_back(each.data[0], each.data[1]);
        return all;
    }
    using All = std::vector<std::pair<int, int>>;
};

TEST_F(HalfForced, sends_each_demand_with_the_forced_signal) {
    demand_late(128, 4);
    demand_late(2, 5);
    EXPECT_EQ(demanded(), (All{{128, 7}, {2, 7}}));
    release();
    EXPECT_EQ(demanded().back(), std::pair(2, 5)) << "what stood behind the force reaches the wire";
}

TEST_F(HalfForced, sends_no_earlier_demand_when_its_bus_stops) {
    demand_late(129, 6);
    heard.clear();
    change(0, LifeChange::stop);
    wait();
    EXPECT_EQ(demanded(), All{});
}

TEST_F(ForcedDemand, sends_no_demand_dropped_while_stopped_when_a_force_changes) {
    demand_each_once();
    change(0, LifeChange::stop);
    demand(129, 6);
    run_until(40ms);
    change(0, LifeChange::start);
    run_until(60ms);
    heard.clear();
    force("can.nmt.node", FacetKind::input, 6);
    release();
    EXPECT_TRUE(heard_of(0x000).empty());
}

TEST_F(OnDemand, sends_demands_after_one_with_a_future_time) {
    for (const Duration ahead :
         {Duration{900ms}, Duration{1h}}) { // a little, and further than any valid time
        heard.clear();
        master->sync_at = clock.now() + ahead;
        master->sync_next = 1;
        run(20ms);
        master->sync_at = Time::min();
        for (int n = 0; n < 3; ++n) {
            master->sync_next = 1;
            run(20ms);
        }
        EXPECT_EQ(heard_of(0x080).size(), 4u) << ahead / 1ms;
    }
}

TEST_F(OnDemand, sends_demands_whose_times_are_out_of_order) {
    run_until(100ms);
    for (const Time at : {at_ns(130'000'000), at_ns(110'000'000), at_ns(105'000'000)}) {
        master->sync_at = at;
        master->sync_next = 5;
        run(20ms);
    }
    EXPECT_EQ(heard_of(0x080).size(), 3u);
}

TEST_F(ForcedDemand, sends_a_demand_once_though_its_time_lies_ahead) {
    run_until(10ms);
    for (const bool is_ahead : {false, true}) {
        heard.clear();
        master->sync_at = is_ahead ? clock.now() + 900ms : Time::min();
        master->sync_next = 1;
        run(20ms);
        force("can.sync.count", FacetKind::input, 1);
        release();
        run(20ms);
        EXPECT_EQ(heard_of(0x080).size(), 2u) << is_ahead;
    }
}

TEST_F(ForcedDemand, sends_no_demand_after_a_force_that_a_fault_dropped) {
    run_until(10ms);
    for (const bool is_ahead : {false, true}) {
        write(1);
        force("can.sync.count", FacetKind::input, 7);
        wire.bus_off(twin);
        run(20ms);
        master->sync_at = is_ahead ? clock.now() + 900ms : Time::min();
        master->sync_next = 7; // dropped: the bus is off
        run(400ms);
        ASSERT_FALSE(bus->is_faulted.last()) << is_ahead;
        heard.clear();
        release();
        run(20ms);
        EXPECT_TRUE(sent().empty()) << is_ahead;
        master->sync_at = Time::min();
        write(8);
        EXPECT_EQ(sent(), std::vector{8}) << is_ahead;
    }
}

TEST_F(HalfForced, sends_no_demand_after_a_force_that_a_fault_dropped) {
    wire.bus_off(twin);
    run(20ms);
    demand(129, 6); // dropped: the bus is off
    run(400ms);
    heard.clear();
    release();
    run(20ms);
    EXPECT_EQ(demanded(), All{});
}

TEST_F(ForcedDemand, sends_no_hidden_demand_at_its_stop) {
    demand_each_once();
    force("can.sync.count", FacetKind::input, 7);
    write(5);
    run(3s);
    heard.clear();
    change(0, LifeChange::stop);
    wait();
    EXPECT_TRUE(sent().empty());
}

TEST_F(ForcedDemand, sends_no_hidden_demand_at_the_stop_of_its_writer) {
    demand_each_once();
    for (const bool is_ahead : {false, true}) {
        force("can.sync.count", FacetKind::input, 7);
        master->sync_at = is_ahead ? clock.now() + 900ms : Time::min();
        write(5);
        heard.clear();
        change(1, LifeChange::stop);
        wait();
        EXPECT_TRUE(sent().empty()) << is_ahead;
        change(1, LifeChange::start);
        master->sync_at = Time::min();
        write(6);
        EXPECT_EQ(sent(), std::vector{6}) << is_ahead;
    }
}

TEST_F(ForcedDemand, sends_a_demand_made_since_a_fault_whatever_its_time) {
    run_until(10ms);
    write(1);
    const Time before = clock.now();
    force("can.sync.count", FacetKind::input, 7);
    wire.bus_off(twin);
    run(800ms);
    ASSERT_FALSE(bus->is_faulted.last());
    heard.clear();
    master->sync_at = before; // like a writer that forwards the time of a measurement
    write(9);
    release();
    EXPECT_EQ(sent(), std::vector{9});
}

/// A writer on another processor may be ahead of the cycle that reads its first half.
TEST_F(OnDemand, sends_a_command_once_though_its_halves_arrive_in_two_cycles) {
    run_until(10ms);
    for (const Duration ahead : {Duration{0}, Duration{5ms}, Duration{50ms}}) {
        heard.clear();
        master->nmt_at = clock.now() + ahead;
        EXPECT_TRUE(master->commands_alone.push(1));
        run(2ms);
        master->node_next = 1;
        run(100ms);
        EXPECT_EQ(heard_of(0x000).size(), 1u) << ahead / 1ms;
    }
}

TEST_F(OnDemand, sends_no_command_whose_halves_have_no_time) {
    run_until(10ms);
    for (const Time at : {never, Time::min()}) {
        master->nmt_at = never;
        demand(1, 1);
        run(20ms);
        master->nmt_at = at;
        heard.clear();
        master->node_next = 9; // half of the next demand; the other half never comes
        run(30ms);
        EXPECT_THAT(heard_of(0x000), testing::IsEmpty()) << (at == never ? "at no time" : "now");
    }
}

} // namespace
} // namespace tappet::test
