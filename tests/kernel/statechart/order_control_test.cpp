// The execution order, thesis 5.2, second half: modes, waiting, errors and pause. A test for each line of the
// table in kernel/statechart/README.md.
#include "tests/kernel/statechart/play.hpp"

namespace tappet {
namespace {

TEST(StateMachineOrder, line_30_executes_and_evaluates_nothing_in_reactive_mode) {
    Play m{R"(
        state a initial run !a handle ~a
        state b entry +b..
        from a to safe if g
        from a to safe after 1
        from b to a on back
        from a to b on go)"};
    EXPECT_EQ(m.execution.activate(m.now), StateOutcome::taken);
    EXPECT_EQ(m.execution.machine_status(), MachineStatus::active);
    EXPECT_EQ(m.step(5ms), "");
    EXPECT_EQ(m.execution.next_timeout(), never);
    EXPECT_EQ(m.send("go"), "+b:");
    m.step();
    EXPECT_EQ(m.step(), ":+b");
    m.execution.start(m.now);
    EXPECT_EQ(m.execution.machine_status(), MachineStatus::running);
}

TEST(StateMachineOrder, line_31_enters_a_requested_state_when_its_guard_holds) {
    Play m{R"(
        state a initial exit -a
        state b entry +b
        state c
        state safe final entry +safe
        from a to b if first then *first
        from a to b if second then *second
        from b to c on go
        from c to b on back
        from a to c on go)"};
    m.execution.activate(m.now);
    EXPECT_EQ(m.request("b"), "?first ?second");
    EXPECT_EQ(m.outcome, StateOutcome::ignored);
    EXPECT_EQ(m.request("c"), "") << "by events only";
    EXPECT_EQ(m.outcome, StateOutcome::ignored);
    m.yes = {"second"};
    EXPECT_EQ(m.request("b"), "?first ?second *second -a +b");
    EXPECT_EQ(m.outcome, StateOutcome::taken);
    EXPECT_EQ(m.request("b"), "") << "it is there";
    EXPECT_EQ(m.outcome, StateOutcome::taken);
    EXPECT_EQ(m.request("safe"), "+safe") << "always valid";
    EXPECT_EQ(m.request("b"), "");
    EXPECT_EQ(m.request("a"), "") << "likewise";
    EXPECT_EQ(m.active(), "a");
}

TEST(StateMachineOrder, line_32_runs_the_run_programs_once_after_a_request) {
    Play m{R"(
        state a initial
        state b entry +b run !b.
        from a to b if g
        from b to safe if g)"};
    m.execution.activate(m.now);
    m.yes = {"g"};
    EXPECT_EQ(m.request("b", true), "?g +b !b:");
    EXPECT_EQ(m.step(), ":!b");
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.request("b", true), "!b:");
}

TEST(StateMachineOrder, line_33_evaluates_no_condition_while_a_program_is_in_hand) {
    const char* table = R"(
        state a initial
        state b entry +b..
        state c
        from a to b on go
        from b to c if g
        from c to a on back)";
    Play automatic{table};
    automatic.yes = {"g"};
    automatic.start();
    EXPECT_EQ(automatic.send("go"), "+b:");
    EXPECT_EQ(automatic.step(), "") << "not g, which holds";
    EXPECT_EQ(automatic.step(), ":+b ?g");
    EXPECT_EQ(automatic.active(), "c");

    Play reactive{table};
    reactive.yes = {"g"};
    reactive.execution.activate(reactive.now);
    reactive.send("go");
    EXPECT_EQ(reactive.request("c"), "") << "it waits after the program";
    EXPECT_EQ(reactive.step(), "");
    EXPECT_EQ(reactive.step(), ":+b ?g");
    EXPECT_EQ(reactive.active(), "c");
}

TEST(StateMachineOrder, line_40_defers_events_with_their_arguments_while_a_program_is_in_hand) {
    Started m{R"(
        state a initial
        state b entry +b. exit -b
        state c entry +c
        from a to b on go
        from b to c on take takes if g
        from c to a on back)"};
    m.yes = {"g"};
    m.send("go");
    EXPECT_EQ(m.send("take", 42), "");
    EXPECT_EQ(m.outcome, StateOutcome::queued);
    EXPECT_EQ(m.argument(), 0);
    EXPECT_EQ(m.execution.status().deferred_events, 1u);
    EXPECT_EQ(m.step(), ":+b ?g -b +c");
    EXPECT_EQ(m.argument(), 42);
}

TEST(StateMachineOrder, line_40_counts_events_that_find_no_room) {
    Started m{R"(
        state a initial
        state b entry +b.
        from a to b on go
        from b to a on back)"};
    m.send("go");
    for (std::size_t i = 0; i < StateMachineExecution::max_raised_events; ++i)
        EXPECT_EQ(m.dispatch("go"), StateOutcome::queued);
    EXPECT_EQ(m.dispatch("back"), StateOutcome::lost);
    EXPECT_EQ(m.execution.status().lost_events, 1u);
    EXPECT_FALSE(m.execution.left_over()) << "a program hinders them";
}

TEST(StateMachineOrder, line_41_aborts_a_waiting_run_program_only_for_an_accepted_transition) {
    Started m{R"(
        state a initial run !a... exit -a handle ~a
        state b
        from a to b on go if g
        from a to b on other if g else *else
        from b to a on back)"};
    EXPECT_EQ(m.step(), "!a:");
    EXPECT_EQ(m.send("go"), "?g ~a");
    EXPECT_EQ(m.send("other"), "?g *else");
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.step(), ":!a ~a");
    EXPECT_EQ(m.step(), "!a:");
    m.yes = {"g"};
    EXPECT_EQ(m.send("go"), "?g -a");
    m.send("back");
    EXPECT_EQ(m.step(), "!a:") << "from its beginning";
}

TEST(StateMachineOrder, line_42_serves_program_requests_after_the_call_and_final_state_first) {
    Started m{R"(
        state a initial exit -a
        state b entry +b exit -b
        state c entry +c
        state safe final entry +safe
        from a to b on go
        from b to c on next
        from c to a if g
        from b to c if g)"};
    m.yes = {"g"};
    m.act = [&](std::string_view what) {
        if (what != "+b") return;
        EXPECT_EQ(m.execution.request_state(find_state(m.table(), "c"), m.now), StateOutcome::queued);
        EXPECT_EQ(m.execution.request_state(find_state(m.table(), "a"), m.now), StateOutcome::lost);
    };
    EXPECT_EQ(m.send("go"), "-a +b ?g -b +c");
    m.act = [&](std::string_view what) {
        if (what != "-a") return;
        EXPECT_EQ(m.dispatch("next"), StateOutcome::queued);
    };
    m.request("a");
    EXPECT_EQ(m.send("go"), "-a +b -b +c");
    m.act = [&](std::string_view what) {
        if (what != "-a") return;
        m.dispatch("next");
        EXPECT_EQ(m.execution.request_final(m.now, "gave up"), StateOutcome::queued);
    };
    m.request("a");
    EXPECT_EQ(m.send("go"), "-a +b -b +safe");
    EXPECT_EQ(m.execution.reason(), "gave up");
}

TEST(StateMachineOrder, line_43_aborts_waiting_programs_for_the_final_state) {
    const std::string text = R"(
        state a initial exit -a
        state b entry +b.... exit -b run !b....
        state safe final entry +safe
        from a to b on go
        from a to b on slow then *slow....
        from b to a on back)";
    Started entering{text};
    entering.send("go");
    EXPECT_EQ(entering.stop(), "-b +safe");
    EXPECT_TRUE(entering.execution.is_final());
    EXPECT_EQ(entering.execution.machine_status(), MachineStatus::stopped);
    Started acting{text};
    acting.send("slow");
    EXPECT_EQ(acting.stop(), "-a +safe");
    EXPECT_FALSE(acting.execution.under_way());
}

TEST(StateMachineOrder, line_43_completes_an_exit_program_in_hand_first) {
    Started m{R"(
        state o initial exit -o
        state a in o initial exit -a..
        state b entry +b
        state safe final entry +safe
        from o to b on go
        from b to o on back)"};
    EXPECT_EQ(m.send("go"), "-a:");
    EXPECT_EQ(m.stop(), "");
    EXPECT_EQ(m.step(), ":-a -o +safe");
    EXPECT_TRUE(m.execution.is_final());
    EXPECT_EQ(m.execution.reason(), "stopped");
}

TEST(StateMachineOrder, line_44_drops_pending_work_when_deactivated) {
    Started m{R"(
        state a initial exit -a.
        state b entry +b...
        from a to b on go
        from b to a on back)"};
    EXPECT_EQ(m.deactivate(), "-a:");
    EXPECT_EQ(m.send("go"), "");
    EXPECT_EQ(m.outcome, StateOutcome::ignored);
    EXPECT_TRUE(m.execution.is_active());
    EXPECT_EQ(m.deactivate(), "") << "it is under way";
    EXPECT_EQ(m.step(), ":-a");
    EXPECT_FALSE(m.execution.is_active());
    EXPECT_EQ(m.execution.machine_status(), MachineStatus::inactive);
    EXPECT_EQ(m.start(), "");
    EXPECT_EQ(m.active(), "a");
}

TEST(StateMachineOrder, line_45_executes_a_bounded_number_of_statements_in_a_call) {
    Play m{R"(
        state a initial exit -a run !a
        state b entry +b run !b
        from a to b on go then *go
        from b to a on back)"};
    m.policy.statements = 2;
    m.bind();
    m.start();
    EXPECT_EQ(m.send("go"), "*go -a");
    EXPECT_TRUE(m.execution.left_over());
    EXPECT_EQ(m.execution.next_timeout(), at_ns(0)) << "the time of the last step, and there was none";
    EXPECT_EQ(m.step(), "+b !b");
    EXPECT_FALSE(m.execution.left_over());
}

TEST(StateMachineOrder, line_50_stops_where_a_program_failed) {
    Started m{R"(
        state a initial run !a!
        state b entry +b!
        from a to b on go then *go!
        from a to b on enter
        from b to a on back)"};
    EXPECT_EQ(m.send("go"), "*go!");
    EXPECT_TRUE(m.execution.in_error());
    EXPECT_EQ(m.execution.fault().part, StatePart::then);
    EXPECT_EQ(m.execution.fault().transition, 0);
    EXPECT_EQ(m.active(), "a");
    EXPECT_EQ(m.execution.machine_status(), MachineStatus::error);
    m.stop();
    m.execution.request_initial(m.now);
    m.send("enter");
    EXPECT_EQ(m.execution.fault().part, StatePart::entry);
    EXPECT_EQ(m.name(m.execution.fault().state), "b");
    EXPECT_EQ(m.execution.fault().number, 2u);
    m.stop();
    m.execution.request_initial(m.now);
    m.heard();
    EXPECT_EQ(m.step(), "!a!");
    EXPECT_EQ(m.execution.fault().part, StatePart::run);
}

TEST(StateMachineOrder, line_50_treats_a_failing_condition_as_an_error) {
    Started m{R"(
        state a initial
        state b pre p
        from a to b on go if g
        from b to a on back)"};
    m.broken = {"g"};
    EXPECT_EQ(m.send("go"), "?g");
    EXPECT_EQ(m.execution.fault().part, StatePart::guard);
    EXPECT_EQ(m.execution.fault().transition, 0);
    m.stop();
    m.execution.request_initial(m.now);
    m.broken = {"p"};
    m.yes = {"g"};
    m.heard();
    EXPECT_EQ(m.send("go"), "?g ?p");
    EXPECT_TRUE(m.execution.in_error());
}

TEST(StateMachineOrder, line_51_serves_only_the_final_state_and_deactivation_in_error) {
    Started m{R"(
        state o initial exit -o
        state a in o initial exit -a run !a!
        state safe final entry +safe
        from a to safe on go
        from a to safe after 1)"};
    m.step();
    ASSERT_TRUE(m.execution.in_error());
    EXPECT_EQ(m.send("go"), "");
    EXPECT_EQ(m.outcome, StateOutcome::ignored);
    EXPECT_EQ(m.step(9ms), "");
    EXPECT_EQ(m.execution.next_timeout(), never);
    EXPECT_EQ(m.execution.start(m.now), StateOutcome::ignored);
    EXPECT_EQ(m.stop(), "-a -o +safe");
    EXPECT_FALSE(m.execution.in_error());
    m.execution.request_initial(m.now);
    m.step();
    m.heard();
    EXPECT_EQ(m.deactivate(), "-a -o");
    EXPECT_FALSE(m.execution.is_active());
}

TEST(StateMachineOrder, line_52_skips_the_failing_program_in_a_second_deactivation) {
    Started m{R"(
        state o initial exit -o!
        state p in o initial exit -p
        state a in p initial exit -a!
        from a to safe on go)"};
    EXPECT_EQ(m.stop(), "-a!") << "the transition fails too";
    EXPECT_EQ(m.deactivate(), "-a!");
    EXPECT_TRUE(m.execution.in_error());
    EXPECT_EQ(m.deactivate(), "-p -o!");
    EXPECT_TRUE(m.execution.in_error());
    EXPECT_EQ(m.deactivate(), "");
    EXPECT_FALSE(m.execution.is_active());
    EXPECT_FALSE(m.execution.in_error());
}

TEST(StateMachineOrder, line_52_exits_the_parents_of_a_failing_exit) {
    Started m{R"(
        state o initial exit -o
        state a in o initial exit -a!.
        state b in o
        from a to b on go
        from b to a on back
        from o to safe on stop)"};
    m.send("go");
    m.deactivate();
    m.step();
    ASSERT_TRUE(m.execution.in_error()) << "the exit that deactivation waited for";
    EXPECT_EQ(m.deactivate(), "-o");
    EXPECT_FALSE(m.execution.is_active());
    EXPECT_TRUE(m.execution.states().empty());
}

TEST(StateMachineOrder, line_53_puts_a_parent_in_error_where_the_policy_says_so) {
    const std::string text = "state a initial run !a!\nstate safe final\nfrom a to safe on go";
    for (const bool escalates : {false, true}) {
        Play parent{"state p initial\nstate safe final\nfrom p to safe on go"};
        Play child{text};
        child.policy.escalates = escalates;
        child.bind(&parent.execution);
        parent.start();
        child.start();
        child.step();
        EXPECT_TRUE(child.execution.in_error());
        EXPECT_EQ(parent.execution.in_error(), escalates);
        EXPECT_EQ(parent.execution.fault().part, escalates ? StatePart::child : StatePart::none);
    }
}

TEST(StateMachineOrder, line_60_does_nothing_while_it_is_paused) {
    Started m{R"(
        state a initial run !a exit -a
        state b entry +b
        from a to b on go
        from b to a on back)"};
    EXPECT_EQ(m.execution.pause(), StateOutcome::taken);
    EXPECT_EQ(m.execution.machine_status(), MachineStatus::paused);
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.send("go"), "");
    EXPECT_EQ(m.outcome, StateOutcome::queued);
    EXPECT_EQ(m.execution.next_timeout(), never);
    EXPECT_EQ(m.execution.start(m.now), StateOutcome::taken);
    EXPECT_EQ(m.step(), "!a -a +b");
    m.execution.pause();
    m.stop();
    EXPECT_FALSE(m.execution.is_paused());
    EXPECT_TRUE(m.execution.is_final());
}

TEST(StateMachineOrder, line_61_steps_one_statement_or_one_condition_at_a_time) {
    Started m{R"(
        state a initial run !a exit -a handle ~a
        state b entry +b
        from a to safe if no
        from a to b if g then *go
        from a to b on go if g
        from b to a on back)"};
    m.execution.pause();
    EXPECT_EQ(m.once(), "!a");
    EXPECT_EQ(m.once(), "?no");
    EXPECT_EQ(m.once(), "?g");
    EXPECT_EQ(m.once(), "~a");
    EXPECT_EQ(m.once(), "!a");
    m.yes = {"g"};
    EXPECT_EQ(m.once(), "?no");
    EXPECT_EQ(m.once(), "?g");
    EXPECT_EQ(m.once(), "*go");
    EXPECT_EQ(m.once(), "-a");
    EXPECT_EQ(m.active(), "b") << "its entry program is next";
    EXPECT_EQ(m.once(), "+b");
    EXPECT_EQ(m.active(), "b");
    EXPECT_FALSE(m.execution.step_once(m.now)) << "nothing to do";
}

TEST(StateMachineOrder, line_61_handles_a_pending_event_in_a_single_step_when_idle) {
    Started m{R"(
        state a initial exit -a
        state b entry +b
        from a to b on go if g
        from b to a on back)"};
    m.execution.pause();
    m.yes = {"g"};
    m.send("go");
    EXPECT_EQ(m.once(), "?g");
    EXPECT_EQ(m.once(), "-a");
    EXPECT_EQ(m.once(), "+b");
}

TEST(StateMachineOrder, line_62_resumes_where_it_was_paused) {
    Started m{R"(
        state a initial run !a handle ~a
        from a to safe if g)"};
    m.execution.pause();
    EXPECT_EQ(m.once(), "!a");
    m.execution.start(m.now);
    EXPECT_EQ(m.step(), "?g ~a");
    EXPECT_EQ(m.step(), "!a ?g ~a");
}

} // namespace
} // namespace tappet
