// Each exchange is measured beside what it is compared with, and each claim is judged.
#include "tests/figures/soundness/smoke.hpp"

#include <algorithm>

namespace tappet::figures {
namespace {

std::size_t rows_of(const Figure& figure, Standing role) {
    return static_cast<std::size_t>(
        std::ranges::count_if(figure.rows, [&](const Row& row) { return row.role == role; }));
}

TEST(ExchangeFigures, stand_beside_floors_and_peers_and_judge_each_goal) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    const bool two_cores = std::ranges::none_of(
        result.notes, [](const std::string& note) { return note.contains("has one processor"); });
    for (const char* size : {"8", "160", "4096"})
        for (const char* kind : {"data.local.", "data.across.", "buffer.local.", "buffer.across."}) {
            const std::string id = "exchange." + std::string{kind} + size;
            EXPECT_EQ(std::ranges::count(result.figures, id, &Figure::id), 1) << id;
        }
    for (const Figure& figure : result.figures) {
        EXPECT_EQ(rows_of(figure, Standing::ours), 1u) << figure.id;
        EXPECT_GE(rows_of(figure, Standing::floor) + rows_of(figure, Standing::peer), 1u) << figure.id;
        for (const Row& row : figure.rows) EXPECT_GT(row.summary.count, 0u) << figure.id << ": " << row.name;
    }
    EXPECT_EQ(result.figures.size(), two_cores ? 22u : 12u);
    EXPECT_EQ(result.goals.size(), two_cores ? 11u : 2u);
    for (const Goal& goal : result.goals) {
        EXPECT_TRUE(std::isfinite(goal.measured)) << goal.text;
        EXPECT_GT(goal.measured, 0) << goal.text;
    }
}

} // namespace
} // namespace tappet::figures
