// The bearing press replays a log of its own bus: a run at a customer's site repeats itself although the
// nodes of the bus are silent.
#include "toolchain/machine/test.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace bearing_press {
namespace {

struct ReplayedPress : testing::Test {
    ReplayedPress() { std::filesystem::create_directories(folder); }
    ~ReplayedPress() override { std::filesystem::remove_all(folder); }

    /// Long enough to seat a bearing.
    static constexpr Duration recorded = 6s;
    void record() {
        Plant plant{1};
        VirtualRun run{on_host(), plant, 1};
        run.devices().record_can(folder.string());
        ASSERT_TRUE(run.start());
        ASSERT_TRUE(run.run_for(recorded));
        ASSERT_GT(plant.worst_force(), 0.98 * Plant::seat_force);
        run.stop();
        ASSERT_TRUE(run.devices().close_logs([](const Sentence&, bool) {}));
    }
    CanReplay::Counts replay() {
        Plant plant{1};
        plant.silence_drive(); // nothing reads it, so this changes nothing
        VirtualRun run{on_host(), plant, 2};
        run.devices().replay_can("axis-can", log.string());
        const auto started = run.start();
        EXPECT_TRUE(started) << started.error().view();
        EXPECT_TRUE(run.run_until([&] { return run.devices().is_done(); }, 2 * recorded));
        run.stop();
        EXPECT_TRUE(run.devices().close_logs(
            [](const Sentence& what, bool good) { EXPECT_TRUE(good) << what.view(); }));
        const CanReplay::Counts counts = run.devices().replayed("axis-can");
        EXPECT_EQ(run.devices().bus("axis-can").frames_on_wire(),
                  counts.played + counts.equal + counts.different + counts.only_sent)
            << "and nothing of the plant's";
        return counts;
    }

    std::filesystem::path folder =
        std::filesystem::path{testing::TempDir()} / ("press." + std::to_string(getpid()));
    std::filesystem::path log = folder / "axis-can.log";
};

TEST_F(ReplayedPress, commands_its_drive_as_it_did_when_the_log_was_recorded) {
    record();
    const auto counts = replay();
    EXPECT_GT(counts.played, 11'000u);
    EXPECT_GT(counts.equal, 5'900u);
    EXPECT_EQ(counts.different, 0u);
    EXPECT_EQ(counts.unknown, 0u);
    EXPECT_LE(counts.only_in_log + counts.only_sent, 10u) << "the last moments, and the end's";
}

// The commands come from the log: the plant is the same.
TEST_F(ReplayedPress, commands_something_else_for_a_changed_log) {
    record();
    std::ifstream in{log};
    std::string text, line;
    while (std::getline(in, line)) {
        // 2 kN as soon as it presses; it stops at that force
        if (line.starts_with("(0000000004.") && line.find(" 182#") != line.npos)
            line.replace(line.find('#') + 1, 8, "400D0300");
        text += line + "\n";
    }
    std::ofstream{log} << text;
    const auto counts = replay();
    EXPECT_GT(counts.different, 100u);
    EXPECT_GE(counts.first_different, Time{4s});
}

} // namespace
} // namespace bearing_press
