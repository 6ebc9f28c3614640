// The resolved form: what it holds, that it is exactly as large as it must be, and loading into bounded room.
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

ArcIndex cell(std::string_view leaf, std::size_t trigger) {
    return view.cells[find_state(view.table, leaf) * view.triggers.size() + trigger];
}
std::vector<TransitionIndex> transitions_of(ArcIndex first) {
    std::vector<TransitionIndex> numbers;
    if (first == no_arc) return numbers;
    for (const StateArc* arc = view.arcs + first;; ++arc) {
        numbers.push_back(arc->transition);
        if (arc->last) return numbers;
    }
}
using Numbers = std::vector<TransitionIndex>;

TEST(StateMachineResolver, lists_each_event_once_in_the_order_of_the_transitions) {
    ASSERT_EQ(view.triggers.size(), 2u);
    EXPECT_EQ(view.triggers[0], "panel.emergency");
    EXPECT_EQ(view.triggers[1], "panel.start");
}

TEST(StateMachineResolver, orders_the_transitions_of_a_leaf_from_the_inside_and_then_by_row) {
    EXPECT_EQ(transitions_of(cell("weave", 0)), (Numbers{2, 0}));
    EXPECT_EQ(transitions_of(cell("run_up", 0)), (Numbers{0}));
    EXPECT_EQ(transitions_of(cell("idle", 0)), (Numbers{}));
    EXPECT_EQ(transitions_of(cell("idle", 1)), (Numbers{1}));
    EXPECT_EQ(transitions_of(view.plans[find_state(view.table, "weave")].conditions), (Numbers{5, 4}));
    EXPECT_EQ(transitions_of(view.plans[find_state(view.table, "run_up")].conditions), (Numbers{3, 4}));
}

TEST(StateMachineResolver, folds_the_programs_of_a_transition_into_one_list) {
    const StateArc& start = view.arcs[cell("idle", 1)];
    Recorder recorder;
    for (std::size_t i = 0; i < start.programs.count; ++i) view.programs[start.programs.first + i](&recorder);
    EXPECT_EQ(recorder.heard(), "*start -idle +working +run_up");
    EXPECT_EQ(start.target, find_state(view.table, "run_up"));
    EXPECT_EQ(start.kept_levels, 0);
    EXPECT_EQ(start.target_levels, 2);
}

TEST(StateMachineResolver, takes_exactly_the_room_it_measured) {
    constexpr ResolvedSizes sizes = measure(loom.view());
    ResolvedMachine<sizes> exact;
    EXPECT_EQ(exact.load(loom.view()).view(), "");
    const auto refused = [](auto room) {
        const Sentence said = room.load(loom.view());
        EXPECT_NE(said.view().find("make the room larger or the machine smaller"), std::string_view::npos)
            << said.view();
        EXPECT_EQ(room.view().plans, nullptr);
    };
    refused(ResolvedMachine<ResolvedSizes{sizes.states - 1, sizes.triggers, sizes.arcs, sizes.programs,
                                          sizes.regions}>{});
    refused(ResolvedMachine<ResolvedSizes{sizes.states, sizes.triggers - 1, sizes.arcs, sizes.programs,
                                          sizes.regions}>{});
    refused(ResolvedMachine<ResolvedSizes{sizes.states, sizes.triggers, sizes.arcs - 1, sizes.programs,
                                          sizes.regions}>{});
    refused(ResolvedMachine<ResolvedSizes{sizes.states, sizes.triggers, sizes.arcs, sizes.programs - 1,
                                          sizes.regions}>{});
}

TEST(StateMachineResolver, makes_the_same_of_a_table_at_run_time_as_the_compiler_did) {
    const std::vector<StateRow> states{loom.states.begin(), loom.states.end()};
    const std::vector<TransitionRow> transitions{loom.transitions.begin(), loom.transitions.end()};
    ResolvedMachine<ResolvedSizes{40, 10, 500, 900, 8}> room;
    ASSERT_EQ(room.load({"loom", states, transitions, type_id<R>}).view(), "");
    const ResolvedView loaded = room.view();
    constexpr ResolvedSizes sizes = measure(loom.view());
    EXPECT_TRUE(std::ranges::equal(loaded.triggers, view.triggers));
    EXPECT_TRUE(std::equal(view.programs, view.programs + sizes.programs, loaded.programs));
    for (std::size_t i = 0; i < sizes.arcs; ++i) {
        EXPECT_EQ(loaded.arcs[i].target, view.arcs[i].target);
        EXPECT_EQ(loaded.arcs[i].transition, view.arcs[i].transition);
        EXPECT_EQ(loaded.arcs[i].programs.first, view.arcs[i].programs.first);
        EXPECT_EQ(loaded.arcs[i].programs.count, view.arcs[i].programs.count);
    }
    for (std::size_t i = 0; i < sizes.states * sizes.triggers; ++i) EXPECT_EQ(loaded.cells[i], view.cells[i]);
}

TEST(StateMachineResolver, loads_one_machine_after_another_into_the_same_room) {
    static constexpr auto small = state_machine<R>("small", states(state("a", initial), state("z", final)),
                                                   transitions(transition("a", "z", on("end"))));
    ResolvedMachine<ResolvedSizes{40, 10, 500, 900, 8}> room;
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

TEST(StateMachineResolver, keeps_no_machine_when_a_faulty_one_was_loaded) {
    ResolvedMachine<ResolvedSizes{40, 10, 500, 900, 8}> room{loom.view()};
    const std::vector<StateRow> faulty{state("a", initial), state("safe", final)};
    EXPECT_EQ(room.load({"faulty", faulty, {}, type_id<R>}).view(),
              "state machine \"faulty\": state \"a\" has no way out; give it a transition, or mark it final");
    StateMachineExecution execution;
    execution.bind(room.view(), nullptr);
    EXPECT_EQ(execution.start(at_ns(0)), StateOutcome::ignored);
}

} // namespace
} // namespace tappet
