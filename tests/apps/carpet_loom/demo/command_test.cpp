// ci/demo reports wrong options before it installs or builds anything.
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace tappet::demo {
namespace {

using testing::HasSubstr;

/// With an empty tool path nothing can be installed or built.
Ended demo(const std::string& words) {
    const std::string only = testing::TempDir() + "tappet-demo-path";
    const Ended ended = run_line("mkdir -p '" + only + "' && ln -sf /usr/bin/dirname '" + only +
                                 "' && PATH='" + only + "' /bin/bash '" DEMO_TREE "/ci/demo' " + words);
    std::filesystem::remove_all(only);
    return ended;
}

TEST(Command, refuses_an_option_without_its_value) {
    for (const char* words : {"--picks", "--seed", "--picks --seed 3", "--picks many", "--seed ''"}) {
        const Ended ended = demo(words);
        EXPECT_EQ(ended.exit_code, 2) << words;
        EXPECT_THAT(ended.text, HasSubstr("needs a whole number after it; --help lists the options\n"))
            << words;
    }
    EXPECT_EQ(demo("--summary").text, "ci/demo: --summary needs a file after it; --help lists the options\n");
    EXPECT_EQ(demo("--summary /nowhere/at/all.json").exit_code, 2);
}

TEST(Command, refuses_an_option_of_another_command) {
    const Ended ended = demo("--runs 3");
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_EQ(ended.text, "ci/demo: '--runs' is not an option; --help lists the options\n");
}

} // namespace
} // namespace tappet::demo
