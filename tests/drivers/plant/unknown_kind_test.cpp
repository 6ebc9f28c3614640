// A device of a kind that start-up does not list is refused, on a host and on a box.
#include "drivers/hardware/hardware.hpp"
#include "drivers/plant/simulation.hpp"
#include "kernel/machine/accept.hpp"
#include "tests/drivers/components/board.hpp"

#include <gtest/gtest.h>

namespace tappet::test {
namespace {

struct Scale {
    static constexpr DeviceKind device_kind{.name = "test.scale"};
    static constexpr int device_map = 0;
    Output<double> weight{};
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(output<&Scale::weight>("weight", "kg", "on it")); }
};
constexpr auto weighing = machine("weighing", components(component<Scale>("scale", device("belt-scale"))),
                                  activities(activity("scale", every(10ms), runs("scale"), budget(20us))),
                                  connections(), reactions(), behaviours());
constexpr Board box = [] {
    Board real = board;
    real.simulated = false;
    real.devices = board_devices(board_device("scale0", "test.scale", "/dev/null"));
    return real;
}();
constexpr Binding on_box = binding(wired("belt-scale", "scale0"));

constexpr std::string_view refusal(bool is_real) {
    return is_real ? "device \"belt-scale\" of component \"scale\" is of kind test.scale, for which "
                     "drivers/hardware/kinds.hpp has no class; add one, or write is_opened_by_driver = true "
                     "in its DeviceKind"
                   : "device \"belt-scale\" of component \"scale\" is of kind test.scale, for which "
                     "drivers/plant/simulated_kinds.hpp has no class; add one, or write is_opened_by_driver "
                     "= true in its DeviceKind";
}

struct Belt final : Plant {
    Time move(Time) override { return never; }
    std::span<const ProvidedDevice> devices() override { return own; }
    std::span<const ProvidedDevice> own{};
};

TEST(UnknownKind, is_refused_by_the_host_unless_the_plant_simulates_it) {
    Belt plant;
    SimulatedDevices devices{plant, 1};
    const auto machine = AtRunTime<weighing, board>::machine();
    const auto opened = devices.open(machine);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().view(), refusal(false));
    int scale = 0;
    const ProvidedDevice simulated{type_id<int>, "belt-scale", &scale};
    plant.own = {&simulated, 1};
    EXPECT_TRUE(devices.open(machine));
}

TEST(UnknownKind, is_refused_by_the_firmware) {
    Hardware<weighing> devices;
    const auto opened = devices.open(AtRunTime<weighing, box, on_box>::machine());
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().view(), refusal(true));
}

TEST(Kinds, say_whether_a_swarm_judges_them) {
    EXPECT_FALSE(SimulatedDevices::is_judged(weighing.view().components[0]));
}

} // namespace
} // namespace tappet::test
