// Block waves as files: independent readers find exactly the recorded waves in them (thesis A.2.1).
#include "toolchain/tools/browser/waves.hpp"

#include "tests/toolchain/tools/browser/vcd_reader.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <random>

namespace tappet::browser {
namespace {

using Json = nlohmann::json;
using Random = std::mt19937_64;

std::int64_t below(Random& random, std::int64_t bound) {
    return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(bound));
}

/// Waves that a machine may have recorded: cycles of an activity never overlap, functions fill them in order.
Waves any_waves(std::uint64_t seed) {
    Random random{seed};
    Waves waves;
    waves.machine = "carpet-loom";
    waves.stamp_ns = below(random, 40);
    waves.activities = {{"motion", true, 1'000'000, {"network", "main-drive", "warp"}},
                        {"logic", true, 500, {"loom"}},
                        {"back ground", false, 0, {"2nd", "browser"}}};
    waves.from = 1'000'000'000'000 + below(random, 1'000'000);
    for (std::uint32_t a = 0; a < 3; ++a) {
        std::int64_t time = waves.from;
        const std::int64_t cycles = below(random, 40);
        for (std::int64_t n = 0; n < cycles; ++n) {
            WaveCycle cycle{a};
            cycle.release = time + 1 + below(random, 5000);
            cycle.begin = cycle.release + below(random, 3) * below(random, 400);
            time = cycle.begin;
            for (std::int64_t f = 1 + below(random, 6); f > 0; --f) {
                const auto function = static_cast<std::uint32_t>(
                    below(random, 4 * static_cast<std::int64_t>(waves.activities[a].components.size())));
                const std::int64_t end = time + 1 + below(random, 900);
                cycle.blocks.push_back({function, time, end});
                time = end + 1 + waves.stamp_ns;
            }
            cycle.end = time;
            waves.cycles.push_back(cycle);
        }
        waves.to = std::max(waves.to, time);
    }
    return waves;
}

class AnyWaves : public testing::TestWithParam<int> {
protected:
    std::uint64_t seed = std::random_device{}();
    Waves waves = any_waves(seed);
};

TEST_P(AnyWaves, as_vcd_have_a_pulse_for_each_cycle_and_function) {
    const VcdReader vcd{as_vcd(waves)};
    ASSERT_EQ(vcd.fault(), "") << "seed " << seed;
    EXPECT_EQ(vcd.timescale(), "1ns");
    const std::vector<std::vector<std::string>> names{
        {"network", "main_drive", "warp"}, {"loom"}, {"_2nd", "browser"}};
    const std::vector<std::string> activities{"motion", "logic", "back_ground"};
    std::map<std::string, std::vector<Pulse>> expected;
    for (const std::string& each : activities)
        expected["carpet_loom." + each + ".runs"], expected["carpet_loom." + each + ".due"];
    for (const WaveCycle& cycle : waves.cycles) {
        const std::string top = "carpet_loom." + activities[cycle.activity] + ".";
        expected[top + "runs"].push_back({cycle.begin - waves.from, cycle.end - waves.from});
        if (cycle.release != cycle.begin)
            expected[top + "due"].push_back({cycle.release - waves.from, cycle.begin - waves.from});
        for (const Block& block : cycle.blocks) {
            static const std::vector<std::string> kinds{"step", "timers", "reactions", "behaviour"};
            expected[top + names[cycle.activity][block.function / 4] + "." + kinds[block.function % 4]]
                .push_back({block.begin - waves.from, block.end - waves.from});
        }
    }
    EXPECT_EQ(vcd.pulses(), expected) << "seed " << seed;
    EXPECT_GE(vcd.end(), waves.to > 0 ? waves.to - waves.from : 0);
}

TEST_P(AnyWaves, as_a_trace_have_a_slice_for_each_cycle_and_function_inside_it) {
    const Json trace = Json::parse(as_trace(waves));
    EXPECT_EQ(trace.at("displayTimeUnit"), "ns");
    const std::int64_t zero = trace.at("otherData").at("zero_ns");
    std::map<std::int64_t, std::string> threads;
    std::vector<Json> slices;
    for (const Json& each : trace.at("traceEvents")) {
        if (each.at("ph") == "M" && each.at("name") == "thread_name")
            threads[each.at("tid")] = each.at("args").at("name");
        else if (each.at("ph") == "X")
            slices.push_back(each);
        else
            EXPECT_EQ(each.at("ph"), "M");
    }
    const auto ns = [](const Json& us) {
        return static_cast<std::int64_t>(std::llround(us.get<double>() * 1000));
    };
    std::size_t at = 0;
    for (const WaveCycle& cycle : waves.cycles) {
        ASSERT_LT(at, slices.size());
        const Json& whole = slices[at++];
        EXPECT_EQ(threads.at(whole.at("tid")), waves.activities[cycle.activity].name);
        EXPECT_EQ(whole.at("cat"), "cycle");
        EXPECT_EQ(zero + ns(whole.at("ts")), cycle.begin);
        EXPECT_EQ(ns(whole.at("dur")), cycle.end - cycle.begin);
        EXPECT_EQ(whole.at("args").at("response_ns"), cycle.response());
        const std::int64_t deadline = waves.activities[cycle.activity].deadline_ns;
        EXPECT_EQ(whole.at("args").contains("missed"), deadline > 0);
        EXPECT_EQ(whole.at("args").value("missed", false), deadline > 0 && cycle.response() > deadline);
        for (const Block& block : cycle.blocks) {
            ASSERT_LT(at, slices.size());
            const Json& part = slices[at++];
            EXPECT_EQ(part.at("tid"), whole.at("tid"));
            EXPECT_EQ(part.at("name"), waves.activities[cycle.activity].name_of(block.function));
            EXPECT_EQ(zero + ns(part.at("ts")), block.begin);
            EXPECT_EQ(ns(part.at("dur")), block.took());
            EXPECT_GE(ns(part.at("ts")), ns(whole.at("ts")));
            EXPECT_LE(ns(part.at("ts")) + ns(part.at("dur")), ns(whole.at("ts")) + ns(whole.at("dur")));
        }
    }
    EXPECT_EQ(at, slices.size()) << "seed " << seed;
}

INSTANTIATE_TEST_SUITE_P(Of, AnyWaves, testing::Range(0, 40));

TEST(VcdReader, finds_what_a_file_must_not_have) {
    const std::string head = "$timescale 1ns $end $scope module m $end $var wire 1 ! a $end $upscope $end "
                             "$enddefinitions $end #0 $dumpvars 0! $end ";
    EXPECT_EQ(VcdReader{head + "#5 1! #7 0!"}.fault(), "");
    EXPECT_NE(VcdReader{head + "#5 1!"}.fault(), "");
    EXPECT_NE(VcdReader{head + "#5 1! #4 0!"}.fault(), "");
    EXPECT_NE(VcdReader{head + "#5 1\""}.fault(), "");
    EXPECT_NE(VcdReader{head + "#5 0!"}.fault(), "");
}

} // namespace
} // namespace tappet::browser
