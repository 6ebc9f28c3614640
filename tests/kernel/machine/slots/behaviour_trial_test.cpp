// A behaviour that was loaded is on trial: until it has shown that it works, the one before it comes back.
#include "tests/kernel/machine/slots/slot_rig.hpp"

namespace tappet::bakery {
namespace {

TEST_F(BehaviourSlotTest, while_nobody_asks_it_for_anything_its_trial_does_not_pass) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(numbered(2, "exit { do oven.note(-1); }")), "");
    run(1s);
    EXPECT_EQ(slot.phase(), SlotPhase::trial) << "only its first program ran, in which nothing failed";
    tick();
    tick();
    EXPECT_EQ(slot.last_roll_back(), RollBack::error);
    EXPECT_EQ(state_now(), "Begin") << "the first is at work";
}

TEST_F(BehaviourSlotTest, one_that_fails_in_its_trial_is_taken_back_and_its_line_is_told) {
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
    // It was brought to its safe state, and the old one begins anew.
    EXPECT_THAT(oven().told, ElementsAre(11, 5, -1, 6, 1));
    tick();
    EXPECT_EQ(state_now(), "Ticked");
}

TEST_F(BehaviourSlotTest, one_that_does_not_come_to_an_end_of_a_step_is_taken_back) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load("var int n = 0; while (true) { set n = n + 1; }"), "");
    run(5ms);
    EXPECT_EQ(slot.last_roll_back(), RollBack::left_over);
    EXPECT_THAT(std::string{slot.describe_roll_back().view()}, HasSubstr("did not come to an end"));
    EXPECT_EQ(state_now(), "Begin");
}

TEST_F(BehaviourSlotTest, one_that_fails_in_its_trial_with_none_before_leaves_the_slot_empty) {
    EXPECT_EQ(load("do oven.note(-1);"), "");
    run(5ms);
    EXPECT_EQ(slot.phase(), SlotPhase::empty);
    EXPECT_EQ(slot.roll_backs(), 1u);
    EXPECT_FALSE(instance.stop_asked());
}

TEST_F(BehaviourSlotTest, an_error_after_the_trial_does_what_its_row_says) {
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

TEST_F(BehaviourSlotTest, while_one_is_on_trial_no_other_is_loaded) {
    EXPECT_EQ(load(numbered(1)), "");
    run(3ms);
    EXPECT_THAT(compile(numbered(2)), HasSubstr("is on trial"));
    settle();
    EXPECT_EQ(load(numbered(2), "door.moved"), "");
    run(3ms);
    EXPECT_THAT(compile(numbered(3)), HasSubstr("another change of behaviour"));
}

/// Takes so many microseconds for a tick.
std::string takes(int us) {
    return "StateMachine Slow { initial state A { transition oven.tick() select B }\n"
           "state B { entry { do oven.bake(" +
           std::to_string(us) + "); } transition oven.tick() select A }\nfinal state End {} }";
}

TEST_F(BehaviourSlotTest, one_that_makes_its_activity_late_on_trial_is_taken_back) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(takes(2000)), "");
    run(3ms);
    ASSERT_EQ(slot.phase(), SlotPhase::trial);
    tick(5ms);
    EXPECT_EQ(slot.last_roll_back(), RollBack::late);
    EXPECT_EQ(slot.describe_roll_back().view(),
              "taken back: test.osd: its activity missed a deadline by it; let it do less in one step");
    EXPECT_EQ(state_now(), "Begin") << "the first is at work";
}

TEST_F(BehaviourSlotTest, one_that_uses_more_than_its_activity_claims_on_trial_is_taken_back) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(takes(200)), "");
    run(3ms);
    for (int i = 0; i < 3; ++i) { // an engine measures its processor once it was busy beyond its budget
        tick();
    }
    run(2ms);
    EXPECT_EQ(slot.last_roll_back(), RollBack::too_much);
    EXPECT_THAT(std::string{slot.describe_roll_back().view()},
                HasSubstr("more of its processor than its row claims"));
    EXPECT_EQ(state_now(), "Begin");
}

TEST_F(BehaviourSlotTest, one_is_not_taken_back_for_what_a_component_of_its_activity_takes) {
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

TEST_F(BehaviourSlotTest, one_whose_statements_take_until_the_deadline_is_stopped_between_two_of_them) {
    load_and_settle(numbered(1));
    // Six milliseconds of work, which the number of statements alone would let one cycle do.
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

TEST_F(BehaviourSlotTest, one_that_stays_within_its_claim_is_kept) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(takes(40)), "");
    settle();
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
    EXPECT_EQ(state_now(), "B");
}

} // namespace
} // namespace tappet::bakery
