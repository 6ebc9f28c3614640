// Both robots' firmwares with their plants in one box: one moves the body, the other one operates on it,
// under loops of 500 Hz that meet their deadlines while values are recorded and users watch (thesis 3.4.3,
// 3.4.5).
#include "tests/bench/processes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <sstream>

namespace tappet::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

const Browser k160{"k160"}, k361{"k361"};

/// One pair of robots for all tests; each continues where the previous one ended, and the last one ends them.
class Robots : public testing::Test {
protected:
    static constexpr const char* recording = "/tmp/operation.mcap";

    static void SetUpTestSuite() {
        body_plant.emplace("k160-plant --joints-to 5006");
        tool_plant.emplace("k361-plant --body-at 5006");
        std::this_thread::sleep_for(300ms);
        body.emplace("k160 --no-guardian --summary /tmp/k160.json"); // the watchdog is the other one's
        are_armed = body->says("armed on board \"bench\"");
        tool.emplace("k361 --summary /tmp/k361.json");
        are_armed &= tool->says("armed on board \"bench\"");
    }
    static void TearDownTestSuite() {
        tool.reset();
        body.reset();
        tool_plant.reset();
        body_plant.reset();
    }
    void SetUp() override { ASSERT_TRUE(are_armed) << body->output() << tool->output(); }

    /// A number that each activity of both counts, by machine and name.
    static std::map<std::string, std::uint64_t> counted(const char* what) {
        std::map<std::string, std::uint64_t> found;
        for (const auto& [name, machine] : {std::pair{"k160 ", &k160}, {"k361 ", &k361}}) {
            std::istringstream lines{machine->run({"info", "--json"}).text};
            for (std::string line; std::getline(lines, line);)
                if (const auto json = nlohmann::json::parse(line, nullptr, false); json.contains("activity"))
                    found[name + json["activity"].get<std::string>()] = json[what].get<std::uint64_t>();
        }
        return found;
    }
    static std::chrono::nanoseconds time_of(const std::string& name) {
        const auto json = nlohmann::json::parse(k361.run({"get", name, "--json"}).text, nullptr, false);
        const std::string text = json.value("value", "0s");
        std::size_t end = 0;
        const long long number = std::stoll(text, &end);
        const std::string unit = text.substr(end);
        const long long of_unit = unit == "ns"   ? 1
                                  : unit == "us" ? 1'000
                                  : unit == "ms" ? 1'000'000
                                                 : 1'000'000'000;
        return std::chrono::nanoseconds{number * of_unit};
    }

    static inline std::optional<Foreign> body_plant, tool_plant, body, tool;
    static inline bool are_armed = false;
};

TEST_F(Robots, meet_their_deadlines_while_recorded_and_observed) {
    Foreign recorder{"tappet-browse --socket " + k361.socket() + " report start " + recording};
    Foreign looker{"tappet-browse --socket " + k160.socket() + " watch joints drives robot --every 20ms"};
    Foreign other{"tappet-browse --socket " + k361.socket() + " watch joints drives replay --every 20ms"};
    ASSERT_TRUE(recorder.says("records"));
    ASSERT_TRUE(looker.says("joints"));
    ASSERT_TRUE(other.says("joints"));
    const auto before = counted("misses");
    const auto cycles = counted("cycles");
    ASSERT_TRUE(before.contains("k160 loop") && before.contains("k361 tool"));
    std::this_thread::sleep_for(6s);
    EXPECT_EQ(counted("misses"), before);
    for (const char* loop : {"k160 loop", "k361 loop", "k361 tool"})
        EXPECT_GE(counted("cycles").at(loop) - cycles.at(loop), 3000u) << loop << ": 500 Hz";
    EXPECT_THAT(k160.run({"behaviour", "list", "robot"}).text, Not(HasSubstr("Faulted")));
    EXPECT_EQ(k361.run({"report", "stop", recording}).code, 0);
    EXPECT_EQ(recorder.wait(), 0) << recorder.output();
    EXPECT_THAT(recorder.output(), Not(HasSubstr("overwritten"))) << "all of it was read in time";
    const Outcome table = k361.run({"report", "convert", recording, "/tmp/operation.csv"});
    EXPECT_EQ(table.code, 0) << table.text;
}

/// Both use the clock of one box, so the true offset is zero.
TEST_F(Robots, know_the_offset_of_each_others_clock) {
    const auto ahead = time_of("body_clock.ahead"), error = time_of("body_clock.error");
    EXPECT_LE(std::abs(ahead.count()), error.count());
    EXPECT_GT(error, 0ns);
    EXPECT_LT(error, 5ms);
    EXPECT_GT(k160.value_of("time.answers"), 20.0);
}

TEST_F(Robots, reload_their_states_at_run_time) {
    const auto states = [] { return k160.run({"behaviour", "list", "robot"}).text; };
    EXPECT_THAT(states(), HasSubstr("body_robot.osd"));
    EXPECT_EQ(k160.run({"behaviour", "unload", "robot"}).code, 0);
    EXPECT_TRUE(soon([&] { return states().find("slot of robot: empty") != std::string::npos; })) << states();
    const Outcome loaded = k160.run({"behaviour", "load", "/bin/body_robot.osd", "robot"});
    EXPECT_EQ(loaded.code, 0) << loaded.text;
    EXPECT_TRUE(soon([&] { return states().find("trial, body_robot.osd") != std::string::npos; }))
        << states();
    EXPECT_THAT(states(), HasSubstr("Off"));
}

TEST_F(Robots, end_on_request) {
    tool->signal(SIGTERM);
    EXPECT_EQ(tool->wait(), 0) << tool->output();
    body->signal(SIGTERM);
    EXPECT_EQ(body->wait(), 0) << body->output();
    EXPECT_THAT(tool->output(), HasSubstr("k361: stopped: requested from outside"));
    EXPECT_THAT(body->output(), HasSubstr("k160: stopped: requested from outside"));
    for (const char* machine : {"/tmp/k160.json", "/tmp/k361.json"}) {
        EXPECT_EQ(number_in(content_of(machine), "heap_allocations_after_arming"), 0) << machine;
        EXPECT_EQ(number_in(content_of(machine), "page_faults_after_arming"), 0) << machine;
    }
    for (const Foreign* each : {&*tool, &*body}) {
        std::istringstream lines{each->output()};
        for (std::string line; std::getline(lines, line);)
            if (line.find("missed its deadline") != std::string::npos) std::printf("%s\n", line.c_str());
    }
    tool_plant->signal(SIGTERM);
    tool_plant->wait();
    EXPECT_THAT(tool_plant->output(), HasSubstr("frames not sent 0, line failures 0"));
}

} // namespace
} // namespace tappet::bench
