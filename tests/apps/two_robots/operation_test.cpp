// Both robots under virtual time (thesis 3.4): one moves the body, the other one operates through the hole in
// it.
#include "tests/apps/two_robots/states.hpp"
#include "toolchain/machine/test.hpp"

#include <gmock/gmock.h>

#include <set>

namespace two_robots::k361 {
namespace {

struct Operation : MachineTest, testing::WithParamInterface<std::uint64_t> {
    Operation() : MachineTest{GetParam()} {}
    [[nodiscard]] std::string_view state() { return state_of("robot"); }
    bool comes_to(std::string_view wanted, Duration within = 120s) {
        return MachineTest::comes_to("robot", wanted, within);
    }
    /// Distance of the tip from the recorded path, across and along the shaft, in m.
    [[nodiscard]] double beside_path() const {
        const Eigen::Vector3d& tip = plant.now().tip;
        const double round = std::sqrt(tip.x() * tip.x() + tip.y() * tip.y()) - recorded_radius;
        return std::sqrt(round * round + (tip.z() + 0.15) * (tip.z() + 0.15));
    }
    double worst_beside_path(Duration time) {
        double worst = 0.0;
        const Time end = run.now() + time;
        while (run.now() < end) {
            run.run_for(5ms);
            worst = std::max(worst, beside_path());
        }
        return worst;
    }
    void hands_over(std::string_view by, std::string_view chain) {
        ScriptText name;
        ASSERT_TRUE(name.assign(chain));
        ASSERT_TRUE(of<ChainSwitch>(by).run(name));
    }
    /// The body goes across the hole, at its full stroke.
    void sways() {
        auto& breath = *plant.body_robot().instance().find<BodySimulation>("breath");
        breath.direction.set(Eigen::Vector3d{0, 1, 0});
    }
};

TEST_P(Operation, moves_the_tip_along_its_path_in_a_moving_body) {
    sways();
    ASSERT_TRUE(comes_to("Operating")) << state();
    run.run_for(4s);
    plant.forget_worst_shaft();
    EXPECT_LT(worst_beside_path(16s), 0.4e-3);
    EXPECT_LT(plant.worst_beside_hole(), 0.3e-3);
    EXPECT_GT(of<Replay>("replay").rounds.last(), 0);
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
}

TEST_P(Operation, needs_prediction_because_the_camera_shows_the_past) {
    sways();
    of<BodyEstimator>("body").predicts.set(false);
    ASSERT_TRUE(comes_to("Operating")) << state();
    run.run_for(4s);
    plant.forget_worst_shaft();
    EXPECT_GT(worst_beside_path(16s), 0.8e-3);
    EXPECT_GT(plant.worst_beside_hole(), 0.8e-3);
}

// Thesis 3.3: one component can replace another one, without their clients having to adapt to, or even be
// aware of, the replacement.
TEST_P(Operation, is_undisturbed_when_another_estimator_takes_over) {
    sways();
    ASSERT_TRUE(comes_to("Operating")) << state();
    run.run_for(4s);
    plant.forget_worst();
    Random random{GetParam()};
    auto& model = of<Replay>("replay").model;
    const auto& by_kalman = of<KalmanBodyEstimator>("body_kalman").model;
    double worst = 0.0;
    for (int i = 0; i < 40; ++i) {
        const bool kalman = i % 2 == 0;
        hands_over("estimation", kalman ? "kalman" : "alpha_beta");
        const Eigen::Vector3d before = by_kalman.last().frame.position;
        for (auto steps = 2 + random.below(150); steps > 0; --steps) {
            run.run_for(2ms);
            ASSERT_TRUE(model.good());
            ASSERT_LE(run.now() - model.stamp(), 2ms) << "each step has its own";
            worst = std::max(worst, beside_path());
        }
        EXPECT_EQ(by_kalman.last().frame.position != before, kalman) << "who does not run is silent";
        EXPECT_EQ(of<ChainSwitch>("estimation").hindered.last().view(), "");
    }
    EXPECT_EQ(state(), "Operating");
    EXPECT_LT(worst, 0.4e-3);
    EXPECT_LT(plant.worst_change(), 4.0) << "rad/s2";
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
}

TEST_P(Operation, keeps_its_estimator_when_the_other_one_sees_no_leds) {
    ASSERT_TRUE(comes_to("Operating")) << state();
    plant.camera.faults.covered = true;
    ASSERT_TRUE(comes_to("Holding", 1s)) << state();
    run.run_for(1s);
    hands_over("estimation", "kalman");
    run.run_for(10ms);
    EXPECT_EQ(of<ChainSwitch>("estimation").chain.last().view(), "alpha_beta");
    EXPECT_EQ(of<ChainSwitch>("estimation").hindered.last().view(), "body_kalman.leds");
}

TEST_P(Operation, is_undisturbed_when_other_kinematics_take_over) {
    sways();
    ASSERT_TRUE(comes_to("Operating")) << state();
    run.run_for(4s);
    plant.forget_worst();
    for (int i = 0; i < 10; ++i) {
        hands_over("geometry", i % 2 == 0 ? "as_measured" : "as_drawn");
        EXPECT_LT(worst_beside_path(Duration{137ms} * static_cast<int>(GetParam())), 0.4e-3);
    }
    of<MeasuredKinematics<ConeWrist>>("measured").l6.set(0.122); // somebody measured again
    of<MeasuredKinematics<ConeWrist>>("measured").changed();
    EXPECT_LT(worst_beside_path(200ms), 0.4e-3) << "nobody asks it yet";
    hands_over("geometry", "as_measured");
    run.run_for(1s);
    EXPECT_NEAR(plant.now().tip.z(), -0.148, 0.4e-3) << "both loops take the arm for 2 mm longer";
    hands_over("geometry", "as_drawn");
    run.run_for(1s);
    EXPECT_LT(worst_beside_path(500ms), 0.4e-3);
    EXPECT_EQ(state(), "Operating");
    EXPECT_EQ(of<ChainSwitch>("mode").chain.last().view(), "tool");
    EXPECT_LT(plant.worst_change(), 4.0) << "rad/s2";
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
}

// Thesis 3.4.7: state machines are (un-)loaded at run-time as scripts.
TEST_P(Operation, runs_on_states_that_were_loaded_at_standstill) {
    ASSERT_TRUE(comes_to("Waiting")) << state();
    run.run_for(500ms); // the button was let go
    LoadedStates states{run};
    EXPECT_EQ(states.unload(), "");
    run.run_for(100ms);
    EXPECT_TRUE(plant.brakes_are_on());
    EXPECT_EQ(states.load("k361/tool_robot.osd"), "");
    EXPECT_EQ(state(), "Off");
    plant.press("start", run.now() + 200ms);
    ASSERT_TRUE(comes_to("Operating")) << state();
    run.run_for(4s);
    EXPECT_LT(worst_beside_path(4s), 0.4e-3);
    EXPECT_EQ(states.slot().phase(), SlotPhase::steady) << states.slot().describe_roll_back().view();
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
}

// Thesis 3.3, time: whenever several processors are used they synchronise their clocks. The test compares the
// estimate of the other robot's clock with the truth.
TEST_P(Operation, knows_the_other_robots_clock_within_its_stated_error) {
    const auto& clock = of<udp::PeerClock>("body_clock");
    const auto wrong = [&] { return (clock.ahead.last() - plant.time_link.ahead(run.now())); };
    const auto looks_for = [&](Duration time) {
        Duration worst{};
        for (const Time end = run.now() + time; run.now() < end;) {
            run.run_for(50ms);
            // Since the last exchange the clocks have drifted a little further.
            EXPECT_LE(std::abs(wrong().count()), (clock.error.last() + 30us).count());
            worst = std::max(worst, clock.error.last());
        }
        return worst;
    };
    run.run_for(3s);
    EXPECT_LT(looks_for(20s), 3ms);
    EXPECT_GT(clock.exchanges.last(), 150);
    EXPECT_GT(clock.lost.last(), 0);
    plant.time_link.faults.is_cut = true;
    const Duration before = clock.error.last();
    EXPECT_GT(looks_for(20s), before + 20s / 10000) << "nobody answers, and it says so";
    plant.time_link.faults.is_cut = false;
    run.run_for(2s);
    EXPECT_LT(clock.error.last(), 3ms);
    EXPECT_EQ(clock.jumps.last(), 0);
    plant.time_link.set_by(1s);
    run.run_for(2s);
    EXPECT_EQ(clock.jumps.last(), 1) << "somebody set it";
    EXPECT_LT(looks_for(5s), 4ms);
}

TEST_P(Operation, knows_where_the_body_is) {
    ASSERT_TRUE(comes_to("Operating")) << state();
    double worst = 0.0;
    for (int i = 0; i < 4000; ++i) {
        run.run_for(2ms);
        worst = std::max(worst,
                         (of<BodyEstimator>("body").model.last().frame.position - plant.now().body).norm());
    }
    EXPECT_LT(worst, 0.3e-3);
    const auto& camera = of<LedCamera>("camera");
    EXPECT_GT(camera.lost.last(), 0);
    EXPECT_GT(camera.invalid.last() + camera.late.last(), 0);
}

TEST_P(Operation, trusts_a_restarted_camera_within_a_second) {
    ASSERT_TRUE(comes_to("Operating")) << state();
    plant.camera.restart();
    run.run_for(1s);
    const auto& camera = of<LedCamera>("camera");
    const std::int64_t late = camera.late.last();
    run.run_for(2s);
    EXPECT_LE(camera.late.last() - late, 4) << "some are held up on their way, as before";
    for (int i = 0; i < 100; ++i) {
        run.run_for(20ms);
        EXPECT_LT((of<BodyEstimator>("body").model.last().frame.position - plant.now().body).norm(), 0.5e-3);
    }
}

TEST_P(Operation, continues_while_one_led_is_hidden) {
    ASSERT_TRUE(comes_to("Operating")) << state();
    plant.camera.faults.hidden_led = static_cast<int>(GetParam() % 6);
    run.run_for(5s);
    EXPECT_EQ(state(), "Operating");
    EXPECT_LT(worst_beside_path(5s), 0.5e-3);
}

TEST_P(Operation, stops_in_the_hole_while_the_body_is_not_seen_and_then_continues) {
    ASSERT_TRUE(comes_to("Operating")) << state();
    run.run_for(Duration{531ms} * static_cast<int>(GetParam()));
    plant.forget_worst();
    plant.camera.faults.covered = true;
    const Time covered = run.now();
    ASSERT_TRUE(comes_to("Holding", 1s)) << state();
    EXPECT_LT(run.now() - covered, 400ms) << "300 ms after the last exposure";
    ASSERT_TRUE(run.run_until([this] { return plant.stands(); }, 2s));
    run.run_for(9s); // more than two breaths
    EXPECT_TRUE(plant.now().is_inside);
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
    plant.camera.faults.covered = false;
    run.run_for(1s);
    plant.press("work", run.now() + 100ms);
    ASSERT_TRUE(comes_to("Operating", 30s)) << state();
    run.run_for(2s);
    EXPECT_LT(worst_beside_path(5s), 0.5e-3);
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
    EXPECT_LT(plant.worst_rates().maxCoeff(), 0.41);
}

TEST_P(Operation, never_leaves_the_hole_when_the_other_robot_stops_at_any_phase) {
    ASSERT_TRUE(comes_to("Operating")) << state();
    run.run_for(Duration{317ms} * static_cast<int>(GetParam()));
    plant.forget_worst();
    plant.forget_worst_shaft();
    plant.body_arm().leave_alone();
    plant.body_arm().press("stop", run.now() + 100ms);
    run.run_for(5s);
    EXPECT_EQ(state(), "Operating");
    EXPECT_LT(plant.worst_beside_hole(), 2e-3);
    EXPECT_LT(plant.worst_change(), 4.0) << "rad/s2";
    EXPECT_LT(worst_beside_path(5s), 0.4e-3) << "the body lies still";
}

TEST_P(Operation, leaves_the_hole_when_stop_is_pressed) {
    ASSERT_TRUE(comes_to("Operating")) << state();
    run.run_for(Duration{731ms} * static_cast<int>(GetParam()));
    plant.leave_alone();
    plant.press("stop", run.now() + 100ms);
    ASSERT_TRUE(comes_to("Waiting", 30s)) << state();
    EXPECT_FALSE(plant.now().is_inside);
    EXPECT_GT(plant.now().tip.z(), 0.03);
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
}

// Thesis 3.4.5: switching from joint space to Cartesian space looks atomic. At 1000 instants over all seeds:
// one Generator and one Controller run in every cycle.
TEST_P(Operation, is_handed_over_between_joints_and_frames_without_a_jump) {
    plant.leave_alone();
    plant.body_arm().leave_alone();
    plant.press("start", run.now() + 200ms);
    ASSERT_TRUE(comes_to("Waiting", 2s)) << state();
    ASSERT_TRUE(run.run_until([this] { return of<Replay>("replay").sees_body(); }, 1s));
    run.run_for(50ms); // and its state has been entered
    Random random{GetParam()};
    auto& drives = of<JointEffector>("drives");
    Joints before = drives.sent.last();
    double worst_jump = 0.0;
    const auto running = [&](std::initializer_list<std::string_view> among) {
        return std::ranges::count_if(among, [&](std::string_view each) {
            return run.instance().life().state_of(find_component(run.instance().machine().table, each)) ==
                   ComponentState::running;
        });
    };
    const auto look = [&] {
        run.run_for(2ms);
        ASSERT_EQ(running({"idle", "standing", "turning", "twisting", "path", "cartesian"}), 1);
        ASSERT_EQ(running({"pid", "forward"}), 1);
        const Joints now = drives.sent.last();
        worst_jump = std::max(worst_jump, (now - before).cwiseAbs().maxCoeff());
        before = now;
    };
    for (int i = 0; i < (1000 + SEEDS - 1) / SEEDS; ++i) {
        static constexpr std::array<std::string_view, 6> chains{"turn",     "twist", "path",
                                                                "path_pid", "tool",  "stand"};
        const std::string_view chain = chains[random.below(chains.size())];
        hands_over("mode", chain);
        for (int k = 0; k < 2; ++k) look();
        ASSERT_EQ(of<ChainSwitch>("mode").chain.last().view(), chain);
        const auto some = [&](double most) { return most * (2.0 * random.unit() - 1.0); };
        if (chain == "turn") of<Turning>("turning").turn(static_cast<int>(1 + random.below(6)), some(0.3));
        if (chain == "twist") {
            const double x = some(0.05), y = some(0.05), z = some(0.05);
            of<Twisting>("twisting").twist(x, y, z, 0, 0, 0);
        }
        if (chain.starts_with("path")) static_cast<void>(of<JointPath>("path").go_ready());
        for (auto steps = 1 + random.below(100); steps > 0; --steps) look();
        if (HasFatalFailure()) return;
    }
    EXPECT_LE(worst_jump, 4.0 * 0.002 + 1e-9) << "rad/s within a cycle: what the Effector may change";
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
}

INSTANTIATE_TEST_SUITE_P(seeds, Operation, testing::Range<std::uint64_t>(1, 1 + SEEDS));

std::uint64_t digest_of_a_run(std::uint64_t seed) {
    Plant plant{seed};
    VirtualRun run{on_host(), plant, seed};
    EXPECT_TRUE(run.start().has_value());
    run.run_for(50s);
    run.stop();
    return digest_of(run.instance(), plant);
}

TEST(TwoRobots, run_identically_for_the_same_seed) {
    const std::uint64_t first = digest_of_a_run(3);
    EXPECT_EQ(digest_of_a_run(3), first);
    EXPECT_NE(digest_of_a_run(4), first);
}

// Thesis 3.4.3: both robots have the same components but differ in their state machines; only one of them has
// to home and to move a body.
TEST(TwoRobots, share_one_set_of_component_types) {
    const auto types_of = [](const MachineView& table) {
        std::set<std::string_view> names;
        for (const ComponentRow& each : table.components) names.insert(each.type->tag->name);
        return names;
    };
    const auto here = types_of(k361::table.view()), there = types_of(k160::table.view());
    std::vector<std::string_view> in_both, only_there;
    std::ranges::set_intersection(here, there, std::back_inserter(in_both));
    std::ranges::set_difference(there, here, std::back_inserter(only_there));
    EXPECT_EQ(in_both.size(), 15u) << testing::PrintToString(in_both);
    const auto ends_with = [](const char* name) {
        return testing::ResultOf(
            [name](std::string_view type) {
                return type.ends_with(name) || type.contains(std::string{name} + "<");
            },
            testing::IsTrue());
    };
    EXPECT_THAT(only_there,
                testing::UnorderedElementsAre(ends_with("Homing"), ends_with("Kinematics"),
                                              ends_with("BodySimulation"), ends_with("ClockAnswers")));
}

} // namespace
} // namespace two_robots::k361
