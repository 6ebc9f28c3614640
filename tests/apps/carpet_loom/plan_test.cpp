// The plan that the compiler derives from the loom's table is under version control: a commit shows every
// change of it.
#include "kernel/machine/plan_text.hpp"
#include "tests/apps/carpet_loom/loom_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

namespace tappet::carpet {
namespace {

using Lines = std::vector<std::string>;

/// The total contains objects of the standard library, whose sizes differ by compiler.
std::string without_total(const std::string& line) {
    return line.starts_with("memory: ") ? line.substr(std::min(line.find(';'), line.size())) : line;
}

TEST(LoomPlan, equals_the_plan_under_version_control) {
    Lines derived, golden;
    describe_plan(on_host(), &derived,
                  [](void* to, std::string_view line) { static_cast<Lines*>(to)->emplace_back(line); });
    std::ifstream file{LOOM_PLAN};
    for (std::string line; std::getline(file, line);) golden.push_back(line);
    for (std::size_t i = 0; i < std::max(derived.size(), golden.size()); ++i)
        EXPECT_EQ(i < derived.size() ? without_total(derived[i]) : "no line",
                  i < golden.size() ? without_total(golden[i]) : "no line")
            << "line " << i + 1 << "; if it is meant: carpet_loom --plan > " LOOM_PLAN;
}

} // namespace
} // namespace tappet::carpet
