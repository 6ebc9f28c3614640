// SPDX-License-Identifier: Apache-2.0
// Who owes a sign of life, and for how long it may.
#include "kernel/machine/worlds/life_watch.hpp"

#include "kernel/machine/firmware.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"

#include <gtest/gtest.h>

namespace tappet {
namespace {

/// Its step is where the test looks: in the middle of a cycle.
struct Patient {
    Property<std::int64_t> unused{0};
    void (*in_cycle)(void*) = nullptr;
    void* context = nullptr;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("the test's own look", if (in_cycle != nullptr) in_cycle(context));
    }
    static constexpr auto interface() {
        return facets(property<&Patient::unused>("unused", "", "a component has a facet", range(0, 0)));
    }
};

inline constexpr auto table =
    machine("watched", components(component<Patient>("patient"), component<Patient>("blocker")),
            activities(activity("beat", every(10ms), budget(1ms), runs("patient")),
                       activity("slow", every(10ms), not_real_time, runs("blocker"))),
            connections(), reactions(), behaviours());
inline constexpr Board board{.name = "test", .memory_budget_bytes = 1 << 20, .heap_bytes = 128 * 1024};

class Watched : public testing::Test {
protected:
    static constexpr Time begin = at_ns(1'000'000'000);

    void SetUp() override {
        ASSERT_TRUE(instance.configure({}));
        clock.advance_to(begin);
        for (Engine& engine : instance.engines()) {
            ASSERT_TRUE(engine.initialise().empty());
            engine.start(begin);
            engine.sleeps_until(never);
            static_cast<void>(engine.waiter().take()); // a start may wake
        }
    }
    void TearDown() override {
        for (Engine& engine : instance.engines()) {
            engine.stop(clock.now());
            engine.finalise();
        }
    }
    Engine& beat() { return instance.engines()[0]; }

    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{Firmware<table, board>::machine(), clock};
    LifeWatch watch{instance, 100ms};
};

TEST_F(Watched, an_activity_that_sleeps_and_is_due_for_nothing_owes_nothing_however_long) {
    EXPECT_EQ(watch.look(begin), LifeWatch::all_live);
    EXPECT_EQ(watch.look(begin + 24h), LifeWatch::all_live);
}

TEST_F(Watched, one_that_does_not_wake_when_it_wanted_to_is_found) {
    beat().sleeps_until(begin + 10ms);
    EXPECT_EQ(watch.look(begin + 9ms), LifeWatch::all_live);
    EXPECT_EQ(watch.look(begin + 12ms), LifeWatch::all_live);
    EXPECT_EQ(watch.look(begin + 112ms), LifeWatch::all_live) << "the limit is reached, not exceeded";
    EXPECT_EQ(watch.look(begin + 113ms), 0u);
}

TEST_F(Watched, one_that_was_woken_and_does_not_run_is_found) {
    beat().waiter().wake();
    EXPECT_EQ(watch.look(begin), LifeWatch::all_live);
    EXPECT_EQ(watch.look(begin + 101ms), 0u);
}

TEST_F(Watched, a_cycle_that_begins_or_ends_is_life) {
    beat().waiter().wake();
    EXPECT_EQ(watch.look(begin), LifeWatch::all_live);
    beat().run(true);
    beat().waiter().wake(); // at once again, as under a load that never ends
    EXPECT_EQ(watch.look(begin + 90ms), LifeWatch::all_live);
    EXPECT_EQ(watch.look(begin + 180ms), LifeWatch::all_live) << "since it was seen alive";
    EXPECT_EQ(watch.look(begin + 191ms), 0u);
}

TEST_F(Watched, one_that_stays_in_its_cycle_is_found) {
    auto* patient = instance.find<Patient>("patient");
    struct Looks {
        LifeWatch& watch;
        std::size_t first = 77, last = 77;
    } looks{watch};
    patient->context = &looks;
    patient->in_cycle = [](void* context) {
        auto& own = *static_cast<Looks*>(context);
        own.first = own.watch.look(begin);
        own.last = own.watch.look(begin + 101ms);
    };
    clock.advance_to(begin + 10ms); // its next period
    beat().run(true);
    EXPECT_EQ(looks.first, LifeWatch::all_live);
    EXPECT_EQ(looks.last, 0u);
    EXPECT_EQ(watch.look(begin + 102ms), LifeWatch::all_live) << "it came to its end after all";
}

TEST_F(Watched, who_may_block_and_who_is_stopped_owe_nothing) {
    instance.engines()[1].waiter().wake();
    EXPECT_EQ(watch.look(begin), LifeWatch::all_live);
    EXPECT_EQ(watch.look(begin + 1h), LifeWatch::all_live) << "it is not real-time";
    beat().stop(begin);
    beat().waiter().wake();
    EXPECT_EQ(watch.look(begin + 1h), LifeWatch::all_live);
    EXPECT_EQ(watch.look(begin + 2h), LifeWatch::all_live);
    beat().start(begin);
}

} // namespace
} // namespace tappet
