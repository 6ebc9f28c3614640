// The cost of a statement of a loaded program, in calls through a pointer to a function that does nothing,
// measured in the same run (thesis 5.1.7: reasonable speed under real-time conditions).
#include "tests/kernel/program/fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <thread>

namespace program_test {

constexpr std::uint32_t statements = 1000;

using Call = void (*)(const void*, const void*, const void*, const void*, const void*);
[[gnu::noinline]] void nothing(const void*, const void*, const void*, const void*, const void*) {
    asm volatile("");
}

/// The minimum of many runs, since any disturbance makes a run longer.
template <class F>
double shortest_ns(const F& run) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 2000; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        run();
        const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
        best = std::min(best, took.count());
    }
    return best / statements;
}

double call_ns() {
    return shortest_ns([] {
        Call call = &nothing;
        for (std::uint32_t i = 0; i < statements; ++i) {
            asm volatile("" : "+r"(call)); // the compiler cannot know which function it is
            call(nullptr, nullptr, nullptr, nullptr, nullptr);
        }
    });
}
double statement_ns(TableBuilder& table) {
    Running running{table, {.statements = statements}};
    running.run();
    EXPECT_TRUE(running.execution.left_over()) << "a loop without end";
    return shortest_ns([&] { running.execution.step(at_ns(1)); });
}

TEST(A_statement_of_a_loaded_program, costs_less_than_five_calls_through_a_pointer) {
    TableBuilder assignments; // of four variables in turn, for ever
    const DataOffset one = assignments.value(ScriptInt{1});
    for (NodeIndex i = 0; i < 32; ++i) {
        static DataOffset count[4];
        if (i < 4) count[i] = assignments.value(ScriptInt{0});
        assignments.node({increment(count[i % 4], one)}).arc(static_cast<NodeIndex>((i + 1) % 32));
    }
    TableBuilder loop; // while (i >= 0) { set i = i + 1; }
    const DataOffset step = loop.value(ScriptInt{1});
    const DataOffset zero = loop.value(ScriptInt{0});
    const DataOffset i = loop.value(ScriptInt{0});
    const DataOffset holds = loop.scratch();
    const Instruction not_negative = find_binary(Operator::at_least, script_int, script_int).instruction;
    loop.node({})
        .arc(1, loop.condition({TableBuilder::with(not_negative, holds, i, zero)}, holds))
        .arc(end_node);
    loop.node({increment(i, step)}).arc(0);

    // A busy neighbour of the processor slows down statements but not calls: the best of several attempts
    // counts.
    double call = 0, assignment = 0, looping = 0;
    for (int moment = 0; moment < 20; ++moment) {
        call = call_ns();
        const double straight = statement_ns(assignments) / call, round = statement_ns(loop) / call;
        assignment = moment == 0 ? straight : std::min(assignment, straight);
        looping = moment == 0 ? round : std::min(looping, round);
        if (assignment < 5 && looping < 6) break;
        std::this_thread::sleep_for(std::chrono::milliseconds{100});
    }
    std::printf("a call %.2f ns; an assignment %.1f calls, a statement of a while loop %.1f calls\n", call,
                assignment, looping);
    EXPECT_LT(assignment, 5);
    EXPECT_LT(looping, 6) << "half of them ask a condition: a second instruction and a second table";
}

} // namespace program_test
