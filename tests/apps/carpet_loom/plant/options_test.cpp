// The options of a simulated loom: right ones are accepted, wrong ones are refused, and other words are not
// its own.
#include "apps/carpet_loom/plant/options.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tappet::loom {
namespace {

enum class Taken { right, wrong, unknown };

Taken take(std::string_view word, std::string_view value, Settings& settings) {
    bool known = false;
    const bool right = read_option(word, value, settings, known);
    return !known ? Taken::unknown : right ? Taken::right : Taken::wrong;
}

TEST(Options, take_faults_by_pick_and_by_time) {
    Settings settings;
    for (const auto& [word, value] :
         std::vector<std::pair<const char*, const char*>>{{"--picks", "200"},
                                                          {"--weft-break-at", "40"},
                                                          {"--oil-lost-at", "20s/500ms"},
                                                          {"--node-lost-at", "3s/2s:3"},
                                                          {"--edge-burst-at", "20s"}})
        EXPECT_EQ(take(word, value, settings), Taken::right) << word;
    EXPECT_EQ(settings.last_pick, 200U);
    ASSERT_EQ(settings.script.size(), 3U);
    EXPECT_EQ(settings.script[0], (ScriptedFault{.fault = Fault::weft_break, .at_pick = 40}));
    EXPECT_EQ(settings.script[1],
              (ScriptedFault{.fault = Fault::oil_lost, .at = Time{} + 20s, .lasts = 500ms}));
    EXPECT_EQ(settings.script[2],
              (ScriptedFault{.fault = Fault::node_lost, .at = Time{} + 3s, .lasts = 2s, .node = 3}));
    EXPECT_EQ(settings.edge_burst_at, 20s);
}

TEST(Options, distinguish_a_wrong_value_from_an_unknown_option) {
    Settings settings;
    for (const auto& [word, value] :
         std::vector<std::pair<const char*, const char*>>{{"--picks", "x"},
                                                          {"--picks", "0"},
                                                          {"--picks", "-1"},
                                                          {"--picks", ""},
                                                          {"--weft-break-at", "40x"},
                                                          {"--weft-break-at", "4:1"},
                                                          {"--node-lost-at", "3s"},
                                                          {"--node-lost-at", "3s:0"},
                                                          {"--node-lost-at", "3s:7"},
                                                          {"--drive-fault-at", "3s:3"},
                                                          {"--edge-burst-at", "99999999999999999999s"}})
        EXPECT_EQ(take(word, value, settings), Taken::wrong) << word << " " << value;
    EXPECT_EQ(take("--weft-brake-at", "40", settings), Taken::unknown);
}

TEST(Options, accept_no_more_faults_than_a_script_holds) {
    Settings settings;
    for (std::size_t i = 0; i < decltype(Settings::script)::capacity(); ++i)
        ASSERT_EQ(take("--weft-break-at", "5", settings), Taken::right);
    EXPECT_EQ(take("--weft-break-at", "5", settings), Taken::wrong);
}

} // namespace
} // namespace tappet::loom
