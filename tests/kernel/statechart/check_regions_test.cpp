// What a state machine with regions, history and else branches must not be, and the sentence that says so
// (thesis 5.2, UML 2.5.1 clause 14). The tables are faulty in one thing each.
#include "kernel/statechart/check.hpp"
#include "kernel/statechart/rows.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tappet {
namespace {

struct Loom {
    void go() noexcept TAPPET_REALTIME {}
    bool ready() const noexcept TAPPET_REALTIME { return true; }
};

// idle | work { shaft: stands turns   weft: waits flies } | safe
struct Good {
    std::vector<StateRow> states{state("idle", initial),
                                 state("work", precondition<&Loom::ready>, handles<&Loom::go>),
                                 state("stands", in("work"), region("shaft"), initial),
                                 state("turns", in("work"), region("shaft")),
                                 state("waits", in("work"), region("weft"), initial),
                                 state("flies", in("work"), region("weft")),
                                 state("safe", final)};
    std::vector<TransitionRow> transitions{
        transition("idle", "work", on("start")),
        transition("idle", "work", on("resume"), deep_history),
        transition("stands", "turns", on("start"), guard<&Loom::ready>, otherwise<&Loom::go>),
        transition("waits", "flies", on("release"), guard<&Loom::ready>, otherwise_to("safe")),
        transition("flies", "waits", on("arrived")),
        transition("work", "idle", on("stop"))};

    [[nodiscard]] std::string fault() const {
        return std::string{check({"m", states, transitions, type_id<Loom>}).view()};
    }
};

/// Changed so, it is refused with the sentence.
void refuses(void (*change)(Good&), std::string_view sentence) {
    Good m;
    change(m);
    EXPECT_EQ(m.fault(), sentence);
}

TEST(StateMachineCheck, finds_no_fault_in_regions_history_and_else_branches) {
    EXPECT_EQ(Good{}.fault(), "");
}

TEST(StateMachineCheck, refuses_what_is_faulty_in_one_place_of_regions_history_and_else_branches) {
    refuses([](Good& m) { m.states[0].region = "shaft"; },
            "state machine \"m\": state \"idle\" is in region \"shaft\" of no state; regions lie in a "
            "composite: add in(...)");
    refuses([](Good& m) { m.states[3].region = ""; }, "state machine \"m\": state \"work\" has regions, and "
                                                      "\"turns\" is in none of them; give it region(...)");
    refuses(
        [](Good& m) { m.states[4].initial = false; },
        "state machine \"m\": state \"work\" has no initial state in region \"weft\"; mark the one to enter");
    refuses([](Good& m) { m.states[5].initial = true; },
            "state machine \"m\": state \"flies\" is a second initial state in \"work\" beside \"waits\"; "
            "keep one");
    refuses([](Good& m) { m.transitions[1].to = "turns"; },
            "state machine \"m\": transition 2 (\"idle\" to \"turns\" on \"resume\") enters by history, and "
            "\"turns\" has no states inside; lead it to a composite state");
    refuses([](Good& m) { m.transitions[2].on_event = false; },
            "state machine \"m\": transition 3 (\"stands\" to \"turns\") has an else branch and no event; "
            "write a second transition after it");
    refuses([](Good& m) { m.transitions[3].otherwise_to = "saef"; },
            "state machine \"m\": transition 4 (\"waits\" to \"flies\" on \"release\") leads to an unknown "
            "state \"saef\" otherwise; did you mean \"safe\"?");
}

TEST(StateMachineCheck, refuses_a_transition_from_one_region_into_another) {
    Good m;
    m.transitions[4].to = "turns";
    EXPECT_EQ(m.fault(),
              "state machine \"m\": transition 5 (\"flies\" to \"turns\" on \"arrived\") leads from one "
              "region into another of the same state, and both stay active; lead it out of that state, "
              "or to that state itself");
    m.transitions[4].to = "work";
    EXPECT_EQ(m.fault(), "");
}

TEST(StateMachineCheck, refuses_more_active_states_than_there_is_room_for) {
    std::vector<std::string> names;
    for (int i = 0; i < 17; ++i) names.push_back("s" + std::to_string(i));
    Good m;
    for (const std::string& name : names) m.states.push_back(state(name, in("work"), region(name), initial));
    EXPECT_EQ(m.fault(),
              "state machine \"m\": 20 of its states may be active at the same time and 16 may; take "
              "regions out of it");
    m.states.resize(7 + 13);
    EXPECT_EQ(m.fault(), "");
}

TEST(StateMachineCheck, refuses_an_else_branch_that_nothing_leads_to) {
    Good m;
    m.transitions[2].guard = {};
    EXPECT_EQ(m.fault(),
              "state machine \"m\": transition 3 (\"stands\" to \"turns\" on \"start\") has an else branch "
              "and nothing to refuse it; give it guard<>");
    m.states[3].precondition = precondition<&Loom::ready>.call;
    EXPECT_EQ(m.fault(), "");
}

TEST(StateMachineCheck, refuses_a_transition_after_one_with_an_else_branch) {
    Good m;
    m.transitions.insert(m.transitions.begin() + 4, transition("waits", "flies", on("release")));
    EXPECT_NE(m.fault().find(
                  "transition 5 (\"waits\" to \"flies\" on \"release\") can never be taken, transition 4"),
              std::string::npos)
        << m.fault();
}

TEST(StateMachineCheck, lets_a_precondition_refuse_what_has_no_guard) {
    Good m;
    m.transitions.push_back(transition("idle", "safe", on("start")));
    EXPECT_EQ(m.fault(), "") << "\"work\" may say no";
    m.states[1].precondition = {};
    EXPECT_NE(m.fault().find("can never be taken"), std::string::npos) << m.fault();
}

TEST(StateMachineCheck, counts_the_way_out_that_another_region_has) {
    Good m;
    m.transitions.pop_back(); // "work" itself leads nowhere
    EXPECT_EQ(m.fault(), "") << "\"turns\" is left by the else branch of \"waits\"";
    m.transitions[3].otherwise_to = "waits";
    EXPECT_EQ(m.fault(),
              "state machine \"m\": state \"turns\" has no way out; give it a transition, or mark it final");
}

TEST(StateMachineCheck, counts_the_initial_states_of_other_regions_as_entered) {
    Good m;
    m.transitions.erase(m.transitions.begin(), m.transitions.begin() + 2);
    m.transitions.push_back(transition("idle", "turns", on("start")));
    EXPECT_NE(m.fault().find("state \"stands\" is never entered"), std::string::npos) << m.fault();
    m.transitions.push_back(transition("turns", "stands", on("halt")));
    EXPECT_EQ(m.fault(), "") << "\"waits\" is entered beside \"turns\"";
}

} // namespace
} // namespace tappet
