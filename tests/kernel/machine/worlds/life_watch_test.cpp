// SPDX-License-Identifier: Apache-2.0
// The activities that must show signs of life, and the longest time between them.
#include "kernel/machine/worlds/life_watch.hpp"

#include "tests/kernel/machine/virtual_rig.hpp"

#include <functional>

namespace tappet {
namespace {

/// The test checks in its step: in the middle of a cycle.
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

struct Watched : testing::Test, ConfiguredRig<table> {
    static constexpr Time begin = at_ns(1'000'000'000);

    void SetUp() override {
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
    /// Checks every 10 ms from the last check to `until`; returns the time of the first hang found, or never.
    Time found_by(Duration until) {
        while (looked < begin + until)
            if (watch.look(looked = std::min(looked + 10ms, begin + until)) != LifeWatch::all_live)
                return looked;
        return never;
    }
    Time looked = begin;

    LifeWatch watch{instance, 100ms};
};

TEST_F(Watched, a_sleeping_activity_without_a_due_time_never_times_out) { EXPECT_EQ(found_by(10s), never); }

TEST_F(Watched, an_activity_that_misses_its_wake_time_is_found) {
    beat().sleeps_until(begin + 10ms);
    EXPECT_EQ(found_by(1s), begin + 120ms)
        << "owed from 10 ms on; at 110 ms the limit is reached, not exceeded";
}

TEST_F(Watched, an_activity_that_was_woken_but_does_not_run_is_found) {
    beat().waiter().wake();
    EXPECT_EQ(found_by(1s), begin + 120ms) << "first seen at 10 ms";
}

TEST_F(Watched, activity_shows_life_when_a_cycle_begins_or_ends) {
    beat().waiter().wake();
    EXPECT_EQ(found_by(50ms), never);
    beat().run(true);
    beat().waiter().wake(); // at once again, as under a load without end
    EXPECT_EQ(found_by(1s), begin + 170ms) << "since it was seen alive, at 60 ms";
}

TEST_F(Watched, an_activity_that_stays_in_its_cycle_is_found) {
    auto* patient = &the<Patient>("patient");
    Time found = at_ns(0);
    std::function<void()> hang = [&] { found = found_by(1s); };
    patient->context = &hang;
    patient->in_cycle = [](void* context) { (*static_cast<std::function<void()>*>(context))(); };
    clock.advance_to(begin + 10ms); // its next period
    beat().run(true);
    EXPECT_EQ(found, begin + 120ms);
    EXPECT_EQ(found_by(2s), never) << "it came to its end after all";
}

TEST_F(Watched, an_activity_may_use_twice_its_deadline_when_that_is_longer) {
    LifeWatch hasty{instance, 8ms}; // the deadline of its activity is its period, 10 ms
    beat().waiter().wake();
    Time found = never;
    for (Time now = begin; now < begin + 100ms && found == never; now += 1ms)
        if (hasty.look(now) != LifeWatch::all_live) found = now;
    EXPECT_EQ(found, begin + 21ms);
}

TEST_F(Watched, activities_on_a_frozen_box_do_not_count_as_hung) {
    beat().waiter().wake();
    EXPECT_EQ(found_by(50ms), never);
    looked = begin + 10s; // no thread ran, not even the watcher
    EXPECT_EQ(watch.look(looked), LifeWatch::all_live);
    EXPECT_EQ(found_by(11s), begin + 10s + 40ms)
        << "of the frozen time counts a quarter of the limit, and what was owed before";
}

TEST_F(Watched, a_hung_activity_is_found_by_a_watcher_that_is_always_late) {
    beat().waiter().wake();
    for (int looks = 0; looks < 6; ++looks)
        if (watch.look(looked += 60ms) != LifeWatch::all_live) return;
    FAIL() << "it was not found in " << (looked - begin) / 1ms << " ms";
}

TEST_F(Watched, activities_that_may_block_or_are_stopped_never_time_out) {
    instance.engines()[1].waiter().wake();
    EXPECT_EQ(found_by(1s), never) << "it is not real-time";
    beat().stop(begin);
    beat().waiter().wake();
    EXPECT_EQ(found_by(2s), never);
    beat().start(begin);
}

} // namespace
} // namespace tappet
