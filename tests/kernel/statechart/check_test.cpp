// The faults of state machines, and the sentence for each (thesis 5.2, UML 2.5.1 clause 14). Each table has
// one fault.
#include "kernel/statechart/check.hpp"
#include "kernel/statechart/resolve.hpp"
#include "kernel/statechart/rows.hpp"

#include <gtest/gtest.h>

#include <cstdlib> // exit
#include <initializer_list>
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

struct Machine {
    std::vector<StateRow> states;
    std::vector<TransitionRow> transitions;

    void add(const StateRow& row) { states.push_back(row); }
    void add(const TransitionRow& row) { transitions.push_back(row); }
    [[nodiscard]] std::string fault() const {
        return std::string{check({"m", states, transitions, type_id<Loom>}).view()};
    }
};

// idle | working { run_up weave } | safe
Machine plain() {
    return {{state("idle", initial, entry<&Loom::go>), state("working"),
             state("run_up", in("working"), initial, run<&Loom::go>),
             state("weave", in("working"), exit<&Loom::go>), state("safe", final)},
            {transition("idle", "run_up", on("panel.start"), guard<&Loom::ready>),
             transition("run_up", "weave", guard<&Loom::ready>, then<&Loom::go>),
             transition("working", "safe", on("panel.emergency")),
             transition("run_up", "safe", after(5s), because("too long")),
             transition("weave", "idle", on("panel.stop"))}};
}

// idle | work { shaft: stands turns   weft: waits flies } | safe
Machine regions() {
    return {{state("idle", initial), state("work", precondition<&Loom::ready>, handles<&Loom::go>),
             state("stands", in("work"), region("shaft"), initial),
             state("turns", in("work"), region("shaft")), state("waits", in("work"), region("weft"), initial),
             state("flies", in("work"), region("weft")), state("safe", final)},
            {transition("idle", "work", on("start")), transition("idle", "work", on("resume"), deep_history),
             transition("stands", "turns", on("start"), guard<&Loom::ready>, otherwise<&Loom::go>),
             transition("waits", "flies", on("release"), guard<&Loom::ready>, otherwise_to("safe")),
             transition("flies", "waits", on("arrived")), transition("work", "idle", on("stop"))}};
}

TEST(StateMachineCheck, accepts_a_good_machine) {
    EXPECT_EQ(plain().fault(), "");
    EXPECT_EQ(regions().fault(), "");
}

/// A change after which a machine is refused, or still valid where `said` is empty.
struct Fault {
    void (*change)(Machine&);
    std::string_view said; ///< after the machine's name
};

void expect_each(Machine (*good)(), std::initializer_list<Fault> faults) {
    for (const Fault& fault : faults) {
        Machine m = good();
        fault.change(m);
        EXPECT_EQ(m.fault(), fault.said.empty() ? "" : "state machine \"m\": " + std::string{fault.said});
    }
}

TEST(StateMachineCheck, refuses_inconsistent_states) {
    expect_each(
        plain,
        {
            {[](Machine& m) { m.states.clear(); }, "it has no state; give it an initial and a final one"},
            {[](Machine& m) { m.states[1].name = ""; }, "state 2 has no name; give it one"},
            {[](Machine& m) { m.add(m.states[3]); }, "state \"weave\" is there twice; rename or drop one"},
            {[](Machine& m) { m.states[3].parent = "workin"; },
             "state \"weave\" is in an unknown state \"workin\"; did you mean \"working\"?"},
            {[](Machine& m) { m.states[1].parent = "weave"; },
             "state \"working\" is inside itself; take one in(...) out of the ring"},
            {[](Machine& m) { m.states[1].parent = "working"; },
             "state \"working\" is inside itself; take one in(...) out of the ring"},
            {[](Machine& m) { m.states[0].initial = false; },
             "no top state is initial; mark the one to start in"},
            {[](Machine& m) { m.states[3].initial = true; },
             "state \"weave\" is a second initial state in \"working\" beside \"run_up\"; keep one"},
            {[](Machine& m) { m.states[1].initial = true; },
             "state \"working\" is a second initial state at the top beside \"idle\"; keep one"},
            {[](Machine& m) { m.states[2].initial = false; },
             "state \"working\" is composite and none of its states is initial; mark the one to enter"},
            {[](Machine& m) { m.states[4].final = false; },
             "no state is final; mark the safe state that the machine may be brought to from everywhere"},
            {[](Machine& m) { m.states[0].final = true; },
             "state \"safe\" is a second final state beside \"idle\"; keep one, the safe state that a "
             "request leads to from everywhere"},
            {[](Machine& m) { m.states[4].parent = "working"; },
             "state \"safe\" is final inside \"working\"; the final state is safe for the whole machine: "
             "take it out of every composite"},
            {[](Machine& m) { m.add(state("inner", in("safe"), initial)); },
             "state \"safe\" is final and has states inside; the safe state is a plain one"},
            {[](Machine& m) {
                 m.add(state("lost"));
                 m.add(transition("lost", "idle", on("found")));
             },
             "state \"lost\" is never entered; lead a transition to it, make it initial, or drop it"},
            {[](Machine& m) {
                 m.add(state("trap"));
                 m.add(transition("idle", "trap", on("fall")));
                 m.add(transition("trap", "trap", on("again")));
                 m.add(internal("trap", on("move"), then<&Loom::go>));
             },
             "state \"trap\" has no way out; give it a transition, or mark it final"},
        });
}

TEST(StateMachineCheck, refuses_transitions_without_a_target_or_a_chance_to_fire) {
    expect_each(
        plain,
        {
            {[](Machine& m) { m.transitions[2].to = "saef"; },
             "transition 3 (\"working\" to \"saef\" on \"panel.emergency\") leads to an unknown state "
             "\"saef\"; did you mean \"safe\"?"},
            {[](Machine& m) { m.transitions[1].from = "xylophone"; },
             "transition 2 (\"xylophone\" to \"weave\") leaves an unknown state \"xylophone\"; name one of "
             "the machine's states, or add this one"},
            {[](Machine& m) { m.add(transition("weave", "safe", on("panel.stop"), guard<&Loom::ready>)); },
             "transition 6 (\"weave\" to \"safe\" on \"panel.stop\") can never be taken, transition 5 "
             "(\"weave\" to \"idle\" on \"panel.stop\") always comes first; give that one a guard<>, put "
             "this one before it, or drop it"},
            {[](Machine& m) { m.add(transition("run_up", "idle", after(4s))); }, ""},
            {[](Machine& m) { m.add(transition("run_up", "idle", after(6s))); },
             "transition 6 (\"run_up\" to \"idle\") can never be taken, transition 4 (\"run_up\" to "
             "\"safe\") always comes first; give that one a guard<>, put this one before it, or drop it"},
            {[](Machine& m) { m.add(transition("run_up", "idle", on("panel.emergency"))); }, ""},
            {[](Machine& m) {
                 m.add(transition("run_up", "idle", on("panel.emergency")));
                 m.add(transition("weave", "idle", on("panel.emergency")));
             },
             "transition 3 (\"working\" to \"safe\" on \"panel.emergency\") can never be taken, transition 7 "
             "(\"weave\" to \"idle\" on \"panel.emergency\") always comes first; give that one a guard<>, "
             "put this one before it, or drop it"},
            {[](Machine& m) {
                 m.add(transition("weave", "run_up"));
                 m.transitions[1].guard = {};
                 m.transitions.erase(m.transitions.begin() + 3); // its time-out would never occur
             },
             "state \"run_up\" comes back to itself without waiting, by transition 5 (\"weave\" to "
             "\"run_up\"); give one transition of the ring on(...), after(...) or guard<>"},
        });
}

TEST(StateMachineCheck, refuses_contradictory_parts_of_a_row) {
    expect_each(
        plain,
        {
            {[](Machine& m) {
                 m.transitions[0].timed = true;
                 m.transitions[0].after = 1s;
             },
             "transition 1 (\"idle\" to \"run_up\" on \"panel.start\") has both on(...) and after(...); make "
             "two transitions of it"},
            {[](Machine& m) { m.transitions[3].after = Duration{0}; },
             "transition 4 (\"run_up\" to \"safe\") has a time-out that is not positive; write a time, or "
             "leave after(...) out"},
            {[](Machine& m) { m.transitions[3].after = Duration{-1}; },
             "transition 4 (\"run_up\" to \"safe\") has a time-out that is not positive; write a time, or "
             "leave after(...) out"},
            {[](Machine& m) { m.transitions[0].event = ""; },
             "transition 1 (\"idle\" to \"run_up\" on \"\") waits for an event without a name; write "
             "on(\"component.event\")"},
            {[](Machine& m) { m.add(internal("weave", on("x"))); },
             "transition 6 (\"weave\" on \"x\") is internal and does nothing; give it then<>, or drop it"},
            {[](Machine& m) { m.add(internal("weave", then<&Loom::go>)); },
             "transition 6 (\"weave\") is internal and has no event, so it would fire in every step; use "
             "run<> of the state"},
            {[](Machine& m) { m.states[0] = state("idle", initial, entry<&Loom::go>, entry<&Loom::go>); },
             "state \"idle\" has more than one entry; keep one"},
            {[](Machine& m) { m.transitions[4] = transition("weave", "idle", on("x"), on("y")); },
             "transition 5 (\"weave\" to \"idle\" on \"y\") has more than one on(...); keep one"},
            {[](Machine& m) { m.states[0] = state("idle", initial, entry<&Loom::go>, exit<&Other::go>); },
             "state \"idle\" has programs of two component types; use those of one"},
            {[](Machine& m) {
                 m.transitions[4] = transition("weave", "idle", on("x"), guard<&Loom::ready>.because(""));
             },
             "transition 5 (\"weave\" to \"idle\" on \"x\") has a condition whose reason is empty; say what "
             "is missing then"},
            {[](Machine& m) {
                 m.transitions[4] = transition("weave", "idle", on("x"),
                                               guard<&Loom::ready>.because("it is cold").because("old"));
             },
             "transition 5 (\"weave\" to \"idle\" on \"x\") has more than one reason of its guard; keep one"},
            {[](Machine& m) {
                 m.transitions[4] = transition("weave", "idle", on("x"),
                                               guard<&Loom::ready>.because<&Other::words>("it is cold"));
             },
             "transition 5 (\"weave\" to \"idle\" on \"x\") has programs of two component types; use those "
             "of one"},
        });
}

TEST(StateMachineCheck, refuses_programs_of_another_component) {
    Machine m = plain();
    m.states[0] = state("idle", initial, entry<&Other::go>);
    EXPECT_NE(m.fault().find("state \"idle\" has a program of "), std::string::npos) << m.fault();
    EXPECT_NE(m.fault().find("Other, and the machine is one of "), std::string::npos) << m.fault();
}

TEST(StateMachineCheck, refuses_inconsistent_regions_and_history) {
    expect_each(
        regions,
        {
            {[](Machine& m) { m.states[0].region = "shaft"; },
             "state \"idle\" is in region \"shaft\" of no state; regions lie in a composite: add in(...)"},
            {[](Machine& m) { m.states[3].region = ""; },
             "state \"work\" has regions, and \"turns\" is in none of them; give it region(...)"},
            {[](Machine& m) { m.states[4].initial = false; },
             "state \"work\" has no initial state in region \"weft\"; mark the one to enter"},
            {[](Machine& m) { m.states[5].initial = true; },
             "state \"flies\" is a second initial state in \"work\" beside \"waits\"; keep one"},
            {[](Machine& m) { m.transitions[1].to = "turns"; },
             "transition 2 (\"idle\" to \"turns\" on \"resume\") enters by history, and \"turns\" has no "
             "states inside; lead it to a composite state"},
            {[](Machine& m) { m.transitions[4].to = "turns"; },
             "transition 5 (\"flies\" to \"turns\" on \"arrived\") leads from one region into another of "
             "the same state, and both stay active; lead it out of that state, or to that state itself"},
            {[](Machine& m) { m.transitions[4].to = "work"; }, ""},
            {[](Machine& m) { // "work" has no transition, the else branch of "waits" leaves "turns"
                 m.transitions.pop_back();
             },
             ""},
            {[](Machine& m) {
                 m.transitions.pop_back();
                 m.transitions[3].otherwise_to = "waits";
             },
             "state \"turns\" has no way out; give it a transition, or mark it final"},
            {[](Machine& m) { // "waits" is entered beside "turns", and "stands" is not
                 m.transitions.erase(m.transitions.begin(), m.transitions.begin() + 2);
                 m.add(transition("idle", "turns", on("start")));
             },
             "state \"stands\" is never entered; lead a transition to it, make it initial, or drop it"},
            {[](Machine& m) {
                 m.transitions.erase(m.transitions.begin(), m.transitions.begin() + 2);
                 m.add(transition("idle", "turns", on("start")));
                 m.add(transition("turns", "stands", on("halt")));
             },
             ""},
        });
}

TEST(StateMachineCheck, refuses_unreachable_else_branches_and_preconditions) {
    expect_each(
        regions,
        {
            {[](Machine& m) { m.transitions[2].on_event = false; },
             "transition 3 (\"stands\" to \"turns\") has an else branch and no event; write a second "
             "transition after it"},
            {[](Machine& m) { m.transitions[3].otherwise_to = "saef"; },
             "transition 4 (\"waits\" to \"flies\" on \"release\") leads to an unknown state \"saef\" "
             "otherwise; did you mean \"safe\"?"},
            {[](Machine& m) { m.transitions[2].guard = {}; },
             "transition 3 (\"stands\" to \"turns\" on \"start\") has an else branch and nothing to refuse "
             "it; give it guard<>"},
            {[](Machine& m) {
                 m.transitions[2].guard = {};
                 m.states[3].precondition = precondition<&Loom::ready>.call;
             },
             ""},
            {[](Machine& m) {
                 m.transitions.insert(m.transitions.begin() + 4, transition("waits", "flies", on("release")));
             },
             "transition 5 (\"waits\" to \"flies\" on \"release\") can never be taken, transition 4 "
             "(\"waits\" to \"flies\" on \"release\") always comes first; give that one a guard<>, put this "
             "one before it, or drop it"},
            {[](Machine& m) { m.add(transition("idle", "safe", on("start"))); }, ""}, // "work" may refuse
            {[](Machine& m) {
                 m.add(transition("idle", "safe", on("start")));
                 m.states[1].precondition = {};
             },
             "transition 7 (\"idle\" to \"safe\" on \"start\") can never be taken, transition 1 (\"idle\" to "
             "\"work\" on \"start\") always comes first; give that one a guard<>, put this one before it, or "
             "drop it"},
        });
}

TEST(StateMachineCheck, refuses_a_hierarchy_that_is_too_deep) {
    static constexpr std::string_view names[] = {"d1", "d2", "d3", "d4", "d5", "d6", "d7", "d8", "d9"};
    static_assert(std::size(names) == max_state_depth + 1, "one more than the limit");
    Machine m = plain();
    m.add(state(names[0]));
    m.add(transition("weave", "d1", on("deeper")));
    m.add(transition("d1", "idle", on("back")));
    for (std::size_t i = 1; i < std::size(names); ++i) {
        EXPECT_EQ(m.fault(), "") << i << " levels";
        m.add(state(names[i], in(names[i - 1]), initial));
    }
    EXPECT_EQ(m.fault(),
              "state machine \"m\": state \"d9\" is more than 8 levels deep; flatten the hierarchy");
}

/// Numbered names that last as long as a row.
std::vector<std::string> names(std::string_view stem, std::size_t number) {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < number; ++i) all.push_back(std::string{stem} + std::to_string(i));
    return all;
}

TEST(StateMachineCheck, refuses_more_rows_than_the_limits) {
    expect_each(plain, {{[](Machine& m) { m.states.resize(max_states + 1, m.states[0]); },
                         "it has 257 states and may have 256; split it over components"},
                        {[](Machine& m) { m.transitions.resize(max_transitions + 1, m.transitions[0]); },
                         "it has 1025 transitions and may have 1024; split it over components"}});
}

TEST(StateMachineCheck, refuses_more_events_than_the_limit) {
    Machine m = plain();
    const auto events = names("event", max_state_events - 2);
    for (const std::string& name : events) m.add(transition("idle", "safe", on(name)));
    EXPECT_EQ(m.fault(),
              "state machine \"m\": it hears 256 events and may hear 255; split it over components");
    m.transitions.pop_back();
    EXPECT_EQ(m.fault(), "");
}

TEST(StateMachineCheck, refuses_more_active_states_than_it_has_room_for) {
    Machine m = regions();
    const auto more = names("s", 14);
    for (const std::string& name : more) m.add(state(name, in("work"), region(name), initial));
    EXPECT_EQ(m.fault(), "state machine \"m\": 17 of its states may be active at the same time and 16 may; "
                         "take regions out of it");
    m.states.pop_back();
    EXPECT_EQ(m.fault(), "");
}

TEST(StateMachineCheck, refuses_more_transitions_of_leaves_than_can_be_numbered) {
    Machine m = plain();
    const auto inner = names("inner", 100);
    for (const std::string& name : inner) {
        m.add(state(name, in("working")));
        m.add(transition("run_up", name, on("panel.choose"), guard<&Loom::ready>));
    }
    EXPECT_EQ(m.fault(), "");
    for (std::size_t i = 0; i < 35; ++i)
        m.add(transition("working", "idle", on("panel.leave"), guard<&Loom::ready>));
    const std::string said = m.fault();
    EXPECT_NE(
        said.find("plain states together and may out of 3600; move transitions of wide composites inwards"),
        std::string::npos)
        << said;
}

TEST(StateMachineCheck, finds_every_misspelt_name_and_names_its_row) {
    const std::size_t states = plain().states.size();
    const std::size_t transitions = plain().transitions.size();
    const auto expect = [](const Machine& m, const std::string& row, const std::string& cure) {
        const std::string said = m.fault();
        EXPECT_NE(said.find(row), std::string::npos) << said;
        EXPECT_NE(said.find("did you mean \"" + cure + "\"?"), std::string::npos) << said;
    };
    for (std::size_t t = 0; t < transitions; ++t) {
        for (std::string_view TransitionRow::* end : {&TransitionRow::from, &TransitionRow::to}) {
            Machine m = plain();
            const std::string right{m.transitions[t].*end};
            const std::string wrong = right + "x";
            m.transitions[t].*end = wrong;
            expect(m, "transition " + std::to_string(t + 1) + " (", right);
        }
    }
    for (std::size_t s = 0; s < states; ++s) {
        Machine m = plain();
        if (m.states[s].parent.empty()) continue;
        const std::string right{m.states[s].parent};
        const std::string wrong = right.substr(1);
        m.states[s].parent = wrong;
        expect(m, "state \"" + std::string{m.states[s].name} + "\"", right);
    }
}

TEST(StateMachineCheck, finds_every_dropped_and_doubled_row_that_matters) {
    for (std::size_t s = 0; s < plain().states.size(); ++s) {
        Machine dropped = plain();
        dropped.states.erase(dropped.states.begin() + static_cast<std::ptrdiff_t>(s));
        EXPECT_NE(dropped.fault(), "") << "without state " << s + 1;
        Machine doubled = plain();
        doubled.states.push_back(doubled.states[s]);
        EXPECT_NE(doubled.fault().find(std::string{doubled.states[s].name}), std::string::npos);
    }
    for (std::size_t t = 0; t < plain().transitions.size(); ++t) {
        Machine doubled = plain();
        doubled.transitions.push_back(doubled.transitions[t]);
        // After a row with a guard its duplicate can still be taken.
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
