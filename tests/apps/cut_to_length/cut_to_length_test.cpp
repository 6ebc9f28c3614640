// The cutter with its plant under virtual time: each piece has its length, and nothing is cut that should not
// be.
#include "apps/cut_to_length/line.hpp"
#include "toolchain/machine/test.hpp"

#include <gtest/gtest-spi.h>

namespace cut_to_length {
namespace {

TEST_F(MachineTest, fails_a_case_that_names_a_component_or_a_state_that_the_machine_lacks) {
    EXPECT_TRUE(comes_to("line", "locked", 1s));
    EXPECT_TRUE(is_in("line", "locked"));
    EXPECT_FALSE(is_in("line", "running"));
    const Time before = run.now();
    EXPECT_NONFATAL_FAILURE(
        EXPECT_FALSE(comes_to("line", "runing", 60s)),
        "the state machine of \"line\" has no state \"runing\"; did you mean \"running\"?");
    EXPECT_EQ(run.now(), before) << "nobody waits for a state that cannot come";
    EXPECT_NONFATAL_FAILURE(static_cast<void>(is_in("lime", "running")),
                            "the machine has no component \"lime\"; did you mean \"line\"?");
    EXPECT_NONFATAL_FAILURE(static_cast<void>(state_of("lime")), "no component \"lime\"");
    EXPECT_NONFATAL_FAILURE(static_cast<void>(comes_to("can", "running", 1s)),
                            "no state machine drives component \"can\"");
    EXPECT_THROW(static_cast<void>(of<Line>("lime")), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(of<Line>("can")), std::invalid_argument) << "it has another type";
    EXPECT_EQ(&of<Line>("line"), run.instance().find<Line>("line"));
}

struct Cutter : MachineTest, testing::WithParamInterface<std::uint64_t> {
    Cutter() : MachineTest{GetParam()} {}
    [[nodiscard]] std::string_view state() {
        const auto path = run.instance().state_machine_of("line")->path();
        return path.empty() ? std::string_view{} : path[0];
    }
};

TEST_P(Cutter, cuts_each_piece_to_its_length_while_the_web_runs_up_runs_and_stops) {
    ASSERT_TRUE(run.run_until([this] { return plant.is_done(); }, 60s)) << plant.pieces() << " pieces";
    EXPECT_GE(plant.pieces(), 60);
    EXPECT_LT(plant.worst_mm(), 0.5);
    EXPECT_TRUE(plant.fault().empty()) << plant.fault().view();
    EXPECT_EQ(state(), "ready");
}

TEST_P(Cutter, stops_in_an_emergency_and_resumes_when_released_and_started) {
    ASSERT_TRUE(run.run_until([this] { return plant.pieces() >= 5; }, 20s));
    plant.press_emergency_stop(true);
    ASSERT_TRUE(run.run_until([this] { return plant.web_stands(); }, 3s));
    EXPECT_EQ(state(), "emergency");
    const std::int64_t pieces = plant.pieces();
    plant.press_start(run.now() + 100ms);
    run.run_for(2s);
    EXPECT_EQ(state(), "emergency") << "it is still pressed";
    const StateMachineExecution& line = *run.instance().state_machine_of("line");
    ASSERT_GT(line.refusals().number, 0u) << "the start that was refused is told";
    EXPECT_EQ(line.machine().table.transitions[line.refusals().transition].refusal.text,
              "the line may not be unlocked");
    EXPECT_EQ(run.instance().find<Line>("line")->obstacle(), "the emergency stop is pressed");
    EXPECT_EQ(plant.pieces(), pieces);
    plant.press_emergency_stop(false);
    plant.press_start(run.now() + 100ms);
    ASSERT_TRUE(run.run_until([this] { return state() == "ready"; }, 1s));
    plant.press_start(run.now() + 300ms);
    EXPECT_TRUE(run.run_until([&] { return plant.pieces() > pieces + 5; }, 20s));
    EXPECT_LT(plant.worst_mm(), 0.5) << "the web was measured while it stood, too";
}

TEST_P(Cutter, goes_to_emergency_when_the_drive_falls_silent_and_does_not_start_again_by_itself) {
    ASSERT_TRUE(run.run_until([this] { return plant.pieces() >= 2; }, 20s));
    plant.silence_drive();
    run.run_for(100ms);
    EXPECT_EQ(run.instance().find<Line>("line")->target.last(), 0.0);
    EXPECT_EQ(state(), "emergency");
}

TEST_P(Cutter, goes_to_emergency_when_the_wheel_falls_silent) {
    ASSERT_TRUE(run.run_until([this] { return plant.pieces() >= 2; }, 20s));
    plant.silence_wheel();
    ASSERT_TRUE(run.run_until([this] { return plant.web_stands(); }, 3s));
    EXPECT_EQ(state(), "emergency");
}

TEST_P(Cutter, does_not_run_a_web_without_a_measurement) {
    ASSERT_TRUE(run.run_until([this] { return plant.is_done(); }, 60s));
    plant.silence_wheel();
    run.run_for(100ms);
    EXPECT_EQ(state(), "emergency") << "though nothing moves";
    plant.press_start(run.now() + 100ms);
    run.run_for(1s);
    EXPECT_EQ(state(), "emergency");
    EXPECT_EQ(run.instance().find<Line>("line")->obstacle(), "the measuring wheel is not to be relied on");
}

TEST_P(Cutter, does_not_cut_a_web_that_is_pulled_by_hand) {
    ASSERT_TRUE(run.run_until([this] { return plant.pieces() >= 2; }, 20s));
    plant.press_emergency_stop(true);
    ASSERT_TRUE(run.run_until([this] { return plant.web_stands(); }, 3s));
    EXPECT_FALSE(plant.knife_is_driven());
    const std::int64_t cuts = plant.cuts();
    for (int i = 0; i < 2000; ++i) {
        plant.pull_web(1.0);
        run.run_for(2ms);
    }
    EXPECT_EQ(plant.cuts(), cuts);
}

INSTANTIATE_TEST_SUITE_P(seeds, Cutter, testing::Values(1, 2, 3));

} // namespace
} // namespace cut_to_length
