// The causes that make the loom safe, the reasons that it gives, and the way back to weaving.
#include "tests/apps/carpet_loom/loom_rig.hpp"

namespace tappet::carpet {
namespace {

using loom::Fault;

class SafeStates : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(seed, SafeStates, seeds(6));
struct WeavingSafely : testing::TestWithParam<std::uint64_t> {
    LoomRig rig{GetParam()};
    void SetUp() override { ASSERT_TRUE(rig.weave()) << rig.told(); }
};
INSTANTIATE_TEST_SUITE_P(seed, WeavingSafely, seeds(6));

/// Expects that the shaft stands, the brake holds, no valve is open, and the lamps ask for a person.
void expect_safe(LoomRig& rig) {
    EXPECT_TRUE(rig.run_until_it_stands(1s));
    EXPECT_TRUE(rig.output(wires::line::brake));
    EXPECT_FALSE(rig.output(wires::line::weft_release));
    EXPECT_TRUE(rig.output(wires::line::lamp_fault));
    EXPECT_FALSE(rig.output(wires::line::lamp_run));
    EXPECT_FALSE(rig.output(wires::line::lamp_stop));
}

/// The operator of the plant repairs, acknowledges and starts the loom.
void expect_weaves_again(LoomRig& rig) {
    EXPECT_TRUE(rig.weave(10)) << rig.told();
    expect_no_damage(rig.report());
}

TEST_P(WeavingSafely, the_emergency_stop_closes_the_valve_and_brakes_at_once) {
    // Each seed stops at another angle, some of them with an open valve.
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

TEST_P(WeavingSafely, the_loom_weaves_again_after_an_emergency_stop_was_released_and_acknowledged) {
    rig.plant().inject({.fault = Fault::emergency_stop});
    ASSERT_TRUE(rig.run_until_state("emergency", 10ms));
    expect_weaves_again(rig);
}

TEST_P(SafeStates, a_held_emergency_stop_cannot_be_acknowledged) {
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

TEST_P(SafeStates, an_emergency_stop_at_standstill_is_obeyed) {
    LoomRig rig{GetParam(), nobody_there()};
    ASSERT_TRUE(rig.prepare());
    rig.plant().inject({.fault = Fault::emergency_stop});
    ASSERT_TRUE(rig.run_until_state("emergency", 10ms));
    rig.plant().press(loom::Button::start, 100ms);
    rig.run_for(1s);
    EXPECT_EQ(rig.state(), "emergency");
    EXPECT_EQ(rig.plant().speed_rpm(), 0.0);
}

/// A fault while the loom weaves: the time until state fault, and the reason.
struct Failing {
    loom::ScriptedFault fault;
    Duration within, at_most; ///< until the check begins, and until the state is due
    std::string_view reason;
};
constexpr Failing failing[] = {
    {{.fault = Fault::node_lost, .node = wires::node::encoder}, 100ms, 15ms, "the encoder is stale"},
    // Its heartbeat is missing.
    {{.fault = Fault::node_lost, .node = wires::node::load_cell}, 500ms, 500ms, "a CAN node is silent"},
    {{.fault = Fault::node_lost, .node = wires::node::feeder}, 500ms, 500ms, "a CAN node is silent"},
    {{.fault = Fault::node_lost, .node = wires::node::dobby}, 500ms, 500ms, "a CAN node is silent"},
    {{.fault = Fault::node_lost, .node = wires::node::main_drive}, 500ms, 60ms, "a drive reports a fault"},
    {{.fault = Fault::node_lost, .node = wires::node::let_off_drive}, 500ms, 60ms, "a drive reports a fault"},
    {{.fault = Fault::drive_fault, .node = wires::node::main_drive}, 50ms, 50ms, "a drive reports a fault"},
    {{.fault = Fault::drive_fault, .node = wires::node::let_off_drive},
     50ms,
     50ms,
     "a drive reports a fault"},
    {{.fault = Fault::oil_lost}, 10s, 10s, "the oil pressure is lost"}};

TEST_P(SafeStates, a_failed_part_stops_the_loom_which_weaves_again_after_repair) {
    for (const Failing& row : failing) {
        SCOPED_TRACE(testing::Message{} << row.reason << ", node " << int{row.fault.node});
        LoomRig rig{GetParam()};
        ASSERT_TRUE(rig.weave());
        const Time failed = rig.now();
        rig.plant().inject(row.fault);
        ASSERT_TRUE(rig.run_until_state("fault", row.within));
        EXPECT_LE(rig.now() - failed, row.at_most);
        EXPECT_EQ(rig.reason(), row.reason);
        EXPECT_EQ(rig.cause(), StopCause::fault);
        if (row.reason == "a CAN node is silent") {
            EXPECT_EQ(rig.component<Network>("network").silent_node.last(), row.fault.node);
        }
        expect_safe(rig);
        EXPECT_EQ(rig.report().damage.ran_dry, 0u);
        expect_weaves_again(rig);
    }
}

TEST_P(WeavingSafely, an_empty_feeder_stops_the_loom_like_a_broken_weft) {
    rig.plant().inject({.fault = Fault::feeder_empty});
    ASSERT_TRUE(rig.run_until_state("stopped", 10s));
    EXPECT_EQ(rig.cause(), StopCause::weft);
    EXPECT_EQ(rig.reason(), "the weft did not arrive");
    EXPECT_FALSE(rig.output(wires::line::weft_release));
    EXPECT_TRUE(rig.output(wires::line::lamp_fault));
    expect_stops_in_tolerance(rig.report());
    expect_weaves_again(rig);
}

TEST_P(WeavingSafely, a_low_oil_level_alone_stops_nothing) {
    rig.plant().inject({.fault = Fault::oil_level_low, .lasts = 2s});
    rig.run_for(3s);
    EXPECT_EQ(rig.state(), "weave");
}

TEST_P(WeavingSafely, the_loom_stops_by_its_lines_alone_when_the_bus_is_off) {
    const Time off = rig.now();
    rig.bus().bus_off(rig.machine_can());
    ASSERT_TRUE(rig.run_until_state("fault", 100ms));
    EXPECT_LE(rig.now() - off, 15ms);
    EXPECT_EQ(rig.reason(), "the CAN bus is off"); // not the silence that follows from it
    expect_safe(rig);
    EXPECT_EQ(rig.report().damage.total(), 0u);
}

TEST_P(WeavingSafely, a_bus_without_acknowledgements_stops_the_loom) {
    rig.bus().set_acknowledged(false);
    ASSERT_TRUE(rig.run_until_state("fault", 100ms));
    EXPECT_TRUE(rig.reason() == "the CAN bus is off" || rig.reason() == "the encoder is stale")
        << rig.reason();
    expect_safe(rig);
    EXPECT_EQ(rig.report().damage.total(), 0u);
}

TEST_P(WeavingSafely, the_loom_weaves_again_after_the_bus_was_restarted_and_the_fault_acknowledged) {
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

TEST_P(WeavingSafely, a_machine_that_is_stopped_leaves_safe_values_on_every_wire) {
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
