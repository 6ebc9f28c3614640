// A line of the script language in a running machine (thesis 3.3, 3.4.6): an expression is evaluated and
// changes nothing, statements do what their client's role allows, commands are monitored to their ends.
#include "tests/kernel/services/interpreter/line_rig.hpp"

namespace tappet::press {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

testing::Matcher<std::string> is_value(std::string_view value) {
    return AllOf(HasSubstr(R"({"id": 7, "line": "done")"),
                 HasSubstr(R"("final": true, "value": )" + std::string{value} + "}"));
}
testing::Matcher<std::string> is_done() { return HasSubstr(R"("line": "done")"); }
testing::Matcher<std::string> has_failed(std::string_view why) {
    return AllOf(HasSubstr(R"("line": "failed")"), HasSubstr(why));
}

TEST_F(Lines, evaluate_an_expression) {
    EXPECT_THAT(execute("1 + 2"), is_value("3"));
    EXPECT_THAT(execute("gauge.force * 2 + 1"), is_value("26"));
    EXPECT_THAT(execute("gauge.height;"), is_value("50"));
    EXPECT_THAT(execute("gauge.target > 9.5 && gauge.all_homed()"), is_value("true"));
    EXPECT_THAT(execute("gauge.half(gauge.steps)"), is_value("3.5"));
    EXPECT_THAT(execute("2 * 20 ms"), is_value("\"40ms\""));
    EXPECT_THAT(execute("\"a \\\"text\\\"\""), is_value(R"("a \"text\"")"));
    EXPECT_THAT(execute("vector3(1, 2, 3) * 2.0"), is_value("[2, 4, 6]"));
    EXPECT_THAT(execute("table.height"), is_value("50")) << "of another activity than the last line";
    EXPECT_THAT(execute("1 / (gauge.steps - 7)"), has_failed("line:1:1: its value could not be computed"));
}

TEST_F(Lines, leave_the_values_they_read_fresh_for_the_component) {
    EXPECT_THAT(ask("1 stop gauge"), HasSubstr("\"ok\": true"));
    run(20ms);
    EXPECT_THAT(ask("2 stop table"), HasSubstr("\"ok\": true")) << "no fresher value comes";
    EXPECT_THAT(execute("gauge.height.fresh"), is_value("true"));
    EXPECT_THAT(execute("gauge.height"), is_value("50"));
    EXPECT_THAT(execute("var double height = gauge.height"), HasSubstr(R"({"height": 50})"));
    EXPECT_THAT(execute("gauge.height.fresh"), is_value("true"));
}

TEST_F(Lines, change_nothing_with_an_expression) {
    EXPECT_THAT(
        execute("gauge.zero()"),
        HasSubstr(
            R"(line:1:7: \"zero\" may change \"gauge\", and an expression changes nothing; write \"do\" before it, or make the method const)"));
    EXPECT_EQ(gauge().zeroed, 0);
    EXPECT_THAT(execute("do gauge.zero()"), is_done());
    EXPECT_THAT(execute("var int n = gauge.zero()"), HasSubstr(R"("variables": {"n": 2})"));
}

TEST_F(Lines, monitor_a_command_to_its_end_and_report_its_result) {
    EXPECT_THAT(ask(request("var int stroke; do ram.move_to(20, stroke)")),
                HasSubstr(R"("ok": true, "state": "sent")"));
    EXPECT_EQ(talker().receive(), "") << "it is on its way";
    EXPECT_THAT(next(talker()), AllOf(is_done(), HasSubstr(R"("variables": {"stroke": 1})")));
    EXPECT_EQ(ram().place.last(), 20);
    EXPECT_THAT(
        execute("var int n; do ram.move_to(-1, n)"),
        has_failed(R"(line:1:12: \"ram.move_to\" was rejected: its component says no, or does not run)"));
    EXPECT_THAT(execute("var int n; do ram.move_to(50, n) timeout 1ms"),
                has_failed(R"(line:1:12: \"ram.move_to\" had not ended in time)"));
}

TEST_F(Lines, send_a_command_to_another_activity_than_its_arguments) {
    EXPECT_THAT(execute("var int n; do ram.move_to(table.height / 2, n)"), is_done());
    EXPECT_EQ(ram().place.last(), 25);
    EXPECT_THAT(execute("var int n; if table.height > 49 then do ram.move_to(gauge.force, n)"),
                HasSubstr("which runs in another activity; send it a command, or connect an input"))
        << "values of two activities are not of one moment";
}

TEST_F(Lines, execute_waiting_statements_step_by_step) {
    EXPECT_THAT(execute("var int n = 0; while n < 3 { set n = n + 1; yield; }"),
                HasSubstr(R"("variables": {"n": 3})"));
    EXPECT_THAT(execute("var int sum = 0; for (var int i = 0; i < 100; i = i + 1) set sum = sum + i;"),
                HasSubstr(R"("variables": {"sum": 4950, )"))
        << "some at a time: its engine has other work";
    EXPECT_THAT(execute("wait 30ms"), is_done());
    EXPECT_THAT(execute("wait gauge.force > 1000 timeout 20ms"),
                has_failed("line:1:1: what it waited for did not come in time"));
    EXPECT_THAT(execute("try do gauge.lock(false); catch do gauge.zero()"), is_done());
    EXPECT_EQ(gauge().zeroed, 1);
    EXPECT_THAT(execute("do gauge.lock(false)"), has_failed(R"(\"gauge.lock\" says no)"));
}

TEST_F(Lines, set_a_property_when_its_component_consents) {
    EXPECT_THAT(execute("set gauge.target = 35.0"), is_done());
    EXPECT_EQ(gauge().target.get(), 35);
    EXPECT_THAT(execute("set gauge.target = 99"), has_failed("is over its greatest value 50"));
    EXPECT_THAT(execute("set ram.speed = 19.5"),
                has_failed(R"(the component of \"ram.speed\" does not consent)"));
    EXPECT_EQ(gauge().target.get(), 35);
}

TEST_F(Lines, set_an_unlimited_property_to_numbers_only) {
    EXPECT_THAT(execute("set gauge.offset = 2.5"), is_done());
    for (const std::string value : {"1e308 * 10", "0.0 - 1e308 * 10", "0.0 / 0.0", "sqrt(0.0 - 1.0)"})
        EXPECT_THAT(execute("set gauge.offset = " + value),
                    has_failed(R"(property \"offset\": is not a finite number; propose a finite one)"))
            << value;
    EXPECT_EQ(gauge().offset.get(), 2.5);
}

TEST_F(Lines, run_one_at_a_time_and_can_be_aborted_by_anyone) {
    EXPECT_THAT(ask("1 break_off"), HasSubstr("no line is at work; there is nothing to break off"));
    EXPECT_THAT(ask(request("wait 10s")), HasSubstr("sent"));
    Talker other{path()};
    EXPECT_THAT(ask(other, "3 execute 1+1"),
                AllOf(HasSubstr("not_now"), HasSubstr("another line is at work")));
    EXPECT_THAT(ask(other, "4 break_off"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(next(talker()), has_failed("it was broken off"));
    EXPECT_THAT(execute("1"), is_value("1"));
}

TEST_F(Lines, let_a_higher_role_interrupt_an_expression) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker observer{path(), 65534};
    hang(0);
    EXPECT_THAT(ask(observer, request("gauge.target")), HasSubstr("sent"));
    EXPECT_THAT(execute("table.height"),
                AllOf(HasSubstr("not_now"), HasSubstr("an observer's line gives way to yours")));
    EXPECT_THAT(next(observer), has_failed("it was broken off"));
    EXPECT_THAT(ask(observer, request("1")), HasSubstr("an engineer is served first; ask again"));
    EXPECT_THAT(execute("table.height"), is_value("50"));
    EXPECT_THAT(ask(observer, request("1")), HasSubstr("sent"));
    EXPECT_THAT(next(observer), is_value("1"));
}

TEST_F(Lines, serve_the_interrupting_role_before_lower_ones) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker worker{path(), 1001};
    EXPECT_THAT(ask(worker, request("wait 10s")), HasSubstr("sent"));
    EXPECT_THAT(ask("3 break_off"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(next(worker), has_failed("it was broken off"));
    EXPECT_THAT(ask(worker, request("wait 10s")), HasSubstr("an engineer is served first; ask again"));
    EXPECT_THAT(execute("1"), is_value("1"));
    EXPECT_THAT(ask(worker, request("wait 10s")), HasSubstr("sent"));
    EXPECT_THAT(execute("1"), HasSubstr("another line is at work"));
    EXPECT_THAT(ask(worker, "4 break_off"), HasSubstr("\"ok\": true")) << "its own";
    EXPECT_THAT(next(worker), has_failed("it was broken off"));
    EXPECT_THAT(ask(worker, request("1")), HasSubstr("an engineer is served first"));
    run(CommandInterpreter::patience);
    EXPECT_THAT(ask(worker, request("1")), HasSubstr("sent")) << "who does not come is not waited for";
    EXPECT_THAT(next(worker), is_value("1"));
}

TEST_F(Lines, keep_a_waiting_client_ahead_of_intermediate_roles) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker worker{path(), 1001};
    Talker observer{path(), 65534};
    hang(0);
    EXPECT_THAT(ask(observer, request("gauge.target")), HasSubstr("sent"));
    ASSERT_TRUE(talker().send(request("table.height")));
    ASSERT_TRUE(worker.send(request("1"))); // in the same cycle, after it
    EXPECT_THAT(next(talker()), HasSubstr("gives way to yours"));
    static_cast<void>(next(worker));
    static_cast<void>(next(observer));
    EXPECT_THAT(ask(worker, request("1")), HasSubstr("an engineer is served first"));
    EXPECT_THAT(execute("table.height"), is_value("50"));
}

TEST_F(Lines, keep_a_line_for_engineers_despite_abandoned_operator_commands) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker worker{path(), 1001};
    ram().speed.set(0.001);
    for (const double to : {49.0, 48.0, 47.0}) {
        const std::string answer =
            ask(worker, request("var int n; do ram.move_to(" + std::to_string(to) + ", n)"));
        if (answer.find("sent") == std::string::npos) {
            EXPECT_THAT(answer, HasSubstr("commands of earlier lines are still on their way"));
        }
        static_cast<void>(ask(worker, "8 break_off"));
        static_cast<void>(next(worker));
    }
    EXPECT_THAT(ask(worker, request("1")), HasSubstr("commands of earlier lines are still on their way"));
    run(CommandInterpreter::patience);
    EXPECT_THAT(execute("1"), is_value("1"));
}

TEST_F(Lines, protect_partial_work_from_interruption_by_a_lower_role) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker worker{path(), 1001};
    EXPECT_THAT(ask(worker, request("wait 10s")), HasSubstr("sent"));
    EXPECT_THAT(execute("1"), HasSubstr("another line is at work"));
    EXPECT_THAT(ask("3 break_off"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(next(worker), has_failed("it was broken off"));
    EXPECT_THAT(ask(request("wait 10s")), HasSubstr("sent"));
    EXPECT_THAT(ask(worker, "4 break_off"),
                AllOf(HasSubstr("denied"), HasSubstr("of a higher role than an operator")));
    EXPECT_THAT(ask("5 break_off"), HasSubstr("\"ok\": true"));
}

TEST_F(Lines, abort_when_their_client_leaves) {
    auto guest = std::make_unique<Talker>(path());
    EXPECT_THAT(ask(*guest, request("while true { do gauge.zero(); yield; }")), HasSubstr("sent"));
    guest->close();
    run(100ms);
    const std::int64_t zeroed = gauge().zeroed;
    EXPECT_GT(zeroed, 0);
    run(200ms);
    EXPECT_EQ(gauge().zeroed, zeroed);
    EXPECT_THAT(execute("gauge.all_homed()"), is_value("true"));
}

TEST_F(Lines, time_out_after_the_longest_allowed_time) {
    interpreter().longest.set(1s);
    EXPECT_THAT(ask(request("wait 10s")), HasSubstr("sent"));
    EXPECT_THAT(next(talker(), 2s), has_failed("it took longer than a line may"));
}

TEST_F(Lines, leave_an_abandoned_command_running_beside_the_next_line) {
    ram().speed.set(0.1);
    for (const double to : {49.0, 48.5, 48.0}) {
        EXPECT_THAT(ask(request("var int n; do ram.move_to(" + std::to_string(to) + ", n)")),
                    HasSubstr("sent"));
        EXPECT_THAT(ask("8 break_off"), HasSubstr("\"ok\": true"));
        EXPECT_THAT(next(talker()), has_failed("it was broken off"));
    }
    EXPECT_THAT(execute("1"), HasSubstr("commands of earlier lines are still on their way"));
    run(1s);
    EXPECT_THAT(execute("ram.place"), is_value("48")) << "the first never ends: it is told to go elsewhere";
}

TEST_F(Lines, send_nothing_to_a_stopped_component) {
    EXPECT_THAT(ask("1 stop gauge"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(execute("gauge.all_homed()"),
                HasSubstr(R"(component \"gauge\" does not run; start it first)"));
    EXPECT_THAT(execute("gauge.target"), is_value("10")) << "it may be looked at";
    EXPECT_THAT(ask("2 stop activity:motion"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(execute("gauge.target"), HasSubstr(R"(activity \"motion\" is stopped)"));
    EXPECT_THAT(ask("3 start activity:motion"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(execute("gauge.target"), is_value("10"));
}

TEST_F(Lines, end_when_their_activity_stops_in_the_middle) {
    EXPECT_THAT(ask(request("wait gauge.force > 1000")), HasSubstr("sent"));
    EXPECT_THAT(ask("1 stop activity:motion"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(next(talker(), 4s),
                has_failed(R"(its engine did not execute it in time: look at activity \"motion\")"));
    EXPECT_THAT(ask("2 start activity:motion"), HasSubstr("\"ok\": true"));
    EXPECT_THAT(ask(request("wait 10s")), HasSubstr("sent"));
    EXPECT_THAT(ask("1 stop interpreter"), Not(HasSubstr("\"ok\": true"))) << "it serves the browser itself";
    EXPECT_THAT(ask("9 break_off"), HasSubstr("\"ok\": true"));
}

TEST_F(Lines, can_be_sent_by_a_peer_as_a_command) {
    panel().wanted = panel().line.assign("gauge.force * 2 + 1");
    run(100ms);
    ASSERT_EQ(panel().execute.state(), CommandState::done);
    EXPECT_EQ(panel().execute.result<0>().view(), "26");
    panel().wanted = panel().line.assign("gauge.fource");
    run(100ms);
    EXPECT_EQ(panel().execute.state(), CommandState::rejected);
    EXPECT_EQ(interpreter().said.last().view(),
              R"(line:1:7: "gauge" has no "fource"; did you mean "force"?)");
    panel().wanted = panel().line.assign("do gauge.lock(false)");
    run(100ms);
    EXPECT_EQ(panel().execute.state(), CommandState::failed);
    EXPECT_THAT(execute("1 + 1"), is_value("2")) << "the next is a browser's";
    EXPECT_EQ(interpreter().executed.last(), 3);
    EXPECT_EQ(interpreter().refused.last(), 1);
}

TEST_F(Lines, of_a_peer_run_despite_observer_requests) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker observer{path(), 65534};
    look(observer);
    for (int n = 0; n < 20; ++n) {
        panel().wanted = panel().line.assign("do gauge.zero()");
        for (int k = 0; k < 30; ++k) run_beside(observer, 10ms);
        EXPECT_EQ(panel().execute.state(), CommandState::done)
            << n << ": " << interpreter().said.last().view();
        panel().execute.reset();
        run(2500ms); // nothing is reserved
    }
}

/// Lines of two peers beside a busy observer: each peer receives its own results.
TEST_F(Lines, of_two_peers_report_to_their_own_sender) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker observer{path(), 65534};
    look(observer);
    Panel &a = panel(), &b = panel("panel_b");
    for (int n = 0; n < 20; ++n) {
        const std::int64_t zeroed = gauge().zeroed;
        gauge().target.set(10);
        a.wanted = a.line.assign("do gauge.zero()");
        b.wanted = b.line.assign("set gauge.target = 20.25");
        for (int k = 0; k < 30; ++k) run_beside(observer, 10ms);
        EXPECT_EQ(a.execute.state() == CommandState::done, gauge().zeroed == zeroed + 1) << n;
        EXPECT_EQ(b.execute.state() == CommandState::done, gauge().target.get() == 20.25) << n;
        EXPECT_TRUE(a.execute.state() == CommandState::done || b.execute.state() == CommandState::done) << n;
        a.execute.reset();
        b.execute.reset();
        run(2500ms); // nothing is reserved
    }
}

TEST_F(Lines, of_a_waiting_peer_can_be_aborted) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker observer{path(), 65534};
    look(observer);
    int waited = 0;
    for (int n = 0; n < 40; ++n) {
        const bool is_broken_off = breaks_off(panel(), observer, [] {});
        waited += is_broken_off ? 1 : 0;
        EXPECT_EQ(is_broken_off, panel().execute.state() != CommandState::done) << n;
        panel().execute.reset();
        run(2500ms);
    }
    EXPECT_GT(waited, 0);
}

TEST_F(Lines, of_two_peers_with_equal_text_stay_separate) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can connect as somebody else";
    Talker observer{path(), 65534};
    look(observer);
    Panel &a = panel(), &b = panel("panel_b");
    int broken_off = 0;
    for (int n = 0; n < 40; ++n) {
        const std::int64_t zeroed = gauge().zeroed;
        const bool is_broken_off =
            breaks_off(a, observer, [&b] { b.wanted = b.line.assign("do gauge.zero()"); });
        broken_off += is_broken_off ? 1 : 0;
        if (is_broken_off) {
            EXPECT_EQ(a.execute.state(), CommandState::failed) << n;
            EXPECT_EQ(b.execute.state() == CommandState::done, gauge().zeroed == zeroed + 1) << n;
        }
        a.execute.reset();
        b.execute.reset();
        run(2500ms);
    }
    EXPECT_GT(broken_off, 0);
}

TEST_F(Press, a_machine_without_an_interpreter_executes_no_lines) {
    EXPECT_THAT(ask("1 execute 1+1"),
                HasSubstr("this machine executes no lines; add component<CommandInterpreter> to its table"));
    EXPECT_THAT(ask("2 break_off"), HasSubstr("unsupported"));
}

} // namespace
} // namespace tappet::press
