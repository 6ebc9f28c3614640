// The CAN bus as a component: which frames leave and when, and which must never leave.
#include "tests/drivers/components/can_machine.hpp"

#include <limits>

namespace tappet::test {
namespace {

using CanBus = CanMachine;

std::int64_t controlword(const can::Frame& frame) { return frame.data[0] | frame.data[1] << 8; }
double target_rpm(const can::Frame& frame) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(frame.data[2]) |
                                     static_cast<std::uint32_t>(frame.data[3]) << 8 |
                                     static_cast<std::uint32_t>(frame.data[4]) << 16 |
                                     static_cast<std::uint32_t>(frame.data[5]) << 24) /
           10.0;
}

TEST_F(CanBus, stamps_values_with_the_time_of_their_frame) {
    run_until(10ms);
    send(0x181, 6, {0x27, 0x02, 0x2e, 0xfb, 0xff, 0xff}); // -1234 tenths
    run_until(12ms);
    EXPECT_EQ(master->statusword.get(), 0x227);
    EXPECT_EQ(master->velocity.get(), -1234 * 0.1);
    EXPECT_EQ(master->statusword.stamp(), Time{10ms} + tick);
    EXPECT_EQ(master->velocity.stamp(), Time{10ms} + tick);
    EXPECT_EQ(master->frames, 1);
}

TEST_F(CanBus, sends_cyclic_frames_at_exact_periods) {
    run_until(4s);
    const auto sent = heard_of(0x201);
    ASSERT_GT(sent.size(), 1990u);
    for (std::size_t i = 0; i < sent.size(); ++i)
        ASSERT_EQ(sent[i].stamp, Time{2ms} + 2ms * static_cast<std::int64_t>(i));
    EXPECT_EQ(controlword(sent.back()), 1);
    EXPECT_EQ(target_rpm(sent.back()), 100.0);
}

TEST_F(CanBus, keeps_its_grid_after_a_late_cycle) {
    run_until(20ms);
    master->overrun = 5500us;
    run_until(40ms);
    int late = 0;
    for (const auto& frame : heard_of(0x201)) late += to_ns(frame.stamp) % 2'000'000 != 0;
    EXPECT_EQ(late, 1) << "the one that the overrun held up";
    EXPECT_EQ(heard_of(0x201).back().stamp, Time{40ms} - 2ms);
}

TEST_F(CanBus, sends_each_demand_once_and_in_order) {
    run_until(10ms);
    for (std::int64_t node = 1; node <= 6; ++node) demand(1, node);
    run_until(200ms);
    const auto sent = heard_of(0x000);
    ASSERT_EQ(sent.size(), 6u);
    for (std::size_t i = 0; i < sent.size(); ++i) {
        EXPECT_EQ(sent[i].data[0], 1);
        EXPECT_EQ(sent[i].data[1], i + 1);
        EXPECT_EQ(sent[i].stamp, Time{11ms} + 1ms * static_cast<std::int64_t>(i))
            << "in the cycle that wrote it";
    }
}

TEST_F(CanBus, sends_the_same_demand_again_when_it_is_written_again) {
    run_until(10ms);
    demand(1, 3);
    demand(1, 3);
    run_until(20ms);
    EXPECT_EQ(heard_of(0x000).size(), 2u);
}

TEST_F(CanBus, counts_demands_that_exceed_the_rate_of_its_map) {
    demand(1, 1);
    run_until(20ms);
    demand(1, 2);
    run_until(40ms);
    EXPECT_EQ(bus->sent_too_often.last(), 0);
    demand(1, 3);
    demand(1, 4); // in its writer's next cycle
    run_until(60ms);
    EXPECT_EQ(heard_of(0x000).size(), 4u) << "it goes out all the same";
    EXPECT_EQ(bus->sent_too_often.last(), 1);
}

TEST_F(CanBus, records_the_longest_response_of_its_sent_frames) {
    run_until(40ms);
    EXPECT_EQ(bus->longest_response("drive_command"), Duration{}) << "the wire of this machine takes no time";
    wire.set_bit_rates({125'000, 0});
    run_until(80ms);
    EXPECT_GE(bus->longest_response("drive_command"), 115 * 8us) << "6 bytes, 115 bits";
    EXPECT_EQ(bus->longest_response("nmt"), Duration{}) << "nobody demanded it";
}

TEST_F(CanBus, does_not_mix_signals_of_two_commands) {
    run_until(10ms);
    demand(1, 3);
    run_until(20ms);
    EXPECT_TRUE(master->commands_alone.push(
        2)); // its node follows in the next cycle, as if the writer was interrupted
    run_until(30ms);
    EXPECT_EQ(heard_of(0x000).size(), 1u);
    demand(2, 4);
    run_until(40ms);
    const auto sent = heard_of(0x000);
    ASSERT_EQ(sent.size(), 2u);
    EXPECT_EQ(sent[1].data[0], 2);
    EXPECT_EQ(sent[1].data[1], 4);
}

TEST_F(CanBus, repeats_the_last_values_when_a_writer_was_interrupted_halfway) {
    run_until(10500us);
    master->word = 5;
    master->writes_target = false; // from 11 ms on only one of the two is new
    run_until(15ms);
    const auto sent = heard_of(0x201);
    ASSERT_EQ(sent.back().stamp, Time{14ms});
    EXPECT_EQ(controlword(sent[sent.size() - 2]), 1) << "at 12 ms: as at 10 ms";
    EXPECT_EQ(controlword(sent.back()), 5) << "at 14 ms: it is how this writer writes";
}

TEST_F(CanBus, holds_a_frame_back_until_all_its_signals_were_written) {
    master->writes_target = false;
    run_until(20ms);
    EXPECT_TRUE(heard.empty());
    master->writes_target = true;
    run_until(40ms);
    EXPECT_EQ(heard_of(0x201).front().stamp, Time{22ms});
    EXPECT_TRUE(heard_of(0x000).empty()) << "nobody demanded anything";
}

TEST_F(CanBus, holds_a_stale_frame_back_and_resumes_on_its_grid) {
    run_until(20ms);
    master->writes_controlword = false; // written last at 20 ms, good for 10 ms
    run_until(60ms);
    EXPECT_EQ(heard_of(0x201).back().stamp, Time{30ms});
    master->writes_controlword = true;
    run_until(70ms);
    const auto sent = heard_of(0x201);
    const auto resumed =
        std::find_if(sent.begin(), sent.end(), [](const auto& f) { return f.stamp > Time{30ms}; });
    ASSERT_NE(resumed, sent.end());
    EXPECT_EQ(resumed->stamp, Time{62ms});
}

TEST_F(CanBus, sends_the_substitute_of_its_row_for_a_stale_value) {
    run_until(20ms);
    const can::Frame before = heard_of(0x201).back();
    master->writes_target = false; // written last at 20 ms, good for 10 ms
    run_until(60ms);
    const can::Frame last = heard_of(0x201).back();
    EXPECT_GT(last.stamp, Time{50ms});
    const can::Signal& velocity = signals.signals[signals.signal("drive_command.velocity")];
    EXPECT_NE(can::extract(before.data, velocity), 0u);
    EXPECT_EQ(can::extract(last.data, velocity), 0u);
}

TEST_F(CanBus, ignores_received_values_that_are_not_finite) {
    const auto& force = bus->physical_out[signals.signals.size() - 1];
    run_until(10ms);
    send(0x182, 4, {0x00, 0x00, 0x20, 0x40});
    run_until(20ms);
    EXPECT_EQ(force.last(), 2.5);
    send(0x182, 4, {0x00, 0x00, 0xc0, 0x7f});
    run_until(30ms);
    send(0x182, 4, {0x00, 0x00, 0x80, 0xff}); // less than any number
    run_until(40ms);
    EXPECT_EQ(force.last(), 2.5) << "and it grows stale";
    EXPECT_EQ(bus->no_numbers.last(), 2);
    instance.each_unsent([](std::string_view component, const Facet& row, const Unsent& each) {
        EXPECT_EQ(component, "can");
        EXPECT_EQ(row.name, "cell.force");
        EXPECT_EQ(row.kind, FacetKind::output);
        EXPECT_EQ(each.no_number, 2u);
        EXPECT_EQ(each.clamped, 0u);
    });
    EXPECT_EQ(can::Bus<signals>::unsent(bus, signals.signals.size() - 1).no_number, 2u);
}

TEST_F(CanBus, sends_no_frame_while_its_value_is_nan) {
    run_until(20ms);
    master->rpm = std::numeric_limits<double>::quiet_NaN();
    run_until(40ms);
    EXPECT_LE(heard_of(0x201).back().stamp, Time{22ms});
    EXPECT_GT(bus->decoding().refused, 0u);
    master->rpm = 50;
    run_until(50ms);
    EXPECT_EQ(target_rpm(heard_of(0x201).back()), 50.0);
}

TEST_F(CanBus, counts_frames_of_a_wrong_length_and_ignores_their_data) {
    run_until(10ms);
    send(0x181, 6, {1});
    run_until(12ms);
    wire.faults.corrupt_length = {.next = 1, .one_in = 0};
    wire.faults.only = can::standard(0x181);
    send(0x181, 6, {2});
    run_until(15ms);
    EXPECT_EQ(bus->decoding().wrong_lengths, 1u);
    EXPECT_EQ(master->statusword.get(), 1);
    EXPECT_EQ(master->frames, 1);
}

TEST_F(CanBus, reports_how_many_frames_were_lost) {
    run_until(10ms);
    wire.overflow(twin, 7);
    send(0x181, 6, {1});
    run_until(12ms);
    EXPECT_EQ(master->lost.get(), 7);
    EXPECT_EQ(master->statusword.get(), 1) << "the frame after the lost ones counts";
}

TEST_F(CanBus, reads_a_whole_burst_without_another_frame_to_wake_it) {
    run_until(10ms);
    can::Frame frame{.id = 0x181, .length = 6};
    wire.babble(frame, 250ns, clock.now() + 1us);
    run_until(10ms + tick);
    wire.babble(frame, 0ns, never);
    run_until(12ms);
    EXPECT_GT(twin.counters().received, 2u * Bus::max_frames_per_cycle);
    EXPECT_EQ(master->received.get(), static_cast<std::int64_t>(twin.counters().received));
}

TEST_F(CanBus, drops_queued_and_new_demands_from_a_fault_until_the_restart) {
    run_until(20300us); // off the grid of the frames
    const auto before = heard.size();
    wire.bus_off(twin);
    demand(1, 1); // demanded into the fault
    run_until(25ms);
    master->sync_next = 1; // this demand wakes nobody
    EXPECT_EQ(master->faults, 1);
    EXPECT_TRUE(master->was_faulted);
    master->word = 9;
    run_until(110ms);
    EXPECT_EQ(heard.size(), before) << "nothing is sent";
    run_until(200ms); // by the restarter
    EXPECT_EQ(master->recoveries, 1);
    EXPECT_FALSE(master->was_faulted);
    EXPECT_TRUE(heard_of(0x000).empty()) << "what was demanded meanwhile is dropped";
    ASSERT_GT(heard.size(), before);
    for (std::size_t i = before; i < heard.size(); ++i) {
        ASSERT_EQ(heard[i].id, 0x201u);
        EXPECT_EQ(controlword(heard[i]), 9) << "made after the restart";
        EXPECT_GT(heard[i].stamp, Time{110ms});
        EXPECT_EQ(to_ns(heard[i].stamp) % 2'000'000, 0) << "on its grid";
    }
    demand(1, 2);
    run_until(210ms);
    ASSERT_EQ(heard_of(0x000).size(), 1u);
    EXPECT_TRUE(heard_of(0x080).empty());
    EXPECT_EQ(heard_of(0x000)[0].data[1], 2);
}

TEST_F(CanBus, sends_no_unacknowledged_frame_when_the_bus_recovers) {
    run_until(20ms);
    wire.set_acknowledged(false);
    run_until(40ms); // cyclic frames took the controller's four places
    for (std::int64_t node = 1; node <= 6; ++node) demand(1, node);
    run_until(100ms);
    EXPECT_EQ(master->faults, 1);
    master->word = 7;
    heard.clear();
    wire.set_acknowledged(true); // the cable is back
    run_until(110ms);
    EXPECT_LE(heard.size(), 4u) << "frames that the controller holds cannot be withdrawn";
    heard.clear();
    run_until(400ms);
    EXPECT_EQ(master->recoveries, 1);
    EXPECT_TRUE(heard_of(0x000).empty());
    ASSERT_FALSE(heard.empty());
    for (const auto& frame : heard) EXPECT_EQ(controlword(frame), 7);
}

TEST_F(CanBus, uses_hardly_any_time_while_it_is_faulted) {
    restarter->attempts.set(0);
    run_until(20ms);
    wire.bus_off(twin);
    run_until(30ms);
    const auto before = bus_cycles();
    run_until(1030ms);
    EXPECT_LE(bus_cycles() - before, 50u) << "one look in 20 ms";
}

TEST_F(CanBus, sends_its_safe_values_at_the_stop_and_repeats_no_demand) {
    run_until(10ms);
    demand(1, 3);
    run_until(20500us);
    heard.clear();
    world.stop();
    carry(clock.now() + 1ms);
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_EQ(heard[0].id, 0x201u);
    EXPECT_EQ(controlword(heard[0]), 2);
    EXPECT_EQ(target_rpm(heard[0]), 0.0);
}

TEST_F(CanBus, sends_the_safe_values_of_its_map_at_every_stop) {
    master->leaves_safe = false;
    run_until(20500us);
    heard.clear();
    change(0, LifeChange::stop);
    run_until(30ms);
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_EQ(controlword(heard[0]), 2);
    EXPECT_EQ(target_rpm(heard[0]), 0.0);
    EXPECT_TRUE(master->was_faulted) << "nobody serves it";
    EXPECT_EQ(master->faults, 1);
    EXPECT_EQ(instance.life().left_unsafe(), "");
}

TEST_F(CanBus, sends_its_safe_values_at_a_stop_right_after_a_bus_restart) {
    run_until(20300us);
    wire.bus_off(twin);
    restarter->attempts.set(0);
    run_until(45ms);
    ASSERT_EQ(twin.restart(), can::Restart::done);
    heard.clear();
    change(0, LifeChange::stop);
    run_until(60ms);
    ASSERT_FALSE(heard_of(0x201).empty());
    EXPECT_EQ(controlword(heard_of(0x201).back()), 2);
}

TEST_F(CanBus, works_again_after_a_stop_and_a_start) {
    run_until(10ms);
    wire.overflow(twin, 3);
    send(0x181, 6, {1});
    demand_each_once();
    run_until(20300us);
    ASSERT_EQ(master->lost.get(), 3);
    change(0, LifeChange::stop);
    run_until(30ms);
    heard.clear();
    master->word = 4;
    demand(1, 2); // demanded while the bus is stopped
    master->sync_next = 1;
    for (std::uint8_t i = 0; i < 100; ++i) {
        if (i == 50) wire.overflow(twin, 5);
        send(0x181, 6, {9});
        run_until(31ms + i * 1ms);
    }
    run_until(140300us);
    EXPECT_TRUE(heard.empty());
    change(0, LifeChange::start);
    run_until(150ms);
    ASSERT_FALSE(heard.empty());
    EXPECT_EQ(heard[0].stamp, Time{142300us}) << "a period after the start";
    for (const auto& frame : heard) {
        ASSERT_EQ(frame.id, 0x201u) << "what was demanded before the start is not sent";
        EXPECT_EQ(controlword(frame), 4);
    }
    EXPECT_EQ(master->statusword.get(), 1) << "what arrived before the start is no news";
    EXPECT_EQ(master->frames, 1);
    EXPECT_EQ(master->received.get(), 0);
    EXPECT_EQ(master->lost.get(), 0);
    EXPECT_EQ(master->faults, 1) << "that nobody serves it";
    EXPECT_EQ(master->recoveries, 1);
    send(0x181, 6, {2});
    demand(1, 3);
    run_until(155ms);
    EXPECT_EQ(master->statusword.get(), 2);
    EXPECT_EQ(master->received.get(), 1);
    ASSERT_EQ(heard_of(0x000).size(), 1u);
    EXPECT_EQ(heard_of(0x000)[0].data[1], 3);
}

TEST_F(CanBus, sends_no_values_from_before_its_stop) {
    run_until(10ms);
    demand_each_once();
    run_until(20300us);
    change(0, LifeChange::stop);
    master->word = 5;
    master->writes_target = false; // the two no longer agree, and the last agreement is from before the stop
    run_until(23300us);
    heard.clear();
    change(0, LifeChange::start);
    run_until(26ms);
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_EQ(controlword(heard[0]), 5);
}

TEST_F(CanBus, drops_at_its_start_the_frames_queued_before_its_stop) {
    run_until(10ms);
    demand_each_once();
    run_until(20300us);
    wire.set_acknowledged(false);
    run_until(30300us); // four frames are in the controller, the safe values and this wait after them
    demand(1, 7);
    run_until(33300us);
    change(0, LifeChange::stop);
    wire.set_acknowledged(true);
    run_until(34300us);
    heard.clear();
    change(0, LifeChange::start);
    run_until(50ms);
    EXPECT_TRUE(heard_of(0x000).empty());
    for (const auto& frame : heard_of(0x201)) EXPECT_EQ(controlword(frame), 1) << "not the safe value";
    EXPECT_EQ(master->faults, 1) << "that nobody served it";
}

TEST_F(CanBus, reports_a_fault_again_when_it_starts_on_a_faulted_bus) {
    run_until(10ms);
    demand_each_once();
    run_until(20ms);
    wire.bus_off(twin);
    run_until(25ms);
    ASSERT_EQ(master->faults, 1);
    stop_unheard("can");
    run_until(30ms);
    change(0, LifeChange::start);
    run_until(35ms);
    EXPECT_EQ(master->faults, 2);
    EXPECT_EQ(master->recoveries, 0);
    EXPECT_TRUE(master->was_faulted);
    run_until(200ms); // by the restarter
    EXPECT_EQ(master->recoveries, 1);
    EXPECT_FALSE(master->was_faulted);
}

/// A controller that requests service in the past, or has no room for a while.
class DifficultDevice final : public can::Device {
public:
    Time wants_service = Time::min();
    int no_room_for = 0;
    int sent = 0;
    can::Receive receive(can::Frame&) noexcept TAPPET_REALTIME override { return {}; }
    can::Send send(const can::Frame&, can::Keep) noexcept TAPPET_REALTIME override {
        ++waiting_;
        return can::Send::queued;
    }
    void service(Time) noexcept TAPPET_REALTIME override {
        if (waiting_ == 0) return;
        if (no_room_for > 0) {
            --no_room_for;
            ++count_.back_pressure;
            return;
        }
        sent += waiting_;
        waiting_ = 0;
    }
    bool finish(Time now) noexcept TAPPET_REALTIME override {
        service(now);
        return waiting_ == 0;
    }
    [[nodiscard]] Time next_service() const noexcept TAPPET_REALTIME override { return wants_service; }
    [[nodiscard]] can::State state() const noexcept TAPPET_REALTIME override { return can::State::active; }
    [[nodiscard]] can::Counters counters() const noexcept TAPPET_REALTIME override { return count_; }
    void purge() noexcept TAPPET_REALTIME override {}
    can::Restart restart() noexcept override { return can::Restart::not_needed; }
    [[nodiscard]] bool wakes(os::Waiter&) noexcept override { return true; }

private:
    can::Counters count_{};
    int waiting_ = 0;
};

TEST_F(CanBus, does_not_spin_when_its_device_requests_service_in_the_past) {
    DifficultDevice device;
    begin(device);
    master->writes_target = false;
    run_until(100ms);
    EXPECT_LE(bus_cycles(), 100ms / Bus::shortest_wait + 100);
}

TEST_F(CanBus, retries_soon_when_the_kernel_had_no_room_for_a_frame) {
    DifficultDevice device;
    device.wants_service = never;
    begin(device);
    master->writes_target = false; // no cyclic frame triggers its sending
    run_until(10ms);
    device.no_room_for = 4; // twice in the cycle in which it is demanded
    demand(1, 1);
    run_until(13ms);
    EXPECT_EQ(device.sent, 0);
    run_until(15ms);
    EXPECT_EQ(device.sent, 1);
}

} // namespace
} // namespace tappet::test
