// The execution order, thesis 5.2: regions, history, and the view of an observer. A test for each line of the
// table in kernel/statechart/README.md.
#include "tests/kernel/statechart/play.hpp"

namespace tappet {
namespace {

// idle | x { left: a b   right: c d } | safe
const std::string regions = R"(
    state idle initial exit -idle
    state x entry +x exit -x run !x handle ~x
    state a in x region left initial entry +a exit -a run !a
    state b in x region left entry +b exit -b run !b
    state c in x region right initial entry +c exit -c run !c
    state d in x region right entry +d exit -d run !d
    state safe final entry +safe
)";

TEST(StateMachineOrder, line_03_leaves_the_last_region_first_and_enters_the_first_one_first) {
    Started m{regions + R"(
        from idle to x on go then *go
        from x to idle on back
        from a to b on swap
        from c to d on swap
        from b to a on swap
        from d to c on swap)"};
    EXPECT_EQ(m.send("go"), "*go -idle +x +a +c");
    EXPECT_EQ(m.active(), "x(a c)");
    EXPECT_EQ(m.send("back"), "-c -a -x");
    EXPECT_EQ(m.active(), "idle");
}

TEST(StateMachineOrder, line_04_enters_other_regions_on_the_way_by_their_initial_states) {
    Started m{regions + R"(
        from idle to b on left
        from idle to d on right
        from x to idle on back
        from a to b on never
        from c to d on never)"};
    EXPECT_EQ(m.send("left"), "-idle +x +b +c");
    m.send("back");
    EXPECT_EQ(m.send("right"), "-idle +x +a +d");
    EXPECT_EQ(m.active(), "x(a d)");
}

const std::string nested = R"(
    state out initial
    state x entry +x
    state a in x region l initial entry +a
    state b in x region l entry +b
    state ba in b initial entry +ba
    state bb in b entry +bb
    state c in x region r initial entry +c
    state d in x region r entry +d
    from out to x on plain
    from out to x on shallow shallow
    from out to x on deep deep
    from x to out on away
    from a to bb on move
    from c to d on move
    from ba to bb on swap
)";

TEST(StateMachineOrder, line_05_restores_the_last_active_states_by_history) {
    Started m{nested};
    EXPECT_EQ(m.send("deep"), "+x +a +c") << "nothing to remember";
    m.send("move");
    EXPECT_EQ(m.active(), "x(b(bb) d)");
    m.send("away");
    EXPECT_EQ(m.send("shallow"), "+x +b +ba +d");
    m.send("swap");
    m.send("away");
    EXPECT_EQ(m.send("deep"), "+x +b +bb +d");
    m.send("away");
    EXPECT_EQ(m.send("plain"), "+x +a +c");
    m.send("away");
    EXPECT_EQ(m.send("deep"), "+x +a +c");
}

TEST(StateMachineOrder, line_05_clears_history_when_bound_again) {
    Started m{nested};
    m.send("plain");
    m.send("move");
    m.deactivate();
    m.bind();
    m.start();
    EXPECT_EQ(m.send("deep"), "+x +a +c");
}

TEST(StateMachineOrder, line_13_offers_an_event_to_every_region_before_anything_runs) {
    Started m{regions + R"(
        from idle to x on go
        from a to b on swap if ga then *ab
        from c to d on swap if gc then *cd
        from x to idle on swap if gx)"};
    m.send("go");
    m.yes = {"ga", "gc", "gx"};
    EXPECT_EQ(m.send("swap"), "?ga ?gc *ab -a +b *cd -c +d");
    EXPECT_EQ(m.active(), "x(b d)");
    EXPECT_EQ(m.send("swap"), "?gx -d -b -x") << "no region took it";
}

TEST(StateMachineOrder, line_13_asks_the_parent_of_regions_once_when_none_handled_it) {
    Started m{regions + R"(
        from idle to x on go
        from a to b on swap if ga
        from c to d on swap if gc
        from x to idle on swap if gx)"};
    m.send("go");
    EXPECT_EQ(m.send("swap"), "?ga ?gc ?gx");
    m.yes = {"gc", "gx"};
    EXPECT_EQ(m.send("swap"), "?ga ?gc -c +d");
}

TEST(StateMachineOrder, line_13_drops_the_transition_of_a_region_that_was_left) {
    Started m{regions + R"(
        from idle to x on go
        from a to idle on out then *out
        from c to d on out then *cd
        from c to d on swap
        from a to b on swap)"};
    m.send("go");
    EXPECT_EQ(m.send("out"), "*out -c -a -x");
    EXPECT_EQ(m.active(), "idle");
}

TEST(StateMachineOrder, line_13_executes_the_second_regions_transition_after_the_first_waited) {
    Started m{regions + R"(
        from idle to x on go
        from a to b on swap then *ab.
        from c to d on swap then *cd.
        from x to idle on back)"};
    m.send("go");
    EXPECT_EQ(m.send("swap"), "*ab:");
    EXPECT_EQ(m.step(), ":*ab -a +b *cd:");
    EXPECT_EQ(m.step(), ":*cd -c +d !x !b !d ~x");
}

TEST(StateMachineOrder, line_23_evaluates_a_refusing_region_again_after_another_changed) {
    Started m{regions + R"(
        from idle to x on go
        from a to b if ga
        from c to d if gc
        from b to idle on never
        from x to idle on back)"};
    m.send("go");
    m.yes = {"gc"};
    EXPECT_EQ(m.step(), "!x !a !c ?ga ?gc -c +d !d ?ga ~x");
}

TEST(StateMachineOrder, shows_every_change_in_a_trace) {
    Play m{regions + R"(
        from idle to x on go
        from c to d on swap
        from x to idle on back
        from a to b on never)"};
    struct Change {
        std::string_view from, to;
        TransitionIndex transition;
        Time at;
        bool operator==(const Change&) const = default;
    };
    struct Changes {
        Play& play;
        std::vector<Change> list{};
    } changes{m};
    m.execution.trace(
        [](void* context, StateIndex from, StateIndex to, TransitionIndex transition, Time at) noexcept
        TAPPET_REALTIME {
            auto& [play, list] = *static_cast<Changes*>(context);
            TAPPET_ESCAPE("a test's list grows",
                          list.push_back({play.name(from), play.name(to), transition, at}));
        },
        &changes);
    m.start();
    m.send("go");
    m.send("swap");
    m.send("back");
    m.stop();
    m.execution.request_initial(m.now);
    m.deactivate();
    EXPECT_EQ(changes.list, (std::vector<Change>{{"none", "idle", start_transition, m.now},
                                                 {"idle", "c", 0, m.now},
                                                 {"c", "d", 1, m.now},
                                                 {"d", "idle", 2, m.now},
                                                 {"idle", "safe", final_transition, m.now},
                                                 {"safe", "idle", reset_transition, m.now},
                                                 {"idle", "none", leaving_transition, m.now}}));
}

TEST(StateMachineOrder, is_not_bound_without_memory_for_history_and_arguments) {
    Play m{nested};
    StateMachineBinding binding;
    binding.machine = m.execution.machine();
    binding.code.run = [](const ProgramTables&, ProgramContext&, std::uint32_t&) noexcept
        TAPPET_REALTIME { return ProgramReturn::ended; };
    StateMachineExecution execution;
    EXPECT_FALSE(execution.bind(binding));
    EXPECT_EQ(execution.start(m.now), StateOutcome::ignored);
    std::array<StateIndex, 24> history{};
    binding.history = history;
    EXPECT_TRUE(execution.bind(binding));
    binding.code = {};
    EXPECT_FALSE(execution.bind(binding)) << "its programs have no code";
}

} // namespace
} // namespace tappet
