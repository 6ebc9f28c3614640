// The tasks of loaded behaviours (thesis 5.1.6, 5.2.5): rows, scripts and people command and set them like
// compiled ones, and the properties persist across behaviours.
#include "kernel/services/configuration/property_files.hpp"
#include "kernel/services/tasks/behaviour_task.hpp"
#include "kernel/services/tasks/component_life.hpp"
#include "tests/kernel/machine/behaviour_machine.hpp"

#include <filesystem>
#include <memory>

#include <gmock/gmock.h>

#include <unistd.h>

// A namespace different from tasks_test.cpp: g++ merges functions generated for members of types in unnamed
// namespaces.
namespace tappet::bakery::loaded {
namespace {

using testing::ElementsAre;

/// The shape: every loaded script has these variables and programs.
constexpr ScriptSource shape{"baking.osd", R"(
StateMachine Baking {
    param double heat = 150.0
    var int count = 7; var text words = "none";
    initial state Cold { transition oven.tick() select Off }
    final state Off { }
}
RootStateMachine Baking baking
program int loaves(int number, double weight = 0.5) { return number; }
)"};
constexpr auto reach = script_reach(reachable<Oven>("oven"));
constexpr const ScriptUnit& script = compiled_script<shape, reach>;
using Baking = BehaviourTask<script, "baking">;
using Loaves = BehaviourTask<script, "loaves">;

/// Counts at each tick from the count it finds; one of two scripts with the same shape.
std::string counting(int by) {
    return R"(program int loaves(int number, double weight) {
    var int made = 0;
    while (made < number) { do oven.note(made + int(weight * 100)); set made = made + 1; yield; }
    if (number == 3) then do oven.note(-1);
    return made * )" +
           std::to_string(by) + R"(;
}
StateMachine Baking {
    var int other = 1; var int count = 1000; param double heat = 10; var text words = "mine";
    initial state Cold {
        transition oven.tick() if count >= 0 then { set count = count + )" +
           std::to_string(by) + R"(; do oven.note(count); }
        transition door.moved() { do feeding.stop(); do oven.note(3000); }
        transitions { if count > 100000 select Off }
    }
    final state Off { }
}
RootStateMachine Baking baking
)";
}

struct Panel {
    CommandCall<ScriptInt, double, ScriptInt&> bake;
    CommandCall<> halt_it;
    static constexpr auto interface() {
        return facets(sends<&Panel::bake>("bake", "so many, and how many were made"),
                      sends<&Panel::halt_it>("stop", "ends the states"));
    }
};

/// A compiled script of another component: it commands loaves and sets the variables of the loaded script.
struct Shop {
    Output<std::int64_t> sold;
    Property<std::int64_t> got{0};
    Event<> opens;
    static constexpr auto interface() {
        return facets(output<&Shop::sold>("sold", "", "of them"),
                      property<&Shop::got>("got", "", "of the last baking"),
                      event<&Shop::opens>("opens", "for customers"));
    }
};
constexpr ScriptSource selling{"selling.osd", R"(
StateMachine Selling {
    initial state Closed { transition shop.opens() select Open }
    state Open {
        entry { set baking.count = 40; do making.run(2, 0.1, got); }
        transition shop.opens() select Closed
    }
    final state Off { }
}
)"};
constexpr auto selling_reach =
    script_reach(reachable<Shop>("shop"), reachable<Baking>("baking"), reachable<Loaves>("making"));
constexpr const ScriptUnit& sells = compiled_script<selling, selling_reach>;

// clang-format off
constexpr auto table = machine("bakery",
    components(component<Oven>("oven"), component<Door>("door"), component<Feeder>("feeder"), component<Panel>("panel"), component<Shop>("shop"),
               component<Baking>("baking", controls("oven"), set("heat", 80.0), properties_file("baking.cpf", optional)),
               component<Loaves>("making", controls("oven")),
               component<ComponentLife>("feeding", controls("feeder")),
               component<Onlooker>("watcher")),
    activities(
        activity("fast", every(1ms), budget(50us), runs("oven", "door", "shop", "baking", "making", "feeding")),
        activity("slow", every(5ms), budget(50us), runs("feeder")),
        activity("desk", every(5ms), budget(50us), runs("panel")),
        activity("office", every(50ms), not_real_time, stack(256 * 1024), runs("watcher"))),
    connections(),
    reactions(uses("panel.bake", "making.run"), uses("panel.stop", "baking.stop")),
    behaviours(behaviour("shop", sells, {}),
               behaviour("oven", slot(nodes(60), data_bytes(1024), depth(3), command_slots(2), timers(2), text_bytes(2000),
                                      peers("feeding", "door"), operations("feeding.stop"), events("door.moved"), trial(3)), on_error(OnError::report))));

/// The same machine, with a slot that starts with the shape.
constexpr auto begun = machine("bakery",
    components(component<Oven>("oven"), component<Door>("door"), component<Feeder>("feeder"), component<Baking>("baking", controls("oven"), set("heat", 80.0)),
               component<Loaves>("making", controls("oven")), component<Panel>("panel"), component<Onlooker>("watcher")),
    activities(
        activity("fast", every(1ms), budget(50us), runs("oven", "door", "baking", "making", "feeder")),
        activity("desk", every(5ms), budget(50us), runs("panel")),
        activity("office", every(50ms), not_real_time, stack(256 * 1024), runs("watcher"))),
    connections(),
    reactions(uses("panel.bake", "making.run"), uses("panel.stop", "baking.stop")),
    behaviours(behaviour("oven", script, {}, slot(nodes(60), data_bytes(1024), depth(3), text_bytes(2000), trial(3)))));
// clang-format on

struct Bakery : PlacedRig<table> {
    PropertyFiles files;

    explicit Bakery(const std::string& directory) : files{directory} {
        instance.read_properties_from(files.store());
        const auto standing = instance.configure({});
        EXPECT_TRUE(standing) << standing.error().view();
        EXPECT_EQ(world.start().view(), "");
        run(5ms);
    }
    BehaviourSlot& slot() { return *instance.slot_of("oven"); }
    Oven& oven() { return the<Oven>("oven"); }
    Panel& panel() { return the<Panel>("panel"); }
    ScriptInt& count() { return property<ScriptInt>("baking", "count"); }
    std::string compile(std::string_view text) { return PlacedRig::compile(slot(), text, "new.osd"); }
    void change(BehaviourSlot::Change what) {
        PlacedRig::change(slot(), what);
        run(2ms);
    }
    void load(std::string_view text) {
        ASSERT_EQ(compile(text), "");
        change(BehaviourSlot::Change::take_over);
    }
    void tick(int times = 1) {
        for (int i = 0; i < times; ++i) {
            oven().tick.emit();
            run(2ms);
        }
    }
    /// The state of the command for so many loaves.
    CommandState bake(ScriptInt number, double weight) {
        EXPECT_TRUE(panel().bake.send(number, weight));
        run(20ms);
        return panel().bake.state();
    }
    /// Sets it as a browser's transaction does.
    void set_count(ScriptInt value) {
        const MachineView& of = instance.machine().table;
        const std::size_t c = find_component(of, "baking");
        PropertyTransaction transaction;
        transaction.begin("baking", *of.components[c].type, instance.component(c));
        std::memcpy(transaction.change(find_facet(of.components[c], "count")), &value, sizeof value);
        transaction.commit();
        ASSERT_EQ(transaction.state(), PropertyTransaction::State::done);
    }
};

struct Directory {
    std::string path = testing::TempDir() + "loaded_tasks_test_" + std::to_string(getpid());
    Directory() { std::filesystem::create_directory(path); }
    ~Directory() { std::filesystem::remove_all(path); }
};
struct Loaded : testing::Test, Directory, Bakery {
    Loaded() : Bakery{path} {}
};

TEST_F(Loaded, slot_rejects_commands_and_keeps_properties_while_empty) {
    EXPECT_EQ(property<double>("baking", "heat"), 80.0) << "of the row";
    EXPECT_EQ(count(), 7) << "of the shape";
    EXPECT_EQ(bake(2, 0.25), CommandState::rejected);
}

TEST_F(Loaded, program_is_a_command_with_parameters_and_a_result) {
    load(counting(10));
    EXPECT_EQ(bake(2, 0.25), CommandState::done);
    EXPECT_EQ(panel().bake.result(), 20);
    EXPECT_THAT(oven().told, ElementsAre(25, 26));
    EXPECT_EQ(bake(3, 0.0), CommandState::failed);
    EXPECT_EQ(bake(1, 0.0), CommandState::done) << "after an error too";
    EXPECT_EQ(panel().bake.result(), 10);
}

TEST_F(Loaded, command_fails_when_another_script_takes_over) {
    load(counting(1));
    tick(4);
    ASSERT_TRUE(panel().bake.send(1000, 0.0));
    run(10ms);
    ASSERT_EQ(panel().bake.state(), CommandState::executing);
    load(counting(2));
    run(10ms);
    EXPECT_EQ(panel().bake.state(), CommandState::failed);
    EXPECT_EQ(bake(1, 0.0), CommandState::done);
    EXPECT_EQ(panel().bake.result(), 2);
}

TEST_F(Loaded, machine_is_stopped_by_a_row) {
    load(counting(1));
    ASSERT_TRUE(panel().halt_it.send());
    run(20ms);
    EXPECT_EQ(panel().halt_it.state(), CommandState::done);
    EXPECT_TRUE(slot().active()->parts()[1].machine->is_final());
}

TEST_F(Loaded, script_receives_properties_and_shows_its_changes) {
    load(counting(1));
    EXPECT_EQ(property<double>("baking", "heat"), 80.0);
    tick(2);
    EXPECT_THAT(oven().told, ElementsAre(8, 9)) << "from 7 on, not from its own 1000";
    EXPECT_EQ(count(), 9);
    set_count(20);
    tick();
    EXPECT_EQ(count(), 21);
}

TEST_F(Loaded, script_inherits_the_properties_of_its_predecessor) {
    load(counting(1));
    tick(5);
    ASSERT_EQ(slot().phase(), SlotPhase::steady);
    EXPECT_EQ(count(), 12);
    load(counting(100));
    tick();
    EXPECT_EQ(count(), 112);
    change(BehaviourSlot::Change::unload);
    EXPECT_EQ(count(), 112) << "nothing is loaded, and they stay";
}

TEST_F(Loaded, script_that_is_rolled_back_has_changed_no_property) {
    load(counting(1));
    tick(5);
    ASSERT_EQ(slot().phase(), SlotPhase::steady);
    oven().told.clear();
    load(counting(-8)); // 4, then -4, which the oven refuses
    tick();
    property<double>("baking", "heat") = 99;
    tick();
    EXPECT_EQ(slot().last_roll_back(), RollBack::error);
    EXPECT_THAT(oven().told, ElementsAre(4, -4));
    EXPECT_EQ(count(), 12);
    EXPECT_EQ(property<double>("baking", "heat"), 99.0) << "what people set meanwhile is theirs";
    tick();
    EXPECT_EQ(count(), 13);
    EXPECT_EQ(property<double>("baking", "heat"), 99.0);
}

TEST_F(Loaded, script_that_does_not_fit_is_refused_with_the_reason) {
    const auto refused = [&](std::string_view from, std::string_view to) {
        std::string text = counting(1);
        for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
            text.replace(at, from.size(), to);
        return compile(text);
    };
    EXPECT_EQ(refused("Baking baking", "Baking bakin"),
              "new.osd: task \"baking\" is that of state machine \"baking\", which it does not have; did you "
              "mean \"bakin\"?");
    EXPECT_EQ(refused("program int loaves(int number, double weight) {",
                      "program loaves { const int number = 2; const double weight = 1;"),
              "new.osd:5:12: found a value, but the program returns nothing");
    EXPECT_EQ(refused("param double heat", "param int heat"),
              "new.osd: task \"baking\" has \"param double heat\" of \"baking\", which it does not have so; "
              "declare it there");
    EXPECT_EQ(refused("param double heat", "var double heat"),
              "new.osd: task \"baking\" has \"param double heat\" of \"baking\", which it does not have so; "
              "declare it there");
    EXPECT_EQ(refused("words", "word"), "new.osd: task \"baking\" has \"var text words\" of \"baking\", "
                                        "which it does not have so; declare it there");
    EXPECT_EQ(
        refused("double weight)", "double weight, bool quick)"),
        "new.osd: task \"making\" gives \"loaves\" 2 parameters, and it has 3; give it those of the task");
    EXPECT_EQ(refused("int number", "double number"),
              "new.osd: task \"making\" has \"int number\" of \"loaves\", which it does not have so; declare "
              "it there");
    EXPECT_EQ(refused("program int", "program double"),
              "new.osd: task \"making\" has a result of type int of \"loaves\", which it does not have so; "
              "declare it there");
    EXPECT_EQ(
        compile(
            "StateMachine Baking { initial state A { transition oven.tick() select B } final state B { } }\n"
            "RootStateMachine Baking loaves\nRootStateMachine Baking baking"),
        "new.osd: task \"making\" is that of a program with parameters, and \"loaves\" is not one; write it "
        "so, or rename it");
    EXPECT_EQ(compile(counting(1)), "");
}

TEST_F(Loaded, script_is_commanded_and_set_by_another_behaviour) {
    load(counting(10));
    the<Shop>("shop").opens.emit();
    run(20ms);
    EXPECT_THAT(oven().told, ElementsAre(10, 11));
    EXPECT_EQ(the<Shop>("shop").got.get(), 20) << "the command's result";
    EXPECT_EQ(count(), 40);
    tick();
    EXPECT_EQ(count(), 50);
}

TEST_F(Loaded, script_stops_a_component) {
    load(counting(1));
    the<Door>("door").moved.emit();
    run(30ms);
    EXPECT_THAT(oven().told, ElementsAre(3000));
    EXPECT_EQ(instance.life().state_of(2), ComponentState::stopped);
}

TEST(What_is_loaded, resumes_where_the_machine_was_switched_off) {
    const Directory directory;
    for (const ScriptInt begins : {7, 10}) { // the shape's, then the stored ones
        Bakery bakery{directory.path};
        EXPECT_EQ(bakery.count(), begins);
        bakery.load(counting(1));
        bakery.tick(3);
        EXPECT_EQ(bakery.count(), begins + 3);
        bakery.world.stop();
        EXPECT_EQ(bakery.instance.save_properties(bakery.instance.standing()).view(), "");
    }
}

struct Begun : testing::Test, Rig<begun> {};

TEST_F(Begun, behaviour_receives_properties_from_the_start_and_obeys_commands) {
    run(5ms);
    const BehaviourUnit& unit = *instance.slot_of("oven")->active();
    EXPECT_EQ(property<double>("baking", "heat"), 80.0) << "of the row";
    const BehaviourType& type = unit.unit().types[unit.parts()[0].row->type];
    double heat = 0.0;
    for (const VariableRow& each : type.tables.variables)
        if (each.name == "heat") std::memcpy(&heat, unit.parts()[0].data + each.at, sizeof heat);
    EXPECT_EQ(heat, 80.0);
    auto& panel = the<Panel>("panel");
    ASSERT_TRUE(panel.bake.send(2, 0.25));
    run(20ms);
    EXPECT_EQ(panel.bake.state(), CommandState::done);
    EXPECT_EQ(panel.bake.result(), 2);
    EXPECT_EQ(state(unit, 0), "Cold");
    ASSERT_TRUE(panel.halt_it.send());
    run(20ms);
    EXPECT_EQ(panel.halt_it.state(), CommandState::done);
}

} // namespace
} // namespace tappet::bakery::loaded
