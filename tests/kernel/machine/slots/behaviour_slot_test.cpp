// A behaviour is loaded into a running machine (thesis 5.1.4, 5.2.4: programs and state machines are loaded
// at run time): the old one ends safely, and a faulty one changes nothing.
#include "tests/kernel/machine/slots/slot_rig.hpp"

#include <limits>

namespace tappet::bakery {
namespace {

TEST_F(BehaviourSlotTest, a_loaded_script_receives_arguments_too_large_for_a_message) {
    load_and_settle(R"(StateMachine Cooking {
        var double a = 0.0; var double b = 0.0; var double c = 0.0; var double d = 0.0; var double e = 0.0; var double f = 0.0;
        var int pieces = 0;
        initial state Waiting { transition oven.recipe(a, b, c, d, e, f, pieces) select Cooking
                                transition oven.tick() select Waiting }
        state Cooking { entry { set oven.target = f; do oven.note(pieces); }
                        transition oven.tick() select Waiting
                        transition oven.recipe(a, b, c, d, e, f, pieces) if f > 100.0 then select Cooking }
        final state Off {}
    })");
    for (std::int64_t n = 1; n <= 4; ++n)
        oven().recipe.emit(1, 2, 3, 4, 5, n == 3 ? 50.0 : 200.0 + static_cast<double>(n), n);
    run(10ms);
    EXPECT_THAT(oven().told, ElementsAre(1, 2, 4)) << "its guard refused the third";
    EXPECT_EQ(oven().target.get(), 204.0);
}

TEST_F(BehaviourSlotTest, a_script_is_loaded_into_an_empty_slot_and_runs) {
    EXPECT_EQ(slot.phase(), SlotPhase::empty);
    EXPECT_EQ(load(numbered(1)), "");
    run(2ms);
    EXPECT_EQ(slot.phase(), SlotPhase::trial);
    EXPECT_EQ(slot.script(), "test.osd");
    EXPECT_THAT(oven().told, ElementsAre(1));
    tick();
    EXPECT_THAT(oven().told, ElementsAre(1, 10));
    settle();
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
}

TEST_F(BehaviourSlotTest, events_are_connected_only_while_loaded_behaviours_need_them) {
    tick();
    EXPECT_EQ(posted("tick"), 0u);
    load_and_settle(numbered(1));
    const std::uint64_t heard = posted("tick");
    oven().tick.emit();
    door().moved.emit();
    run(2ms);
    EXPECT_EQ(posted("tick"), heard + 1);
    EXPECT_EQ(posted("moved"), 0u);
    EXPECT_EQ(request(BehaviourSlot::Change::unload), "");
    run(3ms);
    tick();
    EXPECT_EQ(posted("tick"), heard + 1);
}

TEST_F(BehaviourSlotTest, a_faulty_script_is_refused_with_its_line_and_the_old_one_continues) {
    load_and_settle(numbered(1));
    EXPECT_THAT(load("StateMachine Faulty {\n    initial state A {\n        entry { do oven.notes(1); }\n"),
                HasSubstr("test.osd:3:"));
    EXPECT_THAT(load("StateMachine Faulty {\n    initial state A {\n        entry { do oven.notes(1); }\n"),
                HasSubstr("did you mean \"note\"?"));
    run(5ms);
    tick();
    EXPECT_THAT(oven().told, ElementsAre(10));
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
}

TEST_F(BehaviourSlotTest, the_old_behaviour_reaches_its_final_state_before_the_new_one_starts) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(numbered(2)), "");
    run(2ms);
    EXPECT_THAT(oven().told, ElementsAre(11, 2));
}

std::string ends_after(std::string_view wait) {
    return "StateMachine Slow { initial state A { transition oven.tick() select B }\n"
           "state B { transition oven.tick() select A }\n"
           "final state End { entry { wait(" +
           std::string{wait} + "); do oven.note(2); } } }";
}

TEST_F(BehaviourSlotTest, an_old_behaviour_gets_the_time_it_needs_to_end) {
    load_and_settle(ends_after("20ms"));
    EXPECT_EQ(load(numbered(3)), "");
    run(10ms);
    EXPECT_EQ(slot.phase(), SlotPhase::handing_over);
    EXPECT_THAT(oven().told, IsEmpty());
    run(20ms);
    EXPECT_THAT(oven().told, ElementsAre(2, 3));
}

TEST_F(BehaviourSlotTest, a_waiting_final_state_ends_before_its_component_stops) {
    load_and_settle(ends_after("20ms"));
    const Time begun = clock.now();
    world.stop();
    EXPECT_THAT(oven().told, ElementsAre(2));
    EXPECT_EQ(clock.now() - begun, 20ms);
    for (std::size_t a = 0; a < instance.engines().size(); ++a)
        EXPECT_EQ(instance.observation().describe_end(a).view(), "");
}

/// Takes 20 ms to end.
constexpr std::string_view slow_to_end =
    "StateMachine Slow { initial state A { entry { do oven.note(1); } transition oven.tick() select B }\n"
    "state B { transition oven.tick() select A }\n"
    "final state End { entry { wait(20ms); do oven.note(2); } } }";

TEST_F(BehaviourSlotTest, a_component_alone_stops_after_its_final_state) {
    load_and_settle(slow_to_end);
    const std::size_t c = find_component(instance.machine().table, "oven");
    const LifeTicket ticket = instance.life().ask_component(c, LifeChange::restart);
    run(10ms);
    EXPECT_EQ(instance.life().answer_of_component(c, ticket).outcome, LifeOutcome::pending);
    EXPECT_EQ(instance.life().state_of(c), ComponentState::running);
    EXPECT_THAT(oven().told, IsEmpty());
    run(15ms);
    EXPECT_EQ(instance.life().answer_of_component(c, ticket).outcome, LifeOutcome::done);
    EXPECT_THAT(oven().told, ElementsAre(2, 1));
    EXPECT_EQ(state_now(), "A") << "and begins anew";
}

TEST_F(BehaviourSlotTest, a_final_state_that_times_out_ends_at_the_next_start) {
    load_and_settle(ends_after("300ms"));
    const Time begun = clock.now();
    world.stop();
    EXPECT_EQ(clock.now() - begun, Engine::end_limit);
    EXPECT_THAT(oven().told, IsEmpty());
    std::string told;
    for (std::size_t a = 0; a < instance.engines().size(); ++a)
        told += instance.observation().describe_end(a).view();
    EXPECT_EQ(told, "the behaviour of \"oven\" was left in \"End\": 100 ms after the request to end it had "
                    "not ended; it ends first when it is started again; shorten its way to the end");
    EXPECT_EQ(world.start().view(), "");
    run(310ms);
    EXPECT_THAT(oven().told, ElementsAre(2));
    EXPECT_EQ(state_now(), "A");
}

TEST_F(BehaviourSlotTest, a_script_takes_over_at_an_event_in_its_reach) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(numbered(2), "door.moved"), "");
    run(50ms);
    EXPECT_EQ(slot.phase(), SlotPhase::waiting);
    tick();
    EXPECT_THAT(oven().told, ElementsAre(10)); // the old one is running
    door().moved.emit();
    run(2ms);
    EXPECT_THAT(oven().told, ElementsAre(10, 11, 2));
}

TEST_F(BehaviourSlotTest, a_script_takes_over_when_its_angle_is_passed_upwards) {
    for (const double wanted : {0.0, 85.0, 90.0, 355.0}) {
        load_and_settle(numbered(1));
        EXPECT_EQ(load(numbered(2), std::to_string(wanted)), "");
        for (int i = 0; i < 100 && oven().told.empty(); ++i) run(1ms);
        const double at = oven().angle_deg.last();
        double past = at - wanted;
        while (past < 0) past += 360;
        EXPECT_LT(past, 10.0) << "wanted " << wanted << ", was " << at; // one step turns 10 degrees
        settle();
    }
}

TEST_F(BehaviourSlotTest, a_script_does_not_take_over_while_the_angle_jitters_elsewhere) {
    oven().trembles = true;
    oven().from_deg = 70.0;
    load_and_settle(numbered(1));
    EXPECT_EQ(load(numbered(2), "180"), "");
    run(50ms);
    EXPECT_EQ(slot.phase(), SlotPhase::waiting);
    oven().from_deg = 190.0;
    run(2ms);
    EXPECT_NE(slot.phase(), SlotPhase::waiting);
}

TEST_F(BehaviourSlotTest, an_angle_of_any_size_is_checked_in_constant_time) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(numbered(2), "85"), "");
    for (const double astray : {-1e18, 1e18, -1e300, std::numeric_limits<double>::quiet_NaN()}) {
        oven().from_deg = astray;
        run(2ms); // one turn at a time, this would never end
    }
    oven().from_deg = -3600.0; // ten turns back is the same angle
    run(80ms);
    settle();
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
    EXPECT_THAT(oven().told, testing::Contains(2));
}

TEST_F(BehaviourSlotTest, an_invalid_moment_is_refused_with_the_nearest_name) {
    SlotMoment moment;
    EXPECT_THAT(std::string{slot.parse_moment("door.mved", moment).view()},
                HasSubstr("did you mean \"door.moved\"?"));
    EXPECT_THAT(std::string{slot.parse_moment("360", moment).view()}, HasSubstr("between 0 and 360"));
    EXPECT_THAT(std::string{slot.parse_moment("-1", moment).view()}, HasSubstr("between 0 and 360"));
    EXPECT_THAT(std::string{slot.parse_moment("nan", moment).view()}, HasSubstr("has no event \"nan\""));
}

TEST_F(BehaviourSlotTest, the_previous_behaviour_returns_on_roll_back) {
    load_and_settle(numbered(1));
    load_and_settle(numbered(2));
    EXPECT_EQ(request(BehaviourSlot::Change::roll_back), "");
    run(3ms);
    EXPECT_THAT(oven().told, ElementsAre(21, 1));
    EXPECT_EQ(slot.last_roll_back(), RollBack::asked);
    EXPECT_EQ(request(BehaviourSlot::Change::unload), "");
    run(3ms);
    EXPECT_EQ(slot.phase(), SlotPhase::empty);
    EXPECT_THAT(oven().told, ElementsAre(21, 1, 11));
    EXPECT_THAT(request(BehaviourSlot::Change::unload), HasSubstr("nothing is loaded"));
}

TEST_F(BehaviourSlotTest, a_waiting_script_ignores_the_moment_of_another_change) {
    load_and_settle(numbered(1));
    EXPECT_EQ(load(numbered(2), "door.moved"), "");
    run(3ms);
    ASSERT_EQ(slot.phase(), SlotPhase::waiting);
    ASSERT_TRUE(slot.ask(BehaviourSlot::Change::unload)); // now; its engine does not know it yet
    run(5ms);
    EXPECT_EQ(slot.phase(), SlotPhase::waiting);
    EXPECT_THAT(oven().told, IsEmpty()) << "the first is at work";
    ASSERT_TRUE(instance.requests().post_change(slot));
    run(3ms);
    EXPECT_EQ(slot.phase(), SlotPhase::empty);
    EXPECT_THAT(oven().told, ElementsAre(11)) << "the first came to its end, and the second was never there";
}

TEST_F(BehaviourSlotTest, a_roll_back_discards_a_waiting_script_and_keeps_the_running_one) {
    load_and_settle(numbered(1));
    load_and_settle(numbered(2));
    EXPECT_EQ(load(numbered(3), "door.moved"), "");
    run(2ms);
    ASSERT_EQ(slot.phase(), SlotPhase::waiting);
    EXPECT_EQ(request(BehaviourSlot::Change::roll_back), "");
    run(2ms);
    door().moved.emit();
    run(2ms);
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
    EXPECT_THAT(oven().told, IsEmpty());
    tick();
    EXPECT_THAT(oven().told, ElementsAre(20)) << "the second";
    EXPECT_THAT(request(BehaviourSlot::Change::roll_back), HasSubstr("no earlier behaviour"))
        << "the third was compiled over the first";
}

TEST_F(BehaviourSlotTest, a_roll_back_to_an_overwritten_bank_is_refused) {
    EXPECT_THAT(request(BehaviourSlot::Change::roll_back), HasSubstr("no earlier behaviour"));
    load_and_settle(numbered(1));
    load_and_settle(numbered(2));
    EXPECT_THAT(compile("nonsense"), HasSubstr("test.osd:1:1"));
    EXPECT_THAT(request(BehaviourSlot::Change::roll_back), HasSubstr("no earlier behaviour"));
    run(3ms);
    EXPECT_EQ(state_now(), "Begin");
}

TEST_F(BehaviourSlotTest, a_script_beyond_the_room_or_reach_of_the_slot_is_refused) {
    std::string many = "StateMachine Many { initial state A { entry {";
    for (int i = 0; i < 60; ++i) many += "do oven.note(1);";
    many += "} transition oven.tick() select A } final state E {} }";
    EXPECT_THAT(load(many), HasSubstr("test.osd:"));
    EXPECT_THAT(load("wait(1ms); wait(2ms); wait(3ms);"), HasSubstr("time"));
    EXPECT_THAT(load("set door.opn = true;"), HasSubstr("\"open\""));
    EXPECT_EQ(slot.phase(), SlotPhase::empty);
}

TEST_F(BehaviourSlotTest, a_bank_with_a_pending_command_is_not_overwritten) {
    EXPECT_EQ(load("StateMachine Feeding { initial state A { run { do feeder.feed(10); wait(1s); }\n"
                   "transition oven.tick() select B } state B { transition oven.tick() select A }\n"
                   "final state E {} }"),
              "");
    run(22ms); // ten pieces take 50 ms
    EXPECT_EQ(load(numbered(2)), "");
    settle();
    EXPECT_EQ(slot.phase(), SlotPhase::steady);
    EXPECT_THAT(compile(numbered(3)), HasSubstr("is still on its way"));
    run(100ms);
    EXPECT_EQ(compile(numbered(3)), "");
}

TEST_F(BehaviourSlotTest, a_restarting_behaviour_stays_ended_when_another_takes_over) {
    load_and_settle(slow_to_end);
    static_cast<void>(instance.life().ask_component(0, LifeChange::restart));
    run(10ms);
    EXPECT_EQ(load(numbered(3)), "");
    run(50ms);
    EXPECT_THAT(oven().told, ElementsAre(2, 3));
}

TEST_F(BehaviourSlotTest, a_replaced_behaviour_does_not_restart_with_its_component) {
    load_and_settle(slow_to_end);
    EXPECT_EQ(load(numbered(3)), "");
    run(10ms);
    EXPECT_EQ(slot.phase(), SlotPhase::handing_over);
    static_cast<void>(instance.life().ask_component(0, LifeChange::restart));
    run(50ms);
    EXPECT_THAT(oven().told, ElementsAre(2, 3));
}

TEST_F(BehaviourSlotTest, a_component_stop_ends_the_behaviour_safely_and_a_start_restarts_it) {
    load_and_settle(numbered(1));
    static_cast<void>(instance.life().ask_component(0, LifeChange::stop));
    run(3ms);
    EXPECT_THAT(oven().told, ElementsAre(11));
    static_cast<void>(instance.life().ask_component(0, LifeChange::start));
    run(3ms);
    EXPECT_THAT(oven().told, ElementsAre(11, 1));
}

} // namespace
} // namespace tappet::bakery
