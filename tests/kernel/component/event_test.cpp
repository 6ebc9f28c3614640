// Events (thesis 4.6): immediate reactions, reactions posted to another engine within their quota, and
// connecting and disconnecting them, also from reactions.
#include "tests/kernel/component/event_rig.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <utility>

namespace {

using namespace tappet;

/// Records its arguments in order, then runs the test's action.
struct Listener {
    std::vector<double> heard;
    std::function<void()> then;
    void hear(double value) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test remembers", heard.push_back(value); if (then) then());
    }
};
inline constexpr const OperationOperations& hear = detail::operation_of<&Listener::hear>;

/// The tests run as activity 0.
struct AnEvent : testing::Test {
    RunsActivity here{0};
    Emitter emitter;
    Listener first, second, third;
};

/// The only asynchronous row to a receiver, which has more room than the row's quota.
struct Told : Receiver, Row {
    EventHandle handle;

    Told(Emitter& emitter, Listener& listener, std::uint32_t quota, bool keeps_latest = false)
        : Receiver{quota + 4},
          Row{static_cast<Receiver&>(*this), hear, &listener, quota, keeps_latest},
          handle{emitter.tell(row)} {}
};

TEST_F(AnEvent, has_no_effect_without_subscribers) {
    Event<double> event;
    event.emit(1.0);
    event(2.0);
}

TEST_F(AnEvent, calls_its_synchronous_reactions_at_once_in_the_order_of_their_rows) {
    std::vector<int> order;
    first.then = [&] { order.push_back(1); };
    second.then = [&] { order.push_back(2); };
    emitter.call(hear, &first);
    emitter.call(hear, &second);
    emitter.event(1.5);
    EXPECT_EQ(first.heard, (std::vector{1.5}));
    EXPECT_EQ(second.heard, (std::vector{1.5}));
    EXPECT_EQ(order, (std::vector{1, 2}));
}

TEST_F(AnEvent, posts_its_asynchronous_reactions_and_wakes_the_receiver) {
    Told told{emitter, first, 4};
    int wakes = 0;
    told.row.waker = {[](void* count) noexcept TAPPET_REALTIME { ++*static_cast<int*>(count); }, &wakes};
    emitter.event(1.0);
    emitter.event(2.0);
    EXPECT_EQ(first.heard, std::vector<double>{}) << "not before the receiver serves";
    EXPECT_EQ(wakes, 2);
    EXPECT_EQ(told.inbox.run_all(), 2u);
    EXPECT_EQ(first.heard, (std::vector{1.0, 2.0}));
}

TEST_F(AnEvent, loses_and_counts_emissions_above_the_quota_of_the_row) {
    Told told{emitter, first, 2};
    for (double value : {1.0, 2.0, 3.0}) emitter.event(value);
    EXPECT_EQ(told.row.counts().lost, 1u);
    EXPECT_EQ(told.row.counts().high_water, 2u);
    told.inbox.run_all();
    EXPECT_EQ(first.heard, (std::vector{1.0, 2.0}));
    emitter.event(4.0); // served messages free their places
    told.inbox.run_all();
    EXPECT_EQ(first.heard, (std::vector{1.0, 2.0, 4.0}));
    EXPECT_EQ(told.row.counts().lost, 1u);
    EXPECT_EQ(told.row.counts().posted, 3u);
    EXPECT_EQ(told.row.counts().served, 3u);
}

TEST_F(AnEvent, keeps_the_quota_of_a_row_when_another_row_floods) {
    Emitter other;
    Receiver receiver{3}; // two for the one row, one for the other, as the planner sizes it
    Row many{receiver, hear, &first, 2}, one{receiver, hear, &second, 1};
    emitter.tell(many.row);
    other.tell(one.row);
    for (int i = 0; i < 10; ++i) emitter.event(i);
    other.event(99);
    receiver.inbox.run_all();
    EXPECT_EQ(second.heard, (std::vector{99.0}));
    EXPECT_EQ(many.row.counts().lost, 8u);
    EXPECT_EQ(one.row.counts().lost, 0u);
}

/// Arguments of a running operation stay unchanged, whatever arrives meanwhile.
using Large = std::array<double, 9>;
struct Handler {
    Event<Large>& event;
    std::uint32_t more = 0; ///< come while the first one is handled
    std::vector<double> heard{};
    static void run(void* self, const std::byte* packed) noexcept TAPPET_REALTIME {
        auto& handler = *static_cast<Handler*>(self);
        TAPPET_ESCAPE("a test emits and remembers", handler.handle(packed));
    }
    void handle(const std::byte* packed) {
        if (heard.empty())
            for (std::uint32_t i = 0; i < more; ++i) event.emit(of(2.0 + i));
        Large arrived;
        std::memcpy(arrived.data(), packed, sizeof arrived);
        heard.push_back(arrived == of(arrived[0]) ? arrived[0] : -1.0);
    }
    static Large of(double number) {
        Large made;
        for (std::size_t i = 0; i < made.size(); ++i) made[i] = number + static_cast<double>(i) / 16;
        return made;
    }
};

/// The numbers received and lost when 1 is emitted, and `more` further numbers while it is handled.
std::pair<std::vector<double>, std::uint64_t> emitted(std::uint32_t more, std::uint32_t quota,
                                                      bool keeps_latest) {
    EmitterOf<Large> large;
    Handler handler{large.event, more};
    Receiver receiver{quota + 1};
    Row row{receiver, hear, &handler, quota, keeps_latest, sizeof(Large)};
    row.row.operation = nullptr;
    row.row.run = &Handler::run;
    row.row.object = &handler;
    large.tell(row.row);
    large.event(Handler::of(1.0));
    while (receiver.inbox.run_all() != 0) {
    }
    return {handler.heard, row.row.counts().lost};
}

TEST_F(AnEvent, keeps_large_arguments_in_use_while_the_queue_fills) {
    for (const std::uint32_t quota : {1u, 2u, 3u, 4u, 8u}) {
        std::vector<double> all;
        for (std::uint32_t i = 0; i <= quota; ++i) all.push_back(1.0 + i);
        EXPECT_EQ(emitted(quota, quota, false), (std::pair{all, std::uint64_t{0}})) << "queue of " << quota;
    }
}

TEST_F(AnEvent, keeps_the_large_argument_in_use_when_a_newer_one_arrives) {
    EXPECT_EQ(emitted(3, 1, true), (std::pair{std::vector{1.0, 4.0}, std::uint64_t{2}}));
}

TEST_F(AnEvent, delivers_only_the_latest_and_counts_replaced_emissions) {
    Told told{emitter, first, 1, true};
    int wakes = 0;
    told.row.waker = {[](void* count) noexcept TAPPET_REALTIME { ++*static_cast<int*>(count); }, &wakes};
    for (double value : {1.0, 2.0, 3.0}) emitter.event(value);
    EXPECT_EQ(wakes, 1) << "who is told already is not told again";
    told.inbox.run_all();
    EXPECT_EQ(first.heard, (std::vector{3.0}));
    EXPECT_EQ(told.row.counts().lost, 2u);
    emitter.event(4.0);
    told.inbox.run_all();
    EXPECT_EQ(first.heard, (std::vector{3.0, 4.0}));
    EXPECT_EQ(told.row.counts().lost, 2u);
}

TEST_F(AnEvent, runs_no_disconnected_reaction_but_each_reconnected_one) {
    const EventHandle handle = emitter.call(hear, &first);
    EXPECT_TRUE(handle.connected());
    handle.disconnect();
    EXPECT_FALSE(handle.connected());
    emitter.event(1.0);
    handle.connect();
    handle.connect(); // a second call changes nothing
    emitter.event(2.0);
    EXPECT_EQ(first.heard, (std::vector{2.0}));
}

TEST_F(AnEvent, copies_handles_that_control_the_same_row) {
    const EventHandle handle = emitter.call(hear, &first);
    const EventHandle copy = handle;
    copy.disconnect();
    EXPECT_FALSE(handle.connected());
}

TEST_F(AnEvent, drops_and_counts_emissions_queued_before_a_disconnect) {
    Told told{emitter, first, 4};
    emitter.event(1.0);
    emitter.event(2.0);
    told.handle.disconnect();
    told.inbox.run_all();
    EXPECT_EQ(first.heard, std::vector<double>{});
    EXPECT_EQ(told.row.counts().outdated, 2u);
    EXPECT_EQ(told.row.counts().served, 2u) << "their places are free again";
}

TEST_F(AnEvent, drops_emissions_queued_before_a_disconnect_even_after_a_reconnect) {
    for (const bool keeps_latest : {false, true}) {
        Emitter emits;
        Listener listener;
        Told told{emits, listener, keeps_latest ? 1u : 4u, keeps_latest};
        emits.event(1.0);
        told.handle.disconnect();
        told.handle.connect();
        if (!keeps_latest) emits.event(2.0);
        told.inbox.run_all();
        EXPECT_EQ(listener.heard, keeps_latest ? std::vector<double>{} : (std::vector{2.0}));
        EXPECT_EQ(told.row.counts().outdated, 1u);
    }
}

TEST_F(AnEvent, skips_gaps_among_its_rows) {
    const EventHandle one = emitter.call(hear, &first);
    emitter.call(hear, &second).disconnect();
    const EventHandle three = emitter.call(hear, &third);
    EXPECT_TRUE(one.connected() && three.connected());
    emitter.event(1.0);
    EXPECT_EQ(first.heard, (std::vector{1.0}));
    EXPECT_TRUE(second.heard.empty());
    EXPECT_EQ(third.heard, (std::vector{1.0}));
}

TEST_F(AnEvent, lets_a_running_reaction_change_its_rows) {
    enum Change { connect, disconnect };
    static constexpr struct {
        std::size_t who;
        Change does;
        std::size_t to;
        std::size_t times_heard[3]; ///< counts for two emissions
        const char* what;
    } cases[] = {{0, disconnect, 0, {1, 2, 2}, "itself: what stands after it is not skipped"},
                 {0, disconnect, 1, {2, 0, 2}, "a later one: it does not run in the same emission"},
                 {1, disconnect, 0, {1, 2, 2}, "one that ran"},
                 {1, connect, 2, {2, 2, 2}, "a later one: it runs in the same emission, and nothing twice"}};
    for (const auto& each : cases) {
        Emitter emits;
        std::array<Listener, 3> listeners;
        std::array<EventHandle, 3> handles;
        for (std::size_t i = 0; i < 3; ++i) handles[i] = emits.call(hear, &listeners[i]);
        if (each.does == connect) handles[each.to].disconnect();
        listeners[each.who].then = [&] {
            each.does == connect ? handles[each.to].connect() : handles[each.to].disconnect();
        };
        for (const double value : {1.0, 2.0}) emits.event(value);
        for (std::size_t i = 0; i < 3; ++i) {
            std::vector heard{1.0, 2.0};
            heard.resize(each.times_heard[i]);
            EXPECT_EQ(listeners[i].heard, heard) << each.what;
        }
    }
}

TEST_F(AnEvent, lets_reactions_connect_and_disconnect_each_other) {
    Emitter other;
    const EventHandle elsewhere = other.call(hear, &third);
    const EventHandle one = emitter.call(hear, &first);
    const EventHandle two = emitter.call(hear, &second);
    two.disconnect();
    first.then = [&] { one.disconnect(), two.connect(), elsewhere.disconnect(); };
    second.then = [&] { two.disconnect(), one.connect(), elsewhere.connect(); };
    for (double value : {1.0, 2.0}) {
        emitter.event(value); // the first connects the second, which runs in the same emission
        other.event(value);
    }
    EXPECT_EQ(first.heard, (std::vector{1.0, 2.0}));
    EXPECT_EQ(second.heard, (std::vector{1.0, 2.0}));
    EXPECT_EQ(third.heard, (std::vector{1.0, 2.0}));
}

TEST_F(AnEvent, can_be_disconnected_with_emissions_pending_in_the_receiver) {
    Told told{emitter, first, 4};
    first.then = [&] { told.handle.disconnect(); };
    for (double value : {1.0, 2.0, 3.0}) emitter.event(value);
    told.inbox.run_all();
    EXPECT_EQ(first.heard, (std::vector{1.0}));
    EXPECT_EQ(told.row.counts().outdated, 2u);
}

TEST_F(AnEvent, can_be_emitted_by_its_own_reaction) {
    emitter.call(hear, &first);
    first.then = [&] {
        if (first.heard.size() < 3) emitter.event(first.heard.back() + 1);
    };
    emitter.event(1.0);
    EXPECT_EQ(first.heard, (std::vector{1.0, 2.0, 3.0}));
}

TEST_F(AnEvent, gives_each_emitting_activity_its_own_quota_and_order) {
    Receiver receiver{2, 2};
    Row row{receiver, hear, &first, 2};
    emitter.tell(row.row);
    for (double value : {1.0, 2.0, 3.0}) emitter.event(value);
    {
        const RunsActivity there{1};
        for (double value : {10.0, 20.0}) emitter.event(value);
    }
    receiver.inbox.run_all();
    EXPECT_EQ(first.heard, (std::vector{1.0, 2.0, 10.0, 20.0}));
    EXPECT_EQ(row.row.counts().lost, 1u);
    EXPECT_EQ(row.row.counts().posted, 4u);
}

TEST_F(AnEvent, counts_emissions_of_an_activity_without_a_row_as_stray) {
    Told told{emitter, first, 2};
    emitter.call(hear, &second);
    for (const std::uint32_t activity : {1u, no_activity}) {
        const RunsActivity there{activity};
        emitter.event(1.0);
    }
    told.inbox.run_all();
    EXPECT_EQ(first.heard, std::vector<double>{});
    EXPECT_EQ(told.row.counts().stray, 2u);
    EXPECT_EQ(told.row.counts().lost, 2u);
    EXPECT_EQ(second.heard, (std::vector{1.0, 1.0})) << "what runs in the emitter needs no lane";
}

TEST_F(AnEvent, runs_no_reaction_of_a_component_that_is_not_running) {
    Told told{emitter, first, 2};
    told.gate.state.store(ComponentState::stopped);
    emitter.event(1.0);
    told.inbox.run_all();
    EXPECT_EQ(told.row.counts().dropped, 1u);
    told.gate.state.store(ComponentState::running);
    emitter.event(2.0);
    told.inbox.run_all();
    EXPECT_EQ(first.heard, (std::vector{2.0}));
}

TEST_F(AnEvent, stays_connected_while_a_scoped_handle_exists) {
    const EventHandle handle = emitter.call(hear, &first);
    handle.disconnect();
    {
        ScopedEventHandle scope{handle};
        EXPECT_TRUE(scope.connected());
        emitter.event(1.0);
        ScopedEventHandle moved{std::move(scope)};
        emitter.event(2.0);
        EXPECT_TRUE(handle.connected());
        ScopedEventHandle none;
        none = std::move(moved);
        EXPECT_TRUE(handle.connected());
        none = ScopedEventHandle{};
        EXPECT_FALSE(handle.connected()) << "it was given up for another";
        none = ScopedEventHandle{handle};
    }
    emitter.event(3.0);
    EXPECT_FALSE(handle.connected());
    EXPECT_EQ(first.heard, (std::vector{1.0, 2.0}));
}

TEST_F(AnEvent, has_handles_that_do_nothing_without_a_row) {
    const EventHandle handle;
    handle.connect();
    handle.disconnect();
    EXPECT_FALSE(handle.connected());
    EXPECT_FALSE(handle.valid());
}

} // namespace
