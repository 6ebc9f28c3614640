// The plan that the compiler derives from the loom's table is under version control: a commit shows every
// change of it.
#include "kernel/machine/plan_text.hpp"
#include "tests/apps/carpet_loom/loom_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace tappet::carpet {
namespace {

using Lines = std::vector<std::string>;

/// The sizes of objects differ by compiler, because the standard library's do: these may differ by 5 %.
void expect_same(const std::string& derived, const std::string& golden, std::size_t line) {
    SCOPED_TRACE("line " + std::to_string(line) + "; if it is meant: carpet_loom --plan > " LOOM_PLAN);
    if (!derived.starts_with("memory: ")) {
        EXPECT_EQ(derived, golden);
        return;
    }
    static const std::regex number{"[0-9]+"};
    EXPECT_EQ(std::regex_replace(derived, number, "N"), std::regex_replace(golden, number, "N"));
    std::sregex_iterator one{derived.begin(), derived.end(), number},
        other{golden.begin(), golden.end(), number};
    for (const std::sregex_iterator end; one != end && other != end; ++one, ++other)
        EXPECT_NEAR(std::stod(one->str()), std::stod(other->str()), 0.05 * std::stod(other->str()))
            << derived;
}

TEST(LoomPlan, equals_the_plan_under_version_control) {
    Lines derived, golden;
    describe_plan(on_host(), &derived,
                  [](void* to, std::string_view line) { static_cast<Lines*>(to)->emplace_back(line); });
    std::ifstream file{LOOM_PLAN};
    for (std::string line; std::getline(file, line);) golden.push_back(line);
    for (std::size_t i = 0; i < std::max(derived.size(), golden.size()); ++i)
        expect_same(i < derived.size() ? derived[i] : "no line", i < golden.size() ? golden[i] : "no line",
                    i + 1);
}

} // namespace
} // namespace tappet::carpet
