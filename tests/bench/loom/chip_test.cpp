// The GPIO chip is removed from a weaving loom, like an unplugged expander: the loom stops by the remaining
// wires, reports why, and does not spin.
#include "tests/bench/loom/loom_rig.hpp"

#include <array>
#include <filesystem>

namespace tappet::bench {
namespace {

/// Ticks of processor time used by all threads of the machine's process.
long processor_ticks(const Foreign& firmware) {
    std::ifstream stat{"/proc/" + std::to_string(machine_of(firmware)) + "/stat"};
    std::string word;
    std::array<long, 2> used{};
    for (int field = 1; stat >> word && field <= 15; ++field)
        if (field >= 14) used[static_cast<std::size_t>(field - 14)] = std::strtol(word.c_str(), nullptr, 10);
    return used[0] + used[1];
}

TEST(LoomChip, causes_an_emergency_stop_without_spinning_when_removed) {
    Loom loom;
    Foreign listener{listen_to_the_machine};
    ASSERT_TRUE(loom.weaves()) << loom.machine->output();
    loom.forget();
    const WallTime removed = wall_now();
    std::ofstream{"/sys/kernel/config/gpio-sim/io/live"} << 0;
    EXPECT_TRUE(loom.says("the loom goes to \"emergency\"")) << loom.since();
    EXPECT_TRUE(loom.says("state=emergency")) << loom.since();

    const long before = processor_ticks(*loom.machine);
    std::this_thread::sleep_for(2s);
    EXPECT_LT(processor_ticks(*loom.machine) - before, 100) << "half of two seconds, at 100 ticks a second";
    EXPECT_TRUE(loom.machine->runs());
    EXPECT_EQ(loom.end(), 4) << "nobody makes its lines safe; " << loom.machine->output();
    listener.signal(SIGINT);
    listener.wait();
    const auto frames = frames_of(listener.output());
    const auto stop = std::find_if(frames.begin(), frames.end(), [&](const Logged& f) {
        return f.id == wires::cob::main_drive_command && f.at > removed && (f.word() & 0x06u) == 0x02u;
    });
    ASSERT_NE(stop, frames.end()) << "the drive's quick stop";
    EXPECT_LT(stop->at - removed, 100ms);
    EXPECT_EQ(stop->target(), 0);
}

} // namespace
} // namespace tappet::bench
