// The resolved form: its content, its exact size, and loading into bounded room.
#include "tests/kernel/statechart/recorder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tappet {
namespace {

using R = Recorder;

struct Declared {
    void real_time() noexcept TAPPET_REALTIME {}
    bool real_time_too() const noexcept TAPPET_REALTIME { return true; }
    void blocking() noexcept;
    void throwing();
    void with_argument(int) noexcept TAPPET_REALTIME;
};
static_assert(statechart::Member<decltype(&Declared::real_time)>::real_time);
static_assert(statechart::Member<decltype(&Declared::real_time_too)>::real_time);
static_assert(!statechart::Member<decltype(&Declared::throwing)>::real_time);
static_assert(!statechart::Member<decltype(&Declared::with_argument)>::real_time);
#if defined(__clang__)
static_assert(!statechart::Member<decltype(&Declared::blocking)>::real_time,
              "clang knows the effect; g++ reads a comment");
#endif

constexpr auto loom = state_machine<R>(
    "loom",
    states(state("idle", initial, exit<&R::say<"-idle">>), state("working", entry<&R::say<"+working">>),
           state("run_up", in("working"), initial, entry<&R::say<"+run_up">>, run<&R::say<"!run_up">>),
           state("weave", in("working")), state("safe", final)),
    transitions(transition("working", "safe", on("panel.emergency")),
                transition("idle", "run_up", on("panel.start"), then<&R::say<"*start">>),
                transition("weave", "idle", on("panel.emergency"), guard<&R::if_yes>),
                transition("run_up", "weave", guard<&R::if_yes>), transition("working", "idle", after(5s)),
                transition("weave", "idle", after(1s), because("late"))));
static_assert(check(loom.view()).empty());
constexpr ResolvedView view = resolved<loom>.view();

AskedIndex cell(std::string_view leaf, std::size_t trigger) {
    return view.cells[find_state(view.table, leaf) * view.triggers.size() + trigger];
}
std::vector<TransitionIndex> transitions_of(AskedIndex first) {
    std::vector<TransitionIndex> numbers;
    if (first == none_asked) return numbers;
    for (const AskedArc* asked = view.asked + first;; ++asked) {
        numbers.push_back(view.arcs[asked->arc()].transition);
        if (asked->is_last()) return numbers;
    }
}
using Numbers = std::vector<TransitionIndex>;

TEST(StateMachineResolver, lists_each_event_once_in_the_order_of_the_transitions) {
    ASSERT_EQ(view.triggers.size(), 2u);
    EXPECT_EQ(view.triggers[0], "panel.emergency");
    EXPECT_EQ(view.triggers[1], "panel.start");
}

TEST(StateMachineResolver, orders_transitions_of_a_leaf_from_inside_and_then_by_row) {
    EXPECT_EQ(transitions_of(cell("weave", 0)), (Numbers{2, 0}));
    EXPECT_EQ(transitions_of(cell("run_up", 0)), (Numbers{0}));
    EXPECT_EQ(transitions_of(cell("idle", 0)), (Numbers{}));
    EXPECT_EQ(transitions_of(cell("idle", 1)), (Numbers{1}));
    EXPECT_EQ(transitions_of(view.plans[find_state(view.table, "weave")].conditions), (Numbers{5, 4}));
    EXPECT_EQ(transitions_of(view.plans[find_state(view.table, "run_up")].conditions), (Numbers{3, 4}));
}

std::string steps_of(StepIndex at) {
    constexpr std::array<std::string_view, 9> words{"act",        "otherwise", "leave",  "place", "entry",
                                                    "remembered", "arrive",    "depart", "handle"};
    std::string text;
    for (;; ++at) {
        const TransitionStep& step = view.steps[at];
        text.append(text.empty() ? "" : " ").append(words[static_cast<std::size_t>(step.kind)]);
        if (step.state != no_state) text.append("(").append(view.table.states[step.state].name).append(")");
        if (is_last(step.kind)) return text;
    }
}

TEST(StateMachineResolver, lists_the_steps_of_a_transition_in_their_order) {
    const StateArc& start = view.arcs[first_arc + 1];
    EXPECT_EQ(start.transition, 1);
    EXPECT_EQ(steps_of(start.steps),
              "act leave place(working) entry(working) place(run_up) entry(run_up) arrive(run_up)");
    EXPECT_EQ(start.kept_levels, 0);
    EXPECT_EQ(steps_of(view.arcs[first_arc + 3].steps), "leave place(weave) arrive(weave)");
    EXPECT_EQ(view.arcs[first_arc + 3].kept_levels, 1);
    EXPECT_EQ(steps_of(view.arcs[start_arc].steps), "leave place(idle) arrive(idle)");
    EXPECT_EQ(steps_of(view.arcs[final_arc].steps), "leave place(safe) arrive(safe)");
    EXPECT_EQ(steps_of(view.arcs[leaving_arc].steps), "leave depart");
}

TEST(StateMachineResolver, uses_exactly_the_room_it_measured) {
    constexpr ResolvedSizes sizes = measure(loom.view());
    ResolvedMachine<sizes> exact;
    EXPECT_EQ(exact.load(loom.view()).view(), "");
    const auto refused = [](auto room) {
        const Sentence said = room.load(loom.view());
        EXPECT_NE(said.view().find("make the room larger or the machine smaller"), std::string_view::npos)
            << said.view();
        EXPECT_EQ(room.view().plans, nullptr);
    };
    const auto without = []<ResolvedSizes all, auto member>() {
        constexpr ResolvedSizes less = [] {
            ResolvedSizes one = all;
            --(one.*member);
            return one;
        }();
        return ResolvedMachine<less>{};
    };
    refused(without.template operator()<sizes, &ResolvedSizes::states>());
    refused(without.template operator()<sizes, &ResolvedSizes::triggers>());
    refused(without.template operator()<sizes, &ResolvedSizes::asked>());
    refused(without.template operator()<sizes, &ResolvedSizes::arcs>());
    refused(without.template operator()<sizes, &ResolvedSizes::steps>());
    refused(without.template operator()<sizes, &ResolvedSizes::regions>());
}

TEST(StateMachineResolver, gives_the_same_result_at_run_time_and_compile_time) {
    const std::vector<StateRow> states{loom.states.begin(), loom.states.end()};
    const std::vector<TransitionRow> transitions{loom.transitions.begin(), loom.transitions.end()};
    ResolvedMachine<ResolvedSizes{40, 10, 40, 500, 900, 8}> room;
    ASSERT_EQ(room.load({"loom", states, transitions, type_id<R>}).view(), "");
    const ResolvedView loaded = room.view();
    constexpr ResolvedSizes sizes = measure(loom.view());
    EXPECT_TRUE(std::ranges::equal(loaded.triggers, view.triggers));
    for (std::size_t i = 0; i < sizes.arcs; ++i) {
        EXPECT_EQ(loaded.arcs[i].transition, view.arcs[i].transition);
        EXPECT_EQ(loaded.arcs[i].steps, view.arcs[i].steps);
    }
    for (std::size_t i = 0; i < sizes.asked; ++i) EXPECT_EQ(loaded.asked[i].arc(), view.asked[i].arc());
    for (std::size_t i = 0; i < sizes.steps; ++i) {
        EXPECT_EQ(loaded.steps[i].kind, view.steps[i].kind);
        EXPECT_EQ(loaded.steps[i].state, view.steps[i].state);
    }
    for (std::size_t i = 0; i < sizes.states * sizes.triggers; ++i) EXPECT_EQ(loaded.cells[i], view.cells[i]);
}

TEST(StateMachineResolver, loads_one_machine_after_another_into_the_same_room) {
    static constexpr auto small = state_machine<R>("small", states(state("a", initial), state("z", final)),
                                                   transitions(transition("a", "z", on("end"))));
    ResolvedMachine<ResolvedSizes{40, 10, 40, 500, 900, 8}> room;
    Recorder recorder;
    StateMachineExecution execution;
    ASSERT_EQ(room.load(loom.view()).view(), "");
    execution.bind(room.view(), &recorder);
    execution.start(at_ns(0));
    EXPECT_EQ(execution.path()[0], "idle");
    execution.request_final(at_ns(1));
    execution.deactivate(at_ns(2));
    ASSERT_EQ(room.load(small.view()).view(), "");
    execution.bind(room.view(), &recorder);
    execution.start(at_ns(3));
    EXPECT_EQ(execution.path()[0], "a");
    EXPECT_EQ(execution.dispatch(1, at_ns(4)), StateOutcome::ignored)
        << "the machine before had this trigger";
    EXPECT_EQ(execution.dispatch(0, at_ns(4)), StateOutcome::taken);
}

TEST(StateMachineResolver, discards_the_machine_when_a_faulty_one_was_loaded) {
    ResolvedMachine<ResolvedSizes{40, 10, 40, 500, 900, 8}> room{loom.view()};
    const std::vector<StateRow> faulty{state("a", initial), state("safe", final)};
    EXPECT_EQ(room.load({"faulty", faulty, {}, type_id<R>}).view(),
              "state machine \"faulty\": state \"a\" has no way out; give it a transition, or mark it final");
    StateMachineExecution execution;
    execution.bind(room.view(), nullptr);
    EXPECT_EQ(execution.start(at_ns(0)), StateOutcome::ignored);
}

} // namespace
} // namespace tappet
