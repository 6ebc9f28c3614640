// A loaded behaviour is on trial: until it has proved that it works, a failure brings the previous one back.
#include "tests/kernel/machine/slots/slot_rig.hpp"

namespace tappet::bakery {
namespace {

TEST_F(BehaviourSlotTest, a_trial_does_not_pass_while_the_script_is_idle) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(numbered(2, "exit { do oven.note(-1); }")), "");
    run(1s);
    EXPECT_EQ(slot.phase(), SlotPhase::trial) << "only its first program ran, in which nothing failed";
    tick();
    tick();
    EXPECT_EQ(slot.last_roll_back(), RollBack::error);
    EXPECT_EQ(state_now(), "Begin") << "the first is at work";
}

TEST_F(BehaviourSlotTest, a_script_that_fails_its_trial_is_rolled_back_and_its_line_reported) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load("StateMachine Failing {\n"
                   "    initial state A { entry { do oven.note(5); } transition oven.tick() select B }\n"
                   "    state B {\n"
                   "        entry { do oven.note(-1); } // which the oven refuses\n"
                   "        transition oven.tick() select A }\n"
                   "    final state End { entry { do oven.note(6); } } }"),
              "");
    run(2ms);
    tick(3ms);
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
    EXPECT_EQ(slot.last_roll_back(), RollBack::error);
    EXPECT_THAT(std::string{slot.describe_roll_back().view()}, HasSubstr("failed in line 4"));
    EXPECT_FALSE(instance.stop_asked());
    // It was brought to its safe state, and the old one restarts.
    EXPECT_THAT(oven().told, ElementsAre(11, 5, -1, 6, 1));
    tick();
    EXPECT_EQ(state_now(), "Ticked");
}

TEST_F(BehaviourSlotTest, a_script_that_never_completes_a_step_is_rolled_back) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load("var int n = 0; while (true) { set n = n + 1; }"), "");
    run(5ms);
    EXPECT_EQ(slot.last_roll_back(), RollBack::left_over);
    EXPECT_THAT(std::string{slot.describe_roll_back().view()}, HasSubstr("exceeded their number"));
    EXPECT_EQ(state_now(), "Begin");
}

TEST_F(BehaviourSlotTest, a_first_script_that_fails_its_trial_leaves_the_slot_empty) {
    EXPECT_EQ(load("do oven.note(-1);"), "");
    run(5ms);
    EXPECT_EQ(slot.phase(), SlotPhase::empty);
    EXPECT_EQ(slot.roll_backs(), 1u);
    EXPECT_FALSE(instance.stop_asked());
}

TEST_F(BehaviourSlotTest, an_error_after_the_trial_is_handled_as_its_row_says) {
    load_and_settle(
        "StateMachine Late { var int left = 6; initial state A {\n"
        "entry { do oven.note(left); set left = left - 1; } transition oven.tick() select B }\n"
        "state B { entry { do oven.note(left); set left = left - 1; } transition oven.tick() select A }\n"
        "final state E {} }");
    for (int i = 0; i < 3; ++i) {
        EXPECT_FALSE(instance.stop_asked());
        tick(3ms);
    }
    EXPECT_TRUE(instance.stop_asked());
    EXPECT_THAT(std::string{instance.describe_stop().view()}, HasSubstr("failed in line 3"));
}

TEST_F(BehaviourSlotTest, no_other_script_is_loaded_during_a_trial) {
    EXPECT_EQ(load(numbered(1)), "");
    run(3ms);
    EXPECT_THAT(compile(numbered(2)), HasSubstr("is on trial"));
    settle();
    EXPECT_EQ(load(numbered(2), "door.moved"), "");
    run(3ms);
    EXPECT_THAT(compile(numbered(3)), HasSubstr("another change of behaviour"));
}

/// Returns a script that takes `us` microseconds for every second tick.
std::string takes(int us) {
    return "StateMachine Slow { initial state A { transition oven.tick() select B }\n"
           "state B { entry { do oven.bake(" +
           std::to_string(us) + "); } transition oven.tick() select A }\nfinal state End {} }";
}

TEST_F(BehaviourSlotTest, a_script_that_delays_its_activity_on_trial_is_rolled_back) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(takes(2000)), "");
    run(3ms);
    ASSERT_EQ(slot.phase(), SlotPhase::trial);
    tick(5ms);
    EXPECT_EQ(slot.last_roll_back(), RollBack::late);
    EXPECT_EQ(
        slot.describe_roll_back().view(),
        "rolled back: test.osd: it made its activity miss a deadline; let the script do less in one step");
    EXPECT_EQ(state_now(), "Begin") << "the first is at work";
}

TEST_F(BehaviourSlotTest, a_script_that_exceeds_the_claim_on_trial_is_rolled_back) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(takes(200)), "");
    run(3ms);
    // An engine measures processor time only from the first cycle on that exceeds its budget.
    for (int i = 0; i < 3; ++i) {
        tick();
    }
    run(2ms);
    EXPECT_EQ(slot.last_roll_back(), RollBack::too_much);
    EXPECT_THAT(std::string{slot.describe_roll_back().view()},
                HasSubstr("more of its processor than its row claims"));
    EXPECT_EQ(state_now(), "Begin");
}

TEST_F(BehaviourSlotTest, a_script_is_not_rolled_back_when_a_component_exceeds_the_budget) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(numbered(2)), "");
    run(3ms);
    ASSERT_EQ(slot.phase(), SlotPhase::trial);
    oven().takes = 200us;
    for (int i = 0; i < 8; ++i) tick();
    EXPECT_GT(instance.engines()[0].statistics().over_claim, 0u);
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
    EXPECT_EQ(slot.last_roll_back(), RollBack::none);
}

TEST_F(BehaviourSlotTest, a_script_is_interrupted_between_statements_at_the_deadline) {
    load_and_settle(numbered(1));
    // Six milliseconds of work, which the limit of statements alone would allow in one cycle.
    EXPECT_EQ(load("StateMachine Slow { var int i = 0; initial state A { transition oven.tick() select B }\n"
                   "state B { entry { while (i < 20) { do oven.bake(300); set i = i + 1; } } "
                   "exit { do oven.note(77); } transition oven.tick() select A }\nfinal state End {} }"),
              "");
    run(3ms);
    ASSERT_EQ(slot.phase(), SlotPhase::trial);
    const Time before = instance.clock().now();
    tick();
    EXPECT_LT(instance.clock().now() - before, 4ms);
    EXPECT_EQ(slot.last_roll_back(), RollBack::left_over);
    EXPECT_THAT(oven().told, testing::Contains(77)) << "its exit program runs although the time is used up";
    EXPECT_EQ(state_now(), "Begin") << "the first is at work";
}

TEST_F(BehaviourSlotTest, a_script_within_its_claim_is_kept) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(takes(40)), "");
    settle();
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
    EXPECT_EQ(state_now(), "B");
}

} // namespace
} // namespace tappet::bakery
