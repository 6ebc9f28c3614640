// The firmware's size is that of a file that exists; without a boot nothing is said of its memory.
#include "tests/figures/soundness/smoke.hpp"

#include <gmock/gmock.h>

namespace tappet::figures {
namespace {

TEST(FirmwareFigures, without_a_boot_tell_the_size_alone) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    expect_sound(result);
    ASSERT_EQ(result.figures.size(), 1u);
    EXPECT_EQ(result.figures[0].id, "firmware.size");
    EXPECT_GT(result.figures[0].rows[0].summary.median, result.figures[0].rows[1].summary.median)
        << "a machine is larger than none";
    ASSERT_EQ(result.figures[0].rows.size(), 4u);
    ASSERT_EQ(result.goals.size(), 1u);
    EXPECT_EQ(result.goals[0].measured, result.figures[0].rows[0].summary.median);
    EXPECT_THAT(result.notes, testing::Contains("nothing was booted in this setting"));
}

} // namespace
} // namespace tappet::figures
