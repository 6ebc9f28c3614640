// Actions that begin at an angle of the shaft end even when their end angle never comes, and the feeds and
// learned values that depend on the shaft stay within its known range.
#include "tests/apps/carpet_loom/loom_rig.hpp"

namespace tappet::carpet {
namespace {

using loom::Button;
using loom::Fault;

struct ByHand : LoomRig {
    explicit ByHand(std::uint64_t seed = 5) : LoomRig{seed, nobody_there()} {}
    /// Stops as by the box's command shaft.stop_at.
    void stop_at(double deg) {
        double error = 0.0;
        static_cast<void>(component<MainShaft>("shaft").stop_shaft_at(deg, error));
    }
    bool stands() {
        return run_until([&] { return component<MainShaft>("shaft").standing.last(); }, 2s);
    }
};

class Angles : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(seed, Angles, testing::Range<std::uint64_t>(1, 5));
struct WeavingAngles : Angles {
    ByHand rig{GetParam()};
    void SetUp() override { ASSERT_TRUE(rig.weave_by_hand()); }
};
INSTANTIATE_TEST_SUITE_P(seed, WeavingAngles, testing::Range<std::uint64_t>(1, 5));

TEST_P(WeavingAngles, the_valve_closes_when_the_shaft_stops_inside_its_window) {
    rig.stop_at(150.0);
    ASSERT_TRUE(rig.stands());
    const double stood_at = std::fmod(rig.plant().position_deg(), 360.0);
    ASSERT_GT(stood_at, 120.0);
    ASSERT_LT(stood_at, 190.0);
    rig.run_for(2ms);
    EXPECT_FALSE(rig.output(wires::line::weft_release));
    rig.run_for(1s);
    EXPECT_FALSE(rig.output(wires::line::weft_release));
}

TEST_P(WeavingAngles, a_weft_missed_by_a_stop_inside_its_window_is_reported) {
    rig.plant().inject({.fault = Fault::weft_break});
    rig.stop_at(235.0);
    ASSERT_TRUE(rig.stands());
    rig.run_for(1s);
    EXPECT_EQ(rig.state(), "stopped") << rig.reason();
    EXPECT_EQ(rig.cause(), StopCause::weft);
}

TEST_P(Angles, the_cutter_is_off_when_the_shaft_stands) {
    for (const double deg : {260.0, 310.0}) { // after the weft's arrival and before the beat-up
        ByHand rig{GetParam()};
        ASSERT_TRUE(rig.weave_by_hand());
        rig.stop_at(deg);
        bool was_on = false;
        ASSERT_TRUE(rig.run_until(
            [&] {
                was_on |= rig.output(wires::line::yarn_cutter);
                return rig.component<MainShaft>("shaft").standing.last();
            },
            2s));
        EXPECT_TRUE(was_on);
        rig.run_for(2ms);
        EXPECT_FALSE(rig.output(wires::line::yarn_cutter)) << deg;
    }
}

TEST_P(Angles, the_cutter_and_the_valve_are_off_when_the_encoder_is_lost) {
    for (const double deg : {100.0, 245.0}) {
        ByHand rig{GetParam()};
        ASSERT_TRUE(rig.weave_by_hand());
        ASSERT_TRUE(rig.run_until_angle(deg));
        rig.plant().inject({.fault = Fault::node_lost, .node = wires::node::encoder});
        rig.run_for(10ms);
        EXPECT_FALSE(rig.output(wires::line::weft_release));
        EXPECT_FALSE(rig.output(wires::line::yarn_cutter));
        EXPECT_EQ(rig.component<MainShaft>("shaft").speed_rpm.last(), 0.0) << "no speed is known";
        EXPECT_FALSE(rig.component<MainShaft>("shaft").standing.last()) << "nor that it stands";
    }
}

TEST_P(WeavingAngles, the_cutter_is_off_when_the_activity_of_the_shaft_hangs) {
    ASSERT_TRUE(rig.run_until([&] { return rig.output(wires::line::yarn_cutter); }, 1s));
    rig.hang("shaft", 1s);
    rig.run_for(35ms); // it is silent after 20 ms, and the check runs every 5 ms
    EXPECT_FALSE(rig.output(wires::line::yarn_cutter));
    rig.run_for(2s);
    EXPECT_FALSE(rig.output(wires::line::yarn_cutter));
}

TEST_P(Angles, the_let_off_feeds_nothing_while_the_loom_stands_and_the_load_cell_is_lost) {
    ByHand rig{GetParam()};
    ASSERT_TRUE(rig.prepare());
    rig.plant().inject({.fault = Fault::node_lost, .node = wires::node::load_cell});
    rig.run_for(30ms);
    for (int i = 0; i < 250; ++i, rig.run_for(1ms))
        ASSERT_EQ(rig.component<WarpTension>("warp").target.last(), 0.0) << rig.state();
}

TEST_P(WeavingAngles, the_let_off_feeds_nothing_when_encoder_and_load_cell_are_lost_together) {
    rig.plant().inject({.fault = Fault::node_lost, .node = wires::node::load_cell});
    rig.plant().inject({.fault = Fault::node_lost, .node = wires::node::encoder});
    rig.run_for(40ms);
    for (int i = 0; i < 2000; ++i, rig.run_for(1ms))
        ASSERT_EQ(rig.component<WarpTension>("warp").target.last(), 0.0) << rig.state();
    EXPECT_EQ(rig.plant().let_off_drive().target(), 0);
}

TEST_P(WeavingAngles, the_learned_distance_of_a_broken_brake_stays_in_range) {
    auto& shaft = rig.component<MainShaft>("shaft");
    for (int stop = 0; stop < 6; ++stop) {
        rig.plant().press(Button::stop, 100ms);
        ASSERT_TRUE(rig.run_until(
            [&] {
                rig.plant().set_line(wires::line::brake, false, rig.now()); // its wire is broken
                return rig.state() == "ready";
            },
            3s))
            << rig.state();
        EXPECT_LE(shaft.brake_distance_deg.last(), 180.0);
        EXPECT_LE(shaft.first_brake_distance_deg.get(), 180.0) << "the next start would refuse it";
        EXPECT_GE(shaft.first_brake_distance_deg.get(), 30.0);
        rig.press(Button::start);
        ASSERT_TRUE(rig.run_until_state("weave", 5s)) << rig.state();
        rig.run_for(300ms);
    }
    EXPECT_GT(shaft.first_brake_distance_deg.get(), 170.0) << "it did learn";
}

} // namespace
} // namespace tappet::carpet
