// A generated machine is compiled, linked, started and run, and each of these is measured.
#include "tests/figures/soundness/smoke.hpp"

#include <algorithm>
#include <string>

namespace tappet::figures {
namespace {

const Row* find(const Result& result, std::string_view figure, std::string_view row) {
    for (const Figure& each : result.figures)
        if (each.id == figure)
            for (const Row& found : each.rows)
                if (found.name == row) return &found;
    return nullptr;
}

TEST(ScaleFigures, measure_a_machine_from_its_source_to_its_step) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    const auto expect_between = [&](const char* figure, const char* row, double low, double high) {
        const Row* found = find(result, figure, row);
        ASSERT_NE(found, nullptr) << figure << ": " << row;
        EXPECT_GT(found->summary.median, low) << figure << ": " << row;
        EXPECT_LT(found->summary.median, high) << figure << ": " << row;
    };
    expect_between("scale.compile.time.10", "g++", 0.1, 100);
    expect_between("scale.compile.memory.10", "g++", 50, 2000);
    expect_between("scale.firmware.10", "file", 100, 4000);
    expect_between("scale.memory.10", "all", 16, 1000); // a stack at least, in kB
    expect_between("scale.start.10", "constructed, wired, configured", 0.1, 1e6);
    expect_between("scale.step.10", "engines", 1, 1e5);
    expect_between("scale.system.time.3", "g++", 0.1, 100);
    expect_between("scale.system.memory.3", "g++", 50, 2000);
    for (const char* figure : {"scale.jacquard.can", "scale.jacquard.registers", "scale.step.10"})
        EXPECT_TRUE(std::ranges::any_of(result.figures, [&](const Figure& each) {
            return each.id == figure && std::ranges::count(each.rows, Standing::floor, &Row::role) == 1;
        })) << figure;
    EXPECT_EQ(result.statements.size(), 2u);
}

} // namespace
} // namespace tappet::figures
