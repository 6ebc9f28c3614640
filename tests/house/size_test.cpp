// How large each folder may be: growth is a decision, so it edits a number here.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace tappet::house {
namespace {

struct Size {
    std::string_view folder;
    std::size_t most_lines; ///< of its sources, comments included
};

// clang-format off
const std::vector<Size> sizes{
    {"kernel/base",           2752},
    {"kernel/os",             4586},
    {"kernel/exchange",       924},
    {"kernel/component",      5247},
    {"kernel/activity",       1888},
    {"kernel/program",        3244},
    {"kernel/statechart",     3981},
    {"kernel/script",         5016},
    {"kernel/machine",        11891},
    {"kernel/cam",            1261},
    {"kernel/motion",         2452},
    {"kernel/control",        1822},
    {"kernel/limits",         739},
    {"kernel/pieces",         700},
    {"kernel/services",       6245},
    {"kernel/system",         2141},
    {"drivers",               22977},
    {"board",                 4559},
    {"apps/carpet_loom",      5245},
    {"apps/bearing_press",    783},
    {"apps/cut_to_length",    321},
    {"apps/car_tracking",     1957},
    {"apps/two_robots",       3079},
    {"apps/woodworking_lane", 1039},
    {"toolchain/machine",     6247},
    {"toolchain/tables",      387},
    {"toolchain/tools",       20274},
    {"tests/kernel",         33196},
    {"tests/drivers",         19360},
    {"tests/apps",            6193},
    {"tests/toolchain",       9004},
    {"tests/bench",           4779},
    {"tests/diagnostics",     4662},
    {"tests/differential",    4851},
    {"tests/figures",         13613},
    {"tests/stack",           831},
    {"tests/waitfree",        1709},
    {"tests/house",           2148},
};
// clang-format on

std::size_t lines_under(const Tree& files, std::string_view folder) {
    std::size_t lines = 0;
    for (const File& file : files)
        if (file.is_cpp() && file.is_under(folder)) lines += file.lines.size();
    return lines;
}

Findings grown(const Tree& files, const std::vector<Size>& allowed) {
    Findings found;
    for (const Size& row : allowed)
        if (const std::size_t lines = lines_under(files, row.folder); lines > row.most_lines)
            found.push_back(
                {std::string(row.folder), lines,
                 "has " + std::to_string(lines) + " lines, and was allowed " + std::to_string(row.most_lines),
                 "look what can go; else write the new number in tests/house/size_test.cpp and why "
                 "in the commit"});
    return found;
}

/// A number that nobody lowers lets the folder grow again unseen.
Findings slack(const Tree& files, const std::vector<Size>& allowed) {
    Findings found;
    for (const Size& row : allowed)
        if (const std::size_t lines = lines_under(files, row.folder);
            lines + lines / 20 + 50 < row.most_lines)
            found.push_back(
                {std::string(row.folder), lines,
                 "has only " + std::to_string(lines) + " of " + std::to_string(row.most_lines) + " lines",
                 "lower its number in tests/house/size_test.cpp"});
    return found;
}

TEST(Size, of_no_folder_grows_unseen) { expect_none(grown(tree(), sizes)); }
TEST(Size, that_was_won_is_kept) { expect_none(slack(tree(), sizes)); }

TEST(SizeRule, counts_what_lies_below_and_no_text) {
    const Tree two{file("kernel/os/a.hpp", "// A.\n// B.\n"), file("kernel/os/deep/b.cpp", "// C.\n"),
                   file("kernel/os/README.md", "Much.\nText.\n")};
    EXPECT_EQ(lines_under(two, "kernel/os"), 3u);
    EXPECT_EQ(grown(two, {{"kernel/os", 2}}).size(), 1u);
    EXPECT_TRUE(grown(two, {{"kernel/os", 3}}).empty());
    EXPECT_EQ(slack(two, {{"kernel/os", 60}}).size(), 1u);
    EXPECT_TRUE(slack(two, {{"kernel/os", 50}}).empty());
}

} // namespace
} // namespace tappet::house
