// Hostile scripts: endless nesting, endless loops, texts that multiply. All are refused, within a time and a
// room that the text's length bounds, and without the heap.
#include "tests/differential/unit_bench.hpp"

#include "kernel/script/compile.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

namespace tappet {
namespace {

constexpr ScriptSizes capacity = script_sizes_for(1000, 16000, 3);
constexpr std::size_t characters = 60'000;

std::string repeated(std::string_view what, std::size_t bytes = characters) {
    std::string text;
    while (text.size() < bytes) text += what;
    return text;
}

/// Compiles a text, refused or not; a good text of this length takes a few milliseconds.
ScriptOutcome compile(const std::string& text) {
    static const auto rows = std::make_unique<ScriptBuffer<capacity>>();
    Reach reach;
    reach.components = UnitBench::reach();
    const auto before = std::chrono::steady_clock::now();
    ScriptOutcome outcome = compile_into(text, "bad.osd", reach, rows->room());
    EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds{2}) << text.substr(0, 200);
    return outcome;
}

void expect_refused(const std::string& text, std::string_view why = "") {
    const ScriptOutcome outcome = compile(text);
    EXPECT_FALSE(outcome.good()) << text.substr(0, 200);
    EXPECT_TRUE(outcome.fault.view().starts_with("bad.osd:")) << outcome.fault.view();
    EXPECT_NE(outcome.fault.view().find(why), std::string_view::npos) << outcome.fault.view();
}

std::string program(const std::string& body) { return "program m {\nvar int a = 0;\n" + body + "\n}\n"; }

TEST(A_hostile_script, is_refused_when_nested_too_deeply) {
    for (std::string_view what : {"(", "-", "!", "abs(", "1 + (", "true ? ("})
        expect_refused(program("set a = " + repeated(what)), "deeper");
    for (std::string_view what :
         {"{", "if true then ", "while (true) ", "try ", "try { ", "if true then { } else "})
        expect_refused(program(repeated(what)), "deeper");
    std::string states = "StateMachine M {\n";
    for (int i = 0; i < 1000; ++i) states += "state S" + std::to_string(i) + " { region r { ";
    expect_refused(states, "deeper");
}

TEST(A_hostile_script, is_refused_when_it_loops_without_waiting) {
    expect_refused(program("while (true) { set a = 1; }"), "without waiting");
    expect_refused(program("while (a < 1) { if a > 0 then yield; }"), "without waiting");
    expect_refused(program("for (var int i = 0; i < 1000000000; i = i + 1) { do note(i); }"),
                   "without waiting");
    expect_refused(program("for (var int i = 0; i < 30; i = i + 1) { for (var int j = 0; j < 30; j = j + 1) "
                           "{ for (var int k = 0; k < 30; k = k + 1) { do note(k); } } }"),
                   "without waiting");
    expect_refused(program("for (var int i = 0; i < 10; i = i + 0) { do note(i); }"), "without waiting");
}

TEST(A_hostile_script, is_refused_when_its_calls_recurse_or_multiply) {
    expect_refused("function f(int a) { do f(a); }\n" + program("do f(1);"), "calls itself");
    // Each calls the one before it ten times: a billion statements of a short text.
    std::string text = "function f0(int a) { do note(a); }\n";
    for (int i = 1; i < 10; ++i) {
        text += "function f" + std::to_string(i) + "(int a) { ";
        for (int n = 0; n < 10; ++n) text += "do f" + std::to_string(i - 1) + "(a); ";
        text += "}\n";
    }
    expect_refused(text + program("do f9(1);"), "make it smaller");
    // The same within one expression.
    text = "function int g0(int a) { return a + a; }\n";
    for (int i = 1; i < 40; ++i) {
        const std::string inner = "g" + std::to_string(i - 1) + "(a)";
        text += "function int g" + std::to_string(i) + "(int a) { return " + inner + " + " + inner + "; }\n";
    }
    expect_refused(text + program("set a = g39(1);"), "deeper");
}

TEST(A_hostile_script, is_refused_when_larger_than_its_room) {
    expect_refused(program(repeated("do note(1);\n")), "make it smaller");
    expect_refused(program("set a = 1" + repeated(" + note(2)")), "make it smaller");
    std::string text = "StateMachine M {\n";
    for (int i = 0; i < 3000; ++i) text += "state S" + std::to_string(i) + " { }\n";
    expect_refused(text + "}", "make it smaller");
    text.clear();
    for (int i = 0; i < 3000; ++i) text += "var matrix4x4 v" + std::to_string(i) + ";\n";
    expect_refused(program(text), "make it smaller");
}

TEST(A_hostile_script, is_refused_when_unterminated_or_meaningless) {
    for (const std::string& text :
         {repeated("a"), repeated("1"), repeated("\""), repeated("/*"), repeated("."), repeated("\xff"),
          repeated("StateMachine "), std::string(characters, '\0'), program(repeated("x.y.z."))})
        expect_refused(text);
}

} // namespace
} // namespace tappet
