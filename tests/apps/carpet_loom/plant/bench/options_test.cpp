// The command line of the bench's plant: what is right is taken, what is wrong is named.
#include "apps/carpet_loom/plant/bench/options.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tappet::loom {
namespace {

std::expected<Options, std::string> parse(std::vector<const char*> words) {
    words.insert(words.begin(), "carpet-loom-plant");
    return parse_options(static_cast<int>(words.size()), words.data());
}

TEST(Options, take_faults_by_pick_and_by_time) {
    const auto options =
        parse({"--seed", "7", "--picks", "200", "--weft-break-at", "40", "--oil-lost-at", "20s/500ms",
               "--node-lost-at", "3s/2s:3", "--stop-modbus-at", "20s/10s", "--die-at", "90s"});
    ASSERT_TRUE(options) << options.error();
    EXPECT_EQ(options->seed, 7U);
    EXPECT_EQ(options->settings.last_pick, 200U);
    ASSERT_EQ(options->settings.script.size(), 3U);
    EXPECT_EQ(options->settings.script[0], (ScriptedFault{.fault = Fault::weft_break, .at_pick = 40}));
    EXPECT_EQ(options->settings.script[1],
              (ScriptedFault{.fault = Fault::oil_lost, .at = Time{} + 20s, .lasts = 500ms}));
    EXPECT_EQ(options->settings.script[2],
              (ScriptedFault{.fault = Fault::node_lost, .at = Time{} + 3s, .lasts = 2s, .node = 3}));
    EXPECT_EQ(options->modbus_stop.at, 20s);
    EXPECT_EQ(options->modbus_stop.lasts, 10s);
    EXPECT_EQ(options->die_at, 90s);
}

TEST(Options, that_are_wrong_are_refused_by_name) {
    const std::vector<std::vector<const char*>> wrong{{"--sede", "1"},
                                                      {"--seed"},
                                                      {"--seed", "x"},
                                                      {"--seed", "-1"},
                                                      {"--seed", ""},
                                                      {"--period", "1us"},
                                                      {"--period", "20"},
                                                      {"--modbus-port", "65536"},
                                                      {"--fifo", "99"},
                                                      {"--weft-break-at", "40x"},
                                                      {"--weft-break-at", "4:1"},
                                                      {"--node-lost-at", "3s"},
                                                      {"--node-lost-at", "3s:0"},
                                                      {"--node-lost-at", "3s:7"},
                                                      {"--drive-fault-at", "3s:3"},
                                                      {"--stop-modbus-at", "20s"},
                                                      {"--die-at", "99999999999999999999s"}};
    for (const auto& words : wrong) {
        const auto options = parse(words);
        ASSERT_FALSE(options) << words[0];
        EXPECT_NE(options.error().find(words[0]), std::string::npos) << options.error();
        EXPECT_NE(options.error().find("--help"), std::string::npos) << options.error();
    }
}

TEST(Options, hold_no_more_faults_than_a_script) {
    std::vector<const char*> words;
    for (std::size_t i = 0; i <= decltype(Settings::script)::capacity(); ++i)
        words.insert(words.end(), {"--weft-break-at", "5"});
    EXPECT_FALSE(parse(words));
}

} // namespace
} // namespace tappet::loom
