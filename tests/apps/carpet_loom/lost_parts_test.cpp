// A part of the loom's machine is stopped, restarted or lost while the rest keeps running: its last values
// become invalid, its valves close, and motion stops until acknowledged.
#include "tests/apps/carpet_loom/loom_rig.hpp"

#include <string>

namespace tappet::carpet {
namespace {

using loom::Button;
using loom::Fault;

struct Parts : LoomRig {
    explicit Parts(std::uint64_t seed = 5) : LoomRig{seed, nobody_there()} {}

    /// `what`: "component:..." or "activity:...".
    void change(const std::string& what, LifeChange how) {
        MachineInstance& instance = run().instance();
        const MachineView& table = instance.machine().table;
        const std::string name = what.substr(what.find(':') + 1);
        if (what.starts_with("component:"))
            static_cast<void>(instance.life().ask_component(find_component(table, name), how));
        else
            static_cast<void>(instance.life().ask_activity(find_activity(table, name), how));
        run_for(1ms);
    }
    void expect_stopped_and_staying_so(Duration within) {
        EXPECT_TRUE(run_until_it_stands(within)) << state();
        run_for(200ms); // only time shows that a shaft stands or that a drive slips
        const double stood_at = plant().position_deg();
        for (const Time end = now() + 2s; now() < end; run_for(1ms)) {
            EXPECT_EQ(component<MainDrive>("main").target.last(), 0.0);
            EXPECT_FALSE(output(wires::line::weft_release));
            EXPECT_FALSE(output(wires::line::yarn_cutter));
            if (testing::Test::HasFailure()) return;
        }
        EXPECT_EQ(plant().position_deg(), stood_at);
        EXPECT_TRUE(output(wires::line::brake));
        EXPECT_EQ(report().damage.motor_blocked, 0u);
    }
};

struct LostWhileWeaving : testing::Test {
    Parts rig;
    void SetUp() override { ASSERT_TRUE(rig.weave_by_hand()); }
};
struct LostWhenReady : testing::Test {
    Parts rig;
    void SetUp() override { ASSERT_TRUE(rig.prepare()); }
};

class WhileWeaving : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(part, WhileWeaving,
                         testing::Values("activity:shaft", "component:shaft", "component:weft", "activity:io",
                                         "component:io", "activity:can", "activity:motion", "component:main",
                                         "component:warp", "component:network", "activity:logic",
                                         "component:loom"));

TEST_P(WhileWeaving, the_stop_of_a_part_stops_the_loom_with_its_valve_closed) {
    for (const double deg : {100.0, 230.0}) { // at these angles the valve is open, or the cutter is on
        Parts rig;
        ASSERT_TRUE(rig.weave_by_hand());
        ASSERT_TRUE(rig.run_until_angle(deg));
        rig.change(GetParam(), LifeChange::stop);
        rig.run_for(30ms); // 4 ms of encoder silence; the watchdogs check every 5 ms
        EXPECT_FALSE(rig.output(wires::line::weft_release)) << "at " << deg << " deg";
        EXPECT_NE(rig.state(), "weave");
        rig.expect_stopped_and_staying_so(1s);
        EXPECT_NE(rig.state(), "ready");
    }
}

/// The watchdogs report a fault once; here nobody heard it.
TEST(TheLastResort, acts_when_it_starts_while_the_states_hang) {
    Parts rig;
    ASSERT_TRUE(rig.weave_by_hand());
    rig.change("component:last_resort", LifeChange::stop);
    rig.hang("logic", 5s);
    rig.plant().press(Button::stop, 100ms); // a person needs it
    rig.run_for(200ms);
    EXPECT_GT(rig.plant().speed_rpm(), 500.0);
    rig.change("component:last_resort", LifeChange::start);
    rig.expect_stopped_and_staying_so(1s);
}

TEST(TheLines, release_no_weft_after_a_restart_while_the_states_hang) {
    Parts rig;
    ASSERT_TRUE(rig.weave_by_hand());
    ASSERT_TRUE(rig.run_until_angle(60.0)); // before the release
    rig.hang("logic", 1s);
    rig.change("component:io", LifeChange::restart);
    EXPECT_TRUE(rig.output(wires::line::brake));
    for (const Time end = rig.now() + 1s; rig.now() < end; rig.run_for(1ms))
        ASSERT_FALSE(rig.output(wires::line::weft_release));
}

class StartedAnew : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(part, StartedAnew,
                         testing::Values("activity:shaft", "component:shaft", "component:weft",
                                         "component:io", "activity:motion", "component:main",
                                         "component:warp", "activity:logic", "component:loom"));

TEST_P(StartedAnew, a_part_restarted_while_weaving_stops_the_loom_until_acknowledged) {
    Parts rig;
    ASSERT_TRUE(rig.weave_by_hand());
    ASSERT_TRUE(rig.run_until_angle(100.0));
    rig.change(GetParam(), LifeChange::restart);
    rig.expect_stopped_and_staying_so(1s);
    EXPECT_TRUE(rig.state() == "fault" || rig.state() == "locked" || rig.state() == "stopped" ||
                rig.state() == "emergency")
        << rig.state() << ": " << rig.reason();
}

TEST_P(StartedAnew, a_part_restarted_during_preparation_moves_nothing_until_acknowledged) {
    if (std::string_view{GetParam()} == "component:weft")
        return; // it drives nothing: the valve is closed until start is pressed
    Parts rig;
    ASSERT_TRUE(rig.prepare());
    rig.change(GetParam(), LifeChange::restart);
    rig.run_for(50ms);
    EXPECT_TRUE(rig.state() == "fault" || rig.state() == "locked" || rig.state() == "emergency")
        << rig.state();
    for (const Time end = rig.now() + 2s; rig.now() < end; rig.run_for(1ms)) {
        ASSERT_EQ(rig.component<MainDrive>("main").target.last(), 0.0);
        ASSERT_EQ(rig.component<WarpTension>("warp").target.last(), 0.0);
        ASSERT_TRUE(rig.output(wires::line::brake));
    }
    rig.press(Button::start);
    EXPECT_EQ(rig.plant().speed_rpm(), 0.0);
    rig.acknowledge();
    EXPECT_TRUE(rig.run_until_state("ready", 5s)) << rig.state() << ": " << rig.reason();
}

TEST_F(LostWhileWeaving, the_watchdog_reports_a_hung_shaft_activity_and_the_valve_closes) {
    ASSERT_TRUE(rig.run_until_angle(85.0));
    ASSERT_TRUE(rig.output(wires::line::weft_release));
    MachineInstance& instance = rig.run().instance();
    instance.engines()[find_activity(instance.machine().table, "shaft")]
        .mark_failed(); // and runs nothing more
    rig.run_for(30ms);
    EXPECT_EQ(rig.state(), "fault");
    EXPECT_EQ(rig.reason(), "the shaft's activity shows no life");
    EXPECT_FALSE(rig.output(wires::line::weft_release));
    EXPECT_TRUE(rig.output(wires::line::brake));
    rig.expect_stopped_and_staying_so(1s);
}

TEST_F(LostWhenReady, every_component_runs_again_after_it_was_stopped_and_started) {
    MachineInstance& instance = rig.run().instance();
    for (std::size_t c = 0; c < instance.machine().table.components.size(); ++c) {
        const std::string_view name = instance.machine().table.components[c].name;
        static_cast<void>(instance.life().ask_component(c, LifeChange::stop));
        rig.run_for(300ms); // a period of the slowest activity
        EXPECT_EQ(instance.life().state_of(c), ComponentState::stopped) << name;
        const LifeTicket ticket = instance.life().ask_component(c, LifeChange::start);
        rig.run_for(300ms);
        EXPECT_EQ(instance.life().state_of(c), ComponentState::running)
            << name << ": "
            << instance.life()
                   .describe(instance.machine().index.activity[c],
                             instance.life().answer_of_component(c, ticket))
                   .view();
    }
    rig.acknowledge();
    ASSERT_TRUE(rig.run_until_state("ready", 20s)) << rig.state() << ": " << rig.reason();
    rig.press(Button::start);
    EXPECT_TRUE(rig.run_until([&] { return rig.state() == "weave" && rig.plant().picks() > 5; }, 5s))
        << rig.state() << ": " << rig.reason();
}

/// The component's last command is standstill, and its values about the drive are invalid.
template <class T> void expect_left_at_rest(const T& leader) {
    EXPECT_EQ(leader.target.last(), 0.0);
    EXPECT_EQ(leader.controlword.last(), canopen::controlword::quick_stop);
    EXPECT_FALSE(leader.enabled.last());
    EXPECT_TRUE(leader.fault.last());
}

TEST_F(LostWhileWeaving, the_main_drive_rests_when_its_component_alone_is_stopped) {
    const auto& main = rig.component<MainDrive>("main");
    ASSERT_TRUE(main.at_speed.last());
    rig.change("component:main", LifeChange::stop);
    rig.run_for(20ms);
    expect_left_at_rest(main);
    EXPECT_FALSE(main.at_speed.last());
    EXPECT_TRUE(rig.run_until([&] { return rig.plant().main_drive().power() == loom::Power::off; }, 1s))
        << "it needs no loom to tell it";
    EXPECT_EQ(rig.plant().main_drive().target(), 0);
}

TEST_F(LostWhileWeaving, the_let_off_rests_when_its_component_alone_is_stopped) {
    const auto& warp = rig.component<WarpTension>("warp");
    ASSERT_NE(warp.target.last(), 0.0);
    ASSERT_TRUE(warp.in_band.last());
    rig.change("component:warp", LifeChange::stop);
    rig.run_for(20ms);
    expect_left_at_rest(warp);
    EXPECT_FALSE(warp.in_band.last());
    EXPECT_TRUE(rig.run_until([&] { return rig.plant().let_off_drive().power() == loom::Power::off; }, 1s))
        << "the beam feeds nothing that nobody measures";
    EXPECT_EQ(rig.plant().let_off_drive().target(), 0);
}

TEST_F(LostWhenReady, unwatched_nodes_are_not_reported_as_operational) {
    ASSERT_TRUE(rig.component<Network>("network").operational.last());
    rig.change("component:network", LifeChange::stop);
    rig.run_for(20ms);
    EXPECT_FALSE(rig.component<Network>("network").operational.last());
    EXPECT_EQ(rig.state(), "fault") << rig.reason();
    rig.press(Button::start);
    rig.run_for(1s);
    EXPECT_EQ(rig.plant().speed_rpm(), 0.0);
}

TEST_F(LostWhileWeaving, lines_that_are_no_longer_driven_cause_an_emergency) {
    rig.change("activity:io", LifeChange::stop);
    ASSERT_TRUE(rig.run_until_state("emergency", 10ms)) << rig.state();
    EXPECT_EQ(rig.reason(), "the lines can no longer be relied on");
}

TEST_F(LostWhileWeaving, a_missing_chip_is_an_emergency_until_it_is_back) {
    rig.lines().set_removed(true);
    ASSERT_TRUE(rig.run_until_state("emergency", 200ms)) << rig.state();
    EXPECT_EQ(rig.reason(), "the lines can no longer be relied on");
    EXPECT_TRUE(rig.run_until_it_stands(1s)) << "by the drive alone";
    rig.run_for(200ms);
    rig.acknowledge();
    EXPECT_EQ(rig.state(), "emergency");
    rig.lines().set_removed(false);
    rig.run_for(100ms);
    rig.acknowledge();
    EXPECT_TRUE(rig.run_until_state("ready", 5s)) << rig.state() << ": " << rig.reason();
}

TEST_F(LostWhileWeaving, the_drive_stops_a_loom_without_a_brake_even_as_the_machine_ends) {
    rig.lines().set_removed(true);
    ASSERT_TRUE(rig.run_until_state("emergency", 200ms)) << rig.state();
    rig.change("activity:logic", LifeChange::stop); // the first step of an orderly stop
    EXPECT_TRUE(rig.run_until_it_stands(1s)) << "it does not coast";
}

TEST(LostParts, no_weft_is_released_into_a_stop_while_the_states_hang) {
    for (Duration later{}; later < 100ms; later += 7ms) { // anywhere in a turn
        Parts rig;
        ASSERT_TRUE(rig.weave_by_hand());
        rig.run_for(later);
        rig.hang("logic", 5s);
        rig.plant().press(Button::stop, 100ms); // wakes it in vain
        ASSERT_TRUE(rig.run_until([&] { return rig.output(wires::line::brake); }, 100ms));
        ASSERT_FALSE(rig.output(wires::line::weft_release));
        while (rig.plant().speed_rpm() != 0.0) {
            rig.run_for(100us);
            ASSERT_FALSE(rig.output(wires::line::weft_release)) << "hung " << later / 1ms << " ms later";
        }
    }
}

TEST_F(LostWhenReady, a_hung_shaft_activity_keeps_a_ready_loom_from_starting) {
    MachineInstance& instance = rig.run().instance();
    instance.engines()[find_activity(instance.machine().table, "shaft")].mark_failed();
    rig.run_for(50ms);
    const double stood_at = rig.plant().position_deg();
    rig.press(Button::start);
    rig.run_for(1s);
    EXPECT_EQ(rig.plant().position_deg(), stood_at);
    EXPECT_EQ(rig.state(), "fault") << rig.reason();
}

TEST_F(LostWhenReady, the_loom_does_not_start_without_its_weft_check) {
    rig.change("component:weft", LifeChange::stop);
    rig.press(Button::start);
    rig.run_for(1s);
    EXPECT_EQ(rig.plant().speed_rpm(), 0.0);
}

TEST_F(LostWhileWeaving, a_drive_that_pulls_against_a_brake_is_stopped) {
    rig.plant().set_line(wires::line::brake, true, rig.now()); // it brakes without a command
    ASSERT_TRUE(rig.run_until_state("fault", 300ms)) << rig.state();
    EXPECT_EQ(rig.reason(), "the main drive does not keep its speed");
    EXPECT_EQ(rig.report().damage.motor_blocked, 0u);
}

} // namespace
} // namespace tappet::carpet
