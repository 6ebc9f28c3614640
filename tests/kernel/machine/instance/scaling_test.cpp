// Values that a row scales: one multiplication between two units, within an activity and across.
#include "tests/kernel/machine/virtual_rig.hpp"

#include <Eigen/Core>

#include <limits>
#include <string>

namespace tappet {
namespace {

struct Pump {
    Output<double> flow;
    Output<float> pressure;
    double litres = 0;
    bool stands = false;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (stands) return;
        flow.write(litres);
        pressure.write(static_cast<float>(litres));
    }
    static constexpr auto interface() {
        return facets(output<&Pump::flow>("flow", "l/min", "delivered"),
                      output<&Pump::pressure>("pressure", "", "raw, of the sensor"));
    }
};

struct Dosing {
    Input<double> flow;
    Input<float> pressure;
    double seen = -1;
    float bar = -1;
    Flow how = Flow::stale;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        how = flow.read(seen);
        bar = pressure.get();
    }
    static constexpr auto interface() {
        return facets(input<&Dosing::flow>("flow", "ml/s", "arriving"),
                      input<&Dosing::pressure>("pressure", "bar", "of the pump"));
    }
};

// clang-format off
inline constexpr auto table = machine("pumps",
    components(component<Pump>("pump"), component<Dosing>("near"), component<Dosing>("far")),
    activities(activity("fast", every(1ms), budget(50us), runs("pump", "near")),
               activity("slow", every(4ms), budget(50us), runs("far"))),
    connections(
        data("pump.flow",     "near.flow",     converted),
        data("pump.flow",     "far.flow",      converted, stale_after(20ms), substitute(5.0), initially(7.0)),
        data("pump.pressure", "near.pressure", scaled(0.25)),
        data("pump.pressure", "far.pressure",  scaled(0.5))),
    reactions(), behaviours());
// clang-format on

struct Scaling : testing::Test, RunningRig<table> {
    Pump& pump = the<Pump>("pump");
    Dosing& near = the<Dosing>("near");
    Dosing& far = the<Dosing>("far");
};

TEST_F(Scaling, converts_values_to_the_readers_unit_within_and_across_activities) {
    pump.litres = 6;
    run(20ms);
    EXPECT_DOUBLE_EQ(near.seen, 100.0) << "6 l/min are 100 ml/s, in the writer's own cycle";
    EXPECT_EQ(near.how, Flow::fresh);
    EXPECT_DOUBLE_EQ(far.seen, 100.0);
    EXPECT_EQ(near.bar, 1.5F);
    EXPECT_EQ(far.bar, 3.0F) << "each row has its own factor";
    EXPECT_EQ(pump.flow.last(), 6.0) << "the writer's value is its own";
    pump.litres = -12;
    run(20ms);
    EXPECT_DOUBLE_EQ(near.seen, -200.0);
    EXPECT_DOUBLE_EQ(far.seen, -200.0);
}

TEST_F(Scaling, leaves_row_values_in_the_readers_unit) {
    pump.stands = true;
    run(8ms);
    EXPECT_EQ(far.seen, 7.0) << "before the first value";
    pump.stands = false;
    pump.litres = 6;
    run(8ms);
    EXPECT_DOUBLE_EQ(far.seen, 100.0);
    pump.stands = true;
    run(40ms);
    EXPECT_EQ(far.how, Flow::stale);
    EXPECT_EQ(far.seen, 5.0) << "the substitute";
    EXPECT_DOUBLE_EQ(near.seen, 100.0) << "the old value is scaled once, however often it is read";
}

/// A value known only at program start, so that the compiler cannot fold it.
const Eigen::Vector3d parked{0.0, std::numeric_limits<double>::quiet_NaN(), 1.0};
const Eigen::Vector3d aloft{0.0, 0.0, 1.0};

struct Crane {
    Output<Eigen::Vector3d> hook;
    Input<Eigen::Vector3d> above;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(output<&Crane::hook>("hook", "m", "where it hangs"),
                      input<&Crane::above>("above", "m", "where the other one does", optional));
    }
};

template <const Eigen::Vector3d& substituted, const Eigen::Vector3d& at_first>
inline constexpr auto cranes =
    machine("cranes", components(component<Crane>("near"), component<Crane>("far")),
            activities(activity("all", every(1ms), budget(50us), runs("near", "far"))),
            connections(data("near.hook", "far.above", stale_after(4ms), substitute<substituted>(),
                             initially<at_first>())),
            reactions(), behaviours());

template <const auto& table>
std::string begin() {
    const auto configured = PlacedRig<table>{}.instance.configure({});
    return configured ? "" : std::string{configured.error().view()};
}

TEST(ConstantOfARow, is_refused_at_start_when_it_is_not_a_number) {
    EXPECT_EQ((begin<cranes<aloft, aloft>>()), "");
    EXPECT_EQ((begin<cranes<parked, aloft>>()), "connection \"near.hook\" -> \"far.above\": the value in "
                                                "substitute is not a finite number; write a finite one");
    EXPECT_EQ((begin<cranes<aloft, parked>>()), "connection \"near.hook\" -> \"far.above\": the value in "
                                                "initially is not a finite number; write a finite one");
}

} // namespace
} // namespace tappet
