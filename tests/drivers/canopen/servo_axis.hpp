// A servo drive on a CANopen bus as an axis of a machine: SYNC each millisecond, its process data at each
// SYNC, its motions as commands.
#pragma once

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

using canopen::synchronous;
using motion::AxisMode;

inline constexpr auto servo_signals = can::signal_map(
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

inline constexpr auto servo_network =
    canopen::network(servo_signals, canopen::manager(127).sync(1ms),
                     canopen::node(9, "servo", canopen::dictionary<files::servo_eds>)
                         .heartbeat(20ms)
                         .pdo("status", synchronous(), {0x6041, 0x6061})
                         .pdo("actual", synchronous(), {0x6064, 0x606C})
                         .pdo("control", synchronous(), {0x6040, 0x6060})
                         .pdo("target", synchronous(), {0x607A, 0x60FF})
                         .pdo("profile", synchronous(), {0x6081, 0x6071}));

/// Sends the requests of a test.
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
    Duration ahead{}; ///< added to the time of the next set point
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
inline constexpr auto servo_machine = machine("servo-machine",
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
        data("can.actual.position",    "client.position",   stale_after(10s), hold),
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
    void SetUp() override { power(); }
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
    void follow_positions() {
        ASSERT_TRUE(client->synchronize.send(8));
        ASSERT_TRUE(until([&] { return axis->follows.last(); }));
    }
    template <class Call> bool ends(Call& call) {
        return until([&] { return !in_flight(call.state()); }) && call.state() == CommandState::done;
    }
    template <class Call, class... Arguments> bool does(Call& call, Arguments... arguments) {
        call.reset();
        return call.send(arguments...) && ends(call);
    }

    canopen::SimulatedDevice<canopen::dictionary<files::servo_eds>> node{9};
    canopen::SimulatedServo servo;
    Time next_step{};
    Manager* manager = instance.find<Manager>("network");
    Axis* axis = instance.find<Axis>("axis");
    Client* client = instance.find<Client>("client");
};

} // namespace tappet::test
