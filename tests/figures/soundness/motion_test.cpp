// The figures of motion are whole, their goals stand, and what is compared computes the same.
#include "tests/figures/soundness/smoke.hpp"

#include <vector>

namespace tappet::figures {
namespace {

TEST(MotionFigures, are_whole_and_compare_what_is_the_same) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    expect_sound(result);
    std::vector<std::string> ids;
    for (const Figure& figure : result.figures) ids.push_back(figure.id);
    EXPECT_EQ(ids, (std::vector<std::string>{"motion.kinematics", "motion.dynamics", "motion.inverse",
                                             "motion.cascade.robot", "motion.cascade.axis", "motion.sine",
                                             "motion.trajectory", "motion.control"}));
    std::vector<double> limits;
    for (const Goal& goal : result.goals) limits.push_back(goal.limit);
    EXPECT_EQ(limits, (std::vector<double>{0.25, 0.33, 1.2, 1.2, 100, 250}));
    ASSERT_EQ(result.statements.size(), 2u);
    for (const Statement& each : result.statements) EXPECT_TRUE(each.held) << each.text << each.measured;
}

} // namespace
} // namespace tappet::figures
