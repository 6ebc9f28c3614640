// A behaviour whose end takes time, in an activity that only the behaviour's own wait wakes.
#include "tests/kernel/machine/behaviour_machine.hpp"

namespace tappet::bakery {
namespace {

// clang-format off
constexpr auto sporadic = machine("gate",
    components(component<Door>("door"), component<Onlooker>("watcher")),
    activities(
        activity("gate", on_work(), at_most(8, 1ms), deadline(500us), budget(50us), runs("door")),
        activity("office", every(50ms), not_real_time, stack(256 * 1024), runs("watcher"))),
    connections(), reactions(),
    behaviours(behaviour("door", slot(nodes(40), data_bytes(512), depth(3), timers(2), text_bytes(2000), trial(2)))));
// clang-format on

struct Gate : testing::Test, Rig<sporadic> {
    Door& gate = *instance.find<Door>("door");
    BehaviourSlot& slot = *instance.slot_of("door");
    Gate() {
        constexpr std::string_view text =
            "StateMachine Slow { initial state A { transition door.moved() select B }\n"
            "state B { transition door.moved() select A }\n"
            "final state End { entry { wait(20ms); set door.open = true; } } }";
        EXPECT_EQ(compile(slot, text, "gate.osd"), "");
        change(slot, BehaviourSlot::Change::take_over);
        run(5ms);
        EXPECT_EQ(state(*slot.active()), "A");
    }
};

TEST_F(Gate, is_woken_by_the_wait_of_its_final_state) {
    const Time begun = clock.now();
    EXPECT_EQ(world.change_activity(0, LifeChange::stop).view(), "");
    EXPECT_TRUE(gate.open.get());
    EXPECT_EQ(clock.now() - begun, 20ms);
}

TEST_F(Gate, refuses_a_component_request_when_its_activity_stops) {
    const LifeTicket ticket = instance.life().ask_component(0, LifeChange::restart);
    run(5ms);
    EXPECT_EQ(instance.life().answer_of_component(0, ticket).outcome, LifeOutcome::pending);
    EXPECT_EQ(world.change_activity(0, LifeChange::restart).view(), "");
    EXPECT_EQ(instance.life().answer_of_component(0, ticket).outcome, LifeOutcome::refused);
    EXPECT_TRUE(gate.open.get()) << "it came to its end all the same";
    run(5ms);
    EXPECT_EQ(state(*slot.active()), "A");
}

TEST_F(Gate, starts_nothing_during_its_end) {
    struct Asking {
        Gate* gate;
        LifeTicket ticket{};
        Time at;
    } asking{this, {}, clock.now() + 10ms};
    world.add({&asking, [](void* self) { return static_cast<Asking*>(self)->at; },
               [](void* self, Time) {
                   auto& each = *static_cast<Asking*>(self);
                   each.at = never;
                   each.ticket = each.gate->instance.life().ask_component(0, LifeChange::restart);
               }});
    const Time begun = clock.now();
    EXPECT_EQ(world.change_activity(0, LifeChange::stop).view(), "");
    EXPECT_EQ(clock.now() - begun, 20ms);
    EXPECT_TRUE(gate.open.get());
    EXPECT_EQ(instance.life().answer_of_component(0, asking.ticket).outcome, LifeOutcome::refused);
    EXPECT_EQ(instance.life().state_of(0), ComponentState::stopped);
}

} // namespace
} // namespace tappet::bakery
