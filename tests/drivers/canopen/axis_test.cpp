// A servo drive on a CANopen bus as an axis of a machine: SYNC each millisecond, its process data at each
// SYNC, its motions as commands.
#include "drivers/canopen/axis.hpp"
#include "drivers/canopen/manager.hpp"
#include "drivers/canopen/simulated_servo.hpp"
#include "tests/drivers/canopen/servo.eds.hpp"
#include "tests/drivers/canopen/wire_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>

namespace tappet::test {
namespace {

using canopen::synchronous;
using motion::AxisMode;

constexpr auto servo_signals = can::signal_map(
    can::receive(can::standard(0x189), "status", can::bytes(3), can::every(1ms), can::signal("word", 0, 16),
                 can::signal("mode", 16, 8).as_signed()),
    can::receive(can::standard(0x289), "actual", can::bytes(8), can::every(1ms),
                 can::signal("position", 0, 32).as_signed().times(0.001).in("mm"),
                 can::signal("velocity", 32, 32).as_signed().times(0.001).in("mm/s")),
    can::transmit(can::standard(0x209), "control", can::bytes(3), can::every(1ms),
                  can::signal("word", 0, 16).safe(2), can::signal("mode", 16, 8).as_signed().safe(0)),
    can::transmit(can::standard(0x309), "target", can::bytes(8), can::every(1ms),
                  can::signal("position", 0, 32).as_signed().times(0.001).in("mm"),
                  can::signal("velocity", 32, 32).as_signed().times(0.001).in("mm/s"))
        .safe_by_silence(),
    can::transmit(can::standard(0x409), "profile", can::bytes(6), can::every(1ms),
                  can::signal("velocity", 0, 32).times(0.001).in("mm/s"),
                  can::signal("torque", 32, 16).as_signed().times(0.1))
        .safe_by_silence());

constexpr auto servo_network =
    canopen::network(servo_signals, canopen::manager(127).sync(1ms),
                     canopen::node(9, "servo", canopen::dictionary<files::servo_eds>)
                         .heartbeat(20ms)
                         .pdo("status", synchronous(), {0x6041, 0x6061})
                         .pdo("actual", synchronous(), {0x6064, 0x606C})
                         .pdo("control", synchronous(), {0x6040, 0x6060})
                         .pdo("target", synchronous(), {0x607A, 0x60FF})
                         .pdo("profile", synchronous(), {0x6081, 0x6071}));

/// Asks what a test asks.
struct Client {
    CommandCall<> home, halt, come_to_stop;
    CommandCall<double, double> move_to;
    CommandCall<double, double, double> superimpose;
    CommandCall<double> move_at;
    CommandCall<std::int64_t> synchronize;
    Event<> power_on, power_off, reset, release;
    Output<double> set_point;
    bool oscillates = false;
    std::optional<double> once{};
    Duration ahead{}; ///< of the next one
    int errors = 0;
    double worst_lag = 0;
    Input<double> position;
    Time began{};

    void on_error() noexcept TAPPET_REALTIME { ++errors; }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        if (!oscillates) {
            began = cycle.now;
            if (once) set_point.write(*std::exchange(once, {}), cycle.now + std::exchange(ahead, {}));
            return;
        }
        const double wanted = 10.0 * std::sin(6.283185307179586 * to_seconds(cycle.now - began));
        set_point.write(wanted, cycle.now + std::exchange(ahead, {}));
        if (cycle.now - began > 50ms) worst_lag = std::max(worst_lag, std::abs(wanted - position.get()));
    }
    static constexpr auto interface() {
        return facets(
            sends<&Client::home>("home", "its reference"), sends<&Client::halt>("halt", "to rest"),
            sends<&Client::come_to_stop>("stop", "to rest, and held"),
            sends<&Client::move_to>("move_to", "a place"), sends<&Client::move_at>("move_at", "a speed"),
            sends<&Client::superimpose>("superimpose", "a motion on the one that runs"),
            sends<&Client::synchronize>("synchronize", "a cyclic mode"),
            event<&Client::power_on>("power_on", "asked for"),
            event<&Client::power_off>("power_off", "asked for"), event<&Client::reset>("reset", "asked for"),
            event<&Client::release>("release", "asked for"),
            output<&Client::set_point>("set_point", "mm", "of an oscillation"),
            input<&Client::position>("position", "mm", "of the axis"),
            operation<&Client::on_error>("on_error", "the axis stopped by an error"));
    }
};

using Bus = can::Bus<servo_signals, canopen::frames<servo_network>>;
using Manager = canopen::Manager<servo_network>;
using Axis = canopen::Axis<"mm">;

// clang-format off
constexpr auto servo_machine = machine("servo-machine",
    components(
        component<Bus>("can", device("wire")),
        component<Manager>("network"),
        component<Axis>("axis", set("standing", 0.01)),
        component<Client>("client")),
    activities(
        activity("can",    on_device("can"), at_most(16, 1ms), runs("can"), deadline(500us), budget(20us)),
        activity("motion", every(1ms), runs("network", "client", "axis"), budget(50us))),
    connections(
        buffer<64>("can.services",     "network.received"),
        buffer<32>("network.to_send",  "can.to_send", wakes),
        data("can.status.word",        "axis.statusword",   stale_after(5ms), hold),
        data("can.status.mode",        "axis.mode_display", stale_after(5ms), hold),
        data("can.actual.position",    "axis.position",     stale_after(5ms), hold),
        data("can.actual.velocity",    "axis.velocity",     stale_after(5ms), hold),
        data("can.actual.position",    "client.position"),
        data("client.set_point",       "axis.set_point",    stale_after(20ms), substitute(0.0)),
        data("axis.controlword",       "can.control.word"),
        data("axis.mode",              "can.control.mode"),
        data("axis.target_position",   "can.target.position"),
        data("axis.target_velocity",   "can.target.velocity"),
        data("axis.profile_velocity",  "can.profile.velocity"),
        data("axis.target_torque",     "can.profile.torque")),
    reactions(
        uses("client.home",        "axis.home"),
        uses("client.halt",        "axis.halt"),
        uses("client.stop",        "axis.stop"),
        uses("client.move_to",     "axis.move_to"),
        uses("client.move_at",     "axis.move_at"),
        uses("client.superimpose", "axis.superimpose"),
        uses("client.synchronize", "axis.synchronize"),
        when("client.power_on",    call("axis.power_on")),
        when("client.power_off",   call("axis.power_off")),
        when("client.reset",       call("axis.reset")),
        when("client.release",     call("axis.release")),
        when("axis.stopped_by_error", call("client.on_error"))),
    behaviours());
// clang-format on

struct ServoAxis : testing::Test, WireRig<servo_machine, Bus> {
    ServoAxis() : WireRig{1'000'000} { node.power_on(Time{5ms}); }
    ~ServoAxis() override {
        EXPECT_TRUE(good);
        EXPECT_EQ(refused, 0);
    }
    void hear(const can::Frame& frame, Time now) override {
        if (node.receive(frame, now, *this) != canopen::SimulatedNode::Heard::process_data) return;
        servo.take({static_cast<std::uint16_t>(node.get(0x6040)), node.get_signed(0x6060),
                    0.001 * static_cast<double>(node.get_signed(0x607A)),
                    0.001 * static_cast<double>(node.get_signed(0x6081)),
                    0.001 * static_cast<double>(node.get_signed(0x60FF)),
                    0.1 * static_cast<double>(node.get_signed(0x6071))});
    }
    void pass(Time now) override {
        if (now >= next_step) {
            servo.step(0.001);
            next_step = now + 1ms;
        }
        const auto whole = [](double value) {
            return static_cast<std::uint64_t>(std::llround(value * 1000));
        };
        if (!node.tick(now, *this)) return;
        node.set(0x6041, servo.statusword());
        node.set(0x6061, static_cast<std::uint64_t>(servo.mode()));
        node.set(0x6064, whole(servo.position()));
        node.set(0x606C, whole(servo.velocity()));
        node.send_due(*this);
    }
    template <class Condition> bool until(Condition condition) {
        for (int i = 0; i < 5000 && !condition(); ++i) run(1ms);
        return condition();
    }
    bool reaches(AxisMode state) {
        return until([&] { return axis->state.last() == state; });
    }
    void power() {
        ASSERT_TRUE(until([&] { return manager->operational.last(); })) << manager->reason.last().view();
        run(10ms);
        client->power_on.emit();
        ASSERT_TRUE(reaches(AxisMode::standstill));
    }
    template <class Call> bool ends(Call& call) {
        return until([&] { return !in_flight(call.state()); }) && call.state() == CommandState::done;
    }

    canopen::SimulatedDevice<canopen::dictionary<files::servo_eds>> node{9};
    canopen::SimulatedServo servo;
    Time next_step{};
    Manager* manager = instance.find<Manager>("network");
    Axis* axis = instance.find<Axis>("axis");
    Client* client = instance.find<Client>("client");
};

TEST_F(ServoAxis, says_done_of_no_motion_that_was_halted) {
    power();
    ASSERT_TRUE(client->move_to.send(100.0, 20.0));
    run(1s);
    ASSERT_TRUE(client->halt.send());
    EXPECT_TRUE(ends(client->halt));
    EXPECT_EQ(client->move_to.state(), CommandState::failed);
    client->move_to.reset();
    ASSERT_TRUE(client->synchronize.send(8));
    ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    ASSERT_TRUE(client->superimpose.send(50.0, 10.0, 500.0));
    run(500ms);
    client->halt.reset();
    ASSERT_TRUE(client->halt.send());
    EXPECT_TRUE(ends(client->halt));
    EXPECT_EQ(client->superimpose.state(), CommandState::failed);
}

TEST_F(ServoAxis, says_done_of_no_motion_that_another_took_the_place_of) {
    power();
    ASSERT_TRUE(client->superimpose.send(5.0, 20.0, 100.0)); // from a stand, a relative move
    run(100ms);
    ASSERT_TRUE(client->move_to.send(-50.0, 80.0));
    EXPECT_TRUE(ends(client->move_to));
    EXPECT_EQ(client->superimpose.state(), CommandState::failed);
    client->superimpose.reset();
    ASSERT_TRUE(client->synchronize.send(8));
    ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    ASSERT_TRUE(client->superimpose.send(50.0, 10.0, 500.0));
    run(500ms);
    client->synchronize.reset();
    ASSERT_TRUE(client->synchronize.send(9));
    ASSERT_TRUE(until([&] { return !in_flight(client->superimpose.state()); }));
    EXPECT_EQ(client->superimpose.state(), CommandState::failed);
}

TEST_F(ServoAxis, is_held_after_a_stop_until_it_is_released_also_without_power_in_between) {
    power();
    ASSERT_TRUE(client->come_to_stop.send());
    EXPECT_TRUE(ends(client->come_to_stop));
    client->power_off.emit();
    run(200ms);
    power();
    ASSERT_TRUE(client->move_to.send(10.0, 20.0));
    ASSERT_TRUE(until([&] { return !in_flight(client->move_to.state()); }));
    EXPECT_EQ(client->move_to.state(), CommandState::rejected);
}

TEST_F(ServoAxis, goes_home_to_places_and_at_speeds_by_commands) {
    servo.set_home(3);
    power();
    ASSERT_TRUE(client->home.send());
    EXPECT_TRUE(ends(client->home));
    EXPECT_NEAR(servo.position(), 0, 1e-3);
    client->home.reset();
    ASSERT_TRUE(client->move_to.send(25.0, 80.0));
    EXPECT_TRUE(ends(client->move_to));
    EXPECT_NEAR(servo.position(), 25, 1e-3);
    ASSERT_TRUE(client->move_at.send(-40.0));
    EXPECT_TRUE(until([&] { return servo.velocity() == -40; }));
    EXPECT_EQ(axis->state.last(), AxisMode::continuous_motion);
    ASSERT_TRUE(client->come_to_stop.send());
    EXPECT_TRUE(ends(client->come_to_stop));
    EXPECT_EQ(servo.velocity(), 0);
    EXPECT_EQ(axis->state.last(), AxisMode::stopping);
    client->release.emit();
    EXPECT_TRUE(reaches(AxisMode::standstill));
}

TEST_F(ServoAxis, follows_set_points_at_each_sync) {
    power();
    ASSERT_TRUE(client->synchronize.send(8));
    ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    client->oscillates = true;
    run(2s);
    EXPECT_EQ(axis->state.last(), AxisMode::synchronized_motion);
    EXPECT_GT(client->worst_lag, 0);
    EXPECT_LT(client->worst_lag, 0.32) << "five cycles of 63 mm/s at most: out, SYNC, motion, SYNC, in";
    EXPECT_EQ(client->errors, 0);
}

TEST_F(ServoAxis, takes_what_the_row_gives_for_a_velocity_that_grew_stale) {
    power();
    ASSERT_TRUE(client->synchronize.send(9));
    client->oscillates = true;
    run(2100ms); // a tenth of a period: it moves
    ASSERT_GT(std::abs(axis->target_velocity.last()), 1.0);
    client->oscillates = false;
    run(100ms);
    EXPECT_EQ(axis->target_velocity.last(), 0.0);
    EXPECT_NEAR(servo.velocity(), 0.0, 1e-6);
}

TEST_F(ServoAxis, comes_to_rest_when_its_velocity_is_no_number) {
    power();
    ASSERT_TRUE(client->synchronize.send(9));
    run(20ms);
    client->once = 20;
    run(10ms);
    ASSERT_EQ(axis->target_velocity.last(), 20);
    client->once = std::nan("");
    run(10ms);
    EXPECT_EQ(axis->target_velocity.last(), 0);
}

TEST_F(ServoAxis, begins_no_motion_by_a_set_point_of_before) {
    power();
    ASSERT_TRUE(client->synchronize.send(8));
    ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    client->once = 1;
    run(500ms);
    ASSERT_NEAR(servo.position(), 1, 0.1);
    ASSERT_TRUE(client->synchronize.send(9));
    run(500ms);
    EXPECT_NEAR(servo.velocity(), 0, 1e-6) << "a place is no velocity, and it is stale";
    client->once = 30;
    run(10ms);
    EXPECT_EQ(axis->target_velocity.last(), 30);
}

TEST_F(ServoAxis, takes_no_place_for_a_velocity_until_the_mode_of_velocities_is_ordered) {
    power();
    ASSERT_TRUE(client->synchronize.send(8));
    ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    client->oscillates = true;
    run(2200ms);
    client->synchronize.reset();
    ASSERT_TRUE(client->synchronize.send(9));
    ASSERT_TRUE(until([&] { return axis->mode.last() == 9; }));
    client->oscillates = false;
    run(5ms);
    EXPECT_EQ(axis->target_velocity.last(), 0);
    client->once = 3;
    run(5ms);
    EXPECT_EQ(axis->target_velocity.last(), 3);
}

/// Its set point is forced meanwhile, for less than what stands behind it takes to grow stale.
struct ForcedAxis : ServoAxis {
    void force(double value) {
        ASSERT_TRUE(resolve(instance.machine().table, "axis.set_point", FacetKind::input, end).empty());
        EXPECT_TRUE(port().force(instance.place_of(end), true, reinterpret_cast<const std::byte*>(&value)));
        run(4ms);
    }
    void release() {
        port().release(instance.place_of(end), true);
        run(3ms);
    }
    void write(double value) {
        client->once = value;
        run(3ms);
    }
    [[nodiscard]] const PortOperations& port() { return *facet_at(instance.machine().table, end).port; }
    End end;
};

TEST_F(ForcedAxis, stands_when_nothing_stood_behind_a_force) {
    power();
    ASSERT_TRUE(client->synchronize.send(9));
    ASSERT_TRUE(until([&] { return axis->mode.last() == 9; }));
    force(30);
    EXPECT_EQ(axis->target_velocity.last(), 30);
    release();
    EXPECT_EQ(axis->target_velocity.last(), 0);
}

TEST_F(ForcedAxis, jumps_to_no_place_that_stood_behind_a_force) {
    power();
    ASSERT_TRUE(client->synchronize.send(8));
    ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    write(1);
    force(1.5);
    ASSERT_NEAR(axis->target_position.last(), 1.5, 1e-9);
    release();
    EXPECT_NEAR(axis->target_position.last(), 1.5, 1e-9);
}

TEST_F(ForcedAxis, comes_to_rest_when_the_force_of_its_velocity_ends) {
    power();
    ASSERT_TRUE(client->synchronize.send(9));
    run(20ms);
    write(30);
    force(20);
    ASSERT_EQ(axis->target_velocity.last(), 20);
    release();
    EXPECT_EQ(axis->target_velocity.last(), 0);
}

TEST_F(ForcedAxis, is_led_by_nothing_that_was_written_before_it_follows) {
    power();
    write(30);
    force(20);
    ASSERT_TRUE(client->synchronize.send(9));
    run(3ms);
    release();
    EXPECT_EQ(axis->target_velocity.last(), 0);
}

TEST_F(ServoAxis, stays_where_it_was_turned_without_power) {
    servo.faults.knows_no_halt_in_cyclic = true;
    power();
    ASSERT_TRUE(client->synchronize.send(8));
    ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    client->oscillates = true;
    run(200ms);
    client->oscillates = false;
    client->power_off.emit();
    ASSERT_TRUE(until([&] { return servo.turn(5.45); }));
    run(50ms);
    const double there = servo.position();
    power();
    run(500ms);
    EXPECT_EQ(servo.position(), there);
    EXPECT_NEAR(axis->target_position.last(), there, 1e-3);
}

TEST_F(ServoAxis, superimposes_a_motion_on_what_it_follows) {
    power();
    ASSERT_TRUE(client->superimpose.send(1.0, 10.0, 500.0));
    EXPECT_TRUE(ends(client->superimpose));
    EXPECT_NEAR(servo.position(), 1, 1e-3) << "from a stand: a relative motion";
    client->superimpose.reset();
    ASSERT_TRUE(client->synchronize.send(8));
    ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    ASSERT_TRUE(client->superimpose.send(4.0, 10.0, 500.0));
    EXPECT_TRUE(ends(client->superimpose));
    EXPECT_EQ(axis->state.last(), AxisMode::synchronized_motion);
    run(20ms);
    EXPECT_NEAR(servo.position(), 5, 1e-3);
    client->superimpose.reset();
    ASSERT_TRUE(client->move_at.send(20.0));
    ASSERT_TRUE(until([&] { return servo.velocity() == 20; }));
    ASSERT_TRUE(client->superimpose.send(4.0, 10.0, 500.0));
    EXPECT_FALSE(ends(client->superimpose)) << "the drive makes this motion, and adds none to it";
    EXPECT_EQ(client->superimpose.state(), CommandState::rejected);
    EXPECT_EQ(axis->state.last(), AxisMode::continuous_motion);
}

TEST_F(ServoAxis, stops_by_an_error_when_its_node_is_silent_and_comes_back_by_a_reset) {
    power();
    ASSERT_TRUE(client->move_at.send(20.0));
    ASSERT_TRUE(until([&] { return servo.velocity() == 20; }));
    node.cut_off(true);
    EXPECT_TRUE(reaches(AxisMode::error_stop));
    EXPECT_EQ(client->errors, 1);
    run(200ms);
    EXPECT_FALSE(manager->operational.last());
    node.cut_off(false);
    ASSERT_TRUE(until([&] { return manager->operational.last(); }));
    run(100ms);
    EXPECT_EQ(axis->state.last(), AxisMode::error_stop) << "nobody reset it";
    client->reset.emit();
    EXPECT_TRUE(reaches(AxisMode::standstill));
    ASSERT_TRUE(servo.trip());
    EXPECT_TRUE(reaches(AxisMode::error_stop));
    EXPECT_EQ(client->errors, 2);
}

TEST_F(ServoAxis, rejects_what_its_state_has_no_way_for) {
    power();
    client->power_off.emit();
    EXPECT_TRUE(reaches(AxisMode::disabled));
    ASSERT_TRUE(client->move_at.send(20.0));
    EXPECT_FALSE(ends(client->move_at));
    EXPECT_EQ(client->move_at.state(), CommandState::rejected);
    ASSERT_TRUE(client->move_to.send(std::nan(""), 5.0));
    EXPECT_FALSE(ends(client->move_to));
}

TEST_F(ServoAxis, is_led_by_what_is_written_after_a_set_point_with_a_time_ahead) {
    power();
    ASSERT_TRUE(client->synchronize.send(9));
    ASSERT_TRUE(until([&] { return axis->mode.last() == 9; }));
    client->once = 30;
    client->ahead = 900ms;
    run(3ms);
    EXPECT_EQ(axis->target_velocity.last(), 30.0);
    int stood = 0;
    for (int i = 0; i < 100; ++i) {
        client->once = 20;
        run(1ms);
        stood += axis->target_velocity.last() == 0;
    }
    EXPECT_EQ(axis->target_velocity.last(), 20.0);
    EXPECT_EQ(stood, 0);
}

TEST_F(ServoAxis, does_not_jump_after_a_place_with_a_time_ahead) {
    power();
    ASSERT_TRUE(client->synchronize.send(8));
    ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    client->oscillates = true;
    run(1000ms);
    client->ahead = 740ms;
    double before = axis->target_position.last(), largest = 0;
    for (int i = 0; i < 1000; ++i) {
        run(1ms);
        largest = std::max(largest, std::abs(std::exchange(before, axis->target_position.last()) -
                                             axis->target_position.last()));
    }
    EXPECT_LT(largest, 0.1) << "of the oscillation: 0.063";
}

} // namespace
} // namespace tappet::test
