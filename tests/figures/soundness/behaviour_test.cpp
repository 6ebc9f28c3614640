// Behaviours in all their forms count the same, and are measured beside switches written by hand and peers.
#include "tests/figures/soundness/smoke.hpp"

#include <algorithm>

namespace tappet::figures {
namespace {

TEST(BehaviourFigures, stand_beside_switches_by_hand_and_judge_each_goal) {
    const Result result = run_smoke(TAPPET_PROGRAM); // fails where two forms count differently
    expect_sound(result);
    for (const char* id : {"behaviour.event.random", "behaviour.event.steady", "behaviour.step",
                           "behaviour.condition", "behaviour.timeout", "behaviour.statement"}) {
        const auto found = std::ranges::find(result.figures, id, &Figure::id);
        ASSERT_NE(found, result.figures.end()) << id;
        EXPECT_GT(std::ranges::count(found->rows, Standing::floor, &Row::role), 0) << id;
    }
    EXPECT_EQ(result.goals.size(), 4u);
}

} // namespace
} // namespace tappet::figures
