// A machine on a bus with CAN FD frames, from its board's two bit rates to the values at its plant.
#include "drivers/can/bus.hpp"
#include "drivers/can/far_end.hpp"
#include "drivers/plant/simulation.hpp"
#include "tests/drivers/components/machine_rig.hpp"

namespace tappet::test {
namespace {

constexpr auto signals = can::signal_map(
    can::receive(can::standard(0x181), "scan", can::fd_bytes(64), can::every(2ms),
                 can::signal("count", 0, 16),
                 can::signal("width", 487, 24).big_endian().times(0.001).in("mm")),
    can::receive(can::standard(0x182), "guard", can::bytes(1), can::every(10ms), can::signal("closed", 0, 1)),
    can::transmit(can::standard(0x201), "recipe", can::fd_bytes(24).in_one_rate(), can::every(10ms),
                  can::signal("thickness", 160, 24).times(0.001).in("mm").safe(0)));

/// Planes the scanned board to half of its width.
struct Planer {
    Input<double> width{};
    Output<double> thickness{};
    void step(const Cycle&) noexcept TAPPET_REALTIME { thickness.write(width.get() / 2); }
    static constexpr auto interface() {
        return facets(input<&Planer::width>("width", "mm", "of the board, scanned"),
                      output<&Planer::thickness>("thickness", "mm", "to be planed to"));
    }
};

// clang-format off
constexpr auto planing_machine = machine("planing-machine",
    components(component<can::Bus<signals>>("can", device("wire")), component<Planer>("planer")),
    activities(
        activity("can",    on_device("can"), at_most(8, 1ms), runs("can"), deadline(500us), budget(20us)),
        activity("planer", every(1ms), runs("planer"), budget(20us))),
    connections(
        data("can.scan.width",   "planer.width", stale_after(50ms), hold),
        data("planer.thickness", "can.recipe.thickness", stale_after(50ms), hold)),
    reactions(), behaviours());
// clang-format on

constexpr Board box{.name = "box",
                    .memory_budget_bytes = 4u << 20,
                    .devices =
                        board_devices(board_device("can0", "can", "can0", bit_rate(500'000, 2'000'000)))};
constexpr Binding on_box = binding(wired("wire", "can0"));

struct Scanner final : Plant {
    Scanner() { can.send_every("scan", 2ms); }
    Time move(Time now) override { return now + 1ms; }
    can::FarEnd<signals> can{ends, "wire"};
};

struct PlaningMachine : MachineRig<planing_machine, box, on_box> {
    PlaningMachine() {
        devices.set_bit_rates({500'000, 2'000'000});
        const auto opened = devices.open(instance.machine());
        EXPECT_TRUE(opened) << opened.error().view();
        const auto configured = instance.configure(devices.provided());
        EXPECT_TRUE(configured) << configured.error().view();
    }
    Time carry(Time now) override {
        devices.advance(now);
        return now + 50us;
    }

    Scanner plant;
    SimulatedDevices devices{plant, 1};
    can::Bus<signals>& bus = *instance.find<can::Bus<signals>>("can");
};

TEST_F(PlaningMachine, sends_and_receives_values_behind_the_eighth_byte) {
    plant.can.set("scan.width", 123.456);
    run(100ms);
    EXPECT_NEAR(plant.can.get("recipe.thickness"), 61.728, 0.0005);
    plant.can.set("scan.width", 8000.25);
    run(100ms);
    EXPECT_NEAR(plant.can.get("recipe.thickness"), 4000.125, 0.0005);
    EXPECT_EQ(bus.wrong_lengths.last(), 0);
    EXPECT_GE(bus.longest_response("recipe"), 740us) << "300 + 5 bits, all of them slow";
    EXPECT_LT(bus.longest_response("recipe"), 10ms);
}

TEST_F(PlaningMachine, counts_frames_that_the_bus_truncated) {
    run(20ms);
    devices.bus("wire").faults.only = can::standard(0x181);
    devices.bus("wire").faults.corrupt_length.next = 2;
    run(20ms);
    EXPECT_EQ(bus.wrong_lengths.last(), 2);
}

} // namespace
} // namespace tappet::test
