// Programs of a script command earlier ones (thesis 5.1.6: from activities of the same task, too); the effect
// is the same in native code, with interpreted tables and in a slot.
#include "tests/kernel/machine/behaviour_machine.hpp"

#include "kernel/machine/table/compiled.hpp"

#include <gmock/gmock.h>

namespace tappet::bakery::beside {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr ScriptSource baking{"baking.osd", R"(
program int loaves(int number, double weight) {
    var int made = 0;
    while (made < number) { do oven.note(made + int(weight * 100)); set made = made + 1; wait (200 us); }
    if (number == 3) then { do oven.note(-1); }
    return made * 10;
}
program endless() { while true { yield; } }
program rolls(duration each) {
    var int made = 0;
    wait (each);
    do loaves(1, 0.07, made);
    do oven.note(made);
}
program sawing() { do oven.tick(); do oven.note(1); wait (200 us); do oven.note(2); }
StateMachine Baking {
    var int made = 0;
    initial state Cold {
        transition oven.tick() select Hot
        transition door.moved() select Busy
        transition oven.hot() select Late
    }
    state Hot {
        entry { do loaves(2, 0.1, made); do oven.note(made); do loaves(1, 0.2, oven.shown); }
        transition oven.tick() select Again
    }
    state Again {
        entry { try do loaves(3, 0, made); catch do oven.note(5); do loaves(1, 0.5, made); do oven.note(made); }
        transition oven.tick() select Cold
    }
    state Busy {
        entry {
            do endless.start();
            try do endless(); catch do oven.note(2);
            do endless.pause();
            if endless.isPaused() && !endless.isRunning() then do oven.note(3);
            do endless.stop();
            try do endless() timeout 5 ms; catch do oven.note(4);
            if endless.isRunning() && !endless.inError() then do oven.note(6);
            do endless.stop();
        }
        transition door.moved() select Cold
    }
    state Late {
        run { do rolls(20 ms); do oven.note(8); }
        transition oven.tick() select Cold
        transition door.moved() select Cut
    }
    state Cut {
        run { try do sawing(); catch do oven.note(9); do oven.note(10); }
        transition oven.tick() { do sawing.stop(); }
        transition door.moved() select Cold
    }
    final state Off { entry { do loaves(1, 0.9, made); do oven.note(77); } }
}
)"};
constexpr auto reach = script_reach(reachable<Oven>("oven"), reachable<Door>("door"));
constexpr const ScriptUnit& script = compiled_script<baking, reach>;

struct Native {};
struct Walked {};
struct Loaded {};
template <class Form> constexpr auto row() {
    if constexpr (std::is_same_v<Form, Native>)
        return behaviour("oven", compiled<script>);
    else if constexpr (std::is_same_v<Form, Walked>)
        return behaviour("oven", script, {});
    else
        return behaviour("oven", slot(nodes(120), data_bytes(2048), depth(2), timers(4), text_bytes(4000),
                                      peers("door"), events("door.moved"), trial(1)));
}
// clang-format off
template <class Form, class... Trigger>
constexpr auto bakery(const Trigger&... trigger) { return machine("bakery",
    components(component<Oven>("oven"), component<Door>("door"), component<Onlooker>("watcher")),
    activities(activity("fast", trigger..., budget(50us), runs("oven", "door")),
               activity("office", every(50ms), not_real_time, stack(256 * 1024), runs("watcher"))),
    connections(), reactions(), behaviours(row<Form>())); }
// clang-format on
template <class Form> constexpr auto table = bakery<Form>(every(1ms));
/// Only its events wake the activity that drives the oven.
template <class Form> constexpr auto woken = bakery<Form>(on_work(), at_most(10, 1ms), deadline(1ms));

template <const auto& Machine> struct Bakery : Rig<Machine> {
    void load() {
        BehaviourSlot* const slot = this->instance.slot_of("oven");
        if (slot == nullptr) return;
        EXPECT_EQ(this->compile(*slot, baking.text, baking.name), "");
        this->change(*slot, BehaviourSlot::Change::take_over);
        this->run(2ms);
    }
    void tick() {
        this->oven().told.clear();
        Rig<Machine>::tick(20ms);
    }
};

template <class Form> struct A_program_beside : testing::Test {
    Bakery<table<Form>> bakery;
    Oven& oven = bakery.oven();
    A_program_beside() { bakery.load(); }
};
using Forms = testing::Types<Native, Walked, Loaded>;
TYPED_TEST_SUITE(A_program_beside, Forms);

TYPED_TEST(A_program_beside, receives_parameters_and_returns_its_result) {
    this->bakery.run(5ms);
    EXPECT_THAT(this->oven.told, IsEmpty()) << "it does not run by itself";
    this->bakery.tick();
    EXPECT_THAT(this->oven.told, ElementsAre(10, 11, 20, 20));
    EXPECT_EQ(this->oven.shown.last(), 10);
}

TYPED_TEST(A_program_beside, fails_the_commanding_statement_when_it_fails_and_restarts) {
    this->bakery.tick();
    this->bakery.tick();
    EXPECT_THAT(this->oven.told, ElementsAre(0, 1, 2, -1, 5, 50, 10));
}

TYPED_TEST(A_program_beside, rejects_commands_at_work_and_can_be_paused_and_stopped) {
    this->bakery.door().moved.emit();
    this->bakery.run(20ms);
    EXPECT_THAT(this->oven.told, ElementsAre(2, 3, 4, 6));
}

TYPED_TEST(A_program_beside, commands_another_program) {
    this->oven.hot.emit(1.0, 2);
    this->bakery.run(19ms);
    EXPECT_THAT(this->oven.told, IsEmpty());
    this->bakery.run(10ms);
    ASSERT_GE(this->oven.told.size(), 3u);
    EXPECT_THAT(std::vector(this->oven.told.begin(), this->oven.told.begin() + 3), ElementsAre(7, 10, 8));
}

TYPED_TEST(A_program_beside, completes_its_step_when_its_own_event_stops_it) {
    this->oven.hot.emit(1.0, 2);
    this->bakery.run(2ms);
    this->bakery.door().moved.emit();
    this->bakery.run(5ms);
    ASSERT_GE(this->oven.told.size(), 3u);
    EXPECT_THAT(std::vector(this->oven.told.begin(), this->oven.told.begin() + 3), ElementsAre(1, 9, 10));
}

TYPED_TEST(A_program_beside, ends_when_a_final_state_ends_it) {
    this->bakery.run(5ms);
    this->bakery.world.stop();
    EXPECT_THAT(this->oven.told, ElementsAre(90, 77));
}

TYPED_TEST(A_program_beside, is_monitored_in_an_activity_that_nothing_else_wakes) {
    Bakery<woken<TypeParam>> other;
    other.load();
    other.oven().hot.emit(1.0, 2);
    other.run(30ms);
    ASSERT_GE(other.oven().told.size(), 3u);
    EXPECT_THAT(std::vector(other.oven().told.begin(), other.oven().told.begin() + 3), ElementsAre(7, 10, 8));
}

} // namespace
} // namespace tappet::bakery::beside
