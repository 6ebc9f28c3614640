// A slot that starts with a compiled behaviour: it runs from the start and is replaced by loaded ones.
#include "kernel/machine/table/compiled.hpp"
#include "tests/kernel/machine/slots/slot_rig.hpp"

// A namespace different from the other tests': g++ merges functions generated for members of types in unnamed
// namespaces.
namespace tappet::bakery::begun {
namespace {

constexpr ScriptSource source{"first.osd", R"(
StateMachine First {
    initial state Begin { entry { do oven.note(1); } transition oven.tick() select Ticked }
    state Ticked { entry { do oven.note(10); do door.push(1); } transition door.moved() select Begin }
    final state End { entry { do oven.note(11); } }
}
RootStateMachine First first
)"};
constexpr auto reach = script_reach(reachable<Oven>("oven"), reachable<Door>("door"));
constexpr const ScriptUnit& first = compiled_script<source, reach>;

template <class Begin> constexpr auto bakery(const Begin& begin) {
    return machine(
        "bakery",
        components(component<Oven>("oven"), component<Door>("door"), component<Onlooker>("watcher")),
        activities(activity("fast", every(1ms), budget(50us), runs("oven", "door")),
                   activity("office", every(50ms), not_real_time, stack(256 * 1024), runs("watcher"))),
        connections(), reactions(), behaviours(begin));
}
constexpr Slot room = slot(nodes(40), data_bytes(512), depth(2), timers(1), text_bytes(2000), peers("door"),
                           operations("door.push"), events("door.moved"), trial(2));
constexpr auto native = bakery(behaviour("oven", compiled<first>, room, at_most(30)));
constexpr auto interpreted = bakery(behaviour("oven", first, {}, room, at_most(30)));

template <class Machine> struct Begun : testing::Test, Machine {
    BehaviourSlot& slot = *this->instance.slot_of("oven");
    Begun() { this->run(5ms); }
    [[nodiscard]] std::string compile(std::string_view text) {
        return Machine::compile(slot, text, "second.osd");
    }
    void change(BehaviourSlot::Change how) {
        Machine::change(slot, how);
        this->run(3ms);
    }
    std::string state_now() { return slot.active() == nullptr ? "none" : this->state(*slot.active()); }
};
using Kinds = testing::Types<Rig<native>, Rig<interpreted>>;
TYPED_TEST_SUITE(Begun, Kinds);

TYPED_TEST(Begun, behaviour_runs_from_the_start) {
    EXPECT_EQ(this->slot.phase(), SlotPhase::steady);
    EXPECT_EQ(this->slot.script(), "first.osd");
    EXPECT_EQ(this->slot.loads(), 0u);
    EXPECT_EQ(this->state_now(), "Begin");
    EXPECT_EQ(this->instance.behaviour_of("oven"), this->slot.active()) << "it drives the oven";
    this->tick();
    EXPECT_EQ(this->state_now(), "Ticked");
    this->door().moved.emit();
    this->run(2ms);
    EXPECT_THAT(this->oven().told, ElementsAre(1, 10, 1));
    EXPECT_EQ(this->door().pushes, 1);
}

TYPED_TEST(Begun, behaviour_is_replaced_by_a_load_and_returns_on_roll_back) {
    ASSERT_EQ(this->compile(numbered(2)), "");
    this->change(BehaviourSlot::Change::take_over);
    EXPECT_THAT(this->oven().told, ElementsAre(1, 11, 2)) << "by its final state";
    EXPECT_EQ(this->slot.script(), "second.osd");
    this->change(BehaviourSlot::Change::roll_back);
    EXPECT_EQ(this->slot.script(), "first.osd");
    this->tick();
    EXPECT_THAT(this->oven().told, ElementsAre(1, 11, 2, 21, 1, 10));
}

TYPED_TEST(Begun, behaviour_returns_when_the_loaded_one_fails_its_trial) {
    ASSERT_EQ(this->compile(numbered(2, "run { do oven.note(-1); }")), "");
    this->change(BehaviourSlot::Change::take_over);
    this->tick();
    EXPECT_EQ(this->slot.last_roll_back(), RollBack::error);
    EXPECT_EQ(this->slot.script(), "first.osd");
    EXPECT_EQ(this->state_now(), "Begin");
    EXPECT_FALSE(this->instance.stop_asked());
}

TYPED_TEST(Begun, behaviour_can_be_unloaded_and_loaded_again_as_a_script) {
    this->change(BehaviourSlot::Change::unload);
    EXPECT_EQ(this->slot.phase(), SlotPhase::empty);
    EXPECT_EQ(this->instance.behaviour_of("oven"), nullptr);
    this->tick();
    EXPECT_THAT(this->oven().told, ElementsAre(1, 11)) << "nobody hears it";
    ASSERT_EQ(this->compile(source.text), "");
    this->change(BehaviourSlot::Change::take_over);
    this->tick();
    EXPECT_THAT(this->oven().told, ElementsAre(1, 11, 1, 10));
}

TYPED_TEST(Begun, behaviour_restarts_with_its_component) {
    this->tick();
    const LifeTicket ticket = this->instance.life().ask_component(0, LifeChange::restart);
    this->run(5ms);
    EXPECT_EQ(this->instance.life().answer_of_component(0, ticket).outcome, LifeOutcome::done);
    EXPECT_EQ(this->state_now(), "Begin");
    EXPECT_THAT(this->oven().told, ElementsAre(1, 10, 11, 1));
}

// ---- a table of C++

constexpr auto shut = state_machine<Oven>(
    "shut", states(state("closed", initial), state("open"), state("off", final)),
    transitions(transition("closed", "open", on("tick")), transition("open", "closed", on("door.moved"))));
constexpr auto of_a_table = bakery(behaviour("oven", compiled<shut>, room));

struct BegunTable : Begun<Rig<of_a_table>> {};

TEST_F(BegunTable, runs_until_a_script_takes_over) {
    EXPECT_EQ(state_now(), "closed");
    tick();
    EXPECT_EQ(state_now(), "open");
    ASSERT_EQ(compile(numbered(2)), "");
    change(BehaviourSlot::Change::take_over);
    EXPECT_EQ(state_now(), "Begin");
}

} // namespace
} // namespace tappet::bakery::begun
