// The demo shows a break of each kind, for any seed and any number of picks.
#include "apps/carpet_loom/demo/scenario.hpp"
#include "apps/carpet_loom/plant/options.hpp"
#include "tests/apps/carpet_loom/loom_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace tappet::demo {
namespace {

/// The demo's plant, on the host's loom.
loom::Report report_of(std::uint64_t picks, std::uint64_t seed) {
    const std::vector<std::string> words = troubles(picks);
    loom::Settings settings;
    for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
        bool known = false;
        EXPECT_TRUE(loom::read_option(words[i], words[i + 1], settings, known) || !known) << words[i];
    }
    settings.last_pick = picks;
    carpet::LoomRun run{settings, seed};
    EXPECT_TRUE(run.start());
    EXPECT_TRUE(run.weave(picks, 400s)) << "seed " << seed;
    const loom::Report report = run.plant().report();
    run.stop();
    return report;
}

TEST(TheDemo, shows_a_stop_of_each_kind_with_any_seed) {
    for (const std::uint64_t picks : {usual_picks, std::uint64_t{60}})
        for (std::uint64_t seed = usual_seed; seed < usual_seed + 5; ++seed) {
            const loom::Report report = report_of(picks, seed);
            const auto count = [&report](loom::StopCause cause) {
                return std::ranges::count_if(report.stops,
                                             [cause](const loom::Stop& stop) { return stop.cause == cause; });
            };
            EXPECT_GE(report.weft_breaks_injected, 1u) << "seed " << seed;
            EXPECT_GE(report.warp_breaks_injected, 1u) << "seed " << seed;
            for (const loom::StopCause cause :
                 {loom::StopCause::weft, loom::StopCause::warp, loom::StopCause::emergency})
                EXPECT_GE(count(cause), 1)
                    << "seed " << seed << ", " << picks << " picks, " << loom::name_of(cause);
            EXPECT_EQ(report.damage.total(), 0u) << "seed " << seed;
        }
}

} // namespace
} // namespace tappet::demo
