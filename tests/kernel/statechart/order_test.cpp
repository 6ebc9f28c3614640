// The execution order, thesis 5.2: a test for each line of the table in kernel/statechart/README.md, with the
// line number in the test's name. Programs and conditions are written as in play.hpp.
#include "tests/kernel/statechart/play.hpp"

namespace tappet {
namespace {

TEST(StateMachineOrder, line_01_runs_the_transition_program_then_exits_then_entries) {
    Play m{R"(
        state a initial entry +a exit -a
        state b entry +b
        from a to b on go then *go
        from b to a on back)"};
    EXPECT_EQ(m.start(), "+a");
    EXPECT_EQ(m.send("go"), "*go -a +b");
}

TEST(StateMachineOrder, line_01_keeps_that_order_when_each_program_waits) {
    Started m{R"(
        state a initial entry +a exit -a.
        state b entry +b..
        from a to b on go then *go.
        from b to a on back)"};
    EXPECT_EQ(m.send("go"), "*go:");
    EXPECT_TRUE(m.execution.under_way());
    EXPECT_EQ(m.active(), "a");
    EXPECT_EQ(m.step(), ":*go -a:");
    EXPECT_EQ(m.active(), "a");
    EXPECT_EQ(m.step(), ":-a +b:");
    EXPECT_EQ(m.active(), "b");
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.execution.status().transitions, 1u) << "it has not arrived";
    EXPECT_EQ(m.step(), ":+b");
    EXPECT_FALSE(m.execution.under_way());
    EXPECT_EQ(m.execution.status().transitions, 2u);
}

TEST(StateMachineOrder, line_02_leaves_all_states_below_the_common_parent) {
    Started m{R"(
        state o initial entry +o exit -o
        state p in o initial entry +p exit -p
        state a in p initial entry +a exit -a
        state b in p entry +b exit -b
        state q in o entry +q exit -q
        from a to b on near
        from p to q on far
        from q to q on self
        from q to o on out
        from b to safe on end
        from o to a on inwards)"};
    EXPECT_EQ(m.send("near"), "-a +b");
    EXPECT_EQ(m.send("far"), "-b -p +q");
    EXPECT_EQ(m.send("self"), "-q +q");
    EXPECT_EQ(m.send("out"), "-q -o +o +p +a");
    EXPECT_EQ(m.send("inwards"), "-a -p -o +o +p +a");
}

TEST(StateMachineOrder, line_06_keeps_a_waiting_run_program_through_an_internal_transition) {
    Started m{R"(
        state a initial run !a.. exit -a
        from a to - on poke then *poke
        from a to safe on end)"};
    const Time entered = m.now;
    EXPECT_EQ(m.step(), "!a:");
    EXPECT_EQ(m.send("poke"), "*poke");
    EXPECT_EQ(m.outcome, StateOutcome::taken);
    EXPECT_EQ(m.execution.entered_at(), entered);
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.step(), ":!a");
}

TEST(StateMachineOrder, line_07_checks_preconditions_of_all_entered_states_after_the_guard) {
    Started m{R"(
        state idle initial exit -idle
        state x pre px
        state a in x region l initial pre pa
        state c in x region r initial pre pc
        state safe final pre never
        from idle to x on go if g
        from x to idle on back)"};
    EXPECT_EQ(m.send("go"), "?g");
    m.yes = {"g", "px", "pc"};
    EXPECT_EQ(m.send("go"), "?g ?px ?pa");
    EXPECT_EQ(m.outcome, StateOutcome::ignored);
    m.yes.insert("pa");
    EXPECT_EQ(m.send("go"), "?g ?px ?pa ?pc -idle");
    m.stop();
    EXPECT_TRUE(m.execution.is_final()) << "asks nothing";
}

TEST(StateMachineOrder, line_08_counts_a_states_time_from_before_its_entry_program) {
    Started m{R"(
        state a initial
        state b entry +b..
        from a to b on go
        from b to a after 3)"};
    m.send("go");
    const Time entered = m.now;
    m.step();
    m.step();
    EXPECT_EQ(m.execution.entered_at(), entered);
    EXPECT_EQ(m.active(), "b");
    EXPECT_EQ(m.execution.next_timeout(), entered + 3ms);
    m.step();
    EXPECT_EQ(m.active(), "a");
}

TEST(StateMachineOrder, line_10_asks_the_innermost_state_first_with_the_arguments) {
    Started m{R"(
        state o initial
        state a in o initial
        state b in o
        state c in o
        from o to b on go
        from a to b on go takes if first
        from a to c on go takes if second
        from b to c on go
        from c to a on go)"};
    m.yes = {"second"};
    EXPECT_EQ(m.send("go", 7), "?first ?second");
    EXPECT_EQ(m.active(), "o(c)");
    EXPECT_EQ(m.argument(), 7);
    m.send("go");
    EXPECT_EQ(m.send("go", 9), "?first ?second");
    EXPECT_EQ(m.argument(), 9);
    m.yes.clear();
    m.send("go");
    EXPECT_EQ(m.send("go"), "?first ?second");
    EXPECT_EQ(m.active(), "o(b)") << "the outer one";
}

TEST(StateMachineOrder, line_10_ignores_an_event_without_the_required_arguments) {
    Started m{R"(
        state a initial
        from a to safe on go takes)"};
    EXPECT_EQ(m.execution.dispatch(0, m.now), StateOutcome::ignored);
    EXPECT_EQ(m.active(), "a");
}

TEST(StateMachineOrder, line_11_executes_the_else_branch_of_a_refused_transition) {
    Started m{R"(
        state a initial exit -a handle ~a
        state b entry +b
        state c entry +c
        from a to b on one if g then *one else *no otherwise c
        from a to b on two if g else *stay
        from b to a on back
        from c to a on back)"};
    EXPECT_EQ(m.send("two"), "?g *stay");
    EXPECT_EQ(m.outcome, StateOutcome::taken);
    EXPECT_EQ(m.active(), "a");
    EXPECT_EQ(m.send("one"), "?g *no -a +c");
    m.send("back");
    m.yes = {"g"};
    EXPECT_EQ(m.send("one"), "?g *one -a +b");
}

TEST(StateMachineOrder, line_12_runs_the_handle_program_of_the_innermost_refusing_state) {
    Started m{R"(
        state o initial handle ~o
        state a in o initial handle ~a
        from a to safe on go if inner
        from o to safe on go if outer
        from o to safe on far if outer)"};
    EXPECT_EQ(m.send("go"), "?inner ?outer ~a");
    EXPECT_EQ(m.outcome, StateOutcome::ignored);
    EXPECT_EQ(m.send("far"), "?outer ~o");
}

TEST(StateMachineOrder, line_14_counts_a_time_out_from_the_entry_of_its_source) {
    Started m{R"(
        state o initial
        state a in o initial
        state b in o
        state c
        from a to b after 10
        from b to a after 30
        from o to c after 100 because slow
        from c to safe on end)"};
    const Time entered = m.now;
    EXPECT_EQ(m.execution.next_timeout(), entered + 10ms);
    m.step(10ms - 1ns);
    EXPECT_EQ(m.active(), "o(a)");
    m.step(1ns);
    EXPECT_EQ(m.active(), "o(b)");
    EXPECT_EQ(m.execution.next_timeout(), m.now + 30ms);
    m.step(60ms);
    m.step(10ms);
    EXPECT_EQ(m.active(), "o(b)");
    EXPECT_EQ(m.execution.next_timeout(), entered + 100ms) << "it was never left meanwhile";
    m.step(20ms);
    EXPECT_EQ(m.active(), "c");
    EXPECT_EQ(m.execution.reason(), "slow");
    EXPECT_EQ(m.execution.next_timeout(), never);
}

TEST(StateMachineOrder, line_14_evaluates_the_guard_of_a_due_time_out_in_every_step) {
    Started m{R"(
        state a initial
        from a to safe after 2 if g)"};
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.step(), "?g");
    EXPECT_EQ(m.step(), "?g");
    m.yes = {"g"};
    m.step();
    EXPECT_EQ(m.active(), "safe");
}

TEST(StateMachineOrder, line_20_continues_pending_work_and_then_starts_a_round) {
    Started m{R"(
        state a initial
        state b entry +b. run !b
        from a to b if g then *g.
        from b to safe on end)"};
    m.yes = {"g"};
    EXPECT_EQ(m.step(), "?g *g:");
    EXPECT_EQ(m.step(), ":*g +b:");
    EXPECT_EQ(m.step(), ":+b !b");
}

TEST(StateMachineOrder, line_21_runs_outer_states_first_and_waiting_programs_delay_no_other) {
    Started m{R"(
        state o initial run !o..
        state a in o initial run !a
        from o to safe on end)"};
    EXPECT_EQ(m.step(), "!o: !a");
    EXPECT_EQ(m.step(), "!a");
    EXPECT_EQ(m.step(), ":!o !a");
    EXPECT_EQ(m.step(), "!o: !a");
}

TEST(StateMachineOrder, line_22_evaluates_conditions_only_after_the_run_program_ended) {
    Started m{R"(
        state o initial run !o handle ~o
        state a in o initial run !a. handle ~a
        state b in o
        from a to b if inner
        from o to safe if outer
        from b to a on back)"};
    EXPECT_EQ(m.send("back"), "") << "no event asks them";
    EXPECT_EQ(m.step(), "!o !a: ?outer ~o");
    EXPECT_EQ(m.step(), "!o :!a ?inner ?outer ~o ~a");
}

TEST(StateMachineOrder, line_22_aborts_a_waiting_run_program_when_a_time_out_is_due) {
    Started m{R"(
        state a initial run !a......... exit -a
        state b entry +b
        from a to b after 3 because slow
        from b to a on back)"};
    EXPECT_EQ(m.step(), "!a:");
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.step(), "-a +b");
    EXPECT_EQ(m.execution.reason(), "slow");
}

TEST(StateMachineOrder, line_23_runs_entered_states_and_evaluates_all_conditions_again) {
    Started m{R"(
        state o initial run !o handle ~o
        state a in o initial run !a
        state b in o run !b handle ~b
        from a to b if g
        from o to safe if gone
        from b to a on back)"};
    m.yes = {"g"};
    EXPECT_EQ(m.step(), "!o !a ?g !b ?gone ~o ~b");
}

TEST(StateMachineOrder, line_23_bounds_the_transitions_of_a_step) {
    std::string text = "state s0 initial\nstate safe final\n";
    for (int i = 1; i < 11; ++i) text += "state s" + std::to_string(i) + " run !" + std::to_string(i) + "\n";
    for (int i = 0; i < 10; ++i)
        text += "from s" + std::to_string(i) + " to s" + std::to_string(i + 1) + " if g\n";
    Play m{text + "from s10 to safe if h"};
    m.yes = {"g"};
    m.start();
    m.step();
    EXPECT_EQ(m.active(), "s8");
    EXPECT_TRUE(m.execution.left_over());
    EXPECT_EQ(m.execution.next_timeout(), m.now);
    EXPECT_EQ(m.step(), "!8 ?g !9 ?g !10 ?h");
    EXPECT_FALSE(m.execution.left_over());
}

TEST(StateMachineOrder, line_24_continues_a_waiting_handle_program_in_a_later_step) {
    Started m{R"(
        state o initial run !o handle ~o.
        state a in o initial handle ~a
        from o to safe on end)"};
    EXPECT_EQ(m.step(), "!o ~o:");
    EXPECT_EQ(m.step(), ":~o ~a");
    EXPECT_EQ(m.step(), "!o ~o:");
}

TEST(StateMachineOrder, line_25_starts_each_run_program_at_most_once_per_step) {
    Started m{R"(
        state a initial entry +a run !a handle ~a
        state b run !b
        from a to b if g
        from b to a if g
        from b to safe on end)"};
    m.yes = {"g"};
    EXPECT_EQ(m.step(), "!a ?g !b ?g +a");
    EXPECT_EQ(m.step(), "!a ?g !b ?g +a");
}

TEST(StateMachineOrder, line_26_handles_pending_events_after_the_round) {
    Started m{R"(
        state a initial run !a handle ~a exit -a
        state b entry +b
        from a to b on go
        from b to a on back)"};
    m.act = [&](std::string_view what) {
        if (what == "!a") m.outcome = m.dispatch("go");
    };
    EXPECT_EQ(m.step(), "!a ~a -a +b");
    EXPECT_EQ(m.outcome, StateOutcome::queued);
}

TEST(StateMachineOrder, line_26_bounds_a_cycle_of_raised_events_in_one_call) {
    Started m{R"(
        state ping initial entry +ping
        state pong entry +pong
        from ping to pong on ring
        from pong to ping on ring
        from ping to safe on end)"};
    m.act = [&](std::string_view) { m.dispatch("ring"); };
    m.send("ring");
    EXPECT_TRUE(m.execution.left_over());
    const std::uint64_t taken = m.execution.status().transitions;
    EXPECT_EQ(taken, 2 + StateMachineExecution::max_raised_events);
    m.step();
    EXPECT_EQ(m.execution.status().transitions, taken + StateMachineExecution::max_raised_events);
    EXPECT_EQ(m.dispatch("end"), StateOutcome::queued) << "after the one that waits";
    m.act = {};
    m.deactivate();
    EXPECT_FALSE(m.execution.left_over()) << "dropped, line 44";
    m.start();
    m.step();
    EXPECT_EQ(m.active(), "ping");
}

} // namespace
} // namespace tappet
