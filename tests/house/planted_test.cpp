// Each fault that is kept as a patch still applies: otherwise its code was changed unnoticed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace tappet::house {
namespace {

bool applies(const std::filesystem::path& patch, const char* how) {
    const std::string command =
        std::string{"cd '" TAPPET_TREE "' && git apply --check "} + how + " '" + patch.string() + "'";
    return std::system(command.c_str()) == 0;
}

TEST(Planted, faults_say_what_they_are_and_still_apply) {
    for (const auto& entry : std::filesystem::directory_iterator{TAPPET_TREE "/tests/planted"}) {
        if (entry.path().extension() != ".patch") continue;
        std::string first;
        std::getline(std::ifstream{entry.path()}, first);
        EXPECT_FALSE(first.empty() || first.starts_with("diff "))
            << entry.path() << ": say in its first line what the fault is";
        EXPECT_TRUE(applies(entry.path(), "")) << entry.path() << ": make it anew against the tree as it is";
    }
}

TEST(PlantedRule, sees_a_patch_that_does_not_fit) {
    const auto patch = std::filesystem::path{testing::TempDir()} / "tappet-planted.patch";
    const auto write = [&](const char* was) {
        std::ofstream{patch}
            << "A fault.\ndiff --git a/LICENSE b/LICENSE\n--- a/LICENSE\n+++ b/LICENSE\n@@ -1 +1 @@\n-" << was
            << "\n+another\n";
    };
    std::string line;
    std::getline(std::ifstream{TAPPET_TREE "/LICENSE"}, line);
    write(line.c_str());
    EXPECT_TRUE(applies(patch, "--unidiff-zero"));
    write("what never stood there");
    EXPECT_FALSE(applies(patch, "--unidiff-zero 2>/dev/null"));
    std::filesystem::remove(patch);
}

} // namespace
} // namespace tappet::house
