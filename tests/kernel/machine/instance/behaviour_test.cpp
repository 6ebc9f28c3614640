// A behaviour row drives a component (thesis 5.1, 5.2.5, 5.3): a compiled script runs in the component's
// activity, after its commands and events. Refused tables: tests/diagnostics/rows.
#include "tests/kernel/machine/behaviour_machine.hpp"

#include <gmock/gmock.h>

namespace tappet::bakery {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr ScriptSource baking{"baking.osd", R"(
StateMachine Baking {
    var double heat = 0.0;
    var int pieces = 0;
    initial state Cold {
        transition oven.hot(heat, pieces) if heat > 100.0 then select Feeding
    }
    state Feeding {
        entry { set oven.target = heat; do oven.note(pieces); }
        run { do feeder.feed(pieces); }
        transitions { select Done }
    }
    state Done {
        entry { set door.open = true; do oven.note(door.push(5)); }
        transition oven.tick() select Cold
    }
    final state Off { entry { do oven.note(99); } }
}
RootStateMachine Baking baking
program counting {
    var int n = 0;
    while (n < 3) { do oven.note(1000 + n); set n = n + 1; yield; }
}
)"};
constexpr auto reach =
    script_reach(reachable<Oven>("oven"), reachable<Door>("door"), reachable<Feeder>("feeder", false));

// clang-format off
constexpr auto parts = components(component<Oven>("oven"), component<Door>("door"), component<Feeder>("feeder"), component<Onlooker>("watcher"));
constexpr auto threads = activities(
    activity("fast", every(1ms), budget(50us), runs("oven", "door")),
    activity("slow", every(5ms), budget(50us), runs("feeder")),
    activity("office", every(50ms), not_real_time, runs("watcher")));
// clang-format on
template <const ScriptSource& source>
constexpr auto table = machine("bakery", parts, threads, connections(), reactions(),
                               behaviours(behaviour("oven", compiled_script<source, reach>, {})));
using Bakery = Rig<table<baking>>;

constexpr ScriptSource cooking{"cooking.osd", R"(
StateMachine Cooking {
    var double a = 0.0; var double b = 0.0; var double c = 0.0; var double d = 0.0; var double e = 0.0; var double f = 0.0;
    var int pieces = 0;
    initial state Waiting {
        transition oven.recipe(a, b, c, d, e, f, pieces) select Cooking
    }
    state Cooking {
        entry { set oven.target = f; do oven.note(pieces); }
        transition oven.tick() select Waiting
                        transition oven.recipe(a, b, c, d, e, f, pieces) if f > 100.0 then select Cooking
    }
    final state Off {}
}
RootStateMachine Cooking cooking
)"};
TEST(Behaviour, receives_event_arguments_too_large_for_a_message) {
    Rig<table<cooking>> rig;
    rig.run(10ms);
    rig.oven().told.clear();
    for (std::int64_t n = 1; n <= 4; ++n) // they are queued together
        rig.oven().recipe.emit(1, 2, 3, 4, 5, n == 3 ? 50.0 : 200.0 + static_cast<double>(n), n);
    rig.run(10ms);
    EXPECT_THAT(rig.oven().told, ElementsAre(1, 2, 4)) << "its guard refused the third";
    EXPECT_EQ(rig.oven().target.get(), 204.0);
}

TEST(Behaviour, runs_a_script_with_events_and_components_of_its_activity) {
    Bakery rig;
    rig.run(10ms);
    rig.oven().told.clear();
    const BehaviourUnit& unit = *rig.instance.behaviour_of("oven");
    EXPECT_EQ(rig.state(unit), "Cold");
    rig.oven().hot.emit(50.0, 3);
    rig.run(5ms);
    EXPECT_EQ(rig.state(unit), "Cold"); // its guard refused
    rig.oven().hot.emit(180.0, 3);
    rig.run(2ms);
    EXPECT_EQ(rig.state(unit), "Feeding");
    EXPECT_EQ(rig.oven().target.get(), 180.0);
    EXPECT_THAT(rig.oven().told, ElementsAre(3));
    rig.run(60ms);
    EXPECT_EQ(rig.state(unit), "Done");
    EXPECT_EQ(rig.feeder().fed, 3); // a command of another activity was sent and awaited
    EXPECT_TRUE(rig.door().open.get());
    EXPECT_THAT(rig.oven().told, ElementsAre(3, 5));
}

TEST(Behaviour, runs_a_program_with_its_component_before_the_state_machines) {
    Bakery rig;
    rig.run(10ms);
    EXPECT_THAT(rig.oven().told, ElementsAre(1000, 1001, 1002));
    EXPECT_EQ(rig.instance.behaviour_of("oven")->parts()[1].program->status(), ProgramStatus::stopped);
}

TEST(Behaviour, reaches_its_final_state_when_its_component_stops_and_restarts_with_it) {
    Bakery rig;
    rig.run(10ms);
    rig.oven().told.clear();
    static_cast<void>(rig.instance.life().ask_component(0, LifeChange::stop));
    rig.run(5ms);
    const BehaviourUnit& unit = *rig.instance.behaviour_of("oven");
    EXPECT_EQ(rig.state(unit), "Off");
    EXPECT_THAT(rig.oven().told, ElementsAre(99));
    static_cast<void>(rig.instance.life().ask_component(0, LifeChange::start));
    rig.run(5ms);
    EXPECT_EQ(rig.state(unit), "Cold");
}

constexpr ScriptSource cooling{"cooling.osd", R"(
StateMachine Cooling {
    initial state Cold { entry { do oven.note(1); } transition oven.tick() select Warm }
    state Warm { transition oven.tick() select Cold }
    final state Off { entry { do feeder.feed(3); do oven.note(99); } } // 15 ms in another activity
}
RootStateMachine Cooling cooling
)"};
TEST(Behaviour, ends_completely_before_its_component_restarts) {
    for (const Duration stopped_for : {0ms, 1ms, 50ms}) {
        Rig<table<cooling>> rig;
        rig.run(10ms);
        const BehaviourUnit& unit = *rig.instance.behaviour_of("oven");
        EXPECT_EQ(rig.state(unit), "Cold");
        rig.oven().told.clear();
        static_cast<void>(rig.instance.life().ask_component(0, LifeChange::stop));
        rig.run(1ms + stopped_for);
        static_cast<void>(rig.instance.life().ask_component(0, LifeChange::start));
        rig.run(50ms);
        EXPECT_EQ(rig.state(unit), "Cold");
        EXPECT_THAT(rig.oven().told, ElementsAre(99, 1));
        EXPECT_EQ(rig.feeder().fed, 3);
    }
}

constexpr ScriptSource failing{"failing.osd", R"(
StateMachine Failing {
    var int pieces = 15;
    initial state Cold { entry { do oven.note(1); } transition oven.tick() select Warm }
    state Warm { transition oven.tick() select Cold }
    final state Off { entry { set pieces = pieces - 4; do feeder.feed(pieces); do oven.note(99); } }
}
RootStateMachine Failing failing
)"};
// clang-format off
constexpr auto failed = machine("failed", parts, threads, connections(), reactions(),
    behaviours(behaviour("oven", compiled_script<failing, reach>, {}, on_error(OnError::report))));
// clang-format on

TEST(Behaviour, does_not_restart_by_itself_after_a_failure_during_its_end) {
    Rig<failed> rig;
    rig.run(10ms);
    const BehaviourUnit& unit = *rig.instance.behaviour_of("oven");
    rig.oven().told.clear();
    static_cast<void>(rig.instance.life().ask_component(0, LifeChange::restart)); // the feeder rejects eleven
    rig.run(50ms);
    StateMachineExecution& machine = *unit.parts()[0].machine;
    EXPECT_TRUE(machine.in_error());
    EXPECT_EQ(machine.request_final(rig.clock.now()), StateOutcome::taken); // and accepts seven
    rig.run(50ms);
    EXPECT_THAT(rig.oven().told, ElementsAre(99));
    EXPECT_EQ(rig.state(unit), "Off");
}

TEST(Behaviour, stops_the_machine_on_an_error_and_reports_the_line) {
    Bakery rig;
    rig.run(10ms);
    rig.oven().hot.emit(180.0, 11); // the feeder rejects this number
    rig.run(60ms);
    EXPECT_TRUE(rig.instance.stop_asked());
    const std::string why{rig.instance.describe_stop().view()};
    EXPECT_THAT(why, HasSubstr("the behaviour of \"oven\""));
    EXPECT_THAT(why, HasSubstr("\"baking\": run of state \"Feeding\" failed in line 10"));
}

} // namespace
} // namespace tappet::bakery
