// Whom the real SocketCAN device wakes on the bench, and what it knows of what it sent when it looks later.
#include "kernel/base/random.hpp"
#include "tests/drivers/can/bench_bus.hpp"

#include <string>

namespace tappet::can {
namespace {

struct WokenByCan : RealCan {
    os::Waiter waiter;
    void open() {
        RealCan::open();
        ASSERT_TRUE(can.wakes(waiter));
        can.service(now());
    }
    bool is_woken_within(Duration time) { return waiter.wait(now() + time); }
};

TEST_F(WokenByCan, by_no_confirmation_that_nobody_waits_for_and_looks_for_it_before_it_is_late) {
    open();
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    can.service(now());
    EXPECT_FALSE(is_woken_within(20ms));
    EXPECT_EQ(can.counters().sent, 0u) << "it is told with what comes next";
    const Time due = can.next_service();
    ASSERT_NE(due, never);
    EXPECT_FALSE(waiter.wait(due));
    can.service(now());
    EXPECT_EQ(can.counters().sent, 1u);
    EXPECT_EQ(can.state(), State::active);
    EXPECT_EQ(can.next_service(), never);
    EXPECT_LT(can.longest_response(standard(0x201)), 10ms) << "by the kernel's time, whenever it is read";
}

TEST_F(WokenByCan, by_each_confirmation_if_somebody_asked) {
    can.wake_when_confirmed();
    open();
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    can.service(now());
    EXPECT_TRUE(is_woken_within(1s));
    can.service(now());
    EXPECT_EQ(can.counters().sent, 1u);
    EXPECT_FALSE(is_woken_within(10ms));
}

TEST_F(WokenByCan, by_a_confirmation_that_makes_room) {
    settings.in_flight = 1;
    open();
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    can.service(now());
    EXPECT_TRUE(is_woken_within(1s));
}

TEST_F(WokenByCan, once_by_an_impostor) {
    open();
    ASSERT_EQ(run_foreign("cansend can0 201#11"), 0);
    EXPECT_TRUE(is_woken_within(1s));
    Frame f;
    EXPECT_EQ(can.receive(f).what, Received::none);
    can.service(now());
    EXPECT_EQ(can.counters().impostors, 1u);
    EXPECT_FALSE(is_woken_within(10ms));
}

/// How long after `since` the last frame with this identifier was confirmed.
Duration through_after(SocketCan& can, std::uint32_t id, Time since) {
    return can.last_confirmed(standard(id)).at - since;
}

TEST_F(WokenByCan, in_the_order_of_times_though_what_was_sent_is_read_later) {
    open();
    const Time before = now();
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    can.service(now());
    std::this_thread::sleep_for(20ms);
    for (int n = 0; n < 2; ++n) ASSERT_EQ(run_foreign("cansend can0 123#00"), 0);
    const Time both_are_there = now();
    std::this_thread::sleep_for(20ms);
    Frame f;
    ASSERT_EQ(can.receive(f).what, Received::frame);
    EXPECT_EQ(can.send(frame(0x202)), Send::queued);
    can.service(now());
    EXPECT_GE(can.counters().sent, 1u);
    EXPECT_LT(through_after(can, 0x201, before), 10ms) << "not when the later frame arrived";
    ASSERT_EQ(can.receive(f).what, Received::frame);
    EXPECT_LE(f.stamp, both_are_there) << "not when the later one was through";
}

TEST_F(WokenByCan, late_and_what_it_sends_then_has_the_time_of_then) {
    open();
    const Dump dump;
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    can.service(now());
    EXPECT_EQ(can.send(frame(0x202)), Send::queued);
    std::this_thread::sleep_for(60ms); // it was held up, and the confirmation is overdue
    EXPECT_EQ(can.send(frame(0x203)), Send::queued);
    can.service(now());
    EXPECT_EQ(can.state(), State::active) << "all was acknowledged at once";
    EXPECT_TRUE(can.finish(now()));
    EXPECT_EQ(can.send(frame(0x204), Keep::last), Send::queued);
    EXPECT_TRUE(can.finish(now()));
    EXPECT_TRUE(dump.says("204#ABCD")) << "its last word";
    EXPECT_EQ(dump.output().find("202#ABCD"), std::string::npos) << "60 ms old";
}

TEST_F(WokenByCan, by_a_period_as_long_as_a_confirmation_may_take) {
    open();
    Random random{1};
    Time due = now() + 50ms;
    for (int sent = 0; sent < 12;) {
        static_cast<void>(waiter.wait(std::min(due, can.next_service())));
        std::this_thread::sleep_for(Duration{static_cast<std::int64_t>(random.below(300'000))});
        const Time at = now();
        if (due <= at) {
            ASSERT_EQ(can.send(frame(0x201, at)), Send::queued);
            due += 50ms;
            ++sent;
        }
        can.service(at);
        ASSERT_EQ(can.state(), State::active) << sent;
    }
}

TEST_F(WokenByCan, by_impostors_until_all_are_read_and_finds_its_confirmation_behind_them) {
    open();
    ASSERT_EQ(run_foreign("cangen can0 -g 0 -n 100 -I 201 -L 8"), 0);
    EXPECT_EQ(can.send(frame(0x202)), Send::queued);
    Frame f;
    for (const Time end = now() + 150ms; now() < end;) {
        static_cast<void>(can.receive(f));
        can.service(now());
        static_cast<void>(waiter.wait(std::min(end, can.next_service())));
    }
    EXPECT_EQ(can.state(), State::active);
    EXPECT_EQ(can.counters().sent, 1u);
    EXPECT_EQ(can.counters().impostors, 100u);
}

TEST_F(WokenByCan, late_twice_by_a_number_of_impostors_that_ends_a_look_on_the_last_one) {
    for (const int impostors : {7, 8, 11, 14, 15}) {
        ASSERT_TRUE(can.open(settings));
        ASSERT_EQ(run_foreign("cangen can0 -g 0 -I 201 -L 8 -n " + std::to_string(impostors)), 0);
        for (const std::uint32_t id : {0x202u, 0x203u}) {
            EXPECT_EQ(can.send(frame(id)), Send::queued);
            can.service(now());
            std::this_thread::sleep_for(60ms);
        }
        can.service(now());
        EXPECT_EQ(can.state(), State::active) << impostors;
        EXPECT_EQ(can.counters().sent, 2u) << impostors;
    }
}

TEST_F(WokenByCan, by_nothing_that_arrived_while_it_stood) {
    open();
    ASSERT_EQ(run_foreign("cansend can0 123#01"), 0);
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    EXPECT_TRUE(can.finish(now()));
    ASSERT_EQ(run_foreign("cangen can0 -g 0 -n 40 -I 123 -L 8"), 0);
    can.purge();
    can.drop_arrivals();
    Frame f;
    EXPECT_EQ(can.receive(f).what, Received::none);
}

TEST_F(WokenByCan, by_confirmations_though_others_sent_our_identifiers_while_it_stood) {
    open();
    EXPECT_TRUE(can.finish(now()));
    ASSERT_EQ(run_foreign("cangen can0 -g 0 -I 201 -L 8 -n 4000"), 0);
    can.purge();
    can.drop_arrivals();
    EXPECT_EQ(can.send(frame(0x202)), Send::queued);
    for (int n = 0; n < 8; ++n) {
        can.service(now());
        std::this_thread::sleep_for(10ms);
    }
    EXPECT_EQ(can.state(), State::active);
    EXPECT_EQ(can.counters().sent, 1u);
}

TEST_F(WokenByCan, by_nothing_that_came_behind_the_word_that_the_interface_was_down) {
    open();
    EXPECT_TRUE(can.finish(now()));
    set_up(false);
    set_up(true);
    ASSERT_EQ(run_foreign("cangen can0 -g 0 -n 40 -I 123 -L 8"), 0);
    can.purge();
    can.drop_arrivals();
    Frame f;
    EXPECT_EQ(can.receive(f).what, Received::none);
}

TEST_F(WokenByCan, by_nothing_of_its_own_while_it_is_faulted) {
    open();
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    can.service(now());
    ASSERT_NE(can.next_service(), never);
    set_up(false);
    Frame f;
    EXPECT_EQ(can.receive(f).what, Received::none);
    can.service(now());
    EXPECT_EQ(can.state(), State::down);
    EXPECT_EQ(can.next_service(), never);
    set_up(true);
}

TEST_F(WokenByCan, by_what_is_said_of_the_bus_though_the_rest_of_it_is_forgotten) {
    open();
    ASSERT_EQ(run_foreign("cansend can0 123#01"), 0);
    ASSERT_EQ(run_foreign("cansend can0 20000004#0010000000000000"), 0);
    Frame f;
    EXPECT_EQ(can.receive(f).what, Received::frame) << "and the other one was read with it";
    can.drop_arrivals();
    EXPECT_EQ(can.state(), State::passive);
}

TEST_F(WokenByCan, again_until_all_that_arrived_is_taken) {
    open();
    ASSERT_EQ(run_foreign("cangen can0 -g 0 -n 40 -I 123 -L 8"), 0);
    std::size_t got = 0, wakes = 0;
    for (Frame f; is_woken_within(10ms); can.service(now()), ++wakes)
        while (can.receive(f).what == Received::frame) ++got;
    EXPECT_EQ(got, 40u);
    EXPECT_LE(wakes, 2u) << "all of them at once";
}

} // namespace
} // namespace tappet::can
