// The robot that holds the body, with its plant under virtual time: homing, states, set points, end stops.
#include "tests/apps/two_robots/states.hpp"
#include "toolchain/machine/test.hpp"

namespace two_robots::k160 {
namespace {

struct K160 : MachineTest, testing::WithParamInterface<std::uint64_t> {
    K160() : MachineTest{GetParam()} {}
    [[nodiscard]] std::string_view state() { return state_of("robot"); }
    bool comes_to(std::string_view wanted, Duration within = 60s) {
        return MachineTest::comes_to("robot", wanted, within);
    }
    /// Records each state that is entered from here on.
    void note_states() {
        run.judge_by([this](Time) {
            if (const auto now = state(); !now.empty() && (entered.empty() || entered.back() != now))
                entered.emplace_back(now);
        });
    }
    /// Only the test presses buttons.
    bool waits_alone() {
        plant.leave_alone();
        plant.press("start", run.now() + 200ms);
        return comes_to("Waiting");
    }
    /// The error of the believed joint angles against the true ones.
    [[nodiscard]] Joints error() { return of<JointSensor>("joints").positions.last() - plant.joints(); }
    void runs(std::string_view chain) {
        run.run_for(50ms); // its state has been entered
        ScriptText name;
        ASSERT_TRUE(name.assign(chain));
        ASSERT_TRUE(of<ChainSwitch>("mode").run(name));
        ASSERT_TRUE(run.run_until([&] { return of<ChainSwitch>("mode").chain.last().view() == chain; }, 1s));
    }

    std::vector<std::string> entered;
};

TEST_P(K160, goes_from_power_on_through_homing_to_the_breath) {
    note_states();
    ASSERT_TRUE(comes_to("Simulating", 120s)) << state();
    run.run_for(10ms);
    const std::vector<std::string> wanted{"Off",    "PoweredOn", "Homing",    "Waiting",
                                          "Moving", "Waiting",   "Simulating"};
    EXPECT_EQ(entered, wanted);
    run.run_for(10s);
    EXPECT_EQ(state(), "Simulating");
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
}

// Thesis 3.4.7: state machines are (un-)loaded at run-time as scripts.
TEST_P(K160, stops_without_its_states_and_resumes_once_they_are_reloaded) {
    LoadedStates states{run};
    EXPECT_EQ(states.slot().phase(), SlotPhase::steady) << "the compiled ones are there from the start";
    ASSERT_TRUE(comes_to("Waiting")) << state();
    plant.leave_alone();
    run.run_for(100ms);
    const Joints at = plant.joints();
    EXPECT_EQ(states.unload(), "");
    EXPECT_EQ(states.slot().phase(), SlotPhase::empty);
    run.run_for(1s);
    EXPECT_TRUE(plant.brakes_are_on()) << "their last state leaves the arm safe";
    plant.press("start", run.now() + 200ms);
    run.run_for(1s);
    EXPECT_TRUE(plant.brakes_are_on()) << "nobody hears the button";
    EXPECT_LT((plant.joints() - at).cwiseAbs().maxCoeff(), 1e-3);

    EXPECT_EQ(states.load("k160/body_robot.osd"), "");
    EXPECT_EQ(state(), "Off");
    note_states();
    const auto press = [&](std::string_view button, std::string_view until) {
        plant.press(button, run.now() + 200ms);
        return comes_to(until, 60s);
    };
    ASSERT_TRUE(press("start", "Waiting")) << state();
    ASSERT_TRUE(press("ready", "Moving")) << state();
    ASSERT_TRUE(comes_to("Waiting")) << state();
    ASSERT_TRUE(press("work", "Simulating")) << state();
    run.run_for(10s);
    const std::vector<std::string> wanted{"Off", "PoweredOn", "Waiting", "Moving", "Waiting", "Simulating"};
    EXPECT_EQ(entered, wanted) << "the counters were set: nothing is homed a second time";
    EXPECT_EQ(states.slot().phase(), SlotPhase::steady) << states.slot().describe_roll_back().view();
    EXPECT_EQ(states.slot().script(), "k160/body_robot.osd");
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
}

TEST_P(K160, homes_with_states_that_were_loaded) {
    plant.leave_alone();
    LoadedStates states{run};
    EXPECT_EQ(states.load("k160/body_robot.osd"), "");
    plant.press("start", run.now() + 200ms);
    ASSERT_TRUE(comes_to("Homing", 2s)) << state();
    ASSERT_TRUE(comes_to("Waiting")) << state();
    run.run_for(100ms);
    EXPECT_LT(error().cwiseAbs().maxCoeff(), 2.0 * Plant::repeatability) << error().transpose();
    EXPECT_EQ(states.roll_back(), "") << "to the compiled ones";
    EXPECT_EQ(state(), "Off");
    EXPECT_TRUE(plant.brakes_are_on());
    plant.press("start", run.now() + 200ms);
    EXPECT_TRUE(comes_to("Waiting", 2s)) << state();
}

TEST_P(K160, knows_its_joints_within_the_repeatability_of_its_switches) {
    ASSERT_TRUE(comes_to("Waiting")) << state();
    run.run_for(100ms);
    EXPECT_LT(error().cwiseAbs().maxCoeff(), 2.0 * Plant::repeatability) << error().transpose();
    EXPECT_LT(of<JointSensor>("joints").positions.last().cwiseAbs().maxCoeff(), 2e-3) << "it is at zero";
}

TEST_P(K160, is_safe_when_a_joint_is_jammed) {
    const int axis = static_cast<int>(1 + GetParam() % 6);
    plant.jam(axis);
    ASSERT_TRUE(comes_to("Faulted", 10s)) << state();
    run.run_for(100ms);
    EXPECT_TRUE(plant.brakes_are_on());
    EXPECT_EQ(of<JointEffector>("drives").sent.last(), Joints{Joints::Zero()});
    EXPECT_TRUE(plant.stands());
    EXPECT_FALSE(of<Homing>("homing").homed.last());
    plant.jam(0); // it was repaired, and somebody starts it again
    plant.press("start", run.now() + 200ms);
    EXPECT_TRUE(comes_to("Waiting")) << state();
}

TEST_P(K160, stops_homing_when_stop_is_pressed) {
    ASSERT_TRUE(comes_to("Homing"));
    plant.leave_alone();
    run.run_for(Duration{137ms} * static_cast<int>(GetParam()));
    plant.press("stop", run.now() + 100ms);
    ASSERT_TRUE(comes_to("Faulted", 1s));
    EXPECT_TRUE(run.run_until([this] { return plant.stands() && plant.brakes_are_on(); }, 1s));
}

TEST_P(K160, does_not_breathe_before_it_is_ready) {
    ASSERT_TRUE(waits_alone());
    plant.press("work", run.now() + 200ms);
    run.run_for(1s);
    EXPECT_EQ(state(), "Waiting");
}

// Thesis 3.4.3: PID and feed-forward. A known rate leaves a smaller error.
TEST_P(K160, follows_a_ramp_better_with_feed_forward_and_both_reach_a_step) {
    ASSERT_TRUE(waits_alone());
    const auto worst_on_the_way = [&](std::string_view chain, double to) {
        runs(chain);
        JointPath& path = of<JointPath>("path");
        EXPECT_TRUE(path.go(to, to, -to, to, to, to));
        double worst = 0.0, now = 0.0;
        for (int i = 0; i < 4000; ++i) {
            run.run_for(2ms);
            now = (path.target.last() - of<JointSensor>("joints").positions.last()).cwiseAbs().maxCoeff();
            worst = std::max(worst, now);
        }
        EXPECT_LT(now, 1e-3) << chain;
        return worst;
    };
    const double by_feed_forward = worst_on_the_way("path", 0.6);
    const double by_error = worst_on_the_way("path_pid", -0.3);
    EXPECT_LT(by_feed_forward, 0.01);
    EXPECT_GT(by_error, 0.05) << "the rate over the gain";
}

TEST_P(K160, never_turns_faster_or_further_than_it_may) {
    ASSERT_TRUE(waits_alone());
    runs("path");
    ASSERT_TRUE(of<JointPath>("path").go(9, -9, 9, -9, 9, -9)); // far beyond the ends
    run.run_for(30s);
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
    EXPECT_LE(plant.worst_rates().maxCoeff(), 0.41);
    for (int i = 0; i < 6; ++i)
        EXPECT_LT(std::min(std::abs(plant.joints()[i] - highest[static_cast<std::size_t>(i)]),
                           std::abs(plant.joints()[i] - lowest[static_cast<std::size_t>(i)])),
                  0.02)
            << "it went as far as it may, joint " << i + 1;
}

INSTANTIATE_TEST_SUITE_P(seeds, K160, testing::Range<std::uint64_t>(1, 1 + SEEDS));

} // namespace
} // namespace two_robots::k160
