// Behaviours and component life cycles as light-weight tasks (thesis 5.1.6, 5.2.5, 3.1.3): rows and scripts
// use their commands, their variables are properties, and a program with parameters is a command.
#include "kernel/services/configuration/property_files.hpp"
#include "kernel/services/tasks/behaviour_task.hpp"
#include "kernel/services/tasks/component_life.hpp"
#include "tests/kernel/machine/behaviour_machine.hpp"

#include "kernel/machine/table/compiled.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

#include <gmock/gmock.h>

namespace tappet::bakery {

enum class Colour : std::uint8_t { red, green };

} // namespace tappet::bakery

template <>
inline constexpr auto tappet::names_of<tappet::bakery::Colour> =
    std::array<std::string_view, 2>{"red", "green"};

namespace tappet::bakery {
namespace {

using testing::ElementsAre;

struct Lamp {
    Property<Colour> colour{Colour::red};
    static constexpr auto interface() {
        return facets(property<&Lamp::colour>("colour", "", "in which it shines"));
    }
};

constexpr ScriptSource baking{"baking.osd", R"(
StateMachine Baking {
    param double heat = 150.0
    var int count = 7; var text words = "none"; var bool open = false; var duration since; var vector3 place; var colour next = green;
    const int fixed = 3;
    initial state Cold {
        transition oven.tick() if count > 8 then { do oven.note(count); } select Hot
    }
    state Hot {
        entry { set oven.target = heat; set lamp.colour = next; }
        transition oven.tick() select Cold
    }
    final state Off { entry { do feeder.feed(3); do oven.note(99); } }
}
RootStateMachine Baking baking
program int loaves(int number, double weight = 0.5) {
    var int made = 0;
    while (made < number) { do oven.note(made + int(weight * 100)); set made = made + 1; yield; }
    if (number == 3) then { do oven.note(-1); }
    return made * 10;
}
program clean() { do oven.note(500); }
program always { while true { yield; } }
)"};
constexpr auto reach =
    script_reach(reachable<Oven>("oven"), reachable<Feeder>("feeder", false), reachable<Lamp>("lamp"));
constexpr const ScriptUnit& script = compiled_script<baking, reach>;

struct Panel {
    CommandCall<ScriptInt, double, ScriptInt&> bake;
    CommandCall<> clean, halt_it, stop_feeder;
    CommandCall<ScriptText> request;
    static constexpr auto interface() {
        return facets(sends<&Panel::bake>("bake", "so many, and ten times as many rolls"),
                      sends<&Panel::clean>("clean", "runs the program"),
                      sends<&Panel::halt_it>("stop", "ends the program"),
                      sends<&Panel::stop_feeder>("stop_feeder", "ends its life"),
                      sends<&Panel::request>("request", "another state"));
    }
};

// The script of another component commands it.
using Loaves = BehaviourTask<script, "loaves">;
using Machine = BehaviourTask<script, "baking">;
constexpr ScriptSource serving{"serving.osd", R"(
StateMachine Serving {
    var int rolls = 0;
    initial state Idle { transition door.moved() select Busy }
    state Busy {
        entry { do making.run(2, 0.1, rolls); do oven.note(rolls); set machine.count = 20; do feeding.stop(); do oven.note(3000); }
        transition door.moved() select Idle
    }
    final state Off { }
}
)"};
constexpr auto serving_reach =
    script_reach(reachable<Door>("door"), reachable<Oven>("oven"), reachable<Loaves>("making"),
                 reachable<Machine>("machine"), reachable<ComponentLife>("feeding"));
constexpr const ScriptUnit& beside = compiled_script<serving, serving_reach>;

// clang-format off
constexpr auto table = machine("bakery",
    components(component<Oven>("oven"), component<Door>("door"), component<Feeder>("feeder"), component<Panel>("panel"), component<Lamp>("lamp"),
               component<Machine>("machine", controls("oven"), set("heat", 80.0), set("words", "from the row"), set("next", Colour::red)),
               component<Loaves>("making", controls("oven")),
               component<BehaviourTask<script, "clean">>("cleaning", controls("oven")),
               component<BehaviourTask<>>("any", controls("oven")),
               component<ComponentLife>("feeding", controls("feeder"))),
    activities(
        activity("fast", every(1ms), budget(50us), runs("oven", "lamp", "door", "machine", "making", "cleaning", "any", "feeding")),
        activity("slow", every(5ms), budget(50us), runs("feeder")),
        activity("desk", every(5ms), budget(50us), runs("panel"))),
    connections(),
    reactions(uses("panel.bake", "making.run"), uses("panel.clean", "cleaning.run"), uses("panel.stop", "machine.stop"),
              uses("panel.request", "machine.request"), uses("panel.stop_feeder", "feeding.stop")),
    behaviours(behaviour("oven", compiled<script>, on_error(OnError::report)), behaviour("door", beside, {})));
// clang-format on

struct Tasks : Rig<table> {
    Panel& panel() { return the<Panel>("panel"); }
    /// The state of the command for so many loaves.
    CommandState bake(ScriptInt number, double weight) {
        EXPECT_TRUE(panel().bake.send(number, weight));
        run(20ms);
        return panel().bake.state();
    }
    const BehaviourUnit& unit() { return *instance.behaviour_of("oven"); }
};

struct A_task_of_a_program : testing::Test, Tasks {};
using A_behaviour = A_task_of_a_program;
using The_life_of_a_component = A_task_of_a_program;

TEST_F(A_task_of_a_program, is_a_command_with_parameters_that_ends_with_its_result) {
    run(10ms);
    EXPECT_TRUE(oven().told.empty()) << "it does not start by itself";
    ASSERT_TRUE(panel().bake.send(2, 0.25));
    run(1ms);
    EXPECT_EQ(panel().bake.state(), CommandState::executing);
    EXPECT_FALSE(panel().bake.send(1, 1.0)) << "it is on its way";
    run(20ms);
    EXPECT_EQ(panel().bake.state(), CommandState::done);
    EXPECT_THAT(oven().told, ElementsAre(25, 26));
    EXPECT_EQ(panel().bake.result(), 20);
    ASSERT_TRUE(panel().bake.send(1, 7.0)); // from its beginning again
    run(20ms);
    EXPECT_THAT(oven().told, ElementsAre(25, 26, 700));
}

TEST_F(A_task_of_a_program, is_a_command_also_without_parameters) {
    ASSERT_TRUE(panel().clean.send());
    run(10ms);
    EXPECT_EQ(panel().clean.state(), CommandState::done);
    EXPECT_THAT(oven().told, ElementsAre(500));
}

TEST_F(A_task_of_a_program, fails_with_its_program_and_can_run_again) {
    ASSERT_EQ(bake(3, 0.0), CommandState::failed);
    oven().told.clear();
    EXPECT_EQ(bake(1, 0.5), CommandState::done);
    EXPECT_THAT(oven().told, ElementsAre(50));
}

TEST_F(A_task_of_a_program, fails_when_aborted_and_never_starts_while_its_component_is_stopped) {
    ASSERT_TRUE(panel().bake.send(1000, 0.0));
    run(10ms);
    ASSERT_EQ(panel().bake.state(), CommandState::executing);
    static_cast<void>(instance.life().ask_component(0, LifeChange::stop));
    run(40ms);
    EXPECT_EQ(panel().bake.state(), CommandState::failed);
    oven().told.clear();
    ASSERT_TRUE(panel().bake.send(2, 0.0));
    ASSERT_TRUE(panel().clean.send());
    run(20ms);
    EXPECT_EQ(panel().bake.state(), CommandState::rejected);
    EXPECT_EQ(panel().clean.state(), CommandState::rejected);
    static_cast<void>(instance.life().ask_component(0, LifeChange::start));
    run(20ms);
    EXPECT_TRUE(oven().told.empty()) << "it does not begin later";
}

// clang-format off
constexpr auto woken = machine("woken",
    components(component<Oven>("oven"), component<Feeder>("feeder"), component<Panel>("panel"), component<Lamp>("lamp"),
               component<Machine>("machine", controls("oven")), component<Loaves>("making", controls("oven")),
               component<BehaviourTask<script, "clean">>("cleaning", controls("oven")), component<ComponentLife>("feeding", controls("feeder"))),
    activities(activity("fast", on_work(), at_most(10, 1ms), deadline(1ms), budget(50us), runs("oven", "lamp", "machine", "making", "cleaning")),
               activity("slow", every(5ms), budget(50us), runs("feeder")),
               activity("desk", every(5ms), budget(50us), runs("panel", "feeding"))),
    connections(),
    reactions(uses("panel.bake", "making.run"), uses("panel.clean", "cleaning.run"), uses("panel.stop", "machine.stop"),
              uses("panel.request", "machine.request"), uses("panel.stop_feeder", "feeding.stop")),
    behaviours(behaviour("oven", script, {})));
// clang-format on

TEST(A_task, responds_in_an_activity_that_nothing_else_wakes) {
    Rig<woken> rig;
    Panel& panel = *rig.instance.find<Panel>("panel");
    rig.run(20ms);
    ASSERT_TRUE(panel.clean.send());
    rig.run(20ms);
    EXPECT_EQ(panel.clean.state(), CommandState::done);
    ASSERT_TRUE(panel.halt_it.send());
    rig.run(60ms);
    EXPECT_EQ(panel.halt_it.state(), CommandState::done);
}

TEST(A_task_of_a_machine, shows_its_variables_and_parameters_as_properties_set_by_the_row) {
    Tasks rig;
    EXPECT_EQ(rig.property<double>("machine", "heat"), 80.0);
    EXPECT_EQ(rig.property<ScriptInt>("machine", "count"), 7);
    EXPECT_EQ(rig.property<ScriptText>("machine", "words").view(), "from the row");
    EXPECT_EQ(rig.property<Colour>("machine", "next"), Colour::red);
    const ComponentType& type = component_type<Machine>;
    const auto has = [&](std::string_view name) {
        return std::ranges::any_of(type.facets, [&](const Facet& each) { return each.name == name; });
    };
    EXPECT_TRUE(has("open") && has("since") && has("place"));
    EXPECT_FALSE(has("fixed")) << "a constant";
    EXPECT_FALSE(has("run")) << "it is no program";
}

// clang-format off
constexpr auto kept = machine("kept",
    components(component<Oven>("oven"), component<Feeder>("feeder"), component<Lamp>("lamp"),
               component<Machine>("machine", controls("oven"), properties_file("baking.cpf", optional))),
    activities(activity("fast", every(1ms), budget(50us), runs("oven", "lamp", "machine")),
               activity("slow", every(5ms), budget(50us), runs("feeder"))),
    connections(), reactions(), behaviours(behaviour("oven", script, {})));
// clang-format on

TEST(A_task_of_a_machine, stores_variables_in_its_properties_file) {
    const std::string directory = testing::TempDir() + "tasks_test_properties";
    std::filesystem::remove_all(directory);
    std::filesystem::create_directory(directory);
    const auto files = std::make_unique<PropertyFiles>(directory);
    const auto end = [](std::string_view name) {
        return End{3, find_facet(kept.view().components[3], name)};
    };
    os::Clock clock{os::Clock::Kind::virtual_time};
    using Place = std::array<double, 3>;
    struct Values {
        ScriptInt count = 7;
        Place place{};
        Colour next = Colour::green;
    };
    for (const Values expected :
         {Values{}, Values{12, {1, 2, 3}, Colour::red}}) { // the script's, then the stored ones
        MachineInstance instance{AtRunTime<kept, test_board>::machine(), clock};
        instance.read_properties_from(files->store());
        const auto standing = instance.configure({});
        ASSERT_TRUE(standing) << standing.error().view();
        auto& count = *static_cast<ScriptInt*>(instance.facet(end("count")));
        auto& place = *static_cast<Place*>(instance.facet(end("place")));
        auto& next = *static_cast<Colour*>(instance.facet(end("next")));
        EXPECT_EQ(count, expected.count);
        EXPECT_EQ(place, expected.place);
        EXPECT_EQ(next, expected.next);
        count = 12, place = {1, 2, 3}, next = Colour::red;
        EXPECT_EQ(instance.save_properties(*standing).view(), "");
    }
    std::filesystem::remove_all(directory);
}

TEST(A_task_of_a_machine, leads_it_to_its_final_state_and_is_then_done) {
    Tasks rig;
    rig.run(10ms);
    ASSERT_TRUE(rig.panel().halt_it.send());
    rig.run(2ms);
    EXPECT_EQ(rig.panel().halt_it.state(), CommandState::executing)
        << "the entry program of Off feeds for 15 ms";
    rig.run(40ms);
    EXPECT_EQ(rig.panel().halt_it.state(), CommandState::done);
    EXPECT_EQ(rig.state(rig.unit()), "Off");
    EXPECT_THAT(rig.oven().told, ElementsAre(99));
}

TEST(A_task_of_a_machine, rejects_an_unknown_or_unreachable_state) {
    Tasks rig;
    rig.run(10ms);
    for (const std::string_view state : {"Hott", "Hot"}) { // the second has no condition transition
        ScriptText text;
        static_cast<void>(text.assign(state));
        ASSERT_TRUE(rig.panel().request.send(text));
        rig.run(10ms);
        EXPECT_EQ(rig.panel().request.state(), CommandState::rejected) << state;
    }
}

TEST_F(A_behaviour, commands_another_behaviour_and_components_and_sets_its_variables) {
    run(10ms);
    door().moved.emit();
    run(4ms);
    EXPECT_THAT(oven().told, ElementsAre(10, 11, 20)) << "and its result";
    run(40ms);
    EXPECT_THAT(oven().told, ElementsAre(10, 11, 20, 3000)) << "once the feeder said that it had stopped";
    EXPECT_EQ(instance.life().state_of(2), ComponentState::stopped);
    tick();
    EXPECT_EQ(state(unit()), "Hot") << "its guard asks for the variable";
    EXPECT_EQ(oven().target.get(), 80.0);
}

TEST_F(The_life_of_a_component, is_commanded_by_a_row) {
    run(10ms);
    ASSERT_TRUE(panel().stop_feeder.send());
    run(20ms);
    EXPECT_EQ(panel().stop_feeder.state(), CommandState::done);
    EXPECT_EQ(instance.life().state_of(2), ComponentState::stopped);
}

} // namespace
} // namespace tappet::bakery
