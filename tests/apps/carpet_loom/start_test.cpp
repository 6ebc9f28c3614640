// After any kind of end, a start moves nothing until somebody at the machine has acknowledged.
#include "tests/apps/carpet_loom/loom_rig.hpp"

namespace tappet::carpet {
namespace {

using loom::Button;

struct Start : LoomRig {
    Start() : LoomRig{11, nobody_there()} {}

    void expect_drives_at_rest() {
        const auto& main = component<MainDrive>("main");
        const auto& warp = component<WarpTension>("warp");
        EXPECT_EQ(main.target.last(), 0.0);
        EXPECT_EQ(warp.target.last(), 0.0);
        for (const std::int64_t word : {main.controlword.last(), warp.controlword.last()})
            EXPECT_NE(word & 0xF, canopen::controlword::enable_operation) << "enabled";
    }
    /// Expects that nothing is driven for that long, however often start is pressed and whatever the plant
    /// does.
    void expect_nothing_moves(Duration time) {
        for (const Time end = now() + time; now() < end; run_for(1ms)) {
            expect_drives_at_rest();
            EXPECT_TRUE(output(wires::line::brake));
            EXPECT_FALSE(output(wires::line::weft_release));
            EXPECT_FALSE(output(wires::line::yarn_cutter));
            if (testing::Test::HasFailure()) return;
        }
    }
    /// Runs from a start to the acknowledgement and beyond.
    void expect_locked_until_acknowledged() {
        expect_drives_at_rest();
        run_for(5ms); // the lines follow at once, whatever they were
        expect_nothing_moves(1s);
        EXPECT_EQ(state(), "locked");
        EXPECT_EQ(component<Loom>("loom").waits_for.last(), WaitsFor::acknowledgement);
        EXPECT_TRUE(output(wires::line::lamp_fault));
        EXPECT_EQ(plant().speed_rpm(), 0.0) << "the brake has stopped it";
        const double stood_at = plant().position_deg();
        for (const Button button : {Button::start, Button::stop}) press(button);
        expect_nothing_moves(3s);
        EXPECT_EQ(state(), "locked") << "time and the other buttons unlock nothing";
        EXPECT_EQ(plant().position_deg(), stood_at);
        EXPECT_EQ(plant().let_off_drive().target(), 0);
        plant().repair(); // repairs what the end left broken
        run_for(500ms);
        acknowledge();
        EXPECT_TRUE(run_until_state("ready", 5s)) << state() << ": " << reason();
        press(Button::start);
        EXPECT_TRUE(run_until([&] { return state() == "weave"; }, 5s)) << state() << ": " << reason();
        EXPECT_EQ(report().damage.total(), 0u);
    }
    void end_and_start_again(StopReason reason) {
        run().instance().ask_stop(reason, 0, run().instance().engines().data());
        run_for(1ms);
        run().stop();
        ASSERT_TRUE(run().start_again());
        expect_locked_until_acknowledged();
    }
};

TEST(ALoom, moves_nothing_after_its_very_first_start) {
    Start rig;
    rig.expect_locked_until_acknowledged();
}

/// The ways in which the supervisor ends a machine.
class AfterAnEnding : public testing::TestWithParam<StopReason> {};
INSTANTIATE_TEST_SUITE_P(reason, AfterAnEnding,
                         testing::Values(StopReason::requested, StopReason::stale_input,
                                         StopReason::missed_deadline, StopReason::broken_contract,
                                         StopReason::behaviour));

TEST_P(AfterAnEnding, the_next_start_moves_nothing_until_acknowledged) {
    Start rig;
    ASSERT_TRUE(rig.weave_by_hand());
    rig.end_and_start_again(GetParam());
}

TEST_P(AfterAnEnding, the_next_start_of_a_prepared_loom_moves_nothing) {
    Start rig;
    ASSERT_TRUE(rig.prepare());
    rig.end_and_start_again(GetParam());
}

/// After a sudden death the lines stay as they are, and the drives follow their last commands.
TEST(AfterADeath, the_next_start_stops_the_loom_and_moves_nothing_until_acknowledged) {
    for (const Duration later : {Duration{0}, Duration{37ms}}) {
        Start rig;
        ASSERT_TRUE(rig.weave_by_hand());
        ASSERT_TRUE(rig.run_until([&] { return rig.output(wires::line::weft_release); }, 1s));
        rig.run_for(later);
        ASSERT_TRUE(rig.run().start_again());
        rig.run_for(2ms);
        EXPECT_FALSE(rig.output(wires::line::weft_release)) << "not even one dead time longer";
        EXPECT_TRUE(rig.output(wires::line::brake));
        rig.expect_locked_until_acknowledged();
    }
}

/// The drive trips again after the acknowledgement has reset it, before it follows.
TEST(AnAcknowledgement, is_required_again_when_a_drive_does_not_follow) {
    const loom::ScriptedFault trip{.fault = loom::Fault::drive_fault, .node = wires::node::main_drive};
    Start rig;
    rig.run_for(500ms); // its nodes boot
    rig.plant().inject(trip);
    rig.run_for(20ms);
    rig.plant().press(Button::acknowledge, 100ms);
    ASSERT_TRUE(rig.run_until([&] { return !rig.component<MainDrive>("main").fault.last(); }, 1s));
    rig.plant().inject(trip);
    rig.run_for(1900ms);
    EXPECT_EQ(rig.state(), "preparing");
    EXPECT_FALSE(rig.output(wires::line::lamp_fault));
    rig.run_for(200ms);
    EXPECT_EQ(rig.state(), "asking");
    EXPECT_TRUE(rig.output(wires::line::lamp_fault));
    rig.run_for(2s);
    EXPECT_EQ(rig.state(), "asking") << "nothing moves by itself";
    rig.acknowledge();
    EXPECT_TRUE(rig.run_until_state("ready", 5s)) << rig.state();
    EXPECT_FALSE(rig.output(wires::line::lamp_fault));
}

TEST(AnAcknowledgement, releases_no_brake_that_holds_a_turning_shaft) {
    Start rig;
    ASSERT_TRUE(rig.weave_by_hand());
    ASSERT_TRUE(rig.run().start_again());
    rig.run_for(1ms);
    ASSERT_GT(rig.plant().speed_rpm(), 500.0);
    rig.plant().press(Button::acknowledge, 20ms);
    rig.run_for(30ms); // the debounced signal reaches the loom while the shaft brakes
    EXPECT_EQ(rig.state(), "locked");
    rig.expect_nothing_moves(500ms);
}

TEST(AnAcknowledgement, does_not_count_when_held_down_before_the_start) {
    Start rig;
    rig.plant().press(Button::acknowledge, 10s);
    rig.run_for(100ms);
    ASSERT_TRUE(rig.run().start_again());
    rig.run_for(5ms);
    rig.expect_nothing_moves(1s);
    EXPECT_EQ(rig.state(), "locked");
}

} // namespace
} // namespace tappet::carpet
