// The lane in a browser: all its machines by the names of their system, whatever one of them does.
#include "apps/woodworking_lane/host/lane_run.hpp"
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/tools/browser/outcome.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <filesystem>
#include <thread>

namespace tappet::browser {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

/// Five machines in a thread of their own, at the pace of this host's clock.
class LaneBrowsed : public testing::Test {
protected:
    LaneBrowsed() { lane.system.browse_in(directory.string()); }
    void SetUp() override {
        const auto started = lane.start();
        ASSERT_TRUE(started) << started.error().view();
        runs = true;
        thread = std::thread{[this] {
            while (runs) {
                if (const std::size_t node = killed.exchange(none); node != none) lane.kill(node);
                lane.run_for(20ms);
            }
        }};
    }
    void TearDown() override {
        runs = false;
        if (thread.joinable()) thread.join();
        lane.system.stop();
    }
    Outcome run(std::vector<std::string> words, const std::string& patience = "10s") const {
        words.insert(words.begin(), {"--directory", directory.string(), "--timeout", patience});
        return run_words(words);
    }

    static constexpr std::size_t none = woodworking::node_count;
    test::Folder directory;
    woodworking::LaneRun lane{1, 1000};
    std::atomic<bool> runs{false};
    std::atomic<std::size_t> killed{none};
    std::thread thread;
};

TEST_F(LaneBrowsed, shows_all_machines_and_continues_when_one_is_gone) {
    const Outcome all = run({"list"});
    EXPECT_EQ(all.code, 0) << all.errors;
    EXPECT_THAT(all.out,
                AllOf(ContainsRegex("conveyor +on host, process [0-9]+; belt.belt_states in running; hears "
                                    "saw, drill, polish, glue\n"),
                      ContainsRegex("saw +on host")));
    EXPECT_THAT(run({"get", "saw.station.number", "glue.station.number", "conveyor.belt.position"}).out,
                ContainsRegex("^saw.station.number = 0\nglue.station.number = 3\nconveyor.belt.position = "));
    EXPECT_EQ(run({"set", "glue.station.number", "4"}).code, 0);
    EXPECT_EQ(run({"get", "glue.station.number"}).out, "glue.station.number = 4\n");

    killed = 2; // the drill
    Outcome without;
    for (int i = 0; i < 100; ++i)
        if (without = run({"list"}, "1s"); without.out.find("does NOT hear drill") != std::string::npos)
            break;
    EXPECT_EQ(without.code, 5);
    EXPECT_THAT(without.out, AllOf(ContainsRegex("drill +does not answer\n"),
                                   ContainsRegex("saw +on host.*; does NOT hear drill")));
    EXPECT_THAT(without.errors, HasSubstr("'drill' does not answer: no answer within 1000 ms"));
    EXPECT_EQ(run({"get", "saw.station.number"}).out, "saw.station.number = 0\n");

    std::filesystem::remove(directory / "drill.socket");
    EXPECT_THAT(run({"list"}).out,
                HasSubstr("has no socket in '" + directory.string() + "'; nobody hears it"));
    const Outcome asked = run({"get", "drill.station.number"});
    EXPECT_EQ(asked.code, 3);
    EXPECT_THAT(asked.errors, HasSubstr("'drill' is a node of this system, and has no socket in"));
    std::filesystem::remove(directory / "polish.socket");
    EXPECT_THAT(run({"list"}).out,
                ContainsRegex("polish +has no socket in .*; heard by conveyor, glue, saw"));
}

} // namespace
} // namespace tappet::browser
