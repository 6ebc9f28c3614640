// Events between the components of a machine (thesis 4.6): rows with handles, the order of an emission,
// several emitting activities, waits, and the general observer. The effects of a single row are tested in
// tests/kernel/component/event_test.cpp.
#include "kernel/machine/plan/subscription.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <vector>

namespace tappet {
namespace {

using testing::ElementsAre;

using Profile = std::array<double, 20>;
using Picture = std::array<double, 80>;
/// The turn determines each of its numbers.
Profile profile_of(std::int64_t turn) noexcept TAPPET_REALTIME {
    Profile made;
    for (std::size_t i = 0; i < made.size(); ++i)
        made[i] = static_cast<double>(turn) + static_cast<double>(i) / 32;
    return made;
}

/// Emits on demand; each step emits what a test has put into `to_emit` and `profiles`.
struct Shaft {
    Event<double> beat_up;
    Event<> standing;
    Event<Profile, std::int64_t> profile; // too large for a message
    Event<Picture> picture;               // too large for an observer
    std::vector<double> to_emit;
    std::vector<std::int64_t> profiles;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        for (double angle : to_emit) beat_up(angle);
        for (const std::int64_t turn : profiles) profile(profile_of(turn), turn);
        TAPPET_ESCAPE("a test's memory", to_emit.clear(); profiles.clear());
    }
    void announce() noexcept TAPPET_REALTIME { beat_up(-1.0); }
    static constexpr auto interface() {
        return facets(event<&Shaft::beat_up>("beat_up", "the reed strikes, at this angle"),
                      event<&Shaft::standing>("standing", "it stopped"),
                      event<&Shaft::profile>("profile", "of one turn, and which"),
                      event<&Shaft::picture>("picture", "of the reed"),
                      operation<&Shaft::announce>("announce", "emits in the caller's activity", any_thread));
    }
};

/// Asks the shaft to emit, from its own activity.
struct Panel {
    Event<> pressed;
    bool press = false;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (press) pressed();
        press = false;
    }
    static constexpr auto interface() { return facets(event<&Panel::pressed>("pressed", "the button")); }
};

struct Console {
    EventHandle beat;
    EventWait<double> next_beat;
    EventHandle profile;
    EventWait<Profile, std::int64_t> next_profile;
    Notes<double> beats;
    Notes<std::int64_t> profiles; ///< turns of the complete ones
    void on_beat(double angle) noexcept TAPPET_REALTIME { beats.add(angle); }
    void on_profile(Profile made, std::int64_t turn) noexcept TAPPET_REALTIME {
        profiles.add(made == profile_of(turn) ? turn : -1);
    }
    static constexpr auto interface() {
        return facets(handle<&Console::beat>("beat", "of its beats"),
                      awaits<&Console::next_beat>("next_beat", "the next one"),
                      handle<&Console::profile>("profile", "of its profiles"),
                      awaits<&Console::next_profile>("next_profile", "the next one"),
                      operation<&Console::on_profile>("on_profile", "shows it"),
                      operation<&Console::on_beat>("on_beat", "shows it"));
    }
};

struct Weft {
    Notes<std::int64_t> profiles;
    void keep_profile(Profile made, std::int64_t turn) noexcept TAPPET_REALTIME {
        profiles.add(made == profile_of(turn) ? turn : -1);
    }
    void hold(double) noexcept TAPPET_REALTIME {}
    void show(double) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(operation<&Weft::hold>("hold", "holds", any_thread),
                      operation<&Weft::show>("show", "shows"),
                      operation<&Weft::keep_profile>("keep_profile", "the latest"));
    }
};

struct Watcher : Onlooker {
    struct Seen {
        std::size_t event;
        double angle;
        Time when;
    };
    std::vector<Seen> seen;
    Sentence configure(Setup& setup) {
        setup.machine->observation().show_events_to({&Watcher::observe, this});
        return {};
    }
    static void observe(void* self, std::size_t event, const std::byte* packed, Time now) noexcept
        TAPPET_REALTIME {
        double angle = 0;
        std::memcpy(&angle, packed, sizeof angle);
        TAPPET_ESCAPE("a test's memory", static_cast<Watcher*>(self)->seen.push_back({event, angle, now}));
    }
};

// clang-format off
constexpr auto table = machine("events",
    components(component<Shaft>("shaft"), component<Panel>("panel"), component<Console>("console"), component<Weft>("weft"),
               component<Watcher>("watcher")),
    activities(
        activity("motion",  every(1ms),  budget(50us), runs("shaft")),
        activity("logic",   every(2ms),  budget(50us), runs("panel")),
        activity("lamps",   on_work(),   at_most(4, 1ms), deadline(500us), budget(50us), runs("weft")),
        activity("console", every(10ms), not_real_time, runs("console")),
        activity("office",  every(10ms), not_real_time, runs("watcher"))),
    connections(),
    reactions(
        when("shaft.beat_up", tell("console.on_beat", queue(4)), handled_by("console.beat"), disconnected),
        when("shaft.beat_up", tell("weft.show", keep_latest)),
        when("shaft.beat_up", tell("console.next_beat")),
        when("shaft.profile", tell("console.on_profile", queue(3)), handled_by("console.profile")),
        when("shaft.profile", tell("weft.keep_profile", keep_latest)),
        when("shaft.profile", tell("console.next_profile", queue(2))),
        when("shaft.beat_up", call("weft.hold")),
        when("panel.pressed", call("shaft.announce"))),
    behaviours());
// clang-format on

struct Rig : RunningRig<table> {
    Shaft& shaft = the<Shaft>("shaft");
    Panel& panel = the<Panel>("panel");
    Console& console = the<Console>("console");
    Weft& weft = the<Weft>("weft");
    Watcher& watcher = the<Watcher>("watcher");
    SubscriptionCounts counts(std::string_view operation) {
        const auto& plan = instance.machine().plan;
        for (std::size_t s = 0; s < plan.subscriptions.size(); ++s)
            if (plan.subscriptions[s].kind != SubscriberKind::observer &&
                !plan.subscriptions[s].synchronous &&
                facet_at(instance.machine().table, plan.subscriptions[s].target).name == operation)
                return instance.observation().counts_of(s);
        ADD_FAILURE() << "no row tells " << operation;
        return {};
    }
};

struct AReactionRow : testing::Test, Rig {};
using AnEmission = AReactionRow;
using AnEvent = AReactionRow;
using AWait = AReactionRow;
using TheObserver = AReactionRow;

TEST_F(AReactionRow, that_starts_disconnected_runs_once_its_handle_connects_it) {
    ASSERT_TRUE(console.beat.valid());
    EXPECT_FALSE(console.beat.connected());
    shaft.to_emit = {1.0};
    pass(20ms);
    console.beat.connect();
    shaft.to_emit = {2.0, 3.0};
    pass(20ms);
    EXPECT_THAT(console.beats, ElementsAre(2.0, 3.0));
    EXPECT_EQ(counts("on_beat").posted, 2u);
}

TEST_F(AReactionRow, carries_large_arguments_in_order_and_complete) {
    for (std::int64_t turn = 0; turn < 40; turn += 2) { // wraps around the slots in which they wait
        shaft.profiles = {turn, turn + 1};
        pass(20ms);
    }
    ASSERT_EQ(console.profiles.size(), 40u);
    for (std::int64_t turn = 0; turn < 40; ++turn)
        EXPECT_EQ(console.profiles[static_cast<std::size_t>(turn)], turn);
    EXPECT_EQ(counts("on_profile").lost, 0u);
}

TEST_F(AReactionRow, counts_large_arguments_that_overflow_and_drops_outdated_ones) {
    shaft.profiles = {1, 2, 3, 4, 5};
    pass(20ms);
    EXPECT_THAT(console.profiles, ElementsAre(1, 2, 3));
    EXPECT_EQ(counts("on_profile").lost, 2u);
    shaft.profiles = {6, 7};
    pass(5ms); // the console's next cycle comes later
    console.profile.disconnect();
    console.profile.connect();
    shaft.profiles = {8};
    pass(20ms);
    EXPECT_THAT(console.profiles, ElementsAre(1, 2, 3, 8));
    EXPECT_EQ(counts("on_profile").outdated, 2u);
}

TEST_F(AReactionRow, delivers_the_latest_large_argument_or_lets_a_wait_accept_it) {
    shaft.profiles = {1, 2, 3};
    pass(2ms);
    EXPECT_THAT(weft.profiles, ElementsAre(3));
    Profile made;
    std::int64_t turn = 0;
    for (const std::int64_t expected : {1, 2}) {
        EXPECT_TRUE(console.next_profile.take(made, turn));
        EXPECT_EQ(turn, expected);
        EXPECT_EQ(made, profile_of(turn));
    }
    EXPECT_FALSE(console.next_profile.take(made, turn)) << "its queue holds two";
}

TEST(TheDigest, includes_every_word_of_large_arguments) {
    const auto digest_after = [](std::int64_t turn) { // the last word of what is emitted
        Rig rig;
        rig.shaft.profile(profile_of(0), turn);
        rig.pass(20ms);
        return rig.instance.engines()[3].digest().value();
    };
    EXPECT_EQ(digest_after(5), digest_after(5));
    EXPECT_NE(digest_after(5), digest_after(6));
}

TEST_F(AnEmission, runs_synchronous_reactions_first_and_then_the_most_urgent_receivers) {
    const auto& machine = instance.machine();
    std::vector<std::string_view> order;
    for (const Subscription& each : machine.plan.subscriptions)
        if (facet_at(machine.table, each.event).name == "beat_up")
            order.push_back(each.kind == SubscriberKind::observer
                                ? "watcher"
                                : facet_at(machine.table, each.target).name);
    // weft.hold is called, weft.show receives it in the most urgent activity, then the rows of the console
    // follow in their order.
    EXPECT_THAT(order, ElementsAre("hold", "show", "on_beat", "next_beat", "watcher"));
}

TEST_F(AnEvent, can_be_emitted_by_each_activity_that_calls_its_component) {
    panel.press = true; // runs shaft.announce in the panel's activity
    shaft.to_emit = {1.0};
    console.beat.connect();
    pass(20ms);
    EXPECT_THAT(console.beats, testing::UnorderedElementsAre(1.0, -1.0));
    EXPECT_EQ(counts("on_beat").stray, 0u);
    EXPECT_EQ(counts("on_beat").posted, 2u);
}

TEST_F(AnEvent, gives_each_emitting_activity_the_whole_queue_of_a_row) {
    console.beat.connect();
    panel.press = true;
    shaft.to_emit = {1.0, 2.0, 3.0, 4.0};
    pass(20ms);
    EXPECT_EQ(console.beats.size(), 5u);
    EXPECT_EQ(counts("on_beat").lost, 0u);
}

TEST_F(AWait, finds_emissions_in_order_and_returns_at_once_in_virtual_time) {
    double angle = 0;
    EXPECT_FALSE(console.next_beat.wait(10s, angle));
    EXPECT_FALSE(console.next_beat.take(angle));
    shaft.to_emit = {1.0, 2.0};
    pass(2ms);
    EXPECT_TRUE(console.next_beat.wait(10s, angle));
    EXPECT_EQ(angle, 1.0);
    EXPECT_TRUE(console.next_beat.take(angle));
    EXPECT_EQ(angle, 2.0);
    EXPECT_FALSE(console.next_beat.take(angle));
}

TEST_F(TheObserver, sees_an_event_from_its_connection_on) {
    const auto& table_of = instance.machine().table;
    const std::size_t index = find_component(table_of, "shaft");
    const std::size_t beat_up = find_facet(table_of.components[index], "beat_up");
    const EventHandle handle = instance.observation().observe_event(index, beat_up);
    ASSERT_TRUE(handle.valid());
    EXPECT_FALSE(handle.connected());
    shaft.to_emit = {1.0};
    pass(20ms);
    EXPECT_TRUE(watcher.seen.empty());
    handle.connect();
    shaft.to_emit = {2.0};
    pass(20ms);
    ASSERT_EQ(watcher.seen.size(), 1u);
    EXPECT_EQ(watcher.seen[0].event, instance.observation().observed_index({index, beat_up}));
    EXPECT_EQ(watcher.seen[0].angle, 2.0);
    EXPECT_GT(watcher.seen[0].when, Time{} + 20ms);
    handle.disconnect();
    shaft.to_emit = {3.0};
    pass(20ms);
    EXPECT_EQ(watcher.seen.size(), 1u);
}

TEST_F(TheObserver, counts_its_lost_emissions_and_causes_no_loss_elsewhere) {
    console.beat.connect();
    const End beat_up{find_component(instance.machine().table, "shaft"), 0};
    instance.observation().observe_event(beat_up.component, beat_up.facet).connect();
    shaft.to_emit.assign(3 * observer_quota, 1.0);
    pass(1ms);
    EXPECT_EQ(instance.observation().counts_of(instance.observation().observed_index(beat_up)).lost,
              2 * observer_quota);
    pass(20ms);
    EXPECT_EQ(console.beats.size(), 4u) << "the console's row has a queue of its own, of four";
}

TEST_F(TheObserver, refuses_facets_that_are_too_large_or_not_events) {
    const auto& table_of = instance.machine().table;
    const std::size_t index = find_component(table_of, "shaft");
    for (const std::string_view facet : {"picture", "announce"})
        EXPECT_FALSE(instance.observation()
                         .observe_event(index, find_facet(table_of.components[index], facet))
                         .valid());
    EXPECT_TRUE(instance.observation()
                    .observe_event(index, find_facet(table_of.components[index], "profile"))
                    .valid());
    const EventHandle standing =
        instance.observation().observe_event(index, find_facet(table_of.components[index], "standing"));
    EXPECT_TRUE(standing.valid()) << "although no row names it";
    standing.connect();
    shaft.standing();
    pass(20ms);
    EXPECT_EQ(watcher.seen.size(), 1u);
}

} // namespace
} // namespace tappet
