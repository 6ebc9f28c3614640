// The condition of a box: read from a simulated kernel tree and shown by a machine.
#include "kernel/services/box/box.hpp"

#include "tests/kernel/machine/virtual_rig.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace tappet {
namespace {

namespace fs = std::filesystem;

struct MadeUpBox : testing::Test {
    fs::path root;
    MadeUpBox() {
        std::string pattern = testing::TempDir() + "tappet-box-XXXXXX";
        root = ::mkdtemp(pattern.data());
    }
    ~MadeUpBox() override { fs::remove_all(root); }
    void put(const std::string& file, const std::string& text) const {
        fs::create_directories((root / file).parent_path());
        std::ofstream{root / file} << text;
    }
};

TEST_F(MadeUpBox, reports_the_temperature_of_its_hottest_readable_sensor) {
    EXPECT_FALSE(os::hottest_celsius(root.native())) << "it has none";
    put("sys/class/thermal/thermal_zone0/temp", "41000\n");
    put("sys/class/thermal/thermal_zone3/temp", "57250\n");
    put("sys/class/thermal/thermal_zone4/temp", "broken\n");
    EXPECT_EQ(os::hottest_celsius(root.native()), 57.25);
    put("sys/class/thermal/thermal_zone0/temp", "-5000\n");
    fs::remove(root / "sys/class/thermal/thermal_zone3/temp");
    EXPECT_EQ(os::hottest_celsius(root.native()), -5.0);
}

TEST_F(MadeUpBox, is_guarded_while_its_watchdog_runs) {
    EXPECT_FALSE(os::watchdog_counts(root.native()));
    put("sys/class/watchdog/watchdog0/state", "inactive\n");
    EXPECT_FALSE(os::watchdog_counts(root.native()));
    put("sys/class/watchdog/watchdog0/state", "active\n");
    EXPECT_TRUE(os::watchdog_counts(root.native()));
}

TEST_F(MadeUpBox, reports_its_free_disk_space) {
    EXPECT_GT(os::free_megabytes(root.c_str()).value_or(0.0), 0.0);
    EXPECT_FALSE(os::free_megabytes((root / "nothing").c_str()));
}

struct Reader {
    Input<double> disk_free;
    Input<bool> watchdog;
    double seen = 0.0;
    void step(const Cycle&) noexcept TAPPET_REALTIME { static_cast<void>(disk_free.read(seen)); }
    static constexpr auto interface() {
        return facets(input<&Reader::disk_free>("disk_free", "MB", "left"),
                      input<&Reader::watchdog>("watchdog", "", "counts"));
    }
};
// clang-format off
constexpr auto table = machine("boxed",
    components(component<Box>("box", set("disk", "/")), component<Reader>("reader")),
    activities(activity("motion", every(1ms), budget(50us), runs("reader")),
               activity("slow", every(1s), not_real_time, runs("box"))),
    connections(data("box.disk_free", "reader.disk_free"), data("box.watchdog", "reader.watchdog")),
    reactions(), behaviours());
// clang-format on
constexpr Board board{.name = "host", .world = "host", .heap_bytes = 65536, .simulated = true};

TEST(Box, reports_its_condition_to_a_machine) {
    RunningRig<table, board> rig;
    EXPECT_TRUE(rig.run(2s));
    EXPECT_GT(rig.the<Reader>("reader").seen, 0.0);
    EXPECT_EQ(rig.the<Box>("box").watchdog.last(), os::watchdog_counts());
    rig.world.stop();
}

} // namespace
} // namespace tappet
