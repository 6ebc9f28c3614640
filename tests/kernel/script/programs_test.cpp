// Programs of the script language: the effect of each statement and expression (thesis 5.1.4, 5.1.5).
#include "tests/kernel/script/fixture.hpp"

#include <gmock/gmock.h>

namespace {

using namespace script_test;

/// The notes of a program that ends in one step.
std::string notes(std::string_view text) {
    Played p{text};
    p.step();
    EXPECT_EQ(p.program().status(), ProgramStatus::stopped) << text;
    return p.own.trace;
}
ProgramStatus status_after_a_step(std::string_view text) {
    Played p{text};
    p.step();
    return p.program().status();
}

TEST(An_expression, uses_the_precedence_of_c_and_the_types_of_its_operands) {
    struct Case {
        std::string_view expression;
        std::string_view value;
    };
    const Case cases[] = {
        {"1 + 2 * 3", "7"},
        {"(1 + 2) * 3", "9"},
        {"10 - 4 - 3", "3"},
        {"7 / 2", "3"},
        {"-7 % 3", "-1"},
        {"7 mod 4", "3"},
        {"-(-2)", "2"},
        {"int(7 / 2.0 * 2)", "7"},
        {"int(sqrt(16.0))", "4"},
        {"max(3, min(9, 5))", "5"},
        {"abs(-4)", "4"},
        {"1 < 2 && 2 < 1 || true ? 1 : 0", "1"},
        {"not (1 == 1) or false ? 1 : 0", "0"},
        {"1 <= 1 and 2 != 3 ? 4 : 5", "4"},
        {"20ms + 5 ms == 25 ms ? 1 : 0", "1"},
        {"1.5s > 1 s ? 1 : 0", "1"},
        {"int(whereabouts().x * 10 + whereabouts().y) + whereabouts().turns", "15"},
        {"narrow + 1", "8"},
        {"int(vector3(1, 2, 3) * 2.0 == vector3(2, 4, 6) ? 1.0 : 0.0)", "1"},
        {"int(vector3(1, 2, 3)[1] + vector3(1, 2, 3).z)", "5"},
        {"int(norm(vector2(3, 4)))", "5"},
        {"int(matrix2x2(1, 2, 3, 4)[1][0])", "3"},
        {"totalAxes() + robot.totalAxes()", "6"},
    };
    for (const Case& each : cases)
        EXPECT_EQ(notes("do note(" + std::string{each.expression} + ");"), each.value) << each.expression;
}

TEST(An_expression, evaluates_and_and_or_with_short_circuit) {
    EXPECT_EQ(notes("if isTrue(false) && isTrue(true) then do note(1);"), "no");
    EXPECT_EQ(notes("if isTrue(true) || isTrue(false) then do note(1);"), "yes 1");
    EXPECT_EQ(notes("if isTrue(true) && isTrue(true) then do note(1);"), "yes yes 1");
    EXPECT_EQ(notes("var int n = 0; if n != 0 && 10 / n > 1 then do note(1); else do note(2);"), "2");
}

TEST(An_action, fails_without_a_valid_value) {
    for (const std::string_view text :
         {"var int n = 0; do note(1 / n);", "var int n = 9223372036854775807; set n = n + 1;",
          "var int n = 300; set small = n;", "var vector3 v; var int i = 3; do note(int(v[i]));",
          "set gain = 11.0;", "do refuse();", "var double d = 1e300; do note(int(d));"})
        EXPECT_EQ(status_after_a_step(text), ProgramStatus::error) << text;
}

TEST(A_variable, keeps_each_assigned_part) {
    EXPECT_EQ(notes(R"(
        var Position p; var Position q = Position(4, 5, 6);
        set p.x = 2; set p.turns = 7; do note(int(p.x) + p.turns);
        set p = q; set p.y = q.y + 1; do note(int(p.y) * 10 + p.turns);
        set aim = p; do note(int(aim.y)); set p = whereabouts(); do note(p.turns);)"),
              "9 66 6 3");
    EXPECT_EQ(notes(R"(
        var vector3 v = vector3(1, 2, 3); const double ten = 10.0; const vector3 more = vector3(0, 0, 5);
        for (var int i = 0; i < 3; i = i + 1) set v[i] = v[i] * ten;
        set v = v + more; set v.x = -1.0;
        do note(int(v[0])); do note(int(v[1] + v.z));)"),
              "-1 55");
    EXPECT_EQ(notes(R"(var matrix2x3 m = matrix2x3(1, 2, 3, 4, 5, 6); var int r = 1; var int c = 2;
        do note(int(m[r][c])); set m[r][c] = 9; do note(int(m[1][2] + m[0, 1])); do note(int((m * transpose(m))[1][1]));)"),
              "6 11 122");
}

TEST(A_variable, of_an_enumeration_or_text_accepts_the_names_of_its_values) {
    Played p{R"(
        set mode = fast; if mode == fast then do note(1); if mode != Mode.slow then do note(2);
        var text t = "weft"; if t == "weft" then do note(3); do setParameter(t, 4);)"};
    p.step();
    EXPECT_EQ(p.own.mode.get(), Mode::fast);
    EXPECT_EQ(p.own.trace, "1 2 3 weft=4");
}

TEST(A_branch, executes_the_side_whose_condition_holds) {
    EXPECT_EQ(notes(R"(for (var int i = 0; i < 4; i = i + 1) {
        if (i == 0) then do note(10); else if i == 1 do note(11); else { do note(12); } } )"),
              "10 11 12 12");
}

TEST(A_loop, obeys_break_and_continue) {
    EXPECT_EQ(notes(R"(for (var int i = 0; i < 10; i = i + 1) {
        if i == 2 then continue; if i == 5 then break; do note(i); } do note(99);)"),
              "0 1 3 4 99");
    EXPECT_EQ(notes("for (var int i = 3; i > 0; i = i - 1) for (var int j = 0; j != 2; j = j + 1) do note(i "
                    "* 10 + j);"),
              "30 31 20 21 10 11");
    EXPECT_EQ(notes("for (var int i = 3; i < 3; i = i + 1) do note(1); do note(2);"), "2");
}

TEST(A_loop, may_run_for_ever_while_it_waits) {
    Played p{"var int n = 0; while (n < 3) { do note(n); set n = n + 1; yield; }"};
    p.step();
    EXPECT_EQ(p.own.trace, "0");
    p.step();
    EXPECT_EQ(p.own.trace, "0 1");
    p.steps(2);
    EXPECT_EQ(p.own.trace, "0 1 2");
    EXPECT_EQ(p.program().status(), ProgramStatus::stopped);
}

TEST(A_wait, ends_when_its_condition_holds_or_its_time_elapses) {
    Played p{
        "wait(gain > 5.0); do note(1); wait(25 ms); do note(2); wait (gain > 9.0) timeout 20ms; do note(3);"};
    p.steps(3);
    EXPECT_EQ(p.own.trace, "");
    p.own.gain.set(6.0);
    p.step(); // 40 ms
    EXPECT_EQ(p.own.trace, "1");
    p.steps(2);
    EXPECT_EQ(p.own.trace, "1") << "20 ms passed";
    p.step();
    EXPECT_EQ(p.own.trace, "1 2");
    p.steps(3);
    EXPECT_EQ(p.program().status(), ProgramStatus::error) << "the time-out makes the statement fail";
}

TEST(A_failure, is_caught_by_the_script) {
    EXPECT_EQ(notes("try do refuse(); catch { do note(1); } do note(2);"), "1 2");
    EXPECT_EQ(notes("try { do note(1); do refuse(); do note(3); } catch do note(2);"), "1 2");
    EXPECT_EQ(notes("try { try do refuse(); catch { do note(1); do refuse(); } } catch do note(2);"), "1 2");
    EXPECT_EQ(notes("try do note(1); catch do note(2);"), "1");

    Played p{"try do robot.go() timeout 35ms; catch do note(1); do note(2);"};
    p.robot.steps_to_go = 100;
    p.steps(4);
    EXPECT_EQ(p.own.trace, "");
    p.step();
    EXPECT_EQ(p.own.trace, "1 2");

    Played rejected{"try do robot.go(); catch do note(1);"};
    rejected.robot.rejects = true;
    rejected.steps(3);
    EXPECT_EQ(rejected.own.trace, "1");
    Played failed{"do robot.go(); do note(1);"};
    failed.robot.fails = true;
    failed.steps(3);
    EXPECT_EQ(failed.program().status(), ProgramStatus::error);
}

TEST(An_own_command, starts_and_is_monitored_in_the_program_itself) {
    Played p{"do go(); do note(1);"};
    p.own.steps_to_go = 2;
    p.step();
    EXPECT_EQ(p.own.trace, "begin");
    p.steps(2);
    EXPECT_EQ(p.own.trace, "begin end 1");
}

TEST(A_command, puts_the_program_in_error_when_it_fails_or_is_rejected) {
    for (const std::string_view whose : {"", "robot.", "far."})
        for (bool Cell::* const does : {&Cell::rejects, &Cell::fails}) {
            Played p{"do " + std::string{whose} + "go();"};
            for (Cell* each : {&p.own, &p.robot, &p.far}) each->*does = true;
            p.steps(3);
            EXPECT_EQ(p.program().status(), ProgramStatus::error) << whose;
        }
}

TEST(A_command_of_a_peer, fails_the_program_when_its_component_is_not_running) {
    Played p{"do far.go();"};
    p.stop_far();
    p.step();
    EXPECT_EQ(p.program().status(), ProgramStatus::error);
}

TEST(A_command_of_a_peer, waits_for_an_earlier_pending_call) {
    Played p{"do far.go();"};
    p.far.steps_to_go = 2;
    p.steps(2);
    EXPECT_TRUE(p.program().stop());
    EXPECT_TRUE(p.program().start());
    p.step();
    EXPECT_EQ(p.far.trace, "begin") << "of the first sending";
    p.steps(3);
    EXPECT_EQ(p.program().status(), ProgramStatus::stopped);
    EXPECT_EQ(p.far.trace, "begin end begin end");
}

TEST(A_command, assigns_its_results_to_variables) {
    for (const std::string_view whose : {"", "robot.", "far."}) {
        Played p{"var int taken = 0; var double mean = 0; do " + std::string{whose} +
                 "measure(12, taken, mean); do note(taken);"};
        p.steps(4);
        EXPECT_EQ(p.own.trace, "12") << whose;
        EXPECT_EQ(p.get<double>("test", "mean"), 2.5) << whose;
    }
}

TEST(A_command, assigns_its_results_to_properties_and_outputs) {
    for (const std::string_view whose : {"", "robot.", "far."}) {
        Played p{"var int taken = 0; do " + std::string{whose} + "measure(12, taken, gain); do " +
                 std::string{whose} + "measure(4, taken, speed); do note(taken);"};
        p.steps(6);
        EXPECT_EQ(p.own.trace, "4") << whose;
        EXPECT_EQ(p.own.gain.get(), 2.5) << whose;
        EXPECT_EQ(p.own.speed.last(), 2.5) << whose;
    }
}

TEST(A_command, fails_its_statement_when_a_property_rejects_the_result) {
    Played p{"var double mean; try do measure(40000, narrow, mean); catch do note(narrow);"};
    p.steps(4);
    EXPECT_EQ(p.own.trace, "7");
}

TEST(A_function, is_expanded_at_each_call) {
    EXPECT_EQ(notes(R"(
        function int twice(int a) { return a * 2; }
        function int longest(int a, int b) { if a > b then return a; return b; }
        function say(int what) { if what == 0 then return; do note(what); }
        program p {
            var int a = 5;
            do note(twice(a + 1) + twice(2));
            do say(0); do say(3); do say(twice(a));
            var int b = longest(3, twice(a)); do note(b);
            set b = longest(20, a); do note(b);
        })"),
              "16 3 10 10 20");
}

TEST(An_output_and_a_property, are_written_and_read) {
    Played p{"set speed = 2; set gain = 3.5; do speed.write(speed + gain); set small = 200; set robot.gain = "
             "gain * 2; do beep(small);"};
    p.step();
    EXPECT_EQ(p.program().status(), ProgramStatus::stopped);
    EXPECT_EQ(p.own.speed.last(), 5.5);
    EXPECT_EQ(p.own.small.last(), 200);
    EXPECT_EQ(p.robot.gain.get(), 7.0);
    EXPECT_EQ(p.own.trace, "beep200");
}

TEST(Comments_and_semicolons, are_allowed_anywhere) {
    EXPECT_EQ(notes("// one\ndo note(1) # two\n/* three\n lines */ do note(2) ;;; { }"), "1 2");
}

} // namespace
