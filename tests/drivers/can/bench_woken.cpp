// When the real SocketCAN device wakes its waiter on the bench, and what it knows of its frames when it is
// served late.
#include "kernel/base/random.hpp"
#include "tests/drivers/can/bench_bus.hpp"

#include <string>

namespace tappet::can {
namespace {

struct WakingCan : RealCan {
    os::Waiter waiter;
    void open() {
        RealCan::open();
        ASSERT_TRUE(can.wakes(waiter));
        can.service(now());
    }
    bool is_woken_within(Duration time) { return waiter.wait(now() + time); }
};

TEST_F(WakingCan, checks_an_unawaited_confirmation_in_time_without_waking) {
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

TEST_F(WakingCan, wakes_for_each_confirmation_on_request) {
    can.wake_when_confirmed();
    open();
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    can.service(now());
    EXPECT_TRUE(is_woken_within(1s));
    can.service(now());
    EXPECT_EQ(can.counters().sent, 1u);
    EXPECT_FALSE(is_woken_within(10ms));
}

TEST_F(WakingCan, wakes_for_a_confirmation_that_frees_room) {
    settings.in_flight = 1;
    open();
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    can.service(now());
    EXPECT_TRUE(is_woken_within(1s));
}

TEST_F(WakingCan, wakes_once_for_an_impostor) {
    open();
    ASSERT_EQ(run_foreign("cansend can0 201#11"), 0);
    EXPECT_TRUE(is_woken_within(1s));
    Frame f;
    EXPECT_EQ(can.receive(f).what, Received::none);
    can.service(now());
    EXPECT_EQ(can.counters().impostors, 1u);
    EXPECT_FALSE(is_woken_within(10ms));
}

/// Time from `since` until the last frame with this identifier was confirmed.
Duration through_after(SocketCan& can, std::uint32_t id, Time since) {
    return can.last_confirmed(standard(id)).at - since;
}

TEST_F(WakingCan, keeps_confirmation_times_though_they_are_read_later) {
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

TEST_F(WakingCan, stamps_confirmations_correctly_after_a_late_service) {
    open();
    const Dump dump;
    EXPECT_EQ(can.send(frame(0x201)), Send::queued);
    can.service(now());
    EXPECT_EQ(can.send(frame(0x202)), Send::queued);
    std::this_thread::sleep_for(60ms); // it was delayed, and the confirmation is overdue
    EXPECT_EQ(can.send(frame(0x203)), Send::queued);
    can.service(now());
    EXPECT_EQ(can.state(), State::active) << "all was acknowledged at once";
    EXPECT_TRUE(can.finish(now()));
    EXPECT_EQ(can.send(frame(0x204), Keep::last), Send::queued);
    EXPECT_TRUE(can.finish(now()));
    EXPECT_TRUE(dump.says("204#ABCD")) << "its last word";
    EXPECT_EQ(dump.output().find("202#ABCD"), std::string::npos) << "60 ms old";
}

TEST_F(WakingCan, stays_active_with_a_period_equal_to_the_confirmation_time_out) {
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

TEST_F(WakingCan, finds_a_confirmation_behind_many_impostors) {
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

TEST_F(WakingCan, stays_active_when_impostors_fill_a_whole_service_call) {
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

TEST_F(WakingCan, drops_all_frames_that_arrived_while_stopped) {
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

TEST_F(WakingCan, still_confirms_frames_after_foreign_use_of_its_identifiers) {
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

TEST_F(WakingCan, drops_frames_that_arrived_after_the_interface_was_down) {
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

TEST_F(WakingCan, requests_no_service_while_it_is_faulted) {
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

TEST_F(WakingCan, keeps_the_bus_state_when_arrivals_are_dropped) {
    open();
    ASSERT_EQ(run_foreign("cansend can0 123#01"), 0);
    ASSERT_EQ(run_foreign("cansend can0 20000004#0010000000000000"), 0);
    Frame f;
    EXPECT_EQ(can.receive(f).what, Received::frame) << "and the other one was read with it";
    can.drop_arrivals();
    EXPECT_EQ(can.state(), State::passive);
}

TEST_F(WakingCan, wakes_until_every_arrival_is_read) {
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
