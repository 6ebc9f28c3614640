// The layout of .clang-format, the lint of .clang-tidy and a spell checker, run over the tree; a test without
// its tool is skipped, visibly.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

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

/// Sources in the kernel's own style keep their layout.
bool is_foreign(const File& file) {
    return file.is_under("board/bench/left_out") || file.is_under("toolchain/libmodbus");
}

TEST(Format, follows_the_house_style) {
    const std::string tool = TAPPET_CLANG_FORMAT;
    if (tool.empty()) GTEST_SKIP() << "clang-format-22 is not installed; ci/setup does it";
    std::string command = "cd '" TAPPET_TREE "' && '" + tool + "' --dry-run -Werror";
    for (const File& file : tree())
        if (file.is_cpp() && !is_foreign(file)) command += " '" + file.path + "'";
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 0) << end_of(outcome.said, 4000) << "cure: clang-format-22 -i <file>";
}

/// A machine with all its drivers and the kernel's wiring includes nearly every header; the target `lint`
/// reads all sources.
TEST(Lint, finds_nothing_in_a_machine) {
    const std::string tool = TAPPET_CLANG_TIDY;
    if (tool.empty()) GTEST_SKIP() << "clang-tidy-22 is not installed; ci/setup does it";
    const Outcome outcome = run("cd '" TAPPET_TREE "' && '" + tool +
                                "' --quiet -p '" TAPPET_BUILD "' apps/carpet_loom/plant_on_wires.cpp "
                                "kernel/machine/instance/instance.cpp");
    EXPECT_EQ(outcome.status, 0) << end_of(outcome.said, 4000)
                                 << "cure: see the check's name; .clang-tidy says which hold";
}

/// Intended misspellings: those that the kernel itself recognises.
bool is_about_misspelling(const File& file) { return file.name() == "life_functions.hpp"; }

/// All text of the product is checked, messages too. Tests misspell on purpose: only their comments are
/// checked.
TEST(Spelling, is_known) {
    const std::string tool = TAPPET_CODESPELL;
    if (tool.empty()) GTEST_SKIP() << "codespell is not installed; ci/setup does it";
    const std::string text = TAPPET_BUILD "/house_prose.txt";
    std::vector<std::string> places;
    {
        std::ofstream prose{text};
        for (const File& file : tree()) {
            if (file.is_under("tests/fuzz/corpus")) continue;
            const bool comments_only =
                file.is_cpp() && (file.is_under("tests") || is_about_misspelling(file));
            const std::vector<std::string>& lines = comments_only    ? file.comments
                                                    : file.is_page() ? file.prose
                                                                     : file.lines;
            for (std::size_t i = 0; i < lines.size(); ++i) {
                places.push_back(file.path + ":" + std::to_string(i + 1));
                prose << (file.is_page() && lines[i].starts_with("    ") ? "" : lines[i]) << '\n';
            }
        }
    }
    const Outcome outcome = run("'" + tool + "' -I '" TAPPET_TREE "/tests/house/words.txt' '" + text + "'");
    std::filesystem::remove(text);
    std::string said;
    std::istringstream findings{outcome.said};
    for (std::string line; std::getline(findings, line);) {
        if (!line.starts_with(text + ":")) {
            said += line + "\n";
            continue;
        }
        line.erase(0, text.size() + 1);
        const std::size_t at = std::stoul(line) - 1;
        said += (at < places.size() ? places[at] : "?") + line.substr(line.find(':')) + "\n";
    }
    EXPECT_EQ(outcome.status, 0) << end_of(said, 4000)
                                 << "cure: correct it, or add the word to tests/house/words.txt";
}

} // namespace
} // namespace tappet::house
