// The time service (thesis 3.3) in virtual time: events at a time, after a delay and periodic; watchdogs that
// detect the silence of an activity and of a connection.
#include "kernel/services/time/timed_event.hpp"
#include "kernel/services/time/watchdog.hpp"

#include "kernel/base/random.hpp"
#include "tests/kernel/machine/real_rig.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>

namespace tappet {
namespace {

/// Writes its level unless the test silences it, and uses the time that the test sets.
struct Worker : Clocked {
    Output<std::int64_t> level;
    bool silent = false;
    Duration load{};
    std::atomic<Duration> hang_for{Duration::zero()}; ///< from another thread
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (!silent) level.write(level.last() + 1);
        if (load > Duration::zero()) clock->consume(load);
        load = {};
        if (const Duration hang = hang_for.exchange(Duration::zero()); hang > Duration::zero())
            clock->consume(hang);
    }
    static constexpr auto interface() { return facets(output<&Worker::level>("level", "", "counts")); }
};

/// Receives everything, and arms timed events.
struct Office : Clocked {
    Input<std::int64_t> level;
    Event<Time> at;
    Event<Duration> after;
    Event<Duration> again;
    Event<> never_mind;
    bool rearms = false;
    Notes<Time> dues, dues_heard_at;
    Notes<Duration> silences, revivals;
    Notes<Duration> level_silences;
    void on_due(Time when) noexcept TAPPET_REALTIME {
        dues.add(when);
        dues_heard_at.add(clock->now());
        if (rearms) at(when + 7ms);
    }
    void on_silent(Duration time) noexcept TAPPET_REALTIME { silences.add(time); }
    void on_revived(Duration time) noexcept TAPPET_REALTIME { revivals.add(time); }
    void on_level_silent(Duration time) noexcept TAPPET_REALTIME { level_silences.add(time); }
    static constexpr auto interface() {
        return facets(input<&Office::level>("level", "", "of the worker"),
                      event<&Office::at>("at", "wants the event at"),
                      event<&Office::after>("after", "wants it after"),
                      event<&Office::again>("again", "wants it every"),
                      event<&Office::never_mind>("never_mind", "does not want it"),
                      operation<&Office::on_due>("on_due", "hears"),
                      operation<&Office::on_silent>("on_silent", "hears"),
                      operation<&Office::on_revived>("on_revived", "hears"),
                      operation<&Office::on_level_silent>("on_level_silent", "hears"));
    }
};

// clang-format off
constexpr auto table = machine("timely",
    components(component<Worker>("worker"), component<Office>("office"), component<TimedEvent>("bell"),
               component<Watchdog>("cycle_dog", watches("motion"),       set("limit", 20ms)),
               component<Watchdog>("level_dog", watches("worker.level"), set("limit", 30ms))),
    activities(
        activity("motion", every(1ms), budget(50us), runs("worker")),
        activity("dogs",   every(2ms), deadline(500us), budget(50us), runs("cycle_dog", "level_dog")),
        activity("logic",  on_work(), at_most(8, 1ms), deadline(1ms), budget(20us), runs("office", "bell"))),
    connections(data("worker.level", "office.level")),
    reactions(
        when("office.at",         call("bell.arm_at")),
        when("office.after",      call("bell.arm_after")),
        when("office.again",      call("bell.every")),
        when("office.never_mind", call("bell.cancel")),
        when("bell.due",          call("office.on_due")),
        when("cycle_dog.silent",  tell("office.on_silent")),
        when("cycle_dog.revived", tell("office.on_revived")),
        when("level_dog.silent",  tell("office.on_level_silent"))),
    behaviours());
constexpr std::size_t motion = 0, worker = 0;
// clang-format on

struct TimeService : testing::Test, RunningRig<table> {
    TimeService() { pass(10ms); }
    /// Emits as if in the logic's activity: nothing else runs in virtual time meanwhile.
    template <class E, class... A> void emit(E& event, A... arguments) {
        event(arguments...);
        instance.engines()[2].waiter().wake();
    }
    Office& office = the<Office>("office");
    TimedEvent& bell = the<TimedEvent>("bell");
    Worker& the_worker = the<Worker>("worker");
    Watchdog& cycle_dog = the<Watchdog>("cycle_dog");
    Watchdog& level_dog = the<Watchdog>("level_dog");
};

using ATimedEvent = TimeService;
using AWatchdog = TimeService;
using AWatchdogInRealTime = InRealTime;
using testing::ElementsAre;
using testing::IsEmpty;

TEST_F(ATimedEvent, is_due_exactly_once_at_its_time) {
    emit(office.at, clock.now() + 40ms);
    const Time when = clock.now() + 40ms;
    pass(40ms - 1ns);
    EXPECT_THAT(office.dues, IsEmpty());
    pass(100ms);
    EXPECT_THAT(office.dues, ElementsAre(when));
    EXPECT_EQ(office.dues_heard_at, office.dues);
    EXPECT_FALSE(bell.armed());
}

TEST_F(ATimedEvent, is_due_after_a_delay_and_moves_when_armed_again) {
    emit(office.after, Duration{30ms});
    pass(20ms);
    const Time when = clock.now() + 50ms;
    emit(office.after, Duration{50ms});
    pass(200ms);
    EXPECT_THAT(office.dues, ElementsAre(when));
}

TEST_F(ATimedEvent, is_due_at_once_when_its_time_is_past) {
    const Time when = clock.now() - 5ms;
    emit(office.at, when);
    pass(1ns);
    EXPECT_THAT(office.dues, ElementsAre(when));
    EXPECT_EQ(office.dues_heard_at[0], clock.now() - 1ns);
}

TEST_F(ATimedEvent, repeats_until_it_is_cancelled) {
    const Time begin = clock.now();
    emit(office.again, Duration{15ms});
    pass(50ms);
    EXPECT_THAT(office.dues, ElementsAre(begin + 15ms, begin + 30ms, begin + 45ms));
    EXPECT_EQ(bell.times.last(), 3);
    emit(office.never_mind);
    pass(100ms);
    EXPECT_EQ(office.dues.size(), 3u);
    EXPECT_EQ(bell.skipped.last(), 0);
}

TEST_F(ATimedEvent, keeps_its_phase_and_counts_periods_lost_to_lateness) {
    const Time begin = clock.now();
    emit(office.again, Duration{10ms});
    pass(10ms);
    the_worker.load = 35ms; // everything waits for it in virtual time
    pass(60ms);
    EXPECT_EQ(bell.skipped.last() + bell.times.last(), 7);
    EXPECT_GT(bell.skipped.last(), 0);
    for (const Time due : office.dues) EXPECT_EQ((due - begin) % 10ms, Duration::zero());
}

TEST_F(ATimedEvent, is_not_armed_with_a_non_positive_period) {
    emit(office.again, Duration{10ms});
    emit(office.again, Duration{0});
    EXPECT_FALSE(bell.armed());
    emit(office.again, Duration{-1});
    pass(100ms);
    EXPECT_THAT(office.dues, IsEmpty());
}

TEST_F(ATimedEvent, can_be_armed_again_by_its_reaction) {
    office.rearms = true;
    const Time begin = clock.now();
    emit(office.after, Duration{10ms});
    pass(25ms);
    EXPECT_THAT(office.dues, ElementsAre(begin + 10ms, begin + 17ms, begin + 24ms));
}

TEST_F(ATimedEvent, is_cancelled_when_its_component_stops) {
    emit(office.after, Duration{10ms});
    static_cast<void>(instance.life().ask_component(2, LifeChange::restart));
    pass(100ms);
    EXPECT_THAT(office.dues, IsEmpty());
}

TEST_F(AWatchdog, reports_nothing_while_there_are_signs_of_life) {
    pass(10s);
    EXPECT_TRUE(cycle_dog.alive.last());
    EXPECT_TRUE(level_dog.alive.last());
    EXPECT_THAT(office.silences, IsEmpty());
    EXPECT_THAT(office.level_silences, IsEmpty());
}

TEST_F(AWatchdog, reports_a_silent_connection_once_within_two_periods_of_the_limit) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Random random{seed};
        office.level_silences.clear();
        pass(random.between(1, 40'000) * 1us);
        the_worker.silent = true;
        const Time from = clock.now();
        while (office.level_silences.empty() && clock.now() < from + 1s) pass(100us);
        EXPECT_GT(clock.now(), from + 29ms); // its last value is up to a millisecond older
        EXPECT_LE(clock.now(), from + 30ms + 2 * 2ms + 100us);
        pass(500ms);
        ASSERT_EQ(office.level_silences.size(), 1u) << "seed " << seed;
        EXPECT_GE(office.level_silences[0], 30ms);
        EXPECT_LT(office.level_silences[0], 32ms);
        EXPECT_FALSE(level_dog.alive.last());
        EXPECT_TRUE(cycle_dog.alive.last()) << "its activity runs";
        the_worker.silent = false;
        pass(5ms);
        EXPECT_TRUE(level_dog.alive.last());
    }
}

TEST_F(AWatchdog, ignores_an_intended_stop_and_restarts_with_its_subject) {
    EXPECT_EQ(world.change_activity(motion, LifeChange::stop).view(), "");
    pass(200ms);
    EXPECT_THAT(office.silences, IsEmpty());
    EXPECT_THAT(office.level_silences, IsEmpty());
    EXPECT_EQ(world.change_activity(motion, LifeChange::start).view(), "");
    static_cast<void>(instance.life().ask_component(worker, LifeChange::stop)); // its activity continues
    pass(200ms);
    EXPECT_THAT(office.silences, IsEmpty());
    EXPECT_THAT(office.level_silences, IsEmpty());
    static_cast<void>(instance.life().ask_component(worker, LifeChange::start));
    the_worker.silent = true;
    pass(29ms);
    EXPECT_THAT(office.level_silences, IsEmpty());
    pass(10ms);
    EXPECT_EQ(office.level_silences.size(), 1u);
}

TEST_F(AWatchdog, detects_the_silence_of_an_abandoned_thread) {
    Engine& engine = instance.engines()[motion];
    engine.stop(clock.now()); // like a thread with a broken contract
    engine.mark_failed();
    pass(100ms);
    EXPECT_EQ(office.silences.size(), 1u);
    EXPECT_FALSE(cycle_dog.alive.last());
}

/// Runs or hangs as the test orders.
struct Sleeper : Clocked {
    std::atomic<bool> hangs{false};
    Timer alarm;
    Duration alarm_after{}; ///< delay after the wake; none: no alarm
    void rouse() noexcept TAPPET_REALTIME {
        if (hangs.exchange(false)) clock->consume(200ms);
        if (alarm_after > Duration::zero()) alarm.arm(clock->now() + alarm_after);
    }
    void ring(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(operation<&Sleeper::rouse>("rouse", "runs"),
                      timer<&Sleeper::alarm, &Sleeper::ring>("alarm", "does nothing"));
    }
};
/// Wakes it, and receives its watchdog's events.
struct Rouser {
    Event<> now;
    std::atomic<bool> rouses{false};
    Notes<Duration> silences, revivals;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (rouses.exchange(false)) now.emit();
    }
    void on_silent(Duration time) noexcept TAPPET_REALTIME { silences.add(time); }
    void on_revived(Duration time) noexcept TAPPET_REALTIME { revivals.add(time); }
    static constexpr auto interface() {
        return facets(event<&Rouser::now>("now", "run"), operation<&Rouser::on_silent>("on_silent", "hears"),
                      operation<&Rouser::on_revived>("on_revived", "hears"));
    }
};
// clang-format off
constexpr auto sleeping_table = machine("sleeping",
    components(component<Sleeper>("sleeper"), component<Rouser>("rouser"), component<Watchdog>("dog", watches("sleep"), set("limit", 20ms))),
    activities(
        activity("watch", every(2ms), runs("dog"), budget(20us)),
        activity("rouse", every(3ms), runs("rouser"), budget(50us), stack(64 * 1024)),
        activity("sleep", on_work(), at_most(1, 100ms), runs("sleeper"), deadline(100ms), budget(50us))),
    connections(),
    reactions(
        when("rouser.now",  tell("sleeper.rouse")),
        when("dog.silent",  tell("rouser.on_silent")),
        when("dog.revived", tell("rouser.on_revived"))),
    behaviours());
// clang-format on

TEST(AWatchdogOfAnActivityWithoutAPeriod, accepts_idle_time_and_detects_a_missed_wake) {
    RunningRig<sleeping_table> rig;
    Rouser& rouser = rig.the<Rouser>("rouser");
    EXPECT_TRUE(rig.run(1s));
    rouser.rouses = true;
    EXPECT_TRUE(rig.run(1s));
    EXPECT_THAT(rouser.silences, IsEmpty()) << "it rests, and when it was woken it came";
    Engine& sleeping = rig.instance.engines()[2];
    sleeping.stop(rig.clock.now()); // like a thread with a broken contract
    sleeping.mark_failed();
    sleeping.waiter().wake();
    EXPECT_TRUE(rig.run(100ms));
    EXPECT_EQ(rouser.silences.size(), 1u);
}

// clang-format off
constexpr auto rousing_table = machine("rousing", // it is woken just before the watchdog checks
    components(component<Sleeper>("sleeper"), component<Rouser>("rouser"), component<Watchdog>("dog", watches("sleep"), set("limit", 1ms))),
    activities(
        activity("watch", every(2ms), runs("rouser", "dog"), budget(50us), stack(64 * 1024)),
        activity("sleep", on_work(), at_most(1, 2ms), runs("sleeper"), deadline(100ms), budget(50us))),
    connections(),
    reactions(when("rouser.now", tell("sleeper.rouse")), when("dog.silent", call("rouser.on_silent"))), behaviours());
// clang-format on

TEST(AWatchdogOfAnActivityWithoutAPeriod, accepts_idle_time_beyond_a_limit_below_its_own_period) {
    RunningRig<rousing_table> rig;
    Rouser& rouser = rig.the<Rouser>("rouser");
    for (int i = 0; i < 20; ++i) {
        rouser.rouses = true;
        EXPECT_TRUE(rig.run(10ms));
    }
    EXPECT_THAT(rouser.silences, IsEmpty()) << "it comes at once, each time";
}

TEST(AWatchdogOfAnActivityWithoutAPeriod, detects_a_missed_timer) {
    RunningRig<sleeping_table> rig;
    Rouser& rouser = rig.the<Rouser>("rouser");
    rig.the<Sleeper>("sleeper").alarm_after = 50ms;
    rouser.rouses = true;
    EXPECT_TRUE(rig.run(40ms));
    rig.world.hang(2, rig.clock.now() + 1s);
    EXPECT_TRUE(rig.run(25ms));
    EXPECT_THAT(rouser.silences, IsEmpty()) << "nothing was due for longer than the limit";
    EXPECT_TRUE(rig.run(100ms));
    EXPECT_EQ(rouser.silences.size(), 1u);
}

TEST_F(AWatchdogInRealTime, detects_a_hang_but_not_idle_time_without_a_period) {
    RealRig<sleeping_table> rig;
    ASSERT_TRUE(rig.runs());
    Rouser& rouser = rig.the<Rouser>("rouser");
    EXPECT_TRUE(rig.world.supervise(300ms)); // fifteen times the limit
    EXPECT_TRUE(rouser.silences.empty()) << "nobody woke it";
    rig.the<Sleeper>("sleeper").hangs = true;
    rouser.rouses = true;
    EXPECT_TRUE(rig.world.supervise(500ms));
    EXPECT_EQ(rig.world.stop(), 0);
    ASSERT_FALSE(rouser.silences.empty());
    EXPECT_GE(rouser.silences[0], 20ms);
    EXPECT_EQ(rouser.revivals.size(), rouser.silences.size());
}

TEST_F(AWatchdog, repeats_exactly_in_every_run) {
    const auto digest = [](std::uint64_t seed) {
        Random random{seed};
        RunningRig<table> again;
        for (int n = 0; n < 50; ++n) {
            again.the<Worker>("worker").silent = random.below(2) == 0;
            EXPECT_TRUE(again.run(random.between(1, 60) * 1ms));
        }
        return again.instance.observation().event_log_digest();
    };
    for (std::uint64_t seed = 1; seed <= 5; ++seed) EXPECT_EQ(digest(seed), digest(seed));
    EXPECT_NE(digest(1), digest(2));
}

TEST_F(AWatchdogInRealTime, detects_a_hang_in_a_cycle_and_its_recovery) {
    RealRig<table> rig;
    ASSERT_TRUE(rig.runs());
    EXPECT_TRUE(rig.world.supervise(100ms));
    rig.the<Worker>("worker").hang_for = 200ms; // ten times the limit
    EXPECT_TRUE(rig.world.supervise(500ms));
    EXPECT_EQ(rig.world.stop(), 0);
    const Office& office = rig.the<Office>("office");
    ASSERT_FALSE(office.silences.empty());
    EXPECT_GE(office.silences[0], 20ms);
    ASSERT_EQ(office.revivals.size(), office.silences.size());
    // Not the first: a busy host may have delayed the worker before.
    EXPECT_GE(*std::ranges::max_element(office.revivals), 150ms);
}

} // namespace
} // namespace tappet
