// Waiting for an event (thesis 4.6.1): an activity blocks until the event or a time-out, and still serves
// everything else.
#include "tests/kernel/component/event_rig.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace {

using namespace tappet;

/// A wait for one number with room for four emissions; the waiter replaces that of its activity.
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

TEST_F(AWait, ends_at_its_time_out) {
    bool came = true;
    const Duration took = time_of([&] { came = wait.wait(20ms, value); });
    EXPECT_FALSE(came);
    EXPECT_GE(took, 20ms);
    EXPECT_FALSE(waiter.is_woken()) << "nobody wanted the activity";
}

TEST_F(AWait, ends_at_once_for_each_earlier_emission) {
    emit(1.0);
    emit(2.0);
    EXPECT_TRUE(wait.wait(10s, value));
    EXPECT_EQ(value, 1.0);
    EXPECT_TRUE(wait.wait(10s, value));
    EXPECT_EQ(value, 2.0);
}

TEST_F(AWait, ends_when_the_event_is_emitted) {
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

TEST_F(AWait, sleeps_again_after_the_earlier_emission_was_accepted) {
    emit(1.0);
    ASSERT_TRUE(wait.take(value));
    bool came = true;
    const Duration took = time_of([&] { came = wait.wait(20ms, value); });
    EXPECT_FALSE(came);
    EXPECT_GE(took, 20ms);
}

TEST_F(AWait, can_be_interrupted_during_and_just_before_it) {
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

TEST_F(AWait, wakes_its_activity_when_an_emission_arrives_outside_a_wait) {
    emit(1.0);
    EXPECT_TRUE(waiter.is_woken());
}

TEST_F(AWait, ignores_an_event_after_its_disconnection) {
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

TEST_F(AWait, counts_emissions_that_no_wait_accepted_in_time) {
    for (double each : {1.0, 2.0, 3.0, 4.0, 5.0}) emit(each);
    for (double each : {1.0, 2.0, 3.0, 4.0}) {
        ASSERT_TRUE(wait.take(value));
        EXPECT_EQ(value, each);
    }
    EXPECT_FALSE(wait.take(value));
    EXPECT_EQ(row.row.counts().lost, 1u);
}

TEST_F(AWait, misses_no_emission_whenever_it_comes) {
    std::atomic<int> taken{0};
    constexpr int all = 2000;
    std::thread other{[&] {
        for (int i = 0; i < all; ++i) {
            emit(i);
            while (taken.load() <= i) std::this_thread::yield(); // one is running at a time
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

TEST(AWaitThatNoRowTells, ends_at_once_without_a_value) {
    EventWait<double, int> wait;
    double value = 0;
    int number = 0;
    EXPECT_FALSE(wait.wait(10s, value, number));
    EXPECT_FALSE(wait.take(value, number));
}

} // namespace
