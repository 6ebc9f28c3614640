// The lane as five firmwares and a hall in one box, on one vcan: it works, a machine is killed and restarted
// meanwhile, and the belt stops within the proven time, measured on the wires.
//     lane_on_bench [KILLS]
#include "tests/bench/lane/facts.hpp"
#include "tests/bench/processes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>

namespace tappet::bench {
namespace {

using testing::HasSubstr;

const Browser conveyor{"conveyor"}, saw{"saw"}, drill{"drill"};
int kills = 4;
constexpr const char* names[] = {"conveyor", "saw", "drill", "polish", "glue"};

/// One lane for all cases; each continues where the previous one ended.
class Lane : public testing::Test {
protected:
    static void SetUpTestSuite() {
        hall.emplace("woodworking_lane-hall --report /tmp/hall.json");
        std::this_thread::sleep_for(300ms);
        for (std::size_t n = 0; n < 5; ++n) start(n);
    }
    static void TearDownTestSuite() {
        for (auto& each : machines) each.reset();
        hall.reset();
    }
    static void start(std::size_t n) {
        // The watchdog is the conveyor's.
        machines[n].emplace(std::string{"lane_"} + names[n] + (n == 0 ? "" : " --no-guardian"));
        are_armed = machines[n]->says("armed on board \"bench\"") && are_armed;
    }
    static bool runs() { return conveyor.run({"get", "belt.lamp"}).text.find("true") != std::string::npos; }
    static void acknowledge() { hall->signal(SIGUSR1); }
    void SetUp() override { ASSERT_TRUE(are_armed) << machines[0]->output() << machines[1]->output(); }

    static inline std::optional<Foreign> hall;
    static inline std::array<std::optional<Foreign>, 5> machines;
    static inline bool are_armed = true;
};

TEST_F(Lane, runs_once_every_machine_is_connected_and_acknowledged) {
    ASSERT_TRUE(soon(
        [] { return conveyor.run({"get", "lane.glue.is_there"}).text.find("true") != std::string::npos; }));
    EXPECT_FALSE(runs()) << "nothing moves before an acknowledgement";
    acknowledge();
    EXPECT_TRUE(soon([] { return runs(); }));
    EXPECT_TRUE(soon([] { return conveyor.value_of("belt.boards_in") >= 1; }, 10s));
}

/// The last time of a line with the identifier in candump's log; -1: never.
double last_of(const std::string& log, const std::string& identifier) {
    double at = -1;
    std::istringstream lines{log};
    for (std::string line; std::getline(lines, line);)
        if (line.find(" " + identifier + "#") != std::string::npos)
            at = std::strtod(line.c_str() + line.find('(') + 1, nullptr);
    return at;
}
/// The first time after `from` at which the drive is commanded to stand.
double told_to_stand(const std::string& log, double from) {
    std::istringstream lines{log};
    for (std::string line; std::getline(lines, line);)
        if (const double at = std::strtod(line.c_str() + line.find('(') + 1, nullptr);
            at >= from && line.find(" 201#0000") != std::string::npos)
            return at;
    return -1;
}

TEST_F(Lane, stops_within_the_proven_time_when_a_machine_is_killed) {
    const double proven = std::chrono::duration<double>(proven_stop_time()).count();
    std::vector<double> took_ms;
    for (int kill = 0; kill < kills; ++kill) {
        const std::size_t n = 1 + static_cast<std::size_t>(kill) % 4;
        Foreign logger{"candump -L can1 can2"};
        std::this_thread::sleep_for(300ms + std::chrono::milliseconds{37 * kill % 61});
        machines[n]->signal(SIGKILL);
        ASSERT_TRUE(soon([] { return !runs(); }));
        std::this_thread::sleep_for(100ms);
        const Outcome without = Browser{}.run({"list"});
        EXPECT_EQ(without.code, 3);
        EXPECT_THAT(without.text, HasSubstr("'" + std::string{names[n]} + "' does not answer"));
        logger.signal(SIGTERM);
        static_cast<void>(logger.wait());
        const std::string log = logger.output();
        std::array<char, 8> beat{};
        std::snprintf(beat.data(), beat.size(), "%03X", beat_of(n));
        const double sign_of_life = last_of(log, beat.data());
        ASSERT_GT(sign_of_life, 0.0) << beat.data() << "\n" << log.substr(0, 2000);
        const double stands = told_to_stand(log, sign_of_life);
        ASSERT_GT(stands, 0.0);
        took_ms.push_back(1000 * (stands - sign_of_life));
        std::printf("%s: the drive is told to stand %.1f ms after its last beat; proven %.1f ms\n", names[n],
                    took_ms.back(), 1000 * proven);
        // The drive's own frame leaves every 5 ms, on its own grid.
        EXPECT_LE(stands - sign_of_life, proven + 0.006);
        machines[n].reset();
        start(n);
        ASSERT_TRUE(are_armed);
        ASSERT_TRUE(soon([&] {
            return conveyor.run({"get", "lane." + std::string{names[n]} + ".is_there"}).text.find("true") !=
                   std::string::npos;
        }));
        EXPECT_FALSE(runs()) << "nothing moves before an acknowledgement";
        acknowledge();
        ASSERT_TRUE(soon([] { return runs(); }));
    }
    std::ranges::sort(took_ms);
    std::printf("%zu kills: %.1f ms at least, %.1f in the middle, %.1f at most; proven %.1f ms\n",
                took_ms.size(), took_ms.front(), took_ms[took_ms.size() / 2], took_ms.back(), 1000 * proven);
}

TEST_F(Lane, a_board_reaches_the_saw_and_is_processed) {
    EXPECT_TRUE(soon([] { return saw.value_of("station.boards_done") >= 1; }, 60s, 200ms));
    for (const char* name : {"lane.frames_refused", "lane.events_lost", "lane.beyond"})
        EXPECT_EQ(conveyor.value_of(name), 0.0) << name;
}

TEST_F(Lane, one_command_lists_and_addresses_all_machines) {
    const Outcome found = Browser{}.run({"list"});
    EXPECT_EQ(found.code, 0) << found.text;
    for (const char* name : names) EXPECT_THAT(found.text, HasSubstr(name));
    EXPECT_THAT(found.text, testing::Not(HasSubstr("NOT")));
    const Outcome values = Browser{}.run({"get", "saw.station.number", "glue.station.number"});
    EXPECT_EQ(values.text, "saw.station.number = 0\nglue.station.number = 3\n");
}

TEST_F(Lane, ends_on_request) {
    for (auto& each : machines) {
        each->signal(SIGTERM);
        EXPECT_EQ(each->wait(), 0) << each->output();
    }
    hall->signal(SIGTERM);
    EXPECT_EQ(hall->wait(), 0) << hall->output();
    const std::string report = content_of("/tmp/hall.json");
    EXPECT_EQ(number_in(report, "harmed"), 0.0) << report;
    EXPECT_GE(number_in(report, "works"), 1.0) << report;
}

} // namespace
} // namespace tappet::bench

int main(int count, char** words) {
    testing::InitGoogleMock(&count, words);
    if (count > 1) tappet::bench::kills = std::atoi(words[1]);
    if (tappet::bench::kills < 1) {
        std::fprintf(stderr, "usage: lane_on_bench [KILLS]: a number from 1 on\n");
        return 2;
    }
    return RUN_ALL_TESTS();
}
