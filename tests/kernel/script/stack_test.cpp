// The stack use of a compilation for any text (thesis 5.1.4): at most the stated size, since the activity
// that compiles a loaded script has no more.
#include "kernel/script/compile.hpp"
#include "tests/kernel/script/fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <pthread.h>

namespace script_test {
namespace {

constexpr ScriptSizes room_sizes = script_sizes_for(4000, 16384, 3);

std::string repeat(std::string_view piece, std::size_t times) {
    std::string text;
    for (std::size_t i = 0; i < times; ++i) text += piece;
    return text;
}
std::string in_program(const std::string& statements) { return "program p { " + statements + " }"; }

std::string many_states(std::size_t states) {
    std::string text = "StateMachine M { initial state S0 { transitions { select S1 } } ";
    for (std::size_t i = 1; i < states; ++i)
        text += "state S" + std::to_string(i) + " { transition halt() select S" +
                std::to_string(i + 1 < states ? i + 1 : 0) + " } ";
    return text + "final state F { } } RootStateMachine M m()";
}
std::string states_inside(std::size_t depth) {
    std::string text = "StateMachine M { ";
    for (std::size_t i = 0; i < depth; ++i)
        text += (i == 0 ? "initial state S" : " initial state S") + std::to_string(i) + " { ";
    return text + repeat("} ", depth) + "final state F { } } RootStateMachine M m()";
}
std::string functions_in_functions(std::size_t depth) {
    std::string text = "int f0(int a) { return a + 1; } ";
    for (std::size_t i = 1; i < depth; ++i) {
        const std::string inner = "f" + std::to_string(i - 1);
        text += "int f" + std::to_string(i) + "(int a) { return " + inner + "((a)) + (" + inner + "(a)); } ";
    }
    return text + in_program("var int x = f" + std::to_string(depth - 1) + "(1);");
}

const std::vector<std::string>& texts() {
    static const std::vector<std::string> all = [] {
        std::vector<std::string> list;
        for (const std::size_t depth : {10u, 40u, 47u, 1000u}) {
            list.push_back(in_program("var int x = " + repeat("(", depth) + "1" + repeat(")", depth) + ";"));
            list.push_back(in_program("var int x = " + repeat("-", depth) + "1;"));
            list.push_back(in_program("var bool x = " + repeat("!(true || ", depth) + "false" +
                                      repeat(")", depth) + ";"));
            list.push_back(in_program("var double x = " + repeat("abs(1.0 + ", depth) + "1.0" +
                                      repeat(")", depth) + ";"));
            list.push_back(in_program(repeat("{ ", depth) + repeat("} ", depth)));
            list.push_back(
                in_program(repeat("if (true) then { ", depth) + repeat("} else { yield; } ", depth)));
            list.push_back(in_program(repeat("while (true) { yield; ", depth) + repeat("} ", depth)));
            list.push_back(in_program(repeat("try do refuse() catch { ", depth) + repeat("} ", depth)));
            list.push_back(states_inside(depth));
            list.push_back(functions_in_functions(depth));
        }
        for (const std::size_t states : {20u, 200u, 255u, 2000u}) list.push_back(many_states(states));
        list.push_back(repeat("StateMachine ", 1000));
        list.push_back(in_program("do unkown" + repeat("n", 3000) + "();"));
        return list;
    }();
    return all;
}

struct Job {
    std::string_view text;
    ScriptOutcome outcome;
};

std::size_t stack_taken(std::string_view text) {
    constexpr std::size_t most = 1024 * 1024;
    constexpr unsigned char paint = 0xa7;
    static ScriptBuffer<room_sizes> buffer;
    alignas(64) static unsigned char stack[most];
    std::fill(std::begin(stack), std::end(stack), paint);
    Job job{text, {}};
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    EXPECT_EQ(pthread_attr_setstack(&attributes, stack, most), 0);
    pthread_t thread{};
    const auto run = [](void* self) -> void* {
        auto& own = *static_cast<Job*>(self);
        Reach reach;
        reach.components = components();
        own.outcome = compile(own.text, "deep.osd", reach, buffer.room());
        return nullptr;
    };
    EXPECT_EQ(pthread_create(&thread, &attributes, run, &job), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
    const auto* first_used =
        std::find_if(std::begin(stack), std::end(stack), [](unsigned char c) { return c != paint; });
    return static_cast<std::size_t>(std::end(stack) - first_used);
}

TEST(ScriptStack, stays_within_the_stated_size_for_any_text) {
    std::size_t most = 0;
    std::string_view worst;
    for (const std::string& text : texts()) {
        const std::size_t taken = stack_taken(text);
        if (taken > most) most = taken, worst = text;
    }
    // The stack also holds the thread's own descriptor, as in an activity.
    std::printf("most stack: %zu bytes of %zu, by: %.80s\n", most, script_stack_bytes, worst.data());
    EXPECT_LE(most, script_stack_bytes);
    EXPECT_GE(2 * most, script_stack_bytes) << "so much is not needed: state less";
}

} // namespace
} // namespace script_test
