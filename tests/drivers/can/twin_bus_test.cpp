// The bus of the host world: arbitration, times, and all its injected faults.
#include "drivers/can/signal_map.hpp"
#include "drivers/can/twin_bus.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace tappet::can {
namespace {

constexpr std::array machine_sends{standard(0x201), standard(0x202), standard(0x203), standard(0x204),
                                   standard(0x205)};
constexpr std::array plant_sends{standard(0x181), standard(0x182)};

struct TwinBusTest : testing::Test {
    explicit TwinBusTest(BitRates rates = {}, Format format = Format::classical)
        : bus{1, rates}, format_{format} {
        const bool takes_fd = format != Format::classical;
        EXPECT_TRUE(machine.open({.interface = "machine",
                                  .receive = plant_sends,
                                  .transmit = machine_sends,
                                  .in_flight = 2,
                                  .restarts_allowed = 2,
                                  .takes_fd = takes_fd}));
        EXPECT_TRUE(plant.open(
            {.interface = "plant", .receive = machine_sends, .transmit = plant_sends, .takes_fd = takes_fd}));
        EXPECT_TRUE(bus.attach(machine));
        EXPECT_TRUE(bus.attach(plant));
    }
    /// Without a length from the test, the frame takes the default of its bus.
    [[nodiscard]] Frame frame(std::uint32_t id, Time made, std::optional<std::uint8_t> length = {}) const {
        Frame f{.id = id, .length = length.value_or(format_ == Format::classical ? 8 : 64), .stamp = made};
        set_format(f, format_);
        for (std::size_t i = 0; i < f.length; ++i) f.data[i] = static_cast<std::uint8_t>(i + 1);
        return f;
    }
    /// One period: the machine is served, the bus delivers, both ends read.
    void step(Time now) {
        machine.service(now);
        plant.service(now);
        bus.deliver_until(now);
    }
    void carry(Device& from, std::uint32_t id, Time now) {
        EXPECT_EQ(from.send(frame(id, now), Keep::latest), Send::queued) << id;
        step(now);
    }
    static std::vector<Frame> drain(Device& end) {
        std::vector<Frame> all;
        Frame f;
        for (int i = 0; i < 2000; ++i)
            if (end.receive(f).what == Received::frame) all.push_back(f);
        return all;
    }
    TwinBus bus;
    Twin machine;
    Twin plant;

private:
    Format format_;
};

TEST_F(TwinBusTest, carries_a_frame_and_confirms_it) {
    Frame sent = frame(0x201, Time{1ms});
    sent.data[3] = 42;
    EXPECT_EQ(machine.send(sent), Send::queued);
    step(Time{1ms});
    const auto arrived = drain(plant);
    ASSERT_EQ(arrived.size(), 1u);
    EXPECT_EQ(arrived[0].data, sent.data);
    EXPECT_EQ(arrived[0].stamp, Time{1ms});
    EXPECT_TRUE(drain(machine).empty()) << "a confirmation is no frame";
    EXPECT_EQ(machine.counters().sent, 1u);
    EXPECT_EQ(plant.counters().received, 1u);
}

TEST_F(TwinBusTest, delivers_only_frames_named_in_the_filter) {
    Twin stranger;
    constexpr std::array others{standard(0x777), extended(0x181)};
    ASSERT_TRUE(stranger.open({.interface = "stranger", .transmit = others}));
    ASSERT_TRUE(bus.attach(stranger));
    EXPECT_EQ(stranger.send(frame(0x777, Time{1ms})), Send::queued);
    Frame long_one = frame(0x181, Time{1ms});
    long_one.extended = true;
    EXPECT_EQ(stranger.send(long_one), Send::queued);
    stranger.service(Time{1ms});
    step(Time{1ms});
    EXPECT_EQ(bus.frames_on_wire(), 2u);
    EXPECT_TRUE(drain(machine).empty());
}

TEST_F(TwinBusTest, refuses_to_send_a_foreign_identifier) {
    EXPECT_EQ(machine.send(frame(0x181, Time{1ms})), Send::refused_invalid);
    EXPECT_EQ(machine.counters().refused, 1u);
}

TEST_F(TwinBusTest, counts_but_does_not_deliver_an_impostor) {
    Twin impostor;
    ASSERT_TRUE(impostor.open({.interface = "impostor", .transmit = machine_sends}));
    ASSERT_TRUE(bus.attach(impostor));
    EXPECT_EQ(impostor.send(frame(0x201, Time{1ms})), Send::queued);
    impostor.service(Time{1ms});
    step(Time{1ms});
    EXPECT_TRUE(drain(machine).empty());
    EXPECT_EQ(machine.counters().impostors, 1u);
}

TEST_F(TwinBusTest, needs_the_bit_times_and_sends_the_lower_identifier_first) {
    TwinBus slow{1, {1'000'000, 0}};
    Twin a, b;
    constexpr std::array low{standard(0x100)};
    constexpr std::array high{standard(0x200)};
    ASSERT_TRUE(a.open({.interface = "a", .receive = low, .transmit = high}));
    ASSERT_TRUE(b.open({.interface = "b", .receive = high, .transmit = low}));
    ASSERT_TRUE(slow.attach(a) && slow.attach(b));
    EXPECT_EQ(a.send(frame(0x200, Time{1ms})), Send::queued);
    EXPECT_EQ(b.send(frame(0x100, Time{1ms})), Send::queued);
    a.service(Time{1ms});
    b.service(Time{1ms});
    slow.deliver_until(Time{1ms + 134us});
    EXPECT_TRUE(drain(a).empty()) << "135 bits take 135 us";
    slow.deliver_until(Time{2ms});
    const auto at_a = drain(a);
    const auto at_b = drain(b);
    ASSERT_EQ(at_a.size(), 1u);
    ASSERT_EQ(at_b.size(), 1u);
    EXPECT_EQ(at_a[0].stamp, Time{1ms + 135us});
    EXPECT_EQ(at_b[0].stamp, Time{1ms + 270us});
}

TEST_F(TwinBusTest, loses_duplicates_and_delays_frames_on_demand) {
    bus.faults.lose.next = 1;
    carry(machine, 0x201, Time{1ms});
    EXPECT_TRUE(drain(plant).empty());
    EXPECT_EQ(bus.frames_lost(), 1u);
    drain(machine);
    EXPECT_EQ(machine.counters().sent, 1u) << "another node acknowledged it";

    bus.faults.duplicate.next = 1;
    carry(machine, 0x201, Time{2ms});
    EXPECT_EQ(drain(plant).size(), 2u);

    bus.faults.delay.next = 1;
    bus.faults.delay_by = 3ms;
    carry(machine, 0x201, Time{3ms});
    EXPECT_TRUE(drain(plant).empty());
    step(Time{6ms});
    const auto late = drain(plant);
    ASSERT_EQ(late.size(), 1u);
    EXPECT_EQ(late[0].stamp, Time{6ms});
}

TEST_F(TwinBusTest, corrupts_the_length_of_one_identifier_only) {
    bus.faults.only = standard(0x202);
    bus.faults.corrupt_length.next = 1;
    EXPECT_EQ(machine.send(frame(0x201, Time{1ms})), Send::queued);
    carry(machine, 0x202, Time{1ms});
    const auto arrived = drain(plant);
    ASSERT_EQ(arrived.size(), 2u);
    EXPECT_EQ(arrived[0].length, 8);
    EXPECT_EQ(arrived[1].length, 7);
}

TEST_F(TwinBusTest, reports_how_many_frames_were_lost_before_the_next_one) {
    bus.overflow(machine, 7);
    carry(plant, 0x181, Time{1ms});
    Frame f;
    const Receive answer = machine.receive(f);
    EXPECT_EQ(answer.what, Received::frame);
    EXPECT_EQ(answer.lost, 7u);
    EXPECT_EQ(machine.counters().lost_in_kernel, 7u);
}

TEST_F(TwinBusTest, overflows_an_unread_inbox) {
    std::uint64_t sent = 0;
    for (Time now{1ms}; sent < 300; now += 1ms, ++sent) {
        carry(plant, 0x181, now);
        drain(plant);
    }
    EXPECT_EQ(drain(machine).size(), Twin::inbox);
    carry(plant, 0x181, Time{1s});
    Frame f;
    EXPECT_EQ(machine.receive(f).lost, 300u - Twin::inbox);
}

TEST_F(TwinBusTest, stops_at_bus_off_until_it_is_restarted) {
    EXPECT_EQ(machine.restart(), Restart::not_needed);
    EXPECT_EQ(machine.send(frame(0x201, Time{1ms})), Send::queued);
    EXPECT_EQ(machine.send(frame(0x202, Time{1ms})), Send::queued);
    EXPECT_EQ(machine.send(frame(0x203, Time{1ms})), Send::queued);
    machine.service(Time{1ms}); // two are in the controller, one waits
    bus.bus_off(machine);
    Frame f;
    ASSERT_EQ(machine.receive(f).what, Received::error_frame);
    EXPECT_EQ(f.error.state, State::bus_off);
    EXPECT_EQ(machine.state(), State::bus_off);
    EXPECT_EQ(machine.counters().dropped_stale, 1u) << "what waited is gone at once";
    EXPECT_EQ(machine.send(frame(0x201, Time{2ms})), Send::refused_fault);
    for (Time now{2ms}; now < Time{500ms}; now += 10ms) step(now);
    EXPECT_TRUE(drain(plant).empty());
    EXPECT_EQ(machine.state(), State::bus_off) << "it does not come back by itself";

    EXPECT_EQ(machine.restart(), Restart::done);
    step(Time{501ms});
    EXPECT_EQ(machine.state(), State::active);
    EXPECT_EQ(machine.send(frame(0x204, Time{500ms})), Send::refused_stale) << "made before the restart";
    carry(machine, 0x205, Time{502ms});
    const auto arrived = drain(plant);
    ASSERT_EQ(arrived.size(), 1u) << "nothing from before the restart is ever sent";
    EXPECT_EQ(arrived[0].id, 0x205u);
    EXPECT_EQ(machine.counters().dropped_stale, 3u);
}

TEST_F(TwinBusTest, drops_queued_frames_when_purged) {
    for (const Identifier& one : machine_sends)
        EXPECT_EQ(machine.send(frame(one.id, Time{1ms})), Send::queued);
    machine.service(Time{1ms});
    machine.purge();
    bus.deliver_until(Time{1ms});
    drain(machine);
    step(Time{2ms});
    EXPECT_EQ(drain(plant).size(), 2u) << "two were in the controller already";
    EXPECT_EQ(machine.counters().dropped_stale, 3u);
}

TEST_F(TwinBusTest, starts_clean_when_it_is_opened_again) {
    bus.bus_off(machine);
    drain(machine);
    EXPECT_EQ(machine.state(), State::bus_off);
    ASSERT_TRUE(machine.open({.interface = "machine", .receive = plant_sends, .transmit = machine_sends}));
    EXPECT_EQ(machine.state(), State::active);
    carry(machine, 0x201, Time{1ms});
    EXPECT_EQ(drain(plant).size(), 1u);
}

TEST_F(TwinBusTest, restarts_only_as_often_as_allowed) {
    Time now{1ms};
    for (int i = 0; i < 2; ++i, now += 1ms) {
        bus.bus_off(machine);
        drain(machine);
        EXPECT_EQ(machine.restart(), Restart::done);
        step(now);
        EXPECT_EQ(machine.state(), State::active);
    }
    bus.bus_off(machine);
    drain(machine);
    EXPECT_EQ(machine.restart(), Restart::exhausted);
    step(now);
    EXPECT_EQ(machine.state(), State::bus_off);
    EXPECT_EQ(machine.counters().restarts, 2u);
}

TEST_F(TwinBusTest, stays_faulted_when_the_restart_fails) {
    machine.make_restarts_fail(true);
    bus.bus_off(machine);
    drain(machine);
    EXPECT_EQ(machine.restart(), Restart::failed);
    step(Time{1ms});
    EXPECT_EQ(machine.state(), State::bus_off);
    machine.make_restarts_fail(false);
    EXPECT_EQ(machine.restart(), Restart::done);
}

TEST_F(TwinBusTest, treats_missing_acknowledgements_as_a_fault_and_drops_stale_frames) {
    bus.set_acknowledged(false);
    for (Time now{0ms}; now <= Time{60ms}; now += 1ms) {
        machine.send(frame(0x201, now));
        step(now);
        drain(machine);
        if (now == Time{10ms}) {
            EXPECT_EQ(machine.state(), State::passive);
        }
    }
    EXPECT_EQ(machine.state(), State::unacknowledged);
    EXPECT_EQ(machine.counters().faults, 1u);
    EXPECT_EQ(machine.restart(), Restart::done);
    bus.set_acknowledged(true);
    step(Time{100ms});
    EXPECT_TRUE(drain(plant).empty());
    carry(machine, 0x201, Time{101ms});
    EXPECT_EQ(drain(plant).size(), 1u);
}

TEST_F(TwinBusTest, recovers_by_itself_from_error_passive) {
    bus.set_state(machine, State::passive);
    drain(machine);
    EXPECT_EQ(machine.state(), State::passive);
    EXPECT_EQ(machine.send(frame(0x201, Time{1ms})), Send::queued) << "a passive controller still sends";
    bus.set_state(machine, State::active);
    drain(machine);
    EXPECT_EQ(machine.state(), State::active);
}

TEST_F(TwinBusTest, starves_lower_priorities_when_a_node_babbles) {
    TwinBus busy{1, {125'000, 0}};
    Twin a, b;
    constexpr std::array sends{standard(0x400)};
    constexpr std::array nothing = std::array<Identifier, 0>{};
    ASSERT_TRUE(a.open({.interface = "a", .receive = nothing, .transmit = sends}));
    ASSERT_TRUE(b.open({.interface = "b", .receive = sends, .transmit = nothing}));
    ASSERT_TRUE(busy.attach(a) && busy.attach(b));
    busy.babble(frame(0, Time{}), 100us, Time{});
    busy.deliver_until(Time{1ms});
    EXPECT_EQ(a.send(frame(0x400, Time{1ms})), Send::queued);
    a.service(Time{1ms});
    busy.deliver_until(Time{60ms});
    a.service(Time{60ms});
    EXPECT_TRUE(drain(b).empty());
    EXPECT_EQ(a.state(), State::unacknowledged) << "its frame never went out";
    busy.babble({}, 0ns, Time{});
}

/// The same bus between two ends that take CAN FD.
struct TwinBusFd : TwinBusTest {
    TwinBusFd() : TwinBusTest{{500'000, 2'000'000}, Format::flexible_faster} {}
};

TEST_F(TwinBusFd, carries_64_bytes_at_two_bit_rates) {
    const Frame sent = frame(0x201, Time{1ms});
    EXPECT_EQ(machine.send(sent), Send::queued);
    machine.service(Time{1ms});
    EXPECT_EQ(bus.next(), Time{1ms + 403us});
    bus.deliver_until(Time{1ms + 402us});
    EXPECT_TRUE(drain(plant).empty());
    bus.deliver_until(Time{1ms + 403us});
    const auto arrived = drain(plant);
    ASSERT_EQ(arrived.size(), 1u);
    EXPECT_EQ(arrived[0].data, sent.data);
    EXPECT_EQ(format_of(arrived[0]), Format::flexible_faster);
    drain(machine);
    EXPECT_EQ(machine.counters().sent, 1u);
}

TEST_F(TwinBusFd, needs_more_time_without_bit_rate_switch_and_for_classical_frames) {
    Frame slow = frame(0x201, Time{1ms});
    slow.bit_rate_switch = false;
    Frame classical = frame(0x202, Time{1ms}, 8);
    classical.fd = classical.bit_rate_switch = false;
    EXPECT_EQ(machine.send(slow), Send::queued);
    EXPECT_EQ(machine.send(classical), Send::queued);
    step(Time{1ms});
    bus.deliver_until(Time{4ms});
    const auto arrived = drain(plant);
    ASSERT_EQ(arrived.size(), 2u);
    EXPECT_EQ(arrived[0].stamp, Time{1ms + 1420us});
    EXPECT_EQ(arrived[1].stamp, Time{1ms + 1420us + 270us});
}

TEST_F(TwinBusFd, injects_every_fault_of_a_classical_bus) {
    bus.faults.spoil.next = 1;
    carry(machine, 0x201, Time{1ms});
    bus.deliver_until(Time{2ms});
    auto arrived = drain(plant);
    ASSERT_EQ(arrived.size(), 1u);
    EXPECT_EQ(arrived[0].stamp, Time{1ms + 403us + 62us + 403us}) << "an error frame is of the slow rate";
    drain(machine);

    bus.faults.lose.next = 1;
    carry(machine, 0x201, Time{3ms});
    bus.deliver_until(Time{4ms});
    EXPECT_TRUE(drain(plant).empty());
    drain(machine);
    EXPECT_EQ(machine.counters().sent, 2u) << "somebody else acknowledged";

    bus.faults.duplicate.next = 1;
    bus.faults.delay.next = 1;
    carry(machine, 0x201, Time{5ms});
    bus.deliver_until(Time{6ms});
    EXPECT_EQ(drain(plant).size(), 1u);
    bus.deliver_until(Time{11ms});
    EXPECT_EQ(drain(plant).size(), 1u) << "the other one is late";
}

TEST_F(TwinBusFd, corrupts_a_length_into_another_valid_one) {
    Time now{};
    for (const auto& [sent, corrupted] : {std::pair{64, 48}, {48, 32}, {12, 8}, {8, 7}, {0, 1}}) {
        bus.faults.corrupt_length.next = 1;
        now += 2ms;
        EXPECT_EQ(machine.send(frame(0x201, now, static_cast<std::uint8_t>(sent))), Send::queued);
        step(now);
        bus.deliver_until(now + 1ms);
        const auto arrived = drain(plant);
        ASSERT_EQ(arrived.size(), 1u) << sent;
        EXPECT_EQ(arrived[0].length, corrupted);
        drain(machine);
    }
    EXPECT_EQ(plant.counters().malformed, 0u);
}

TEST_F(TwinBusFd, delivers_no_can_fd_frame_to_a_classical_end) {
    Twin classical;
    constexpr std::array own{standard(0x300)};
    ASSERT_TRUE(classical.open({.interface = "old", .receive = machine_sends, .transmit = own}));
    ASSERT_TRUE(bus.attach(classical));
    EXPECT_EQ(classical.send(frame(0x300, Time{1ms})), Send::refused_invalid);
    carry(machine, 0x201, Time{1ms});
    bus.deliver_until(Time{2ms});
    EXPECT_TRUE(drain(classical).empty());
    EXPECT_EQ(drain(plant).size(), 1u);
}

TEST_F(TwinBusFd, refuses_invalid_frames) {
    Frame wrong = frame(0x201, Time{1ms}, 9);
    EXPECT_EQ(machine.send(wrong), Send::refused_invalid);
    wrong.length = 8;
    wrong.remote = true;
    EXPECT_EQ(machine.send(wrong), Send::refused_invalid);
}

TEST_F(TwinBusTest, wakes_its_waiter_when_a_frame_is_delivered) {
    os::Waiter waiter;
    ASSERT_TRUE(machine.wakes(waiter));
    step(Time{1ms});
    EXPECT_FALSE(waiter.take());
    carry(plant, 0x181, Time{2ms});
    EXPECT_TRUE(waiter.take());
}

/// The identifiers that arrive under random faults, as one number.
std::uint64_t run_of(std::uint64_t seed) {
    TwinBus bus{seed, {1'000'000, 0}};
    Twin a, b;
    EXPECT_TRUE(a.open({.interface = "a", .transmit = machine_sends}));
    EXPECT_TRUE(b.open({.interface = "b", .receive = machine_sends}));
    EXPECT_TRUE(bus.attach(a) && bus.attach(b));
    bus.faults.lose.one_in = 7;
    bus.faults.duplicate.one_in = 5;
    bus.faults.delay.one_in = 3;
    bus.faults.corrupt_length.one_in = 11;
    std::uint64_t digest = 0;
    Random traffic{seed + 1};
    for (Time now{1ms}; now < Time{2s}; now += 1ms) {
        Frame f{.id = machine_sends[traffic.below(machine_sends.size())].id, .stamp = now};
        a.send(f);
        a.service(now);
        bus.deliver_until(now);
        while (b.receive(f).what != Received::none)
            digest = digest * 31 + f.id * 16 + f.length + static_cast<std::uint64_t>(to_ns(f.stamp));
        while (a.receive(f).what != Received::none) {
        }
    }
    return digest;
}

TEST(TwinBusRuns, are_equal_for_equal_seeds_and_differ_otherwise) {
    EXPECT_EQ(run_of(5), run_of(5));
    EXPECT_NE(run_of(5), run_of(6));
}

TEST(TwinOpen, refuses_an_identifier_out_of_range) {
    Twin twin;
    constexpr std::array wrong{standard(0x800)};
    const auto opened = twin.open({.interface = "loom", .receive = wrong});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().view(),
              "CAN twin \"loom\": identifier 2048 is out of range; correct the signal map");
}

} // namespace
} // namespace tappet::can
