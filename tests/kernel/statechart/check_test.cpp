// What a state machine must not be, and the sentence that says so. The tables are faulty in one thing each.
#include "kernel/statechart/check.hpp"
#include "kernel/statechart/resolve.hpp"
#include "kernel/statechart/rows.hpp"

#include <gtest/gtest.h>

#include <cstdlib> // exit
#include <string>
#include <vector>

/// A machine's own namespace, as its author writes it.
namespace of_ones_own {

using namespace tappet;

struct Gate {
    void go() noexcept TAPPET_REALTIME {}
};
inline constexpr auto gate = state_machine<Gate>(
    "gate", states(state("open", initial, entry<&Gate::go>, exit<&Gate::go>), state("closed", final)),
    transitions(transition("open", "closed", after(1s))));
static_assert(check(gate.view()).empty(), "no word of a state machine is ambiguous beside the C library's");

} // namespace of_ones_own

namespace tappet {
namespace {

struct Loom {
    void go() noexcept TAPPET_REALTIME {}
    bool ready() const noexcept TAPPET_REALTIME { return true; }
};
struct Other {
    void go() noexcept TAPPET_REALTIME {}
    [[nodiscard]] std::string_view words() const noexcept TAPPET_REALTIME { return "very"; }
};

std::string fault(const auto& states, const auto& transitions) {
    return std::string{check(state_machine<Loom>("m", states, transitions).view()).view()};
}

// A machine that every test changes in one place.
struct Good {
    std::vector<StateRow> states{state("idle", initial, entry<&Loom::go>), state("working"),
                                 state("run_up", in("working"), initial, run<&Loom::go>),
                                 state("weave", in("working"), exit<&Loom::go>), state("safe", final)};
    std::vector<TransitionRow> transitions{
        transition("idle", "run_up", on("panel.start"), guard<&Loom::ready>),
        transition("run_up", "weave", guard<&Loom::ready>, then<&Loom::go>),
        transition("working", "safe", on("panel.emergency")),
        transition("run_up", "safe", after(5s), because("too long")),
        transition("weave", "idle", on("panel.stop"))};

    [[nodiscard]] StateMachineTable view() const { return {"m", states, transitions, type_id<Loom>}; }
    [[nodiscard]] std::string fault() const { return std::string{check(view()).view()}; }
};

/// Changed so, it is refused with the sentence.
void refuses(void (*change)(Good&), std::string_view sentence) {
    Good m;
    change(m);
    EXPECT_EQ(m.fault(), sentence);
}

TEST(StateMachineCheck, finds_no_fault_in_a_good_machine) { EXPECT_EQ(Good{}.fault(), ""); }

TEST(StateMachineCheck, refuses_what_is_faulty_in_one_place) {
    refuses([](Good& m) { m.transitions[2].to = "saef"; },
            "state machine \"m\": transition 3 (\"working\" to \"saef\" on \"panel.emergency\") leads to an "
            "unknown state \"saef\"; did you mean \"safe\"?");
    refuses([](Good& m) { m.transitions[1].from = "xylophone"; },
            "state machine \"m\": transition 2 (\"xylophone\" to \"weave\") leaves an unknown state "
            "\"xylophone\"; name one of the machine's states, or add this one");
    refuses(
        [](Good& m) { m.states[3].parent = "workin"; },
        "state machine \"m\": state \"weave\" is in an unknown state \"workin\"; did you mean \"working\"?");
    refuses([](Good& m) { m.states.push_back(m.states[3]); },
            "state machine \"m\": state \"weave\" is there twice; rename or drop one");
    refuses([](Good& m) { m.states[1].name = ""; }, "state machine \"m\": state 2 has no name; give it one");
    refuses([](Good& m) { m.states[0].initial = false; },
            "state machine \"m\": no top state is initial; mark the one to start in");
    refuses([](Good& m) { m.states[3].initial = true; },
            "state machine \"m\": state \"weave\" is a second initial state in \"working\" beside "
            "\"run_up\"; keep one");
    refuses([](Good& m) { m.states[1].initial = true; },
            "state machine \"m\": state \"working\" is a second initial state at the top beside \"idle\"; "
            "keep one");
    refuses([](Good& m) { m.states[2].initial = false; },
            "state machine \"m\": state \"working\" is composite and none of its states is initial; mark the "
            "one to enter");
    refuses([](Good& m) { m.states[4].final = false; },
            "state machine \"m\": no state is final; mark the safe state that the machine may be brought to "
            "from everywhere");
    refuses([](Good& m) { m.states[0].final = true; },
            "state machine \"m\": state \"safe\" is a second final state beside \"idle\"; keep one, the safe "
            "state that a request leads to from everywhere");
    refuses([](Good& m) { m.states[4].parent = "working"; },
            "state machine \"m\": state \"safe\" is final inside \"working\"; the final state is safe for "
            "the whole machine: take it out of every composite");
    refuses(
        [](Good& m) { m.states.push_back(state("inner", in("safe"), initial)); },
        "state machine \"m\": state \"safe\" is final and has states inside; the safe state is a plain one");
    refuses(
        [](Good& m) {
            m.states.push_back(state("lost"));
            m.transitions.push_back(transition("lost", "idle", on("found")));
        },
        "state machine \"m\": state \"lost\" is never entered; lead a transition to it, make it initial, or "
        "drop it");
    refuses(
        [](Good& m) {
            m.states.push_back(state("trap"));
            m.transitions.push_back(transition("idle", "trap", on("fall")));
            m.transitions.push_back(transition("trap", "trap", on("again")));
            m.transitions.push_back(internal("trap", on("move"), then<&Loom::go>));
        },
        "state machine \"m\": state \"trap\" has no way out; give it a transition, or mark it final");
    refuses(
        [](Good& m) {
            m.transitions.push_back(transition("weave", "safe", on("panel.stop"), guard<&Loom::ready>));
        },
        "state machine \"m\": transition 6 (\"weave\" to \"safe\" on \"panel.stop\") can never be taken, "
        "transition 5 (\"weave\" to \"idle\" on \"panel.stop\") always comes first; give that one a guard<>, "
        "put this one before it, or drop it");
    refuses(
        [](Good& m) {
            m.transitions.push_back(transition("weave", "run_up"));
            m.transitions[1].guard = {};
            m.transitions.erase(m.transitions.begin() + 3); // its time-out would never come
        },
        "state machine \"m\": state \"run_up\" comes back to itself without waiting, by transition 5 "
        "(\"weave\" to \"run_up\"); give one transition of the ring on(...), after(...) or guard<>");
}

TEST(StateMachineCheck, refuses_a_reason_of_a_guard_that_says_nothing_or_is_given_twice) {
    Good m;
    m.transitions[0] = transition("idle", "run_up", on("panel.start"), guard<&Loom::ready>.because(""));
    EXPECT_EQ(m.fault(),
              "state machine \"m\": transition 1 (\"idle\" to \"run_up\" on \"panel.start\") has a "
              "condition whose reason is empty; say what is missing then");
    m.transitions[0] = transition("idle", "run_up", on("panel.start"),
                                  guard<&Loom::ready>.because("it is cold").because("it is old"));
    EXPECT_EQ(m.fault(),
              "state machine \"m\": transition 1 (\"idle\" to \"run_up\" on \"panel.start\") is given "
              "the reason of its guard twice; keep one");
    m.transitions[0] = transition("idle", "run_up", on("panel.start"),
                                  guard<&Loom::ready>.because<&Other::words>("it is cold"));
    EXPECT_EQ(m.fault(), "state machine \"m\": transition 1 (\"idle\" to \"run_up\" on \"panel.start\") has "
                         "programs of two component types; use those of one");
}

TEST(StateMachineCheck, refuses_a_machine_without_states) {
    EXPECT_EQ(check(StateMachineTable{.name = "m"}).view(),
              "state machine \"m\": it has no state; give it an initial and a final one");
}

TEST(StateMachineCheck, refuses_a_state_inside_itself) {
    Good m;
    m.states[1].parent = "weave";
    EXPECT_EQ(m.fault(),
              "state machine \"m\": state \"working\" is inside itself; take one in(...) out of the ring");
    m.states[1].parent = "working";
    EXPECT_EQ(m.fault(),
              "state machine \"m\": state \"working\" is inside itself; take one in(...) out of the ring");
}

TEST(StateMachineCheck, refuses_a_hierarchy_that_is_too_deep) {
    static constexpr std::string_view names[] = {"d1", "d2", "d3", "d4", "d5", "d6", "d7", "d8", "d9"};
    static_assert(std::size(names) == max_state_depth + 1, "one more than the limit");
    Good m;
    m.states.push_back(state(names[0]));
    for (std::size_t i = 1; i < std::size(names); ++i) {
        if (i + 1 == std::size(names)) {
            m.transitions.push_back(transition("weave", "d1", on("deeper")));
            m.transitions.push_back(transition("d1", "idle", on("back")));
            EXPECT_EQ(m.fault(), "") << "the limit itself is good";
        }
        m.states.push_back(state(names[i], in(names[i - 1]), initial));
    }
    EXPECT_EQ(m.fault(),
              "state machine \"m\": state \"d9\" is more than 8 levels deep; flatten the hierarchy");
}

TEST(StateMachineCheck, refuses_a_later_time_out_after_an_earlier_one) {
    Good m;
    m.transitions.push_back(transition("run_up", "idle", after(6s)));
    EXPECT_NE(m.fault().find("transition 6 (\"run_up\" to \"idle\") can never be taken"), std::string::npos)
        << m.fault();
    m.transitions.back().after = 4s;
    EXPECT_EQ(m.fault(), "");
}

TEST(StateMachineCheck, refuses_an_outer_transition_only_when_all_states_inside_take_it_away) {
    Good m;
    m.transitions.push_back(transition("run_up", "idle", on("panel.emergency")));
    EXPECT_EQ(m.fault(), "");
    m.transitions.push_back(transition("weave", "idle", on("panel.emergency")));
    EXPECT_NE(
        m.fault().find("transition 3 (\"working\" to \"safe\" on \"panel.emergency\") can never be taken"),
        std::string::npos)
        << m.fault();
}

TEST(StateMachineCheck, refuses_parts_that_contradict_each_other) {
    Good both;
    both.transitions[0].timed = true;
    both.transitions[0].after = 1s;
    EXPECT_NE(both.fault().find("has both on(...) and after(...); make two transitions of it"),
              std::string::npos);
    for (const Duration wrong : {Duration{0}, Duration{-1}}) {
        Good time;
        time.transitions[3].after = wrong;
        EXPECT_NE(time.fault().find("has a time-out that is not positive"), std::string::npos);
    }
    Good nameless;
    nameless.transitions[0].event = "";
    EXPECT_NE(nameless.fault().find("waits for an event without a name"), std::string::npos);
    Good silent;
    silent.transitions.push_back(internal("weave", on("x")));
    EXPECT_NE(silent.fault().find("is internal and does nothing"), std::string::npos);
    Good eager;
    eager.transitions.push_back(internal("weave", then<&Loom::go>));
    EXPECT_NE(eager.fault().find("is internal and has no event"), std::string::npos);
}

TEST(StateMachineCheck, refuses_a_part_that_a_row_is_given_twice) {
    EXPECT_EQ(fault(states(state("a", initial, final, entry<&Loom::go>, entry<&Loom::go>)), transitions()),
              "state machine \"m\": state \"a\" is given entry twice; keep one");
    EXPECT_EQ(fault(states(state("a", initial, final)), transitions(transition("a", "a", on("x"), on("y")))),
              "state machine \"m\": transition 1 (\"a\" to \"a\" on \"y\") is given on twice; keep one");
}

TEST(StateMachineCheck, refuses_programs_of_another_component) {
    const std::string foreign = fault(states(state("a", initial, final, entry<&Other::go>)), transitions());
    EXPECT_NE(foreign.find("state \"a\" has a program of "), std::string::npos) << foreign;
    EXPECT_NE(foreign.find("Other, and the machine is one of "), std::string::npos) << foreign;
    EXPECT_EQ(fault(states(state("a", initial, final, entry<&Loom::go>, exit<&Other::go>)), transitions()),
              "state machine \"m\": state \"a\" has programs of two component types; use those of one");
}

TEST(StateMachineCheck, refuses_more_rows_than_the_limits) {
    Good m;
    m.states.resize(max_states + 1, m.states[0]);
    EXPECT_EQ(m.fault(), "state machine \"m\": it has 257 states and may have 256; split it over components");
    Good n;
    n.transitions.resize(max_transitions + 1, n.transitions[0]);
    EXPECT_EQ(n.fault(),
              "state machine \"m\": it has 1025 transitions and may have 1024; split it over components");
}

TEST(StateMachineCheck, refuses_more_events_than_the_limit) {
    Good m;
    std::vector<std::string> names;
    for (std::size_t i = 0; i <= max_state_events - 3; ++i) names.push_back("event" + std::to_string(i));
    for (const std::string& name : names) m.transitions.push_back(transition("idle", "safe", on(name)));
    EXPECT_EQ(m.fault(),
              "state machine \"m\": it hears 256 events and may hear 255; split it over components");
    m.transitions.pop_back();
    EXPECT_EQ(m.fault(), "");
}

TEST(StateMachineCheck, refuses_more_transitions_of_leaves_than_can_be_numbered) {
    Good m;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < 100; ++i) names.push_back("inner" + std::to_string(i));
    for (const std::string& name : names) {
        m.states.push_back(state(name, in("working")));
        m.transitions.push_back(transition("run_up", name, on("panel.choose"), guard<&Loom::ready>));
    }
    EXPECT_EQ(m.fault(), "");
    for (std::size_t i = 0; i < 35; ++i)
        m.transitions.push_back(transition("working", "idle", on("panel.leave"), guard<&Loom::ready>));
    const std::string said = m.fault();
    EXPECT_NE(
        said.find("plain states together and may out of 3600; move transitions of wide composites inwards"),
        std::string::npos)
        << said;
}

TEST(StateMachineCheck, finds_every_misspelt_name_and_names_its_row) {
    const std::size_t states = Good{}.states.size();
    const std::size_t transitions = Good{}.transitions.size();
    const auto expect = [](const Good& m, const std::string& row, const std::string& cure) {
        const std::string said = m.fault();
        EXPECT_NE(said.find(row), std::string::npos) << said;
        EXPECT_NE(said.find("did you mean \"" + cure + "\"?"), std::string::npos) << said;
    };
    for (std::size_t t = 0; t < transitions; ++t) {
        for (std::string_view TransitionRow::* end : {&TransitionRow::from, &TransitionRow::to}) {
            Good m;
            const std::string right{m.transitions[t].*end};
            const std::string wrong = right + "x";
            m.transitions[t].*end = wrong;
            expect(m, "transition " + std::to_string(t + 1) + " (", right);
        }
    }
    for (std::size_t s = 0; s < states; ++s) {
        Good m;
        if (m.states[s].parent.empty()) continue;
        const std::string right{m.states[s].parent};
        const std::string wrong = right.substr(1);
        m.states[s].parent = wrong;
        expect(m, "state \"" + std::string{m.states[s].name} + "\"", right);
    }
}

TEST(StateMachineCheck, finds_every_dropped_and_doubled_row_that_matters) {
    for (std::size_t s = 0; s < Good{}.states.size(); ++s) {
        Good dropped;
        dropped.states.erase(dropped.states.begin() + static_cast<std::ptrdiff_t>(s));
        EXPECT_NE(dropped.fault(), "") << "without state " << s + 1;
        Good doubled;
        doubled.states.push_back(doubled.states[s]);
        EXPECT_NE(doubled.fault().find(std::string{doubled.states[s].name}), std::string::npos);
    }
    for (std::size_t t = 0; t < Good{}.transitions.size(); ++t) {
        Good doubled;
        doubled.transitions.push_back(doubled.transitions[t]);
        // After a row with a guard its double may still be taken.
        EXPECT_EQ(doubled.fault().empty(), !doubled.transitions[t].guard.empty()) << "transition " << t + 1;
    }
}

TEST(StateMachineCheck, works_in_a_constant_expression) {
    static constexpr auto wrong =
        state_machine<Loom>("wrong", states(state("a", initial, final)), transitions(transition("a", "b")));
    constexpr Sentence said = check(wrong.view());
    static_assert(said.view() ==
                  "state machine \"wrong\": transition 1 (\"a\" to \"b\") leads to an unknown state \"b\"; "
                  "name one of the machine's states, or add this one");
    static_assert(resolved<wrong>.view().plans == nullptr, "a faulty machine resolves to nothing");
    EXPECT_FALSE(said.empty());
}

} // namespace
} // namespace tappet
