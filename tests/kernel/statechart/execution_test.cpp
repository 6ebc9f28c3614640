// The order of exits, transition programs, entries and runs in machines of C++ functions: the lines of the
// table in kernel/statechart/README.md that need nothing that waits (thesis 5.2.1, 5.2.2).
#include "tests/kernel/statechart/recorder.hpp"

#include "kernel/statechart/check.hpp"

#include <vector>

namespace tappet {
namespace {

using R = Recorder;
using Outcome = StateOutcome;

// idle | a { a1 { a11 a12 } a2 } | b { b1 b2 } | safe; every state says when it is entered, left and run.
constexpr auto tree = state_machine<R>(
    "tree",
    states(
        state("idle", initial, entry<&R::say<"+idle">>, exit<&R::say<"-idle">>, run<&R::say<"!idle">>),
        state("a", entry<&R::say<"+a">>, exit<&R::say<"-a">>, run<&R::say<"!a">>),
        state("a1", in("a"), initial, entry<&R::say<"+a1">>, exit<&R::say<"-a1">>, run<&R::say<"!a1">>),
        state("a11", in("a1"), initial, entry<&R::say<"+a11">>, exit<&R::say<"-a11">>, run<&R::say<"!a11">>),
        state("a12", in("a1"), entry<&R::say<"+a12">>, exit<&R::say<"-a12">>, run<&R::say<"!a12">>),
        state("a2", in("a"), entry<&R::say<"+a2">>, exit<&R::say<"-a2">>, run<&R::say<"!a2">>),
        state("b", entry<&R::say<"+b">>, exit<&R::say<"-b">>, run<&R::say<"!b">>),
        state("b1", in("b"), initial, entry<&R::say<"+b1">>, exit<&R::say<"-b1">>, run<&R::say<"!b1">>),
        state("b2", in("b"), entry<&R::say<"+b2">>, exit<&R::say<"-b2">>, run<&R::say<"!b2">>),
        state("safe", final, entry<&R::say<"+safe">>, exit<&R::say<"-safe">>, run<&R::say<"!safe">>)),
    transitions(transition("idle", "a", on("go"), then<&R::say<"*go">>),
                transition("a11", "b2", on("far"), then<&R::say<"*far">>),
                transition("a11", "a12", on("near"), then<&R::say<"*near">>),
                transition("a11", "a11", on("self"), then<&R::say<"*self">>),
                transition("a", "a2", on("inwards"), then<&R::say<"*inwards">>),
                transition("a11", "a", on("outwards"), then<&R::say<"*outwards">>),
                internal("a", on("stay"), then<&R::say<"*stay">>),
                transition("a11", "a12", on("both"), guard<&R::if_yes>, then<&R::say<"*inner">>),
                transition("a", "b", on("both"), then<&R::say<"*outer">>),
                transition("b", "idle", on("back"), because("sent back")),
                transition("a", "idle", on("back"))));
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

TEST(StateMachine, without_a_machine_does_not_start) {
    StateMachineExecution unbound;
    EXPECT_EQ(unbound.start(at_ns(0)), Outcome::ignored);
    EXPECT_EQ(unbound.dispatch(0, at_ns(0)), Outcome::ignored);
    unbound.step(at_ns(0));
    EXPECT_TRUE(unbound.path().empty());
}

TEST(StateMachine, runs_the_transition_program_then_exits_then_entries_down_to_the_initial_leaf) {
    Running<tree> m;
    EXPECT_EQ(m.send("go"), "*go -idle +a +a1 +a11");
    EXPECT_EQ(m.outcome, Outcome::taken);
    EXPECT_EQ(m.send("far"), "*far -a11 -a1 -a +b +b2");
    EXPECT_EQ(m.outcome, Outcome::taken);
    EXPECT_EQ(m.path(), "b/b2");
}

TEST(StateMachine, leaves_all_below_the_innermost_state_around_source_and_target) {
    static constexpr struct {
        std::string_view event, heard;
    } cases[] = {{"near", "*near -a11 +a12"},
                 {"self", "*self -a11 +a11"},
                 {"inwards", "*inwards -a11 -a1 -a +a +a2"},
                 {"outwards", "*outwards -a11 -a1 -a +a +a1 +a11"}};
    for (const auto& each : cases) {
        Running<tree> m{"go"};
        EXPECT_EQ(m.send(each.event), each.heard) << each.event;
    }
}

TEST(StateMachine, runs_only_the_program_of_an_internal_transition) {
    Running<tree> m{"go"};
    const Time entered = m.execution.entered_at();
    m.now += 5ms;
    EXPECT_EQ(m.send("stay"), "*stay");
    EXPECT_EQ(m.outcome, Outcome::taken);
    EXPECT_EQ(m.path(), "a/a1/a11");
    EXPECT_EQ(m.execution.entered_at(), entered);
}

TEST(StateMachine, asks_the_innermost_state_first_and_goes_outwards_when_its_guard_refuses) {
    Running<tree> inner{"go"};
    inner.component.yes = true;
    EXPECT_EQ(inner.send("both"), "*inner -a11 +a12");
    Running<tree> outer{"go"};
    EXPECT_EQ(outer.send("both"), "*outer -a11 -a1 -a +b +b1");
}

TEST(StateMachine, forgets_an_event_that_no_transition_takes) {
    Running<tree> m;
    EXPECT_EQ(m.dispatch("near"), Outcome::ignored);
    EXPECT_EQ(m.execution.dispatch(99, m.now), Outcome::ignored);
    m.send("go");
    EXPECT_EQ(m.path(), "a/a1/a11");
}

TEST(StateMachine, runs_the_active_states_from_the_outside) {
    Running<tree> m{"go"};
    EXPECT_EQ(m.step(), "!a !a1 !a11");
}

TEST(StateMachine, goes_to_its_final_state_from_anywhere_and_says_why) {
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

TEST(StateMachine, tells_where_it_is_and_counts_its_transitions) {
    Running<tree> m;
    m.now += 3ms;
    m.send("go");
    EXPECT_EQ(m.execution.entered_at(), m.now);
    EXPECT_TRUE(m.execution.is_in(find_state(tree.view(), "a11")));
    EXPECT_TRUE(m.execution.is_in(find_state(tree.view(), "a")));
    EXPECT_FALSE(m.execution.is_in(find_state(tree.view(), "b")));
    EXPECT_EQ(m.execution.status().transitions, 2u); // the start is one
}

TEST(StateMachine, keeps_the_last_reason_until_another_is_given) {
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

TEST(StateMachine, numbers_its_reasons_so_that_an_observer_tells_one_from_the_next) {
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

TEST(StateMachine, traces_every_change) {
    struct Change {
        StateIndex from, to;
        TransitionIndex transition;
        Time now;
        bool operator==(const Change&) const = default;
    };
    struct Changes {
        Bounded<Change, 8> list;
        static void add(void* context, StateIndex from, StateIndex to, TransitionIndex t, Time now) noexcept
            TAPPET_REALTIME {
            static_cast<void>(static_cast<Changes*>(context)->list.push({from, to, t, now}));
        }
    } changes;
    Bound<tree> m;
    m.execution.trace(&Changes::add, &changes);
    m.execution.start(m.now);
    m.send("go");
    m.execution.request_final(m.now);
    m.execution.request_initial(m.now);
    m.execution.deactivate(m.now);
    const auto at = [](std::string_view name) { return find_state(tree.view(), name); };
    const std::vector<Change> expected{{no_state, at("idle"), start_transition, m.now},
                                       {at("idle"), at("a11"), 0, m.now},
                                       {at("a11"), at("safe"), final_transition, m.now},
                                       {at("safe"), at("idle"), reset_transition, m.now},
                                       {at("idle"), no_state, leaving_transition, m.now}};
    EXPECT_EQ((std::vector<Change>{changes.list.begin(), changes.list.end()}), expected);
}

// ---- conditions and time-outs

constexpr auto timed = state_machine<R>(
    "timed",
    states(state("idle", initial, run<&R::say<"!idle">>), state("outer", run<&R::say<"!outer">>),
           state("first", in("outer"), initial, run<&R::say<"!first">>),
           state("second", in("outer"), run<&R::say<"!second">>), state("late", run<&R::say<"!late">>),
           state("safe", final)),
    transitions(transition("idle", "outer", guard<&R::if_yes>, then<&R::say<"*go">>),
                transition("first", "second", after(10ms), then<&R::say<"*10ms">>),
                transition("second", "first", after(30ms), guard<&R::if_asked>, then<&R::say<"*guarded">>),
                transition("outer", "late", after(100ms), because("outer took too long")),
                transition("outer", "safe", on("stop")), transition("late", "idle", after(Duration::max()))));
static_assert(check(timed.view()).empty());

struct InOuter : Running<timed> {
    InOuter() {
        component.yes = true;
        step();
        component.yes = false;
    }
};

TEST(StateMachine, asks_the_conditions_in_every_step_after_the_run_programs) {
    Running<timed> m;
    EXPECT_EQ(m.step(), "!idle");
    m.component.yes = true;
    EXPECT_EQ(m.step(), "!idle *go !outer !first");
}

TEST(StateMachine, times_out_when_the_time_is_reached_and_not_before) {
    InOuter m;
    EXPECT_EQ(m.execution.next_timeout(), m.now + 10ms);
    EXPECT_EQ(m.step(10ms - 1ns), "!outer !first");
    EXPECT_EQ(m.step(1ns), "!outer !first *10ms !second");
    EXPECT_EQ(m.execution.next_timeout(), m.now + 30ms);
}

TEST(StateMachine, counts_the_time_of_a_composite_through_the_changes_inside_it) {
    InOuter m;
    const Time entered = m.now;
    m.step(10ms);
    m.step(60ms);
    EXPECT_EQ(m.execution.next_timeout(), entered + 100ms);
    EXPECT_EQ(m.step(30ms), "!outer !second !late");
    EXPECT_EQ(m.execution.reason(), "outer took too long");
}

TEST(StateMachine, asks_the_guard_of_a_due_time_out_in_every_step) {
    InOuter m;
    m.step(10ms);
    m.step(29ms);
    EXPECT_EQ(m.component.asked, 0);
    m.step(1ms);
    m.step();
    EXPECT_EQ(m.component.asked, 2);
    m.component.yes = true;
    EXPECT_EQ(m.step(), "!outer !second *guarded !first");
    EXPECT_EQ(m.execution.next_timeout(), m.now + 10ms);
}

TEST(StateMachine, treats_a_time_out_past_the_end_of_time_as_never) {
    InOuter m;
    m.step(10ms);
    m.step(90ms);
    EXPECT_EQ(m.path(), "late");
    EXPECT_EQ(m.execution.next_timeout(), never);
    m.step(24h);
    EXPECT_EQ(m.path(), "late");
}

TEST(StateMachine, leaves_condition_transitions_to_the_step_after_an_event) {
    Running<timed> m;
    m.component.yes = true;
    EXPECT_EQ(m.dispatch("stop"), Outcome::ignored);
    EXPECT_EQ(m.path(), "idle");
    EXPECT_EQ(m.step(), "!idle *go !outer !first");
}

// ---- bounds

constexpr auto chain = state_machine<R>(
    "chain",
    states(state("s0", initial), state("s1"), state("s2"), state("s3"), state("s4"), state("s5"), state("s6"),
           state("s7"), state("s8"), state("s9"), state("safe", final, run<&R::say<"!safe">>)),
    transitions(transition("s0", "s1"), transition("s1", "s2"), transition("s2", "s3"),
                transition("s3", "s4"), transition("s4", "s5"), transition("s5", "s6"),
                transition("s6", "s7"), transition("s7", "s8"), transition("s8", "s9"),
                transition("s9", "safe")));
static_assert(check(chain.view()).empty());

TEST(StateMachine, takes_a_bounded_number_of_conditions_in_a_step_and_reports_the_rest) {
    Running<chain> m;
    m.step();
    EXPECT_EQ(m.path(), "s8");
    EXPECT_TRUE(m.execution.left_over());
    EXPECT_EQ(m.execution.next_timeout(), m.now);
    EXPECT_EQ(m.step(), "!safe");
    EXPECT_FALSE(m.execution.left_over());
    EXPECT_EQ(m.execution.next_timeout(), never);
}

// Programs that raise events: triggers are 0 "one", 1 "two", 2 "ring", 3 "fall".
constexpr auto raising = state_machine<R>(
    "raising",
    states(state("idle", initial, exit<&R::raise<"-idle", 1>>), state("x", entry<&R::say<"+x">>),
           state("y", entry<&R::say<"+y">>, run<&R::raise<"!y", 0>>),
           state("ping", entry<&R::raise<"+ping", 2>>), state("pong", entry<&R::raise<"+pong", 2>>),
           state("fall", entry<&R::give_up>, run<&R::say<"!fall">>),
           state("safe", final, entry<&R::say<"+safe">>)),
    transitions(transition("idle", "x", on("one")), transition("x", "y", on("two"), then<&R::say<"*two">>),
                transition("y", "ping", on("ring")), transition("idle", "fall", on("fall")),
                transition("ping", "pong", on("ring")), transition("pong", "ping", on("ring")),
                transition("fall", "idle", guard<&R::if_yes>),
                transition("y", "x", on("one"), then<&R::say<"*one">>)));
static_assert(check(raising.view()).empty());

TEST(StateMachine, handles_an_event_that_a_program_raises_after_the_transition) {
    Running<raising> m;
    EXPECT_EQ(m.dispatch("one"), Outcome::taken);
    EXPECT_EQ(m.component.last_outcome, Outcome::queued);
    EXPECT_EQ(m.component.heard(), "-idle +x *two +y");
}

TEST(StateMachine, handles_an_event_that_a_run_program_raises_after_all_run_programs) {
    Running<raising> m{"one"};
    EXPECT_EQ(m.step(), "!y *one +x");
}

TEST(StateMachine, bounds_a_ring_of_raised_events_and_goes_on_in_the_next_call) {
    Running<raising> m{"one", "ring"};
    EXPECT_TRUE(m.execution.left_over());
    const std::uint64_t taken = m.execution.status().transitions;
    EXPECT_EQ(taken, 1 + 2 + 1 + StateMachineExecution::max_raised_events);
    m.step();
    EXPECT_EQ(m.execution.status().transitions, taken + StateMachineExecution::max_raised_events);
    // After the waiting one: in order, and nothing is lost while there is room.
    EXPECT_EQ(m.dispatch("two"), Outcome::queued);
}

TEST(StateMachine, counts_events_that_have_no_room_to_wait) {
    Running<raising> m{"one", "ring"}; // from here one event always waits
    Outcome outcome = Outcome::queued;
    std::uint64_t lost = 0;
    for (int i = 0; i < 100; ++i) {
        outcome = m.dispatch("ring");
        if (outcome == Outcome::lost) ++lost;
    }
    EXPECT_GT(m.execution.status().lost_events, 0u);
    EXPECT_GE(m.execution.status().lost_events, lost);
    EXPECT_EQ(m.execution.request_final(m.now), Outcome::taken);
    EXPECT_TRUE(m.execution.is_final());
}

TEST(StateMachine, serves_a_request_for_the_final_state_out_of_a_program_before_anything_else) {
    Running<raising> m;
    m.component.yes = true; // would lead back to idle
    EXPECT_EQ(m.dispatch("fall"), Outcome::taken);
    EXPECT_EQ(m.component.last_outcome, Outcome::queued);
    EXPECT_TRUE(m.execution.is_final());
    EXPECT_EQ(m.component.heard(), "-idle give_up +safe");
    EXPECT_EQ(m.execution.reason(), "gave up");
}

TEST(StateMachine, drops_what_waits_when_it_is_deactivated) {
    Running<raising> m{"one", "ring"};
    ASSERT_TRUE(m.execution.left_over());
    EXPECT_EQ(m.execution.deactivate(m.now), Outcome::taken);
    EXPECT_FALSE(m.execution.left_over());
    m.execution.start(m.now);
    m.component.heard();
    m.step();
    EXPECT_EQ(m.path(), "idle");
}

} // namespace
} // namespace tappet
