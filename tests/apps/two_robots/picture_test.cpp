// The program of both robots draws their run, or says why not.
#include "apps/two_robots/host/picture.hpp"
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>

namespace two_robots {
namespace {

using testing::HasSubstr;

TEST(Picture, shows_the_states_of_both_and_the_tip) {
    const std::vector<Moment> moments{{0.0, {0, 0, 0.1}, {}, false, 0.0, "Waiting", "Homing"},
                                      {1.0, {0.02, 0, -0.15}, {}, true, 0.1e-3, "Operating", "Simulating"},
                                      {2.0, {0.01, 0, -0.15}, {}, true, 0.2e-3, "Operating", "Simulating"}};
    const std::string picture = picture_of(moments);
    for (const auto* word : {"Waiting", "Operating", "Homing", "Simulating", "</svg>"})
        EXPECT_THAT(picture, HasSubstr(word));
}

TEST(Picture, of_nothing_is_a_picture) { EXPECT_THAT(picture_of({}), HasSubstr("</svg>")); }

std::string content(const std::string& file) {
    std::ifstream in{file};
    return {std::istreambuf_iterator<char>{in}, {}};
}

// With every compiler and on every processor.
TEST(Program, draws_the_picture_of_its_page_or_says_why_not) {
    const std::string file = testing::TempDir() + "two_robots_test.svg";
    const tappet::Ended drawn = tappet::run_line(K361 " --for 90 --picture '" + file + "'");
    EXPECT_EQ(drawn.exit_code, 0) << drawn.text;
    EXPECT_TRUE(content(file) == content(PAGE "/run.svg")) << "draw it anew as the page says";
    std::remove(file.c_str());
    const tappet::Ended nowhere = tappet::run_line(K361 " --for 1 --picture /nowhere/at/all.svg");
    EXPECT_EQ(nowhere.exit_code, 2);
    EXPECT_THAT(nowhere.text, HasSubstr("the picture cannot be written to \"/nowhere/at/all.svg\"; name a"));
}

} // namespace
} // namespace two_robots
