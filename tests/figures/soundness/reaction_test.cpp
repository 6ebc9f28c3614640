// The reaction path is measured beside its bare counterpart, and each claim is made.
#include "tests/figures/soundness/smoke.hpp"

namespace tappet::figures {
namespace {

TEST(ReactionFigures, stand_beside_bare_programs_and_judge_each_goal) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    if (!result.notes.empty() && result.notes.front().starts_with("the reaction path was not measured"))
        GTEST_SKIP() << result.notes.front();
    expect_sound(result);
    ASSERT_EQ(result.figures.size(), 3u);
    EXPECT_EQ(result.figures[0].id, "reaction.event.one_core");
    EXPECT_EQ(result.figures[1].id, "reaction.event.two_cores");
    EXPECT_EQ(result.figures[2].id, "reaction.periodic");
    for (const Figure& figure : result.figures) {
        EXPECT_EQ(figure.rows[0].role, Standing::ours);
        EXPECT_EQ(figure.rows[1].role, Standing::floor);
        EXPECT_EQ(figure.rows[0].summary.count, figure.rows[1].summary.count) << "samples come in pairs";
    }
    EXPECT_EQ(result.goals.size(), 4u);
    EXPECT_EQ(result.plots.size(), 3u);
}

} // namespace
} // namespace tappet::figures
