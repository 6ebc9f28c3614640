// The layout of .clang-format and the lint of .clang-tidy, run over the tree; a test without its tool is
// skipped, visibly.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <sys/wait.h>

namespace tappet::house {
namespace {

struct Outcome {
    int status;
    std::string said;
};

Outcome run(const std::string& command) {
    Outcome outcome{-1, {}};
    std::FILE* const pipe =
        popen((command + " 2>&1").c_str(), "r"); // NOLINT: the command is made of the tree's own names
    if (pipe == nullptr) return outcome;
    std::array<char, 4096> text{};
    while (std::fgets(text.data(), text.size(), pipe) != nullptr) outcome.said += text.data();
    const int status = pclose(pipe);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

std::string end_of(const std::string& text, std::size_t most) {
    return text.size() <= most ? text : "...\n" + text.substr(text.size() - most);
}

/// Sources of the kernel's own kind keep their layout.
bool is_foreign(const File& file) {
    return file.is_under("board/bench/left_out") || file.is_under("toolchain/libmodbus");
}

TEST(Format, is_the_one_of_the_house) {
    const std::string tool = TAPPET_CLANG_FORMAT;
    if (tool.empty()) GTEST_SKIP() << "clang-format-22 is not installed; ci/setup does it";
    std::string command = "cd '" TAPPET_TREE "' && '" + tool + "' --dry-run -Werror";
    for (const File& file : tree())
        if (file.is_cpp() && !is_foreign(file)) command += " '" + file.path + "'";
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 0) << end_of(outcome.said, 4000) << "cure: clang-format-22 -i <file>";
}

/// A machine with all its drivers and the kernel's wiring, which include nearly every header; the target
/// `lint` reads all sources.
TEST(Lint, finds_nothing_in_a_machine) {
    const std::string tool = TAPPET_CLANG_TIDY;
    if (tool.empty()) GTEST_SKIP() << "clang-tidy-22 is not installed; ci/setup does it";
    const Outcome outcome = run("cd '" TAPPET_TREE "' && '" + tool +
                                "' --quiet -p '" TAPPET_BUILD "' apps/carpet_loom/plant_on_wires.cpp "
                                "kernel/machine/instance/instance.cpp");
    EXPECT_EQ(outcome.status, 0) << end_of(outcome.said, 4000)
                                 << "cure: see the check's name; .clang-tidy says which hold";
}

} // namespace
} // namespace tappet::house
