// The words of rows.hpp beyond entry, exit and run, on C++ functions: handle programs, preconditions, else
// branches, regions and history (thesis 5.2.1, listing 5.4), and single steps through functions (5.2.3).
#include "tests/kernel/statechart/recorder.hpp"

#include "kernel/statechart/check.hpp"

namespace tappet {
namespace {

using R = Recorder;

constexpr auto plain = state_machine<R>(
    "plain",
    states(state("a", initial, run<&R::say<"!a">>, handles<&R::say<"~a">>, exit<&R::say<"-a">>),
           state("b", entry<&R::say<"+b">>), state("safe", final)),
    transitions(transition("a", "b", on("go"), guard<&R::if_yes>), transition("b", "a", on("back")),
                transition("a", "safe", guard<&R::if_yes>)));
static_assert(check(plain.view()).empty());

constexpr auto refusing =
    state_machine<R>("refusing",
                     states(state("a", initial), state("b", precondition<&R::if_yes>, entry<&R::say<"+b">>),
                            state("c", entry<&R::say<"+c">>), state("safe", final)),
                     transitions(transition("a", "b", on("go"), otherwise<&R::say<"*no">>, otherwise_to("c")),
                                 transition("b", "a", on("back")), transition("c", "a", on("back"))));
static_assert(check(refusing.view()).empty());

constexpr auto parallel = state_machine<R>(
    "parallel",
    states(state("out", initial), state("x"), state("l1", in("x"), region("l"), initial),
           state("l2", in("x"), region("l"), entry<&R::say<"+l2">>),
           state("r1", in("x"), region("r"), initial),
           state("r2", in("x"), region("r"), entry<&R::say<"+r2">>), state("safe", final)),
    transitions(transition("out", "x", on("go"), deep_history), transition("x", "out", on("back")),
                transition("l1", "l2", on("swap")), transition("r1", "r2", on("swap"))));
static_assert(check(parallel.view()).empty());

TEST(StateMachineWords, handles_runs_when_no_transition_fired) {
    Running<plain> m;
    EXPECT_EQ(m.step(), "!a ~a");
    EXPECT_EQ(m.send("go"), "~a") << "its guard refused";
    m.component.yes = true;
    EXPECT_EQ(m.send("go"), "-a +b");
}

TEST(StateMachineWords, precondition_refuses_an_entry_or_redirects_it) {
    Running<refusing> m;
    EXPECT_EQ(m.send("go"), "*no +c");
    m.send("back");
    m.component.yes = true;
    EXPECT_EQ(m.send("go"), "+b");
}

TEST(StateMachineWords, region_and_history_restore_the_active_states) {
    Running<parallel> m;
    m.send("go");
    EXPECT_EQ(m.send("swap"), "+l2 +r2");
    m.send("back");
    EXPECT_FALSE(m.execution.is_in(find_state(parallel.view(), "x")));
    EXPECT_EQ(m.send("go"), "+l2 +r2");
    EXPECT_TRUE(m.execution.is_in(find_state(parallel.view(), "r2")));
}

TEST(StateMachineWords, single_steps_enter_functions_one_by_one) {
    Running<plain> m;
    m.execution.pause();
    EXPECT_EQ(m.once(), "!a");
    EXPECT_EQ(m.once(), "") << "the condition is asked";
    EXPECT_EQ(m.once(), "~a");
    m.component.yes = true;
    m.execution.dispatch(0, at_ns(4));
    EXPECT_EQ(m.once(), "") << "the event is one";
    EXPECT_EQ(m.once(), "-a");
    EXPECT_EQ(m.once(), "+b");
    m.execution.start(at_ns(5));
    EXPECT_EQ(m.send("back"), "");
    EXPECT_EQ(m.execution.path()[0], "a");
}

} // namespace
} // namespace tappet
