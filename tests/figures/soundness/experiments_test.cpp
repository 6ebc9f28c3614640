// All four applications run in all five settings for a moment, and every histogram of the thesis is there.
#include "tests/figures/soundness/smoke.hpp"

#include <algorithm>

namespace tappet::figures {
namespace {

TEST(ExperimentFigures, run_every_application_in_every_setting) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    expect_sound(result);
    for (const std::string application : {"minimal", "small", "concurrent", "large"})
        for (const char* what :
             {".period", ".period.data", ".period.events", ".latency", ".latency.data", ".exchange.high",
              ".command.send", ".command.serve", ".event.send", ".event.serve"})
            EXPECT_NE(std::ranges::find(result.figures, "experiments." + application + what, &Figure::id),
                      result.figures.end())
                << application << what;
    std::vector<std::string> plots;
    for (const Plot& plot : result.plots) plots.push_back(plot.id);
    for (const char* number : {"4.9.minimal", "4.9.large", "4.10.small", "4.14", "4.15", "4.17", "4.18",
                               "4.20", "4.21", "4.34", "4.35", "4.42", "4.43"})
        EXPECT_NE(std::ranges::find(plots, std::string{"experiments.figure."} + number), plots.end())
            << number;
    EXPECT_GE(result.statements.size(), 15u);
}

} // namespace
} // namespace tappet::figures
