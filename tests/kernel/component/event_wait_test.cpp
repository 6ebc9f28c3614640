// Waiting for an event (thesis 4.6.1): an activity blocks until it comes or a time is over, and is still
// there for whatever else wants it.
#include "tests/kernel/component/event_rig.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace {

using namespace tappet;

/// A wait of one number with room for four emissions; the waiter stands for its activity's.
struct AWait : testing::Test {
    AWait() {
        row.row.run = &EventWaitState::receive;
        row.row.object = &wait;
        row.row.waker = {&EventWaitState::wake, static_cast<EventWaitState*>(&wait)};
        row.row.inbox = &wait.inbox();
        wait.place({&os::Waiter::wake_thunk, &waiter}, clock, receiver.mailboxes, 4);
        handle = emitter.tell(row.row);
    }
    void emit(double number) {
        const RunsActivity here{0};
        emitter.event(number);
    }
    template <class F>
    static Duration time_of(F&& what) {
        const Time begin = os::Clock::monotonic();
        what();
        return os::Clock::monotonic() - begin;
    }

    static constexpr OperationOperations nothing{};
    os::Clock clock{os::Clock::Kind::real};
    os::Waiter waiter;
    EventWait<double> wait;
    Receiver receiver{4};
    Row row{receiver, nothing, nullptr, 4};
    Emitter emitter;
    EventHandle handle;
    double value = 0;
};

TEST_F(AWait, is_over_when_its_time_is) {
    bool came = true;
    const Duration took = time_of([&] { came = wait.wait(20ms, value); });
    EXPECT_FALSE(came);
    EXPECT_GE(took, 20ms);
    EXPECT_FALSE(waiter.is_woken()) << "nobody wanted the activity";
}

TEST_F(AWait, is_over_at_once_for_what_came_before_and_takes_one_emission_at_a_time) {
    emit(1.0);
    emit(2.0);
    EXPECT_TRUE(wait.wait(10s, value));
    EXPECT_EQ(value, 1.0);
    EXPECT_TRUE(wait.wait(10s, value));
    EXPECT_EQ(value, 2.0);
}

TEST_F(AWait, is_over_when_the_event_comes) {
    std::thread other{[this] {
        std::this_thread::sleep_for(20ms);
        emit(3.0);
    }};
    bool came = false;
    const Duration took = time_of([&] { came = wait.wait(60s, value); });
    other.join();
    EXPECT_TRUE(came);
    EXPECT_EQ(value, 3.0);
    EXPECT_LT(took, 30s);
}

TEST_F(AWait, sleeps_on_although_an_emission_that_was_taken_had_come_before) {
    emit(1.0);
    ASSERT_TRUE(wait.take(value));
    bool came = true;
    const Duration took = time_of([&] { came = wait.wait(20ms, value); });
    EXPECT_FALSE(came);
    EXPECT_GE(took, 20ms);
}

TEST_F(AWait, may_be_interrupted_while_it_lasts_and_just_before) {
    std::thread other{[this] {
        std::this_thread::sleep_for(20ms);
        wait.interrupt();
    }};
    bool came = true;
    EXPECT_LT(time_of([&] { came = wait.wait(60s, value); }), 30s);
    other.join();
    EXPECT_FALSE(came);
    wait.interrupt();
    EXPECT_LT(time_of([&] { came = wait.wait(60s, value); }), 30s);
    EXPECT_FALSE(came);
    EXPECT_GE(time_of([&] { came = wait.wait(20ms, value); }), 20ms) << "one interrupt ends one wait";
}

TEST_F(AWait, wakes_its_activity_for_an_emission_that_nobody_waits_for) {
    emit(1.0);
    EXPECT_TRUE(waiter.is_woken());
}

TEST_F(AWait, hears_nothing_of_an_event_from_which_it_was_disconnected) {
    emit(1.0);
    handle.disconnect();
    emit(2.0);
    EXPECT_FALSE(wait.take(value));
    handle.connect();
    emit(3.0);
    EXPECT_TRUE(wait.take(value));
    EXPECT_EQ(value, 3.0);
    EXPECT_EQ(row.row.counts().outdated, 1u);
}

TEST_F(AWait, counts_what_nobody_took_in_time) {
    for (double each : {1.0, 2.0, 3.0, 4.0, 5.0}) emit(each);
    for (double each : {1.0, 2.0, 3.0, 4.0}) {
        ASSERT_TRUE(wait.take(value));
        EXPECT_EQ(value, each);
    }
    EXPECT_FALSE(wait.take(value));
    EXPECT_EQ(row.row.counts().lost, 1u);
}

TEST_F(AWait, sleeps_through_no_emission_whenever_it_comes) {
    std::atomic<int> taken{0};
    constexpr int all = 2000;
    std::thread other{[&] {
        for (int i = 0; i < all; ++i) {
            emit(i);
            while (taken.load() <= i) std::this_thread::yield(); // one is under way at a time
        }
    }};
    int wrong = 0;
    for (int i = 0; i < all; ++i) {
        wrong += wait.wait(20s, value) && value == i ? 0 : 1;
        taken.store(i + 1);
    }
    other.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(row.row.counts().lost, 0u);
}

TEST(AWaitThatNoRowTells, is_over_at_once) {
    EventWait<double, int> wait;
    double value = 0;
    int number = 0;
    EXPECT_FALSE(wait.wait(10s, value, number));
    EXPECT_FALSE(wait.take(value, number));
}

} // namespace
