// What crosses the wire is measured beside a bare program that was found to do the same.
#include "tests/figures/soundness/smoke.hpp"

#include <algorithm>

namespace tappet::figures {
namespace {

TEST(WireFigures, stand_beside_a_bare_program_and_judge_each_goal) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    expect_sound(result);
    for (const char* id : {"wire.value.tell", "wire.value.hear", "wire.event"}) {
        const auto found = std::ranges::find(result.figures, id, &Figure::id);
        ASSERT_NE(found, result.figures.end()) << id;
        EXPECT_GT(std::ranges::count(found->rows, Standing::floor, &Row::role), 0) << id;
    }
    EXPECT_EQ(result.goals.size(), 3u);
}

} // namespace
} // namespace tappet::figures
