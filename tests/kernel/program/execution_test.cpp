// Programs as graphs (thesis 5.1.1 to 5.1.3): nodes act once, arcs are evaluated in order, a program without
// an open arc waits; its status and its policies.
#include "tests/kernel/program/fixture.hpp"

#include <gtest/gtest.h>

namespace program_test {

/// A table with a counter.
struct Counting : TableBuilder {
    DataOffset one = value(ScriptInt{1});
    DataOffset count = value(ScriptInt{0});
    Instruction counts() { return increment(count, one); }
};

/// Counts how often each of its nodes acted: the first always continues, the second waits for a bool.
struct WaitingProgram {
    TableBuilder table{};
    DataOffset one = table.value(ScriptInt{1});
    DataOffset first = table.value(ScriptInt{0});
    DataOffset second = table.value(ScriptInt{0});
    DataOffset third = table.value(ScriptInt{0});
    DataOffset go = table.value(false);
    ConditionIndex may_go = table.condition({}, go);
    WaitingProgram() {
        table.node({increment(first, one)}).arc(1);
        table.node({increment(second, one)}).arc(2, may_go);
        table.node({increment(third, one)}).arc(end_node);
    }
};

TEST(A_program, waits_without_an_open_arc_and_acts_there_once) {
    WaitingProgram p;
    Running running{p.table};
    EXPECT_EQ(running.execution.status(), ProgramStatus::ready);
    EXPECT_EQ(running.run(), ProgramStatus::running);
    running.step(at_ms(1));
    running.step(at_ms(2));
    EXPECT_EQ(running.get<ScriptInt>(p.first), 1);
    EXPECT_EQ(running.get<ScriptInt>(p.second), 1);
    EXPECT_EQ(running.get<ScriptInt>(p.third), 0);
    EXPECT_EQ(running.execution.line(), 2);
    EXPECT_EQ(running.execution.wakes(), never);
    running.put(p.go, true);
    EXPECT_EQ(running.step(at_ms(3)), ProgramStatus::stopped);
    EXPECT_EQ(running.get<ScriptInt>(p.third), 1);
}

TEST(A_program, continues_in_the_next_step_after_a_yield) {
    Counting table;
    table.node({table.counts()}).arc(0);
    table.last().yields = true;
    Running running{table};
    for (int step = 0; step < 5; ++step) {
        step == 0 ? running.run() : running.step(at_ms(step));
        EXPECT_EQ(running.get<ScriptInt>(table.count), step + 1);
        EXPECT_FALSE(running.execution.left_over());
    }
}

TEST(A_time_out, opens_its_arc_after_its_time_since_the_node_was_entered) {
    TableBuilder table;
    const DataOffset after = table.value(Duration{20ms});
    const DataOffset go = table.value(false);
    table.node({}).arc(1, table.condition({}, go)).arc(end_node, no_condition, after);
    table.node({fail_instruction()});
    Running running{table};
    EXPECT_EQ(running.run(at_ms(100)), ProgramStatus::running);
    EXPECT_EQ(running.execution.wakes(), at_ms(120));
    EXPECT_EQ(running.step(at_ms(119)), ProgramStatus::running);
    EXPECT_EQ(running.execution.wakes(), at_ms(120));
    EXPECT_EQ(running.step(at_ms(120)), ProgramStatus::stopped);
    EXPECT_EQ(running.execution.wakes(), never);
}

TEST(A_time_out, puts_the_program_in_error_when_it_leads_nowhere) {
    TableBuilder table;
    const DataOffset limit = table.value(Duration{20ms});
    const DataOffset go = table.value(false);
    table.node({}).arc(end_node, table.condition({}, go)).arc(no_node, no_condition, limit);
    Running running{table};
    EXPECT_EQ(running.run(at_ms(100)), ProgramStatus::running);
    EXPECT_EQ(running.step(at_ms(120)), ProgramStatus::error);
    EXPECT_EQ(running.execution.line(), 1);
}

ActionResult not_yet(ProgramContext&, const Instruction&, std::byte*, const std::byte*,
                     const std::byte*) noexcept TAPPET_REALTIME {
    return ActionResult::again;
}

TEST(A_time_out, opens_its_arc_during_a_waiting_action_but_a_condition_does_not) {
    TableBuilder table;
    const DataOffset limit = table.value(Duration{20ms});
    const DataOffset done = table.value(true);
    table.node({{.run = &not_yet}}).arc(1, table.condition({}, done)).arc(end_node, no_condition, limit);
    table.node({fail_instruction()});
    Running running{table};
    EXPECT_EQ(running.run(at_ms(100)), ProgramStatus::running);
    EXPECT_EQ(running.execution.wakes(), at_ms(120));
    EXPECT_EQ(running.step(at_ms(119)), ProgramStatus::running);
    EXPECT_EQ(running.step(at_ms(120)), ProgramStatus::stopped);
}

TEST(An_action_that_fails, puts_the_program_in_error_at_its_node) {
    Counting table;
    table.node({}).arc(1);
    table.node({fail_instruction(), table.counts()}).arc(2);
    table.node({table.counts()}).arc(end_node);
    Running running{table};
    EXPECT_EQ(running.run(), ProgramStatus::error);
    EXPECT_EQ(running.execution.line(), 2);
    EXPECT_EQ(running.execution.failures(), 1u);
    EXPECT_EQ(running.step(at_ms(1)), ProgramStatus::error);
    EXPECT_EQ(running.get<ScriptInt>(table.count), 0);
    EXPECT_FALSE(running.execution.start()) << "an error is left by stop or reset";
    EXPECT_TRUE(running.execution.stop());
    EXPECT_EQ(running.execution.status(), ProgramStatus::stopped);
}

TEST(A_condition_that_fails, fails_its_node) {
    TableBuilder table;
    const DataOffset one = table.value(ScriptInt{1});
    const DataOffset zero = table.value(ScriptInt{0});
    const DataOffset to = table.scratch();
    table.node({}).arc(
        end_node,
        table.condition({TableBuilder::with(find_binary(Operator::divide, script_int, script_int).instruction,
                                            to, one, zero)},
                        to));
    Running running{table};
    EXPECT_EQ(running.run(), ProgramStatus::error);
    EXPECT_EQ(running.execution.line(), 1);
}

TEST(A_program_that_continues_on_error, skips_failures) {
    Counting table;
    table.node({fail_instruction()}).arc(1);
    table.node({table.counts()}).arc(0);
    Running running{table, {.statements = 10, .continue_on_error = true}};
    EXPECT_EQ(running.run(), ProgramStatus::running);
    EXPECT_TRUE(running.execution.left_over());
    EXPECT_EQ(running.get<ScriptInt>(table.count), 5) << "ten statements: each second one fails";
    EXPECT_EQ(running.execution.failures(), 5u);
}

TEST(A_step, executes_a_bounded_number_of_statements_and_reports_the_rest) {
    for (const std::uint32_t bound : {1u, 2u, 7u, 100u}) {
        Counting table;
        table.node({table.counts()}).arc(0); // for ever
        Running running{table, {.statements = bound}};
        running.run(at_ms(5));
        EXPECT_TRUE(running.execution.left_over());
        EXPECT_EQ(running.execution.wakes(), at_ms(5)) << "at once";
        EXPECT_EQ(running.get<ScriptInt>(table.count), bound);
        running.step(at_ms(6));
        EXPECT_EQ(running.get<ScriptInt>(table.count), 2 * bound);
    }
}

TEST(A_paused_program, executes_one_statement_when_it_is_stepped_from_outside) {
    WaitingProgram p;
    Running running{p.table};
    EXPECT_FALSE(running.execution.pause()) << "only what runs is paused";
    ASSERT_TRUE(running.execution.start());
    ASSERT_TRUE(running.execution.pause());
    EXPECT_EQ(running.step(at_ms(1)), ProgramStatus::paused);
    EXPECT_EQ(running.get<ScriptInt>(p.first), 0) << "the engine's step passes it by";
    ASSERT_TRUE(running.execution.single_step(at_ms(2)));
    EXPECT_EQ(running.get<ScriptInt>(p.first), 1);
    EXPECT_EQ(running.get<ScriptInt>(p.second), 0);
    ASSERT_TRUE(running.execution.single_step(at_ms(3)));
    EXPECT_EQ(running.get<ScriptInt>(p.second), 1);
    EXPECT_FALSE(running.execution.left_over());
    ASSERT_TRUE(running.execution.start());
    running.put(p.go, true);
    EXPECT_EQ(running.step(at_ms(4)), ProgramStatus::stopped);
    EXPECT_FALSE(running.execution.single_step(at_ms(5)));
}

TEST(A_stopped_program, starts_from_its_first_node_and_keeps_its_data_until_it_is_reset) {
    WaitingProgram p;
    Running running{p.table};
    running.run();
    EXPECT_FALSE(running.execution.reset()) << "it runs";
    ASSERT_TRUE(running.execution.stop());
    EXPECT_EQ(running.step(at_ms(1)), ProgramStatus::stopped);
    running.run(at_ms(2));
    EXPECT_EQ(running.get<ScriptInt>(p.first), 2);
    ASSERT_TRUE(running.execution.stop());
    ASSERT_TRUE(running.execution.reset());
    EXPECT_EQ(running.execution.status(), ProgramStatus::ready);
    EXPECT_EQ(running.get<ScriptInt>(p.first), 0);
}

TEST(An_instruction_that_skips, omits_the_instructions_that_follow_it) {
    for (const bool is : {false, true}) {
        TableBuilder table;
        const DataOffset one = table.value(ScriptInt{1});
        const DataOffset left = table.value(is);
        const DataOffset skipped = table.value(ScriptInt{0});
        const DataOffset after = table.value(ScriptInt{0});
        table
            .node({TableBuilder::with(skip_instruction(true, 2), no_data, left), increment(skipped, one),
                   increment(skipped, one), increment(after, one)})
            .arc(end_node);
        Running running{table};
        EXPECT_EQ(running.run(), ProgramStatus::stopped);
        EXPECT_EQ(running.get<ScriptInt>(skipped), is ? 2 : 0);
        EXPECT_EQ(running.get<ScriptInt>(after), 1);
    }
}

} // namespace program_test
