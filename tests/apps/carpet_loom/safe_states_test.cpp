// What makes the loom safe, why it says it did, and how an operator gets it weaving again.
#include "tests/apps/carpet_loom/loom_rig.hpp"

namespace tappet::carpet {
namespace {

using loom::Fault;

class SafeStates : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(seed, SafeStates, seeds(6));

/// The shaft stands, the brake holds, no valve is open, and the lamps say that hands are needed.
void expect_safe(LoomRig& rig) {
    EXPECT_TRUE(rig.run_until([&] { return rig.plant().speed_rpm() == 0.0; }, 1s));
    EXPECT_TRUE(rig.output(wires::line::brake));
    EXPECT_FALSE(rig.output(wires::line::weft_release));
    EXPECT_TRUE(rig.output(wires::line::lamp_fault));
    EXPECT_FALSE(rig.output(wires::line::lamp_run));
    EXPECT_FALSE(rig.output(wires::line::lamp_stop));
}

/// Repaired, acknowledged and started by the operator of the plant.
void expect_weaves_again(LoomRig& rig) {
    EXPECT_TRUE(rig.weave(10)) << "in state " << rig.state() << ": " << rig.reason();
    expect_no_damage(rig.report());
}

TEST_P(SafeStates, the_emergency_stop_closes_the_valve_and_brakes_at_once) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    // At another angle for each seed, the open valve among them.
    rig.run_for(Duration{rig.now().time_since_epoch().count() * 7919 % 100'000'000});
    const Time pressed = rig.now();
    rig.plant().inject({.fault = Fault::emergency_stop});
    ASSERT_TRUE(rig.run_until([&] { return rig.output(wires::line::brake); }, 5ms));
    EXPECT_LE(rig.now() - pressed, 2ms);
    EXPECT_FALSE(rig.output(wires::line::weft_release));
    EXPECT_EQ(rig.state(), "emergency");
    EXPECT_EQ(rig.reason(), "the emergency stop was pressed");
    EXPECT_EQ(rig.cause(), StopCause::emergency);
    expect_safe(rig);
    EXPECT_EQ(rig.report().damage.valve_after_emergency, 0u);
    EXPECT_LT(rig.report().emergency_longest_ms, 60.0); // half a turn at most
}

TEST_P(SafeStates, the_loom_weaves_again_after_an_emergency_stop_was_released_and_acknowledged) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    rig.plant().inject({.fault = Fault::emergency_stop});
    ASSERT_TRUE(rig.run_until_state("emergency", 10ms));
    expect_weaves_again(rig);
}

TEST_P(SafeStates, an_emergency_stop_that_is_held_cannot_be_acknowledged_away) {
    LoomRig rig{GetParam(), nobody_there()};
    ASSERT_TRUE(rig.prepare());
    rig.plant().inject({.fault = Fault::emergency_stop, .lasts = 2s});
    ASSERT_TRUE(rig.run_until_state("emergency", 10ms));
    rig.plant().press(loom::Button::acknowledge, 100ms);
    rig.run_for(500ms);
    EXPECT_EQ(rig.state(), "emergency");
    rig.run_for(2s);
    rig.plant().press(loom::Button::acknowledge, 100ms);
    EXPECT_TRUE(rig.run_until_state("ready", 2s)) << rig.state();
}

TEST_P(SafeStates, an_emergency_stop_at_stand_still_is_obeyed_too) {
    LoomRig rig{GetParam(), nobody_there()};
    ASSERT_TRUE(rig.prepare());
    rig.plant().inject({.fault = Fault::emergency_stop});
    ASSERT_TRUE(rig.run_until_state("emergency", 10ms));
    rig.plant().press(loom::Button::start, 100ms);
    rig.run_for(1s);
    EXPECT_EQ(rig.state(), "emergency");
    EXPECT_EQ(rig.plant().speed_rpm(), 0.0);
}

TEST_P(SafeStates, a_silent_encoder_stops_the_loom_within_milliseconds) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    const Time silent = rig.now();
    rig.plant().inject({.fault = Fault::node_lost, .node = wires::node::encoder});
    ASSERT_TRUE(rig.run_until_state("fault", 100ms));
    EXPECT_LE(rig.now() - silent, 15ms);
    EXPECT_EQ(rig.reason(), "the encoder is stale");
    EXPECT_EQ(rig.cause(), StopCause::fault);
    expect_safe(rig);
    expect_weaves_again(rig);
}

TEST_P(SafeStates, a_silent_load_cell_or_feeder_or_dobby_stops_the_loom_when_its_heartbeat_is_missing) {
    for (const std::uint8_t node : {wires::node::load_cell, wires::node::feeder, wires::node::dobby}) {
        LoomRig rig{GetParam()};
        ASSERT_TRUE(rig.weave());
        rig.plant().inject({.fault = Fault::node_lost, .node = node});
        ASSERT_TRUE(rig.run_until_state("fault", 500ms)) << "node " << int{node};
        EXPECT_EQ(rig.reason(), "a CAN node is silent");
        EXPECT_EQ(rig.component<Network>("network").silent_node.last(), node);
        expect_safe(rig);
        expect_weaves_again(rig);
    }
}

TEST_P(SafeStates, a_silent_drive_stops_the_loom) {
    for (const std::uint8_t node : {wires::node::main_drive, wires::node::let_off_drive}) {
        LoomRig rig{GetParam()};
        ASSERT_TRUE(rig.weave());
        const Time silent = rig.now();
        rig.plant().inject({.fault = Fault::node_lost, .node = node});
        ASSERT_TRUE(rig.run_until_state("fault", 500ms)) << "node " << int{node};
        EXPECT_LE(rig.now() - silent, 60ms);
        EXPECT_EQ(rig.reason(), "a drive reports a fault");
        expect_safe(rig);
        expect_weaves_again(rig);
    }
}

TEST_P(SafeStates, a_drive_that_trips_stops_the_loom) {
    for (const std::uint8_t node : {wires::node::main_drive, wires::node::let_off_drive}) {
        LoomRig rig{GetParam()};
        ASSERT_TRUE(rig.weave());
        rig.plant().inject({.fault = Fault::drive_fault, .node = node});
        ASSERT_TRUE(rig.run_until_state("fault", 50ms)) << "node " << int{node};
        EXPECT_EQ(rig.reason(), "a drive reports a fault");
        expect_safe(rig);
        expect_weaves_again(rig);
    }
}

TEST_P(SafeStates, lost_oil_pressure_stops_the_loom_before_it_runs_dry) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    rig.plant().inject({.fault = Fault::oil_lost});
    ASSERT_TRUE(rig.run_until_state("fault", 10s));
    EXPECT_EQ(rig.reason(), "the oil pressure is lost");
    expect_safe(rig);
    EXPECT_EQ(rig.report().damage.ran_dry, 0u);
    expect_weaves_again(rig);
}

TEST_P(SafeStates, an_empty_feeder_stops_the_loom_like_a_broken_weft) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    rig.plant().inject({.fault = Fault::feeder_empty});
    ASSERT_TRUE(rig.run_until_state("stopped", 10s));
    EXPECT_EQ(rig.cause(), StopCause::weft);
    EXPECT_EQ(rig.reason(), "the weft did not arrive");
    EXPECT_FALSE(rig.output(wires::line::weft_release));
    EXPECT_TRUE(rig.output(wires::line::lamp_fault));
    expect_stops_in_tolerance(rig.report());
    expect_weaves_again(rig);
}

TEST_P(SafeStates, a_low_oil_level_alone_stops_nothing) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    rig.plant().inject({.fault = Fault::oil_level_low, .lasts = 2s});
    rig.run_for(3s);
    EXPECT_EQ(rig.state(), "weave");
}

TEST_P(SafeStates, a_bus_that_went_off_stops_the_loom_by_its_lines_alone) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    const Time off = rig.now();
    rig.bus().bus_off(rig.machine_can());
    ASSERT_TRUE(rig.run_until_state("fault", 100ms));
    EXPECT_LE(rig.now() - off, 15ms);
    EXPECT_EQ(rig.reason(), "the CAN bus is off"); // not the silence that follows from it
    expect_safe(rig);
    EXPECT_EQ(rig.report().damage.total(), 0u);
}

TEST_P(SafeStates, a_bus_on_which_nobody_acknowledges_stops_the_loom) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    rig.bus().set_acknowledged(false);
    ASSERT_TRUE(rig.run_until_state("fault", 100ms));
    EXPECT_TRUE(rig.reason() == "the CAN bus is off" || rig.reason() == "the encoder is stale")
        << rig.reason();
    expect_safe(rig);
    EXPECT_EQ(rig.report().damage.total(), 0u);
}

TEST_P(SafeStates, the_loom_weaves_again_after_the_bus_was_restarted_and_the_fault_acknowledged) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    rig.bus().bus_off(rig.machine_can());
    ASSERT_TRUE(rig.run_until_state("fault", 100ms));
    rig.run_for(3s);
    static_cast<void>(rig.machine_can().restart()); // not needed where a restarter has restarted it
    expect_weaves_again(rig);
}

TEST_P(SafeStates, a_loom_without_its_operator_stays_safe) {
    LoomRig rig{GetParam(), nobody_there()};
    ASSERT_TRUE(rig.prepare());
    rig.plant().press(loom::Button::start, 100ms);
    ASSERT_TRUE(rig.run_until([&] { return rig.plant().picks() > 5; }, 5s));
    rig.plant().inject({.fault = Fault::node_lost, .lasts = 100ms, .node = wires::node::encoder});
    ASSERT_TRUE(rig.run_until_state("fault", 100ms));
    rig.run_for(5s); // the encoder is long back
    EXPECT_EQ(rig.state(), "fault");
    expect_safe(rig);
}

TEST_P(SafeStates, a_machine_that_is_stopped_leaves_safe_values_on_every_wire) {
    LoomRig rig{GetParam()};
    ASSERT_TRUE(rig.weave());
    rig.run().stop();
    EXPECT_EQ(rig.state(), "safe");
    EXPECT_TRUE(rig.output(wires::line::brake));
    EXPECT_FALSE(rig.output(wires::line::weft_release));
    for (Duration after = 0ms; after <= 200ms; after += 1ms) rig.run().devices().advance(rig.now() + after);
    EXPECT_EQ(rig.plant().speed_rpm(), 0.0);
    expect_no_damage(rig.report());
}

} // namespace
} // namespace tappet::carpet
