// Without a boot the program says that nothing was measured, and claims nothing.
#include "tests/figures/soundness/smoke.hpp"

namespace tappet::figures {
namespace {

TEST(BenchFigures, claim_nothing_where_nothing_was_booted) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    EXPECT_EQ(result.program, "bench");
    EXPECT_TRUE(result.figures.empty());
    EXPECT_TRUE(result.statements.empty());
    ASSERT_EQ(result.notes.size(), 1u);
    EXPECT_EQ(result.notes.front(), "nothing was booted in this setting");
}

} // namespace
} // namespace tappet::figures
