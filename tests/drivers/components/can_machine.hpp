// A machine with one CAN bus: a master that writes and reads its signals, a bus, a restarter; and the far end
// of the wire.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/can/restarter.hpp"
#include "drivers/can/twin_bus.hpp"
#include "tests/drivers/components/machine_rig.hpp"

#include <vector>

namespace tappet::test {

inline constexpr auto signals =
    can::signal_map(can::receive(can::standard(0x181), "drive", can::bytes(6), can::every(2ms),
                                 can::signal("statusword", 0, 16),
                                 can::signal("velocity", 16, 32).as_signed().times(0.1).in("rpm")),
                    can::transmit(can::standard(0x201), "drive_command", can::bytes(6), can::every(2ms),
                                  can::signal("controlword", 0, 16).safe(2),
                                  can::signal("velocity", 16, 32).as_signed().times(0.1).in("rpm").safe(0)),
                    can::transmit(can::standard(0x000), "nmt", can::bytes(2), can::on_demand(10ms),
                                  can::signal("command", 0, 8), can::signal("node", 8, 8))
                        .safe_by_silence(),
                    can::transmit(can::standard(0x080), "sync", can::bytes(1), can::on_demand(10ms),
                                  can::signal("count", 0, 8))
                        .safe_by_silence(),
                    can::receive(can::standard(0x182), "cell", can::bytes(4), can::every(2ms),
                                 can::signal("force", 0, 32).as_float().in("N")));

/// Does in each cycle what the test has set.
struct Master {
    struct Demand {
        std::int64_t command = 0;
        std::int64_t node = 0;
        bool operator==(const Demand&) const = default;
    };
    Input<std::int64_t> statusword{};
    Input<double> velocity{};
    Input<bool> faulted{};
    Input<std::int64_t> lost{};
    Input<std::int64_t> received{};
    Output<std::int64_t> controlword{};
    Output<double> target{};
    Output<std::int64_t> command{};
    Output<std::int64_t> node{};
    Output<std::int64_t> sync{};

    bool writes_controlword = true;
    bool writes_target = true;
    bool leaves_safe = true; ///< in its stop()
    std::int64_t word = 1;
    double rpm = 100;
    Bounded<Demand, 16> demands{}; // one a cycle
    Bounded<std::int64_t, 4> commands_alone{};
    int sync_next = -1;         // written in the next cycle
    Time sync_at = Time::min(); // and its time stamp; min: the time of that cycle
    Time nmt_at = Time::min();  // the same for demands
    int node_next = -1;         // a node without a command
    Duration overrun{};
    os::Clock* clock = nullptr;
    bool was_faulted = false;

    int frames = 0, faults = 0, recoveries = 0, surrenders = 0;
    void on_frame() noexcept TAPPET_REALTIME { ++frames; }
    void on_fault() noexcept TAPPET_REALTIME { ++faults; }
    void on_recovery() noexcept TAPPET_REALTIME { ++recoveries; }
    void on_surrender() noexcept TAPPET_REALTIME { ++surrenders; }

    Sentence configure(Setup& setup) {
        clock = setup.clock;
        return {};
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        was_faulted = faulted.get();
        if (writes_controlword) controlword.write(word);
        if (writes_target) target.write(rpm);
        const Time at = nmt_at == Time::min() ? cycle.now : nmt_at;
        if (!demands.empty()) {
            command.write(demands[0].command, at);
            node.write(demands[0].node, at);
            for (std::size_t i = 1; i < demands.size(); ++i) demands[i - 1] = demands[i];
            --demands.used;
        }
        for (const std::int64_t each : commands_alone) command.write(each, at);
        commands_alone.clear();
        if (node_next >= 0) node.write(node_next, at);
        node_next = -1;
        if (sync_next >= 0 && sync_at != Time::min()) sync.write(sync_next, sync_at);
        if (sync_next >= 0 && sync_at == Time::min()) sync.write(sync_next);
        sync_next = -1;
        if (overrun > 0ns) clock->consume(overrun);
        overrun = 0ns;
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        if (!leaves_safe) return;
        controlword.write(2);
        target.write(0.0);
    }

    static constexpr auto interface() {
        return facets(input<&Master::statusword>("statusword", "", "of the drive"),
                      input<&Master::velocity>("velocity", "rpm", "of the drive, measured"),
                      input<&Master::faulted>("faulted", "", "the bus is"),
                      input<&Master::lost>("lost", "", "frames, by the bus"),
                      input<&Master::received>("received", "", "frames, by the bus"),
                      output<&Master::controlword>("controlword", "", "to the drive"),
                      output<&Master::target>("target", "rpm", "of the drive"),
                      output<&Master::command>("command", "", "sent on demand"),
                      output<&Master::node>("node", "", "which one the command is for"),
                      output<&Master::sync>("sync", "", "sent every cycle"),
                      operation<&Master::on_frame>("on_frame", "a frame arrived"),
                      operation<&Master::on_fault>("on_fault", "the bus went off"),
                      operation<&Master::on_recovery>("on_recovery", "the bus is back"),
                      operation<&Master::on_surrender>("on_surrender", "nobody restarts the bus any more"));
    }
};

using Bus = can::Bus<signals>;

// clang-format off
inline constexpr auto can_machine = machine("can-machine",
    components(
        component<Bus>("can", device("wire")),
        component<Master>("master"),
        component<can::Restarter>("restarter", device("wire"), set("attempts", 2), set("pause", 100ms))),
    activities(
        activity("can",    on_device("can"), at_most(8, 1ms), runs("can"), deadline(500us), budget(20us)),
        activity("master", every(1ms), runs("master"), budget(20us)),
        activity("restarter", every(10ms), runs("restarter"), not_real_time)),
    connections(
        data("can.drive.statusword", "master.statusword", stale_after(10s), hold),
        data("can.drive.velocity",   "master.velocity",   stale_after(10s), hold),
        data("can.faulted",          "master.faulted"),
        data("can.frames_lost",      "master.lost"),
        data("can.frames_received",  "master.received"),
        data("can.faulted",          "restarter.faulted"),
        data("master.controlword",   "can.drive_command.controlword", stale_after(10ms), hold),
        data("master.target",        "can.drive_command.velocity",    stale_after(10ms), substitute(0.0)),
        data("master.command",       "can.nmt.command", wakes),
        data("master.node",          "can.nmt.node",    wakes),
        data("master.sync",          "can.sync.count", wakes)),
    reactions(
        when("can.drive.received",  tell("master.on_frame", queue(64))),
        when("can.bus_fault",       tell("master.on_fault")),
        when("can.bus_recovered",   tell("master.on_recovery")),
        when("restarter.gave_up",      tell("master.on_surrender"))),
    behaviours());
// clang-format on

/// The machine, the wire and its far end, which hears everything and sends what a test gives it.
struct CanMachine : MachineRig<can_machine> {
    static constexpr std::array machine_sends{can::standard(0x201), can::standard(0x000),
                                              can::standard(0x080)};
    static constexpr std::array machine_hears{can::standard(0x181), can::standard(0x182),
                                              can::standard(0x555)}; // one more than in its map
    static constexpr std::array far_end_sends{can::standard(0x181), can::standard(0x182),
                                              can::standard(0x555)};
    static constexpr Duration tick = 50us;

    CanMachine() {
        EXPECT_TRUE(twin.open({.interface = "machine",
                               .receive = machine_hears,
                               .transmit = machine_sends,
                               .restarts_allowed = 3}));
        EXPECT_TRUE(
            far_end.open({.interface = "far end", .receive = machine_sends, .transmit = far_end_sends}));
        EXPECT_TRUE(wire.attach(twin));
        EXPECT_TRUE(wire.attach(far_end));
        begin(twin);
    }
    void begin(can::Device& device) {
        configure("wire", device);
        bus = instance.find<Bus>("can");
        master = instance.find<Master>("master");
        restarter = instance.find<can::Restarter>("restarter");
    }
    Time carry(Time now) override {
        far_end.service(now);
        wire.deliver_until(now);
        can::Frame frame;
        while (far_end.receive(frame).what != can::Received::none)
            if (!frame.error.restarted) heard.push_back(frame);
        return now + tick;
    }
    /// Sends from the far end, at the next tick.
    void send(std::uint32_t id, std::uint8_t length, can::Payload data) {
        can::Frame frame{.id = id, .length = length, .data = data, .stamp = clock.now()};
        EXPECT_EQ(far_end.send(frame, can::Keep::every), can::Send::queued);
    }
    /// The master writes it in one of its next cycles.
    void demand(std::int64_t command, std::int64_t node) {
        EXPECT_TRUE(master->demands.push({command, node}));
    }
    [[nodiscard]] std::vector<can::Frame> heard_of(std::uint32_t id) const {
        std::vector<can::Frame> some;
        for (const auto& frame : heard)
            if (frame.id == id) some.push_back(frame);
        return some;
    }
    /// A component starts alone only when each of its inputs was written.
    void demand_each_once() {
        demand(1, 1);
        master->sync_next = 1;
        run(2ms);
        heard.clear();
    }
    [[nodiscard]] std::uint64_t bus_cycles() const { return instance.engines()[0].statistics().cycles; }

    can::TwinBus wire{1};
    can::Twin twin;
    can::Twin far_end;
    std::vector<can::Frame> heard;
    Bus* bus = nullptr;
    Master* master = nullptr;
    can::Restarter* restarter = nullptr;
};

} // namespace tappet::test
