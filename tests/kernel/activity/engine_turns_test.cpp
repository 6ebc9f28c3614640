// When an engine's periods begin, and parts of it that run by turns.
#include "tests/kernel/activity/execution_engine.hpp"

namespace tappet {
namespace {

TEST_F(ExecutionEngine, begins_its_periods_on_the_grid_that_all_have_whenever_it_is_started) {
    clock.advance_to(Time{} + 7'400us);
    begin();
    next_cycle();
    EXPECT_EQ(workers[0].last.release, Time{} + 8ms);
    next_cycle();
    EXPECT_EQ(workers[0].last.release, Time{} + 9ms);
}

TEST_F(ExecutionEngine, begins_them_behind_the_grid_by_its_phase) {
    plan.phase = 200us;
    clock.advance_to(Time{} + 7'100us);
    begin();
    next_cycle();
    EXPECT_EQ(workers[0].last.release, Time{} + 7'200us);
    next_cycle();
    EXPECT_EQ(workers[0].last.release, Time{} + 8'200us);
}

TEST_F(ExecutionEngine, starts_parts_that_run_by_turns_all_or_none) {
    begin();
    engine.rest(0b10, 0b10);
    engine.leave(0b10);
    next_cycle();
    EXPECT_EQ(log.lines, (Lines{"b stops", "a steps"}));
    log.lines.clear();
    EXPECT_EQ(engine.enter(0b10).outcome, LifeOutcome::done);
    next_cycle();
    EXPECT_EQ(log.lines, (Lines{"b starts", "a steps", "b steps"}));
    parts[1].state = ComponentState::failed;
    engine.leave(0b01);
    EXPECT_EQ(engine.enter(0b11).refusal, LifeRefusal::not_initialised);
    EXPECT_EQ(parts[0].state, ComponentState::stopped) << "it had started, and waits again";
}

} // namespace
} // namespace tappet
