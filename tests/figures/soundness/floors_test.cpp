// The floors are there, and those that cannot be otherwise stand in their order.
#include "tests/figures/soundness/smoke.hpp"

#include <algorithm>
#include <thread>

namespace tappet::figures {
namespace {

double median(const Result& result, const std::string& figure, const std::string& row) {
    const auto found = std::ranges::find(result.figures, figure, &Figure::id);
    if (found == result.figures.end()) return -1;
    const auto at = std::ranges::find(found->rows, row, &Row::name);
    return at == found->rows.end() ? -1 : at->summary.median;
}

TEST(FloorsFigures, are_whole_and_none_of_them_is_ours) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    std::vector<std::string> ids;
    for (const Figure& figure : result.figures) {
        ids.push_back(figure.id);
        for (const Row& row : figure.rows) {
            EXPECT_EQ(row.role, Standing::floor) << figure.id << ": " << row.name;
            EXPECT_GT(row.summary.count, 0u) << figure.id << ": " << row.name;
            EXPECT_GT(row.summary.median, 0) << figure.id << ": " << row.name;
            EXPECT_LE(row.summary.median, row.summary.max) << figure.id << ": " << row.name;
        }
    }
    std::vector<std::string> expected{"floors.copy", "floors.word", "floors.system"};
    if (std::thread::hardware_concurrency() > 1)
        expected.insert(expected.end(), {"floors.line", "floors.wake"});
    EXPECT_EQ(ids, expected);
    EXPECT_LT(median(result, "floors.copy", "160 bytes"), median(result, "floors.copy", "4096 bytes"));
    EXPECT_LT(median(result, "floors.word", "release store"), median(result, "floors.word", "exchange"));
}

} // namespace
} // namespace tappet::figures
