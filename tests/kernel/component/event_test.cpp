// Events: reactions here and now, and reactions posted to another engine within their quota.
#include "kernel/component/component.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

namespace {

using namespace tappet;

/// Records what it was told, in order.
struct Listener {
    std::vector<double> heard;
    void hear(double value) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test remembers", heard.push_back(value));
    }
};
inline constexpr const OperationOperations& hear = detail::operation_of<&Listener::hear>;

/// An event with its subscribers in place, as start-up gives them.
struct Emitter {
    static constexpr const EventOperations& operations = PortAccess::event<double>;
    Event<double> event;
    std::array<Subscriber<double>, 4> subscribers{};
    Emitter() { operations.give_storage(&event, subscribers.data()); }
    void call(Listener& listener) { operations.subscribe(&event, hear.call, &listener); }
    void tell(AsyncReaction& row) { operations.subscribe(&event, operations.post, &row); }
};

/// The receiving end: an inbox with room for `capacity` messages of one sender.
struct Receiver {
    explicit Receiver(std::size_t capacity) : storage(Mailbox::bytes_for(capacity) + Mailbox::alignment) {
        void* at = storage.data();
        std::size_t room = storage.size();
        std::align(Mailbox::alignment, Mailbox::bytes_for(capacity), at, room);
        mailboxes[0].place(static_cast<std::byte*>(at), capacity, Overflow::reject);
        inbox.place(mailboxes);
    }
    AsyncReaction& row(AsyncReaction& row, Listener& listener, std::uint32_t quota) {
        row.inbox = &inbox;
        row.run = hear.run;
        row.object = &listener;
        row.quota = quota;
        return row;
    }
    std::vector<std::byte> storage;
    std::array<Mailbox, 1> mailboxes;
    Inbox inbox;
};

TEST(Event, without_subscribers_is_emitted_into_nothing) {
    Event<double> event;
    event.emit(1.0);
    event(2.0);
}

TEST(Event, calls_its_synchronous_reactions_at_once_in_the_order_of_their_rows) {
    Emitter emitter;
    Listener first, second;
    emitter.call(first);
    emitter.call(second);
    emitter.event(1.5);
    EXPECT_EQ(first.heard, (std::vector{1.5}));
    EXPECT_EQ(second.heard, (std::vector{1.5}));
}

TEST(Event, posts_its_asynchronous_reactions_and_wakes_the_receiver) {
    Emitter emitter;
    Listener listener;
    Receiver receiver{4};
    AsyncReaction row;
    int wakes = 0;
    row.waker = {[](void* count) noexcept TAPPET_REALTIME { ++*static_cast<int*>(count); }, &wakes};
    emitter.tell(receiver.row(row, listener, 4));
    emitter.event(1.0);
    emitter.event(2.0);
    EXPECT_EQ(listener.heard, std::vector<double>{}) << "not before the receiver serves";
    EXPECT_EQ(wakes, 2);
    EXPECT_EQ(receiver.inbox.run_all(), 2u);
    EXPECT_EQ(listener.heard, (std::vector{1.0, 2.0}));
}

TEST(Event, loses_and_counts_what_exceeds_the_quota_of_the_row) {
    Emitter emitter;
    Listener listener;
    Receiver receiver{8};
    AsyncReaction row;
    emitter.tell(receiver.row(row, listener, 2));
    for (double value : {1.0, 2.0, 3.0}) emitter.event(value);
    EXPECT_EQ(row.lost, 1u);
    EXPECT_EQ(row.high_water, 2u);
    receiver.inbox.run_all();
    EXPECT_EQ(listener.heard, (std::vector{1.0, 2.0}));
    emitter.event(4.0); // served messages give their place back
    receiver.inbox.run_all();
    EXPECT_EQ(listener.heard, (std::vector{1.0, 2.0, 4.0}));
    EXPECT_EQ(row.lost, 1u);
    EXPECT_EQ(row.posted, 3u);
}

TEST(Event, lets_one_rows_flood_not_take_another_rows_place) {
    Emitter flood, other;
    Listener flooded, heard;
    Receiver receiver{3}; // two for the one row, one for the other, as the planner sizes it
    AsyncReaction many, one;
    flood.tell(receiver.row(many, flooded, 2));
    other.tell(receiver.row(one, heard, 1));
    for (int i = 0; i < 10; ++i) flood.event(i);
    other.event(99);
    receiver.inbox.run_all();
    EXPECT_EQ(heard.heard, (std::vector{99.0}));
    EXPECT_EQ(many.lost, 8u);
    EXPECT_EQ(one.lost, 0u);
}

} // namespace
