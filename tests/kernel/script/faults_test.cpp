// A script fault is reported with its line, its column, the text found, the text expected and the nearest
// name (thesis 5.1.4, 5.2.4).
#include "tests/kernel/script/fixture.hpp"

#include <gmock/gmock.h>

namespace {

using namespace script_test;
using testing::HasSubstr;
using testing::StartsWith;

struct Wrong {
    std::string_view text;
    std::string_view where; ///< "line:column"
    std::vector<std::string_view> says;
};

void expect_fault(const Wrong& wrong, const std::string& text, const std::string& where) {
    const std::string fault = fault_of(text);
    EXPECT_THAT(fault, StartsWith("test.osd:" + where + ": ")) << wrong.text;
    for (const std::string_view part : wrong.says)
        EXPECT_THAT(fault, HasSubstr(std::string{part})) << wrong.text;
}

constexpr std::string_view machine_head = "StateMachine M {\n var int n = 0; var Position place\n";
constexpr std::string_view machine_tail = "\n final state Z { }\n}\n";

const Wrong faults_of_programs[] = {
    {"set x = 1;", "1:5", {"\"x\"", "not known"}},
    {"var int count = 1;\nset coumt = 2;", "2:5", {"\"coumt\"", "did you mean \"count\"?"}},
    {"do robot.totalAxis();", "1:10", {"\"robot\" has no \"totalAxis\"", "did you mean \"totalAxes\"?"}},
    {"do robt.totalAxes();", "1:4", {"\"robt\"", "did you mean \"robot\"?"}},
    {"do setParameter(\"Force\");", "1:24", {"found 1 arguments, expected 2"}},
    {"do setParameter(\"Force\", 1, 2);", "1:27", {"more arguments, expected 2"}},
    {"do setParameter(3, 1.0);", "1:17", {"int", "expected text"}},
    {"do setParameter(\"a text that is too long\", 1.0);", "1:17", {"does not fit"}},
    {"do disableAxis(1.5);", "1:16", {"found a value of type double, expected int"}},
    {"do disableAxis(3000000000);", "1:16", {"does not fit"}},
    {"var bool b = 1;", "1:14", {"found a value of type int, expected bool"}},
    {"var int i = true + 1;", "1:18", {"there is no bool + int"}},
    {"if 3 then do note(1);", "1:4", {"expected a condition of type bool"}},
    {"while (true) { do note(1); }", "1:1", {"can run without waiting", "yield"}},
    {"var int i = 0; while (i < 3) { if i == 1 then yield; set i = i + 1; }",
     "1:16",
     {"can run without waiting"}},
    {"for (var int i = 0; i < 2000; i = i + 1) do note(i);", "1:1", {"more than 1000 statements"}},
    {"for (var int i = 0; i < 5; i = i + 1) set i = 0;", "1:43", {"cannot be assigned", "counter"}},
    {"set speed = \"fast\";", "1:13", {"text", "expected double"}},
    {"set robot.speed = 1;", "1:11", {"an output of \"robot\"", "alone writes it"}},
    {"set far.gain = 1;", "1:9", {"another activity"}},
    {"do far.note(1);", "1:8", {"called in its own activity only"}},
    {"do robot.halt();", "1:10", {"an event of \"robot\"", "alone emits it"}},
    {"set mode = fats;", "1:12", {"did you mean \"fast\"?"}},
    {"var int i = speed.vlaid;", "1:19", {"has no \"vlaid\""}},
    {"do note(aim.z);", "1:13", {"field \"z\""}},
    {"do note(go());", "1:9", {"a command, which takes time"}},
    {"var int a = 1; var int a = 2;", "1:24", {"is there twice"}},
    {"set n 3;", "1:5", {"not known"}},
    {"var int n = 3 set n = 4; }", "1:26", {"found \"}\""}},
    {"do note(1;", "1:10", {"found \";\", expected \")\""}},
    {"do note(", "1:9", {"found the end of the text"}},
    {"var text t = \"open;\n", "1:14", {"without its end"}},
    {"/* open", "1:1", {"a comment without its end"}},
    {"var int n = 99999999999999999999;", "1:13", {"more than 63 bits"}},
    {"wait(3);", "1:5", {"expected a condition or a duration"}},
    {"break;", "1:1", {"outside of a loop"}},
    {"function f() { do f(); }\nprogram p { do f(); }", "1:19", {"calls itself", "recursion"}},
    {"function int f(int a) { return a; }\nprogram p { var int x = f(); }",
     "2:27",
     {"an argument is missing", "\"a\""}},
    {"program p { }", "1:9", {"no statement"}},
    {"program p(int) { yield; }", "1:14", {"found \")\", expected the name"}},
    {"program p(int a { yield; }", "1:17", {"found \"{\", expected \",\" or \")\""}},
    {"program p(int a = true) { yield; }", "1:19", {"found a value of type bool, expected int"}},
    {"program p(int a, int a) { yield; }", "1:22", {"is there twice"}},
    {"program p(a) { yield; }", "1:11", {"type \"a\"", "not known"}},
    {"program q { yield; } program p(int a) { do q(); }", "1:44", {"\"q\" runs by itself", "parameters"}},
    {"program q(int a) { yield; } program p { do q(); }", "1:46", {"found 0 arguments, expected 1"}},
    {"program int q(int a) { yield; return 1; } program p { do q(1); }", "1:61", {"variable or property"}},
    {"program q(int a) { yield; } program p { do q(1, 2); }", "1:47", {"more arguments, expected 1"}},
    {"program q { yield; } program p { do q.stp(); }", "1:39", {"did you mean \"stop\"?"}},
    {"program q { yield; } program p { wait (q.isRuning()); }", "1:42", {"did you mean \"isRunning\"?"}},
    {"program p(int a) { do p(1); }", "1:23", {"\"p\"", "not known"}},
    {"program int p { return 3; }", "1:13", {"nothing asks \"p\"", "parameters"}},
    {"program inti p() { return 3; }", "1:9", {"found \"inti\", expected a type"}},
    {"program int 5() { return 3; }", "1:13", {"found \"5\""}},
    {"program int p() { return true; }", "1:26", {"bool", "int as the program returns"}},
    {"program int p() { return; }", "1:25", {"found \";\""}},
    {"program int p(int a) { if a > 1 then return 3; }", "1:48", {"each way through it", "return"}},
    {"program int p() { while true { yield; } }", "1:41", {"each way through it", "return"}},
    {"program p() { return 3; }", "1:22", {"found a value, but the program returns nothing"}},
    {"", "1:1", {"empty"}},
    {"var Positon q;", "1:5", {"did you mean \"Position\"?"}},
    {"try ; catch do note(1);", "1:13", {"nothing in this try"}},
    {"function f() { do note(1); do note(2); }\nprogram p { var auto x = f(); }",
     "2:26",
     {"returns nothing", "type of a result"}},
};

TEST(A_fault_in_a_program, is_reported_with_its_place_and_a_cure) {
    for (const Wrong& wrong : faults_of_programs)
        expect_fault(wrong, std::string{wrong.text}, std::string{wrong.where});
}

TEST(A_fault_in_a_state_machine, is_reported_with_its_place_and_a_cure) {
    const Wrong cases[] = {
        {"initial state A { transitions { select B } }", "3:40", {"state \"B\"", "not known"}},
        {"initial state Alpha { transitions { select Z } }\n state Beta { transitions { select Alhpa } }",
         "4:36",
         {"did you mean \"Alpha\"?"}},
        {"initial state A { transition hlat select Z }",
         "3:30",
         {"event \"hlat\"", "did you mean \"halt\"?"}},
        {"initial state A { transition seen(n, place, n) select Z }", "3:45", {"has 2 arguments"}},
        {"initial state A { transition seen(m) select Z }", "3:35", {"variable \"m\""}},
        {"initial state A { transition halt else select Z }", "3:35", {"no condition that could be false"}},
        {"initial state A { transitions { if n > 1 then { do note(1); } } }",
         "3:63",
         {"expected \"select\""}},
        {"initial state A { transitions { select B } }\n state B { transitions { select A } }",
         "3:1",
         {"comes back to itself without waiting"}},
        {"initial state A { transition halt select Z }\n initial state A { }", "4:16", {"is there twice"}},
        {"initial state A { transition after(n) select Z }", "3:35", {"known before the machine runs"}},
    };
    for (const Wrong& wrong : cases) {
        std::string text{machine_head};
        text += ' ';
        text += wrong.text;
        text += machine_tail;
        const auto colon = wrong.where.find(':');
        // The text starts one space further right in its first line.
        const int line = std::stoi(std::string{wrong.where.substr(0, colon)});
        const int column = std::stoi(std::string{wrong.where.substr(colon + 1)}) + (line == 3 ? 1 : 0);
        expect_fault(wrong, text, std::to_string(line) + ":" + std::to_string(column));
    }
    EXPECT_THAT(fault_of("StateMachine M { param int k initial state A { transition halt select Z } final "
                         "state Z { } }\nRootStateMachine M m()"),
                StartsWith("test.osd:2:20: the parameter \"k\""));
    EXPECT_THAT(fault_of("RootStateMachine M m()"),
                StartsWith("test.osd:1:18: found state machine type \"M\""));
}

TEST(A_fault, of_nesting_is_found_at_once) {
    const std::string deep = "var int x = " + std::string(100'000, '(') + "1";
    EXPECT_THAT(fault_of(deep), HasSubstr("nested deeper"));
    std::string blocks;
    for (int i = 0; i < 100'000; ++i) blocks += "if true then ";
    EXPECT_THAT(fault_of(blocks), HasSubstr("nested deeper"));
    std::string functions = "function f0() { do note(1); }\n";
    for (int i = 1; i < 40; ++i) {
        const std::string before = "do f" + std::to_string(i - 1) + "(); ";
        functions += "function f" + std::to_string(i) + "() { " + before + before + "}\n";
    }
    EXPECT_FALSE(fault_of(functions + "program p { do f39(); }").empty());
}

TEST(A_room_that_is_too_small, is_reported_and_not_overrun) {
    const auto buffer = std::make_unique<ScriptBuffer<script_sizes_for(4, 256, 3)>>();
    Reach reach;
    reach.components = components();
    std::string text = "program p {\n";
    for (int i = 0; i < 20; ++i) text += "do note(" + std::to_string(i) + ");\n";
    const ScriptOutcome outcome = compile(text + "}", "small.osd", reach, buffer->room());
    EXPECT_TRUE(outcome.out_of_room);
    EXPECT_THAT(std::string{outcome.fault.view()}, HasSubstr("than there is room for"));
    EXPECT_TRUE(outcome.unit.types.empty());
}

} // namespace
