// Encoders, analog inputs and outputs, force sensors and axes against simulated ones: they measure the true
// value, and a failure is reported and moves nothing.
#include "drivers/instruments/analog.hpp"
#include "drivers/instruments/encoder.hpp"
#include "drivers/instruments/force_sensor.hpp"
#include "drivers/instruments/simulated.hpp"
#include "drivers/instruments/velocity_axis.hpp"
#include "kernel/base/random.hpp"
#include "kernel/component/property_transaction.hpp"
#include "tests/drivers/components/machine_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

namespace tappet {
namespace {

using namespace instruments;

/// The drivers' values, and the values written to them.
struct Wires {
    Output<std::int64_t> counts;
    Output<double> current, newtons, wanted_velocity, wanted_pressure;
    Input<double> velocity, raw;
    std::uint64_t register_now = 0;
    double current_now = 4.0, newtons_now = 0.0, velocity_now = 0.0, pressure_now = 0.0;
    bool is_silent = false;
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME { step(cycle); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (is_silent) return;
        counts.write(static_cast<std::int64_t>(register_now));
        current.write(current_now);
        newtons.write(newtons_now);
        wanted_velocity.write(velocity_now);
        wanted_pressure.write(pressure_now);
    }
    static constexpr auto interface() {
        return facets(output<&Wires::counts>("counts", "", "of a register of 16 bits"),
                      output<&Wires::current>("current", "", "mA"),
                      output<&Wires::newtons>("newtons", "N", "of a cell"),
                      output<&Wires::wanted_velocity>("wanted_velocity", "m/s", "of the axis"),
                      output<&Wires::wanted_pressure>("wanted_pressure", "bar", "of the valve"),
                      input<&Wires::velocity>("velocity", "m/s", "to the drive"),
                      input<&Wires::raw>("raw", "", "to the valve, mA"));
    }
};
struct Alarm {
    double heard = 0.0;
    int times = 0;
    void hear(double newtons) noexcept TAPPET_REALTIME { heard = newtons, ++times; }
    static constexpr auto interface() { return facets(operation<&Alarm::hear>("hear", "an overload")); }
};

// clang-format off
constexpr auto table = machine("instruments",
    components(component<Wires>("wires"), component<Alarm>("alarm"),
               component<Encoder<"m", 16>>("encoder", set("counts_per_unit", -1000.0)),
               component<AnalogInput<"bar">>("pressure", set("high", 16.0)),
               component<ForceSensor>("cell", set("most", 1000.0)),
               component<VelocityAxis<"m/s">>("axis", set("most", 0.5)),
               component<AnalogOutput<"bar">>("valve", set("low", 1.0), set("high", 9.0))),
    activities(activity("loop", every(1ms), budget(50us), runs("wires", "encoder", "pressure", "cell", "axis", "valve", "alarm"))),
    connections(
        data("wires.counts", "encoder.counts", stale_after(5ms), hold), data("wires.current", "pressure.raw", stale_after(5ms), hold),
        data("wires.newtons", "cell.measured", stale_after(5ms), hold), data("wires.wanted_velocity", "axis.wanted"),
        data("wires.wanted_pressure", "valve.value"),
        data("axis.velocity", "wires.velocity", delayed),               data("valve.raw", "wires.raw", delayed)),
    reactions(when("cell.overloaded", call("alarm.hear"))), behaviours());
// clang-format on

struct Instruments : test::MachineRig<table> {
    Instruments() {
        EXPECT_TRUE(instance.configure({}));
        pass(0ms);
    }
    template <class T>
    T& of(std::string_view name) {
        return *instance.find<T>(name);
    }
    Wires& wires() { return of<Wires>("wires"); }
    void pass(Duration time = 2ms) { run(time); }
    /// Sets the value from now on, and runs a cycle.
    template <class T> void give(T& what, std::type_identity_t<T> value, Duration time = 2ms) {
        what = value;
        pass(time);
    }
};

TEST_F(Instruments, an_encoder_follows_its_register_across_wraps_in_both_directions) {
    SimulatedEncoder<16> scale{-1000.0};
    auto& encoder = of<Encoder<"m", 16>>("encoder");
    Random random{1};
    double place = 0.0;
    for (int i = 0; i < 2000; ++i) {
        place += 40.0 * (random.unit() - 0.45); // less than 32.768 m in a step, with a drift over time
        give(wires().register_now, scale.count(place), 1ms);
        ASSERT_NEAR(encoder.position.last(), place, 1.1e-3) << "step " << i;
    }
    EXPECT_GT(std::abs(place), 300.0) << "the register went round";
    EXPECT_TRUE(encoder.good.last());
}

TEST_F(Instruments, a_silent_encoder_keeps_its_position_and_resumes_from_its_register) {
    auto& encoder = of<Encoder<"m", 16>>("encoder");
    wires().register_now = 0xffff; // -1
    pass();
    EXPECT_DOUBLE_EQ(encoder.position.last(), 0.001);
    give(wires().is_silent, true, 20ms);
    EXPECT_FALSE(encoder.good.last());
    EXPECT_DOUBLE_EQ(encoder.position.last(), 0.001);
    wires().is_silent = false;
    give(wires().register_now, 500);
    EXPECT_TRUE(encoder.good.last());
    EXPECT_DOUBLE_EQ(encoder.position.last(), -0.5);
}

TEST_F(Instruments, an_encoder_shows_its_counts_despite_slip_and_lost_pulses) {
    SimulatedEncoder<16> scale{-1000.0};
    auto& encoder = of<Encoder<"m", 16>>("encoder");
    scale.slip(-100);
    give(wires().register_now, scale.count(1.0));
    EXPECT_DOUBLE_EQ(encoder.position.last(), 1.1);
    scale.stick(true);
    give(wires().register_now, scale.count(5.0));
    EXPECT_DOUBLE_EQ(encoder.position.last(), 1.1);
}

TEST_F(Instruments, an_analog_input_scales_its_value_and_detects_a_broken_wire) {
    SimulatedTransmitter transmitter{{4.0, 20.0, 0.0, 16.0}};
    auto& pressure = of<AnalogInput<"bar">>("pressure");
    for (const double bar : {0.0, 3.5, 16.0}) {
        give(wires().current_now, transmitter.raw(bar));
        EXPECT_NEAR(pressure.value.last(), bar, 1e-12);
        EXPECT_TRUE(pressure.good.last());
    }
    give(wires().current_now, transmitter.raw(40.0));
    EXPECT_TRUE(pressure.good.last()) << "a transmitter stays below the current that means failure";
    const double before = pressure.value.last();
    transmitter.break_wire(true);
    give(wires().current_now, transmitter.raw(3.0));
    EXPECT_FALSE(pressure.good.last());
    EXPECT_EQ(pressure.value.last(), before) << "it is no pressure below nought";
    give(wires().current_now, std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(pressure.good.last());
    transmitter.break_wire(false);
    give(wires().current_now, transmitter.raw(3.0));
    EXPECT_TRUE(pressure.good.last());
    give(wires().is_silent, true, 20ms);
    EXPECT_FALSE(pressure.good.last());
}

TEST(AnAnalogScale, applies_the_limits_of_NE_43) {
    constexpr AnalogScale scale{4.0, 20.0, 0.0, 10.0};
    for (const double good : {3.6, 4.0, 20.5, 21.0}) EXPECT_TRUE(scale.is_alive(good)) << good;
    for (const double bad : {0.0, 3.59, 21.01}) EXPECT_FALSE(scale.is_alive(bad)) << bad;
    constexpr AnalogScale falling{10.0, 0.0, 0.0, 100.0};
    EXPECT_DOUBLE_EQ(falling.value(2.5), 75.0);
    EXPECT_DOUBLE_EQ(falling.raw(75.0), 2.5);
}

TEST_F(Instruments, a_force_sensor_subtracts_its_tare_and_reports_an_overload_once) {
    auto& cell = of<ForceSensor>("cell");
    auto& alarm = of<Alarm>("alarm");
    give(wires().newtons_now, 15.0);
    cell.tare();
    give(wires().newtons_now, 115.0);
    EXPECT_DOUBLE_EQ(cell.force.last(), 100.0);
    cell.tare();
    cell.tare();
    pass();
    EXPECT_DOUBLE_EQ(cell.force.last(), 0.0) << "twice in one cycle is once";
    give(wires().newtons_now, 15.0);
    cell.tare();
    give(wires().newtons_now, -1200.0, 5ms);
    EXPECT_EQ(alarm.times, 1);
    EXPECT_DOUBLE_EQ(alarm.heard, -1200.0);
    give(wires().newtons_now, 0.0);
    give(wires().newtons_now, 1200.0);
    EXPECT_EQ(alarm.times, 2);
    give(wires().newtons_now, std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(cell.good.last());
    EXPECT_DOUBLE_EQ(cell.force.last(), 1185.0);
    cell.tare();
    give(wires().newtons_now, 15.0);
    EXPECT_DOUBLE_EQ(cell.force.last(), 0.0) << "what is not good is no tare";
}

TEST_F(Instruments, a_value_that_is_not_finite_is_never_good) {
    auto& cell = of<ForceSensor>("cell");
    give(wires().newtons_now, 1.7e308);
    cell.tare();
    give(wires().newtons_now, -1.7e308);
    EXPECT_FALSE(cell.good.last());
    EXPECT_EQ(cell.force.last(), 1.7e308) << "the last one stays";
    EXPECT_EQ(of<Alarm>("alarm").times, 1) << "it is an overload all the same";
    give(wires().newtons_now, 20.0);
    EXPECT_TRUE(cell.good.last()) << "less the tare it is a number again";
    cell.tare();
    pass();
    EXPECT_EQ(cell.force.last(), 0.0);

    auto& encoder = of<Encoder<"m", 16>>("encoder");
    give(wires().register_now, 500);
    for (const double none : {1e-320, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
        encoder.counts_per_unit.set(none); // no proposal with this value is accepted
        wires().register_now += 100;
        pass();
        EXPECT_FALSE(encoder.good.last()) << none;
        EXPECT_EQ(encoder.position.last(), -0.5) << none;
    }
    encoder.counts_per_unit.set(-1000.0);
    wires().register_now += 100;
    pass();
    EXPECT_TRUE(encoder.good.last());
    EXPECT_EQ(encoder.position.last(), -0.9);
}

TEST_F(Instruments, an_encoder_refuses_impossible_counts_per_unit) {
    auto& encoder = of<Encoder<"m", 16>>("encoder");
    PropertyTransaction transaction;
    const auto proposed = [&](double counts) {
        transaction.begin("encoder", component_type<Encoder<"m", 16>>, &encoder);
        for (std::size_t f = 0; f < component_type<Encoder<"m", 16>>.facets.size(); ++f)
            if (const Facet& each = component_type<Encoder<"m", 16>>.facets[f];
                each.name == "counts_per_unit")
                each.property->set(transaction.change(f), {.real = counts});
        transaction.commit();
        return std::string{transaction.refusal().view()};
    };
    for (const double none : {0.0, 1e-300, -1e-300, 0.9e-9})
        EXPECT_EQ(proposed(none), "less than 1e-9 counts for a unit: no encoder is so coarse; write how many "
                                  "there are")
            << none;
    for (const double good : {1e-9, -4096.0, 1e12}) EXPECT_EQ(proposed(good), "") << good;
}

TEST_F(Instruments, an_axis_and_an_analog_output_limit_their_values) {
    struct Case {
        double wanted, sent;
    };
    constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
    constexpr double endless = std::numeric_limits<double>::infinity();
    for (const auto& [wanted, sent] : {Case{0.3, 0.3}, Case{2.0, 0.5}, Case{-2.0, -0.5}, Case{no_number, 0.0},
                                       Case{endless, 0.0}, Case{-endless, 0.0}}) {
        give(wires().velocity_now, wanted);
        EXPECT_EQ(wires().velocity.get(), sent) << wanted;
    }
    for (const auto& [wanted, sent] :
         {Case{5.0, 12.0}, Case{90.0, 20.0}, Case{-3.0, 4.0}, Case{no_number, 4.0}, Case{endless, 4.0}}) {
        give(wires().pressure_now, wanted);
        EXPECT_DOUBLE_EQ(wires().raw.get(), sent) << wanted;
    }
    wires().velocity_now = 0.3, wires().pressure_now = 5.0;
    pass();
    world.stop();
    EXPECT_EQ(of<VelocityAxis<"m/s">>("axis").velocity.last(), 0.0);
    EXPECT_EQ(of<AnalogOutput<"bar">>("valve").raw.last(), 4.0) << "its low end";
}

} // namespace
} // namespace tappet
