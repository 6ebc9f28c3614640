// The bearing press with its plant under virtual time: it seats each bearing with its force, a hand-over
// causes no jump, and after a failure the slide rests.
#include "apps/bearing_press/axis.hpp"
#include "kernel/control/chain_switch.hpp"
#include "kernel/machine/map/view.hpp"
#include "toolchain/machine/test.hpp"

namespace bearing_press {
namespace {

struct BearingPress : MachineTest, testing::WithParamInterface<std::uint64_t> {
    BearingPress() : MachineTest{GetParam()} {}
    [[nodiscard]] std::string_view state() { return state_of("axis"); }
    [[nodiscard]] std::string_view chain() {
        return run.instance().find<ChainSwitch>("mode")->chain.last().view();
    }
    bool comes_to(std::string_view wanted, Duration within = 10s) {
        return MachineTest::comes_to("axis", wanted, within);
    }
    bool stands() {
        return run.run_until([this] { return std::abs(plant.speed()) < 1e-4; }, 1s);
    }
    void change(std::string_view component, LifeChange how) {
        run.instance().life().ask_component(find_component(run.instance().machine().table, component), how);
    }
};

TEST_P(BearingPress, seats_each_bearing_with_its_force_and_not_more) {
    ASSERT_TRUE(run.run_until([this] { return plant.is_done(); }, 60s)) << plant.bearings() << ' ' << state();
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
    EXPECT_LT(plant.worst_force(), 1.005 * Plant::seat_force)
        << "the loop does not overshoot, as the table says";
    EXPECT_GT(plant.worst_force(), 0.98 * Plant::seat_force);
    EXPECT_LT(plant.worst_speed(), 1.1 * slide.velocity);
    EXPECT_EQ(run.instance().find<Axis>("axis")->seated.last(), plant.bearings());
}

// Upper bound: the largest change of the inner ramp, through a drive that lags by 4 ms.
TEST_P(BearingPress, is_never_jolted_by_a_hand_over) {
    ASSERT_TRUE(run.run_until([this] { return plant.is_done(); }, 60s));
    EXPECT_GT(run.instance().observation().counted(0, 4).times, 2u) << "hand-overs to the press";
    EXPECT_LT(plant.worst_jolt(), Plant::most_jolt);
}

TEST_P(BearingPress, comes_to_rest_when_stop_is_pressed_at_any_time_of_the_cycle) {
    plant.work(false);
    for (int i = 0; i < 12; ++i) {
        plant.work(true);
        ASSERT_TRUE(comes_to("DiscreteMotion")) << state();
        run.run_for(37ms * (i + 1));
        plant.press("stop", true);
        plant.work(false);
        ASSERT_TRUE(stands());
        run.run_for(200ms);
        EXPECT_TRUE(state() == "Standstill" || state() == "Pressing" || state() == "Returning") << state();
        plant.press("stop", false);
        run.run_for(50ms);
        plant.press("stop", true); // pressed once while nothing could be stopped
        run.run_for(50ms);
        plant.press("stop", false);
        ASSERT_TRUE(comes_to("Standstill")) << state();
    }
}

TEST_P(BearingPress, is_not_jolted_when_power_comes_back_after_a_stop_in_mid_path) {
    ASSERT_TRUE(comes_to("DiscreteMotion", 20s));
    run.run_for(400ms);
    ASSERT_GT(plant.speed(), 0.1) << "at speed";
    plant.hold_lower_end(true); // the drive brakes by itself, harder than any path
    ASSERT_TRUE(comes_to("ErrorStop", 100ms));
    plant.work(false);
    ASSERT_TRUE(stands());
    plant.hold_lower_end(false);
    plant.forget_jolts();
    plant.work(true);
    const std::int64_t before = plant.bearings();
    ASSERT_TRUE(run.run_until([&] { return plant.bearings() > before; }, 40s))
        << state() << ": it finds its zero anew";
    EXPECT_LT(plant.worst_jolt(), Plant::most_jolt);
}

TEST_P(BearingPress, stops_jogging_and_does_not_start_while_stop_is_held) {
    ASSERT_TRUE(comes_to("Standstill"));
    plant.press("stop", true);
    run.run_for(2s);
    EXPECT_EQ(state(), "Standstill");
    EXPECT_EQ(run.instance().find<Axis>("axis")->obstacle(), "stop is pressed");
    plant.work(false);
    plant.press("stop", false);
    run.run_for(50ms);
    plant.press("down", true);
    ASSERT_TRUE(comes_to("ContinuousMotion", 1s));
    run.run_for(200ms);
    plant.press("stop", true);
    ASSERT_TRUE(comes_to("Standstill", 1s));
    EXPECT_TRUE(stands());
}

TEST_P(BearingPress, stops_jogging_at_an_end_and_jogs_away_from_it) {
    ASSERT_TRUE(comes_to("Standstill"));
    plant.work(false);
    run.run_for(100ms);
    ASSERT_TRUE(comes_to("Standstill"));
    plant.hold_lower_end(true);
    plant.press("down", true);
    run.run_for(300ms);
    EXPECT_NEAR(plant.speed(), 0.0, 1e-3);
    plant.press("down", false);
    ASSERT_TRUE(comes_to("Standstill", 1s));
    plant.press("up", true);
    run.run_for(300ms);
    EXPECT_NEAR(plant.speed(), -0.02, 2e-3);
    plant.press("up", false);
    ASSERT_TRUE(comes_to("Standstill", 1s));
}

TEST_P(BearingPress, jogs_while_a_button_is_held) {
    ASSERT_TRUE(comes_to("Standstill"));
    plant.work(false);
    run.run_for(500ms);
    ASSERT_TRUE(comes_to("Standstill"));
    ASSERT_TRUE(stands());
    const double before = plant.place();
    plant.press("down", true);
    ASSERT_TRUE(comes_to("ContinuousMotion"));
    EXPECT_EQ((run.run_for(1s), chain()), "jog");
    EXPECT_NEAR(plant.place() - before, 0.02, 0.003);
    plant.press("down", false);
    ASSERT_TRUE(comes_to("Standstill"));
    const double there = plant.place();
    run.run_for(500ms);
    EXPECT_NEAR(plant.place(), there, 1e-4);
}

TEST_P(BearingPress, falls_back_and_comes_to_rest_when_a_controller_stops) {
    ASSERT_TRUE(run.run_until([this] { return chain() == "press"; }, 20s));
    change("press", LifeChange::stop);
    run.run_for(2ms);
    EXPECT_EQ(chain(), "off");
    EXPECT_TRUE(comes_to("ErrorStop", 100ms)) << state();
    EXPECT_TRUE(stands());
    EXPECT_LE(plant.worst_force(), 1.02 * Plant::seat_force);
}

TEST_P(BearingPress, stops_the_axis_when_its_drive_falls_silent) {
    ASSERT_TRUE(comes_to("DiscreteMotion", 20s));
    plant.work(false);
    run.run_for(100ms);
    plant.silence_drive();
    run.run_for(40ms);
    EXPECT_EQ(state(), "ErrorStop");
    EXPECT_TRUE(stands());
}

TEST_P(BearingPress, does_not_start_at_an_end_until_it_is_free) {
    ASSERT_TRUE(comes_to("Standstill"));
    plant.hold_lower_end(true);
    run.run_for(3s);
    EXPECT_EQ(state(), "Standstill");
    plant.hold_lower_end(false);
    EXPECT_TRUE(run.run_until([this] { return plant.bearings() > 0; }, 20s)) << state();
}

TEST_P(BearingPress, shows_forced_inputs_that_have_several_writers) {
    const AcceptedMachine& machine = run.instance().machine();
    const auto view = map::View::open(run.instance().observation().shared_memory());
    ASSERT_TRUE(view) << view.error().view();
    for (const std::string_view name : {"place.target", "trim.target"}) {
        End end;
        ASSERT_TRUE(resolve(machine.table, name, FacetKind::input, end).empty());
        const PortOperations& port = *facet_at(machine.table, end).port;
        const double place = 0.25;
        port.force(run.instance().place_of(end), true, reinterpret_cast<const std::byte*>(&place));
        const map::Facet& shown = view->facets()[view->components()[end.component].first_facet + end.facet];
        EXPECT_EQ(view->word<std::uint8_t>(shown.forced_at), 1) << name;
        double value = 0.0;
        EXPECT_TRUE(view->copy(shown.forced_value_at, std::as_writable_bytes(std::span{&value, 1}))) << name;
        EXPECT_EQ(value, place);
        port.release(run.instance().place_of(end), true);
        EXPECT_EQ(view->word<std::uint8_t>(shown.forced_at), 0) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(seeds, BearingPress, testing::Values(1, 2, 3));

} // namespace
} // namespace bearing_press
