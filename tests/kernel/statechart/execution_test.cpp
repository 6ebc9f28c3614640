// External requests to a state machine: start, deactivation, its final state, its current state and the
// reason (thesis 5.2.1, 5.2.2). Its programs are C++ functions; order_test.cpp tests their order.
#include "tests/kernel/statechart/recorder.hpp"

#include "kernel/statechart/check.hpp"

namespace tappet {
namespace {

using R = Recorder;
using Outcome = StateOutcome;

// idle | a { a1 { a11 } } | b | safe; every state says when it is entered and left.
constexpr auto tree =
    state_machine<R>("tree",
                     states(state("idle", initial, entry<&R::say<"+idle">>, exit<&R::say<"-idle">>),
                            state("a", entry<&R::say<"+a">>, exit<&R::say<"-a">>),
                            state("a1", in("a"), initial, entry<&R::say<"+a1">>, exit<&R::say<"-a1">>),
                            state("a11", in("a1"), initial, entry<&R::say<"+a11">>, exit<&R::say<"-a11">>),
                            state("b", entry<&R::say<"+b">>, exit<&R::say<"-b">>, run<&R::say<"!b">>),
                            state("safe", final, entry<&R::say<"+safe">>, exit<&R::say<"-safe">>)),
                     transitions(transition("idle", "a", on("go"), then<&R::say<"*go">>),
                                 transition("a11", "b", on("far"), then<&R::say<"*far">>),
                                 transition("b", "idle", on("back"), because("sent back"))));
static_assert(check(tree.view()).empty());

TEST(StateMachine, enters_the_initial_state_at_start) {
    Bound<tree> m;
    EXPECT_FALSE(m.execution.is_active());
    EXPECT_EQ(m.execution.start(m.now), Outcome::taken);
    EXPECT_EQ(m.component.heard(), "+idle");
    EXPECT_EQ(m.path(), "idle");
    EXPECT_EQ(m.execution.start(m.now), Outcome::ignored);
}

TEST(StateMachine, does_nothing_before_start_and_after_deactivation) {
    Bound<tree> m;
    EXPECT_EQ(m.dispatch("go"), Outcome::ignored);
    EXPECT_EQ(m.execution.request_final(m.now), Outcome::ignored);
    EXPECT_EQ(m.execution.request_initial(m.now), Outcome::ignored);
    EXPECT_EQ(m.execution.deactivate(m.now), Outcome::ignored);
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.execution.next_timeout(), never);
    m.execution.start(m.now);
    m.send("go");
    m.component.heard();
    EXPECT_EQ(m.execution.deactivate(m.now), Outcome::taken);
    EXPECT_EQ(m.component.heard(), "-a11 -a1 -a");
    EXPECT_EQ(m.dispatch("back"), Outcome::ignored);
    EXPECT_EQ(m.step(), "");
    EXPECT_EQ(m.execution.start(m.now), Outcome::taken);
    EXPECT_EQ(m.component.heard(), "+idle");
}

TEST(StateMachine, does_not_start_without_a_table) {
    StateMachineExecution unbound;
    EXPECT_EQ(unbound.start(at_ns(0)), Outcome::ignored);
    EXPECT_EQ(unbound.dispatch(0, at_ns(0)), Outcome::ignored);
    unbound.step(at_ns(0));
    EXPECT_TRUE(unbound.path().empty());
}

TEST(StateMachine, drops_an_event_that_no_transition_handles) {
    Running<tree> m;
    EXPECT_EQ(m.dispatch("far"), Outcome::ignored);
    EXPECT_EQ(m.execution.dispatch(99, m.now), Outcome::ignored);
    EXPECT_EQ(m.send("go"), "*go -idle +a +a1 +a11");
    EXPECT_EQ(m.path(), "a/a1/a11");
}

TEST(StateMachine, goes_to_its_final_state_from_anywhere_and_reports_why) {
    for (const char* event : {"", "go", "far"}) {
        Running<tree> m;
        if (*event != 0) m.send("go");
        if (*event == 'f') m.send("far");
        m.component.heard();
        EXPECT_EQ(m.execution.request_final(m.now, "bus off"), Outcome::taken);
        EXPECT_TRUE(m.execution.is_final());
        EXPECT_EQ(m.execution.reason(), "bus off");
        EXPECT_EQ(m.execution.status().reason, final_transition);
        const std::string heard = m.component.heard();
        EXPECT_TRUE(heard.ends_with(" +safe") && heard.starts_with("-")) << heard;
        EXPECT_EQ(m.execution.request_final(m.now), Outcome::ignored);
        EXPECT_EQ(m.component.heard(), "");
    }
}

TEST(StateMachine, is_reset_from_the_final_state_only) {
    Running<tree> m;
    EXPECT_EQ(m.execution.request_initial(m.now), Outcome::ignored);
    m.execution.request_final(m.now);
    m.component.heard();
    EXPECT_EQ(m.execution.request_initial(m.now), Outcome::taken);
    EXPECT_EQ(m.component.heard(), "-safe +idle");
}

TEST(StateMachine, reports_its_state_and_counts_its_transitions) {
    Running<tree> m;
    m.now += 3ms;
    m.send("go");
    EXPECT_EQ(m.execution.entered_at(), m.now);
    EXPECT_TRUE(m.execution.is_in(find_state(tree.view(), "a11")));
    EXPECT_TRUE(m.execution.is_in(find_state(tree.view(), "a")));
    EXPECT_FALSE(m.execution.is_in(find_state(tree.view(), "b")));
    EXPECT_EQ(m.execution.status().transitions, 2u); // the start counts as one
}

TEST(StateMachine, keeps_the_last_reason_until_a_new_one) {
    Running<tree> m;
    EXPECT_EQ(m.execution.reason(), "");
    m.send("go");
    m.send("far");
    EXPECT_EQ(m.dispatch("back"), Outcome::taken);
    EXPECT_EQ(m.execution.reason(), "sent back");
    const Time given = m.now;
    m.now += 1s;
    m.send("go");
    EXPECT_EQ(m.execution.reason(), "sent back");
    EXPECT_EQ(m.execution.status().reason_at, given);
}

TEST(StateMachine, numbers_its_reasons_so_that_observers_can_distinguish_them) {
    Running<tree> m;
    EXPECT_EQ(m.execution.news().number, 0u);
    std::uint64_t seen = 0;
    for (int round = 0; round < 2; ++round) {
        m.send("go");
        m.send("far");
        m.send("back");
        EXPECT_EQ(m.execution.news().number, ++seen);
        EXPECT_EQ(m.execution.machine().table.transitions[m.execution.news().transition].because,
                  "sent back");
    }
    m.execution.request_final(m.now, "bus off");
    EXPECT_EQ(m.execution.news(), (StateMachineExecution::News{seen + 1, final_transition}));
}

constexpr auto forever = state_machine<R>("forever", states(state("waits", initial), state("safe", final)),
                                          transitions(transition("waits", "safe", after(Duration::max()))));
static_assert(check(forever.view()).empty());

TEST(StateMachine, treats_a_time_out_past_the_end_of_time_as_never) {
    Running<forever> m;
    EXPECT_EQ(m.execution.next_timeout(), never);
    m.step(24h);
    EXPECT_EQ(m.path(), "waits");
}

} // namespace
} // namespace tappet
