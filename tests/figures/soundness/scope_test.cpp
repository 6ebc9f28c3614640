// What recording costs is measured with it, without it and switched off; whether it is little is no test.
#include "tests/figures/soundness/smoke.hpp"

#include <algorithm>

namespace tappet::figures {
namespace {

TEST(ScopeFigures, stand_beside_a_step_that_records_nothing) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    expect_sound(result);
    for (const char* id : {"scope.step.1", "scope.step.10", "scope.step.timeless", "scope.mark", "scope.look",
                           "scope.followed"}) {
        const auto found = std::ranges::find(result.figures, id, &Figure::id);
        ASSERT_NE(found, result.figures.end()) << id;
        EXPECT_GT(std::ranges::count(found->rows, Standing::floor, &Row::role), 0) << id;
    }
    EXPECT_EQ(result.statements.size(), 6u);
}

} // namespace
} // namespace tappet::figures
