// Outputs that the table holds in some states: whatever a component, an event or a force asks for, the wire
// has the safe value outside of them, and orders that stand there are counted.
#include "drivers/can/bus.hpp"
#include "drivers/can/far_end.hpp"
#include "drivers/gpio/far_end.hpp"
#include "drivers/gpio/line_port.hpp"
#include "drivers/modbus/client.hpp"
#include "drivers/modbus/far_end.hpp"
#include "drivers/plant/simulation.hpp"
#include "kernel/limits/held_in.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "tests/drivers/components/forced_port.hpp"
#include "tests/drivers/components/machine_rig.hpp"

namespace tappet::test {
namespace {

constexpr auto io_lines =
    gpio::line_map(gpio::actuator("valve", gpio::safe(false)), gpio::actuator("brake", gpio::safe(true)),
                   gpio::output("motor", gpio::safe(false)));
constexpr auto signals =
    can::signal_map(can::transmit(can::standard(0x201), "drive", can::bytes(4), can::every(10ms),
                                  can::signal("speed", 0, 16).as_signed().times(0.1).in("rpm").safe(0),
                                  can::signal("mode", 16, 8).safe(3)));
constexpr auto registers =
    modbus::register_map(modbus::write("pump", modbus::coils(0, 1), modbus::every(100ms),
                                       modbus::stale_after(5s), modbus::bit("on", 0).safe(0)));

/// Asks for what the test says, in whatever state its machine is.
struct Filler {
    Output<bool> motor{};
    Output<double> speed{}, pump{};
    Output<std::int64_t> mode{};
    Event<> go{}, stop_it{}, open{}, close{}, let_go{}, hold{};
    bool asks = true;   ///< all outputs on
    bool obeys = false; ///< the outputs follow the state
    bool fills = false;
    bool starts = false, ends = false, opens = false, closes = false;

    void begin() noexcept TAPPET_REALTIME { fills = true; }
    void end() noexcept TAPPET_REALTIME { fills = false; }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const bool on = obeys ? fills : asks;
        motor.write(on);
        speed.write(on ? 100.0 : 0.0);
        pump.write(on ? 1.0 : 0.0);
        mode.write(on ? 1 : 3);
        if (std::exchange(starts, false)) go.emit();
        if (std::exchange(ends, false)) stop_it.emit();
        if (std::exchange(opens, false)) open.emit(), let_go.emit();
        if (std::exchange(closes, false)) close.emit(), hold.emit();
    }
    static constexpr auto interface() {
        return facets(
            output<&Filler::motor>("motor", "", "shall run"),
            output<&Filler::speed>("speed", "rpm", "of the drive"),
            output<&Filler::pump>("pump", "", "shall run"), output<&Filler::mode>("mode", "", "of the drive"),
            event<&Filler::go>("go", "begin"), event<&Filler::stop_it>("stop_it", "end"),
            event<&Filler::open>("open", "the valve"), event<&Filler::close>("close", "the valve"),
            event<&Filler::let_go>("let_go", "the brake"), event<&Filler::hold>("hold", "the brake"));
    }
};

constexpr auto states_of_filler = state_machine<Filler>(
    "states_of_filler",
    states(state("idle", initial, entry<&Filler::end>), state("work", entry<&Filler::begin>),
           state("filling", in("work"), initial), state("topping", in("work")),
           state("safe", final, entry<&Filler::end>)),
    transitions(transition("idle", "filling", on("go")), transition("filling", "topping", after(1s)),
                transition("work", "idle", on("stop_it"))));

// clang-format off
template <class... Held> constexpr auto filler_with(const Held&... held) {
    return machine("held-machine",
        components(
            component<gpio::LinePort<io_lines>>("io", device("lines")),
            component<can::Bus<signals>>("can", device("wire")),
            component<modbus::Client<registers>>("unit", device("server")),
            component<Filler>("filler")),
        activities(
            activity("io",     on_device("io"),  at_most(8, 1ms), runs("io"),  deadline(500us), budget(10us)),
            activity("can",    on_device("can"), at_most(8, 1ms), runs("can"), deadline(500us), budget(20us)),
            activity("unit",   every(20ms), runs("unit"), not_real_time),
            activity("filler", every(1ms), runs("filler"), budget(20us))),
        connections(
            data("filler.motor", "io.motor", wakes),
            data("filler.speed", "can.drive.speed", stale_after(50ms), hold),
            data("filler.mode",  "can.drive.mode", stale_after(50ms), hold),
            data("filler.pump",  "unit.pump.on", stale_after(1s), hold)),
        reactions(
            when("filler.open",   tell("io.valve.set")),
            when("filler.close",  tell("io.valve.clear")),
            when("filler.hold",   tell("io.brake.set")),
            when("filler.let_go", tell("io.brake.clear"))),
        behaviours(behaviour("filler", compiled<states_of_filler>)), held...);
}
constexpr auto held_machine = filler_with(
    held_in("io.valve", "filler", "work"), held_in("io.brake", "filler", "work"),
    held_in("io.motor", "filler", "filling", "topping"), held_in("can.drive.speed", "filler", "filling"),
    held_in("can.drive.mode", "filler", "work"), held_in("unit.pump.on", "filler", "work"));
// clang-format on

struct Filled final : Plant {
    Time move(Time now) override { return now + 1ms; }
    can::FarEnd<signals> can{ends, "wire"};
    gpio::FarEnd<io_lines> io{ends, "lines"};
    modbus::FarEnd<registers> unit{ends, "server"};
};

struct Held : MachineRig<held_machine> {
    Held() {
        const auto opened = devices.open(instance.machine());
        EXPECT_TRUE(opened) << (opened ? "" : opened.error().view());
        const auto configured = instance.configure(devices.provided());
        EXPECT_TRUE(configured) << (configured ? "" : configured.error().view());
    }
    Time carry(Time now) override {
        devices.advance(now);
        return std::min(devices.next(), now + 50us);
    }
    void SetUp() override { run(20ms); }
    [[nodiscard]] std::uint64_t counted(std::size_t section) const {
        return instance.observation().counted(section, 0).times;
    }
    void expect_safe() {
        EXPECT_FALSE(plant.io.get("valve"));
        EXPECT_TRUE(plant.io.get("brake"));
        EXPECT_FALSE(plant.io.get("motor"));
        EXPECT_EQ(plant.can.get("drive.speed"), 0.0);
        EXPECT_EQ(plant.can.get("drive.mode"), 3.0);
        EXPECT_EQ(plant.unit.get("pump.on"), 0.0);
    }
    void expect_on() {
        EXPECT_TRUE(plant.io.get("valve"));
        EXPECT_FALSE(plant.io.get("brake"));
        EXPECT_TRUE(plant.io.get("motor"));
        EXPECT_EQ(plant.can.get("drive.speed"), 100.0);
        EXPECT_EQ(plant.can.get("drive.mode"), 1.0);
        EXPECT_EQ(plant.unit.get("pump.on"), 1.0);
    }
    Filled plant;
    SimulatedDevices devices{plant, 1};
    Filler& filler = *instance.find<Filler>("filler");
};

TEST_F(Held, is_safe_at_the_wire_outside_of_its_states_whatever_is_asked_for) {
    filler.opens = true;
    run(400ms);
    expect_safe();
    filler.starts = true;
    run(400ms);
    expect_on();
    filler.ends = true; // nobody turns anything off
    run(400ms);
    expect_safe();
}

TEST_F(Held, counts_an_order_that_stands_outside_of_its_states_once) {
    filler.opens = true;
    run(50ms);
    EXPECT_EQ(counted(0), 0u) << "a writer may see a change of the state some cycles later";
    run(1s);
    for (std::size_t section = 0; section < 6; ++section) EXPECT_EQ(counted(section), 1u) << section;
    EXPECT_EQ(instance.observation().counted(0, 0).what, "io.valve");
    filler.starts = true;
    run(400ms);
    filler.ends = true;
    run(1s);
    for (std::size_t section = 0; section < 6; ++section) EXPECT_EQ(counted(section), 2u) << section;
}

TEST_F(Held, counts_nothing_of_a_component_that_obeys) {
    filler.obeys = true;
    for (int n = 0; n < 5; ++n) {
        filler.starts = true;
        run(10ms);
        filler.opens = true;
        run(400ms);
        expect_on();
        filler.ends = filler.closes = true;
        run(400ms);
        expect_safe();
    }
    for (std::size_t section = 0; section < 6; ++section) EXPECT_EQ(counted(section), 0u) << section;
}

TEST_F(Held, of_an_inner_state_is_safe_in_its_sibling) {
    filler.starts = true;
    run(900ms);
    EXPECT_EQ(plant.can.get("drive.speed"), 100.0);
    EXPECT_TRUE(plant.io.get("motor"));
    run(400ms); // topping
    EXPECT_EQ(plant.can.get("drive.speed"), 0.0);
    EXPECT_TRUE(plant.io.get("motor"));
    EXPECT_EQ(plant.can.get("drive.mode"), 1.0);
}

TEST_F(Held, is_safe_while_the_component_of_its_states_is_stopped) {
    filler.starts = filler.opens = true;
    run(400ms);
    EXPECT_TRUE(plant.io.get("valve"));
    change(3, LifeChange::stop);
    run(400ms);
    expect_safe();
}

TEST_F(Held, does_not_let_a_force_pass) {
    filler.asks = false;
    run(400ms);
    ForcedPort{instance, "io.motor", FacetKind::input}.to(true);
    run(50ms);
    EXPECT_FALSE(plant.io.get("motor"));
    filler.starts = true;
    run(50ms);
    EXPECT_TRUE(plant.io.get("motor"));
}

} // namespace
} // namespace tappet::test
