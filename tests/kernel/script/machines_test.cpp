// State machines of the script language: nested states, regions, history, time, children, functions (thesis
// 5.2.1, 5.2.4, and its future work).
#include "tests/kernel/script/fixture.hpp"

#include <gmock/gmock.h>

namespace {

using namespace script_test;

TEST(A_state_machine, enters_nested_states_and_remembers_them) {
    Started p{R"(
StateMachine M {
    initial state Idle {
        transition startMovement select Work
        transition startCalibration select history(Work)
        transition startLocalisation select deep history(Work)
    }
    state Work {
        transition halt select Idle
        initial state Easy { transition moveCamera select Hard }
        state Hard {
            initial state Begin { transition seen select Middle }
            state Middle { }
        }
    }
    final state Safe { }
}
RootStateMachine M m)",
              "m"};
    p.event("m", "startMovement");
    EXPECT_EQ(p.state("m"), "Easy");
    p.event("m", "moveCamera", 1.0);
    p.event("m", "seen", std::int32_t{1}, Position{});
    EXPECT_EQ(p.state("m"), "Middle");
    p.event("m", "halt");
    p.event("m", "startCalibration");
    EXPECT_EQ(p.state("m"), "Begin");
    p.event("m", "seen", std::int32_t{1}, Position{});
    p.event("m", "halt");
    p.event("m", "startLocalisation");
    EXPECT_EQ(p.state("m"), "Middle");
}

TEST(A_state_machine, has_parallel_regions) {
    Started p{R"(
StateMachine M {
    initial state Both {
        region left {
            initial state L1 { entry { do note(1); } transition halt select L2 }
            state L2 { entry { do note(2); } }
        }
        region right {
            initial state R1 { entry { do note(3); } transition halt select R2 }
            state R2 { entry { do note(4); } transition halt select Safe }
        }
        transition startMovement select Safe
    }
    final state Safe { }
}
RootStateMachine M m)",
              "m"};
    EXPECT_EQ(p.own.trace, "1 3");
    p.event("m", "halt");
    EXPECT_EQ(p.own.trace, "1 3 2 4");
    p.event("m", "startMovement");
    EXPECT_EQ(p.state("m"), "Safe");
}

TEST(A_state_machine, can_name_the_parent_of_a_state_with_in) {
    Started p{R"(
StateMachine M {
    initial state Outer { transition halt select Safe }
    initial state Inner in Outer region first { transition startMovement select Other }
    state Other in Outer region first { }
    initial state Beside in Outer region second { }
    final state Safe { }
})"};
    p.event("M", "startMovement");
    EXPECT_TRUE(p.machine("M").is_in(2));
    EXPECT_TRUE(p.machine("M").is_in(3));
}

TEST(A_script, names_device_facets_as_tables_do) {
    Started p{R"(
StateMachine M {
    initial state Low { transition robot.line.rises select High }
    state High { entry { do robot.line.beep(2); } transition halt select Low }
    final state Safe { }
})"};
    p.event("M", "robot.line.rises");
    EXPECT_EQ(p.state("M"), "High");
    EXPECT_EQ(p.robot.trace, "beep2");
    EXPECT_THAT(fault_of("StateMachine M { initial state A { transition robot.line.raises select B } "
                         "state B { transition halt select A } final state S { } }"),
                testing::HasSubstr("did you mean \"line.rises\"?"));
}

TEST(A_transition, reports_why_its_condition_refuses) {
    Played p{R"(
StateMachine M {
    var bool warm = false
    initial state Cold { transition startMovement if warm because "product is cold" then select Runs }
    state Runs { transition halt select Cold }
    final state Safe { }
})"};
    StateMachineExecution& machine = p.machine("M");
    static_cast<void>(machine.start(p.now()));
    EXPECT_EQ(machine.refusals().number, 0u);
    p.event("M", "startMovement");
    EXPECT_EQ(p.state("M"), "Cold");
    ASSERT_EQ(machine.refusals().number, 1u);
    EXPECT_EQ(machine.machine().table.transitions[machine.refusals().transition].refusal.text,
              "product is cold");
    EXPECT_EQ(machine.look(0, p.now()).answer, StateMachineExecution::Look::Answer::guard);
}

TEST(A_transition, is_refused_with_an_empty_reason) {
    EXPECT_THAT(
        fault_of("StateMachine M { initial state A { transition halt if true because \"\" then select B } "
                 "state B { transition halt select A } final state S { } }"),
        testing::HasSubstr("the reason is empty; say what is missing"));
}

TEST(A_timed_transition, fires_after_its_state_was_active_for_its_time) {
    Started p{R"(
StateMachine M {
    initial state Wait {
        transitions { after(30 ms) { do note(1); } select Safe because "nothing came" }
    }
    final state Safe { }
})"};
    p.steps(2);
    EXPECT_EQ(p.state("M"), "Wait");
    p.step();
    EXPECT_EQ(p.state("M"), "Safe");
    EXPECT_EQ(p.machine("M").reason(), "nothing came");
}

TEST(A_state_machine, commands_and_queries_its_children_and_their_variables) {
    Played p{R"(
StateMachine Axis {
    param int number
    var double target = 0
    initial state Off { entry { do note(number); } transition startMovement select On }
    state On { entry { do note(number * 10); } transitions { if target > 1.0 then select Moved } }
    state Moved { entry { do note(number * 100); } transition startMovement select Off }
    final state Safe { entry { do note(number * 1000); } }
}
StateMachine Pair {
    SubStateMachine Axis left(1)
    SubStateMachine Axis right(2)
    initial state Begin {
        entry { do left.start(); do right.activate(); set left.target = 2.5; do right.requestState(Off); }
        transition halt select Run
    }
    state Run {
        entry { if left.inState("Off") && !right.isRunning() then do note(int(left.target * 2)); do right.start(); }
        transition halt select Safe
    }
    final state Safe { entry { do left.stop(); do right.stop(); } exit { do left.deactivate(); do right.deactivate(); } }
}
RootStateMachine Pair pair)"};
    EXPECT_EQ(p.outcome.unit.instances.size(), 3u);
    static_cast<void>(p.machine("pair").start(p.now()));
    EXPECT_EQ(p.own.trace, "1 2");
    p.event("pair", "halt");
    EXPECT_EQ(p.own.trace, "1 2 5");
    p.event("pair.left", "startMovement");
    p.step();
    EXPECT_EQ(p.state("pair.left"), "Moved");
    p.event("pair", "halt");
    EXPECT_EQ(p.own.trace, "1 2 5 10 100 1000 2000");
    static_cast<void>(p.machine("pair").deactivate(p.now()));
    EXPECT_FALSE(p.machine("pair.left").is_active());
}

TEST(A_run_program, waits_across_steps_while_events_continue) {
    Started p{R"(
StateMachine M {
    const duration pause = 20ms
    function count(int by) { do note(by); wait(pause); do note(by + 1); }
    initial state A {
        run { do count(1); do count(5); }
        transitions { select B }
        transition halt { do note(9); } select B
    }
    state B { transition halt select A }
    final state Z { }
})"};
    p.step();
    EXPECT_EQ(p.own.trace, "1");
    p.steps(2);
    EXPECT_EQ(p.own.trace, "1 2 5");
    p.event("M", "halt");
    EXPECT_EQ(p.state("M"), "B") << "a run program that waits is aborted";
    EXPECT_EQ(p.own.trace, "1 2 5 9");
    p.own.trace.clear();
    p.event("M", "halt");
    p.steps(6);
    EXPECT_EQ(p.own.trace, "1 2 5 6") << "from its beginning again";
    EXPECT_EQ(p.state("M"), "B");
}

TEST(A_function, sees_machine_variables_in_a_guard_before_any_program) {
    Started p{R"(
StateMachine M {
    var int b = 2
    function int times(int n) { return b * n; }
    initial state A { precondition (times(1) == 2) transition halt if times(3) == 6 then select Z }
    final state Z { }
})"};
    p.event("M", "halt");
    EXPECT_EQ(p.state("M"), "Z");
}

// Otherwise one of them would mistake the end of another's command for its own.
TEST(A_command_of_a_peer, has_a_slot_for_every_concurrent_run_program) {
    Played p{R"(
StateMachine M {
    initial state Both {
        run { do robot.go(); }
        exit { do robot.go(); }
        region lane109 { // the names have equal 16-bit hashes
            initial state A { run { do robot.go(); } transition halt select B }
            state B { run { do robot.go(); } exit { do robot.go(); } transition halt select Late }
        }
        region lane368 {
            initial state C { run { do robot.go(); } initial state Inside { run { do robot.go(); } } }
        }
        transition seen { do robot.go(); } select Other
    }
    state Other { run { do robot.go(); } transition halt select Safe }
    state Late in Both region lane109 { run { do robot.go(); } }
    final state Safe { entry { do robot.go(); } }
})"};
    std::size_t slots = 0;
    for (const LinkRow& link : p.outcome.unit.types[0].tables.links) slots += link.needs_slot ? 1 : 0;
    const std::size_t in_hand = 1, outermost = 1, regions = 2, inside = 1, apart = 1;
    EXPECT_EQ(slots, in_hand + outermost + regions + inside + apart);
}

TEST(A_failing_program, puts_the_machine_in_error_with_its_line) {
    Started p{
        "StateMachine M {\n initial state A {\n  entry {\n   do refuse();\n  }\n transition halt select "
        "Z }\n final state Z { } }"};
    EXPECT_TRUE(p.machine("M").in_error());
    const NodeIndex node = p.machine("M").fault().node;
    EXPECT_EQ(p.outcome.unit.types[0].tables.nodes[node].line, 4);
}

TEST(Every_condition_of_a_chain, shares_the_final_else_of_the_chain) {
    Started p{R"(
StateMachine M {
    var int n = 0
    initial state A { transitions { if n == 1 then select B else { do note(7); } select Z } }
    state B { transition halt select Z }
    final state Z { }
})"};
    p.step();
    EXPECT_EQ(p.state("M"), "Z");
    EXPECT_EQ(p.own.trace, "7");
}

} // namespace
