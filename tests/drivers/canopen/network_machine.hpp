// A machine with the manager of a network, and the network's nodes at the other end of its bus. Uses no test
// framework.
#pragma once

#include "apps/carpet_loom/nodes/drive.eds.hpp"
#include "apps/carpet_loom/nodes/encoder.eds.hpp"
#include "drivers/canopen/manager.hpp"
#include "tests/drivers/canopen/wire_rig.hpp"

#include <string>
#include <vector>

namespace tappet::test {

inline constexpr auto signals =
    can::signal_map(can::receive(can::standard(0x185), "drive", can::bytes(6), can::every(5ms),
                                 can::signal("statusword", 0, 16),
                                 can::signal("velocity", 16, 32).as_signed().times(0.1).in("rpm")),
                    can::receive(can::standard(0x187), "encoder", can::bytes(4), can::every(10ms),
                                 can::signal("position", 0, 16), can::signal("sample", 16, 16)),
                    can::transmit(can::standard(0x205), "drive_command", can::bytes(6), can::every(2ms),
                                  can::signal("controlword", 0, 16).safe(2),
                                  can::signal("velocity", 16, 32).as_signed().times(0.1).in("rpm").safe(0)));

inline constexpr auto nodes = canopen::network(
    signals, canopen::manager(127).heartbeat(100ms).sync(10ms, 20).time(1s),
    canopen::node(5, "drive", canopen::dictionary<files::drive_eds>)
        .heartbeat(50ms)
        .pdo("drive", {.type = 254, .event_timer = 5ms}, {0x6041, 0x606C}) // the peer knows no 255
        .pdo("drive_command", {0x6040, 0x60FF})
        .write(0x6060, 3)
        .write(0x605A, 2),
    canopen::node(7, "encoder", canopen::dictionary<files::encoder_eds>)
        .heartbeat(50ms, 120ms)
        .pdo("encoder", canopen::synchronous(), {0x2100, 0x2101}));

/// Writes the drive's command, and records the reports of the network.
struct Operator {
    Input<std::int64_t> statusword{}, position{};
    Input<double> velocity{};
    Input<bool> operational{};
    Output<std::int64_t> controlword{};
    Output<double> target{};
    Output<Duration> clock{};
    Bounded<std::array<std::int64_t, 3>, 32> emergencies{}; // the first ones

    void on_emergency(std::int64_t node, std::int64_t code, std::int64_t error_register) noexcept
        TAPPET_REALTIME {
        static_cast<void>(emergencies.push({node, code, error_register}));
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        controlword.write(6);
        target.write(-12.3);
        if (cycle.now < Time{500ms}) clock.write(Duration{24h} * 366 + 1500ms);
    }
    static constexpr auto interface() {
        return facets(input<&Operator::statusword>("statusword", "", "of the drive"),
                      input<&Operator::position>("position", "", "of the encoder"),
                      input<&Operator::velocity>("velocity", "rpm", "of the drive"),
                      input<&Operator::operational>("operational", "", "all nodes"),
                      output<&Operator::controlword>("controlword", "", "to the drive"),
                      output<&Operator::target>("target", "rpm", "to the drive"),
                      output<&Operator::clock>("clock", "s", "since 1984"),
                      operation<&Operator::on_emergency>("on_emergency", "a node says so"));
    }
};

using Bus = can::Bus<signals, canopen::frames<nodes>>;
using Manager = canopen::Manager<nodes>;

// clang-format off
inline constexpr auto network_machine = machine("network-machine",
    components(
        component<Bus>("can", device("wire")),
        component<Manager>("network"),
        component<Operator>("operator")),
    activities(
        activity("can",     on_device("can"), at_most(12, 1ms), runs("can"), deadline(500us), budget(20us)),
        activity("network", every(1ms), runs("network", "operator"), budget(50us))),
    connections(
        buffer<64>("can.services",      "network.received"),
        buffer<32>("network.to_send",   "can.to_send", wakes),
        data("operator.clock",          "network.time_of_day"),
        data("can.drive.statusword",    "operator.statusword", stale_after(10s), hold),
        data("can.drive.velocity",      "operator.velocity",   stale_after(10s), hold),
        data("can.encoder.position",    "operator.position",   stale_after(10s), hold),
        data("network.operational",     "operator.operational", delayed),
        data("operator.controlword",    "can.drive_command.controlword", stale_after(10ms), hold),
        data("operator.target",         "can.drive_command.velocity",    stale_after(10ms), hold)),
    reactions(
        when("network.emergency", tell("operator.on_emergency", queue(8)))),
    behaviours());
// clang-format on

/// The machine, the wire and the nodes.
struct NetworkRig : WireRig<network_machine, Bus> {
    NetworkRig() : WireRig{500'000} {
        drive.power_on(Time{20ms});
        encoder.power_on(Time{30ms});
    }
    void hear(const can::Frame& frame, Time now) override {
        heard.push_back(frame);
        for (canopen::SimulatedNode* node : all)
            if (node->receive(frame, now, *this) == canopen::SimulatedNode::Heard::started) ++starts;
    }
    void pass(Time now) override {
        for (canopen::SimulatedNode* node : all) {
            if (!node->tick(now, *this)) continue;
            drive.set(0x6041, 0x0231);
            drive.set(0x606C, static_cast<std::uint32_t>(-1234));
            encoder.set(0x2100, 0x0ABC);
            node->send_due(*this);
        }
    }
    [[nodiscard]] bool operational() const { return manager->operational.last(); }
    [[nodiscard]] std::string reason() const { return std::string{manager->reason.last().view()}; }
    [[nodiscard]] canopen::NodePhase phase(std::size_t node) const { return manager->phases[node].last(); }
    [[nodiscard]] std::vector<can::Frame> heard_of(std::uint32_t id) const {
        std::vector<can::Frame> some;
        for (const auto& frame : heard)
            if (frame.id == id) some.push_back(frame);
        return some;
    }

    canopen::SimulatedDevice<canopen::dictionary<files::drive_eds>> drive{5};
    canopen::SimulatedDevice<canopen::dictionary<files::encoder_eds>> encoder{7};
    std::vector<canopen::SimulatedNode*> all{&drive, &encoder};
    int starts = 0;
    std::vector<can::Frame> heard;
    Manager* manager = instance.find<Manager>("network");
    Operator* people = instance.find<Operator>("operator");
};

} // namespace tappet::test
