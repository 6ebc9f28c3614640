// The program of both robots draws their run, or says why not; and it keeps its properties in files.
#include "apps/two_robots/host/picture.hpp"
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace two_robots {
namespace {

using tappet::test::contents_of;
using tappet::test::Folder;
using testing::HasSubstr;

TEST(Picture, shows_the_states_of_both_and_the_tip) {
    const std::vector<Moment> moments{{0.0, {0, 0, 0.1}, {}, false, 0.0, "Waiting", "Homing"},
                                      {1.0, {0.02, 0, -0.15}, {}, true, 0.1e-3, "Operating", "Simulating"},
                                      {2.0, {0.01, 0, -0.15}, {}, true, 0.2e-3, "Operating", "Simulating"}};
    const std::string picture = picture_of(moments);
    for (const auto* word : {"Waiting", "Operating", "Homing", "Simulating", "</svg>"})
        EXPECT_THAT(picture, HasSubstr(word));
}

TEST(Picture, is_complete_without_data) { EXPECT_THAT(picture_of({}), HasSubstr("</svg>")); }

// The picture is the same with every compiler and on every processor.
TEST(Program, draws_the_picture_of_its_page_or_says_why_not) {
    const Folder folder;
    const std::string file = folder / "two_robots_test.svg";
    const tappet::Ended drawn = tappet::run_line(K361 " --for 90 --picture '" + file + "'");
    EXPECT_EQ(drawn.exit_code, 0) << drawn.text;
    EXPECT_TRUE(contents_of(file) == contents_of(PAGE "/run.svg")) << "draw it anew as the page says";
    const tappet::Ended nowhere = tappet::run_line(K361 " --for 1 --picture /nowhere/at/all.svg");
    EXPECT_EQ(nowhere.exit_code, 2);
    EXPECT_THAT(nowhere.text, HasSubstr("the picture cannot be written to \"/nowhere/at/all.svg\"; name a"));
}

// Thesis 3.4.5: control parameters, the kinematics to use, the length of the tools, limits of joints.
TEST(Program, reads_properties_from_files_and_saves_them_there) {
    const Folder folder;
    const std::string& directory = folder.string();
    const auto run = [&] { return tappet::run_line(K361 " --for 1 --properties '" + directory + "'"); };
    const auto set = [&](const std::string& file, const std::string& from, const std::string& to) {
        std::string text = contents_of(directory + file);
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << text;
        std::ofstream{directory + file} << text.replace(at, from.size(), to);
    };
    const tappet::Ended first = run();
    EXPECT_EQ(first.exit_code, 0) << first.text;
    for (const auto* file : {"/replay.cpf", "/forward.cpf", "/pid.cpf", "/drives.cpf", "/measured.cpf"})
        EXPECT_THAT(contents_of(directory + file), HasSubstr("</properties>")) << file;
    set("/replay.cpf", "<value>0.4</value>", "<value>0.35</value>");
    EXPECT_EQ(run().exit_code, 0);
    EXPECT_THAT(contents_of(directory + "/replay.cpf"), HasSubstr("<value>0.35</value>"))
        << "it was read, and saved again";
    set("/replay.cpf", "<value>0.35</value>", "<value>35</value>");
    const tappet::Ended refused = run();
    EXPECT_NE(refused.exit_code, 0) << "a tool of 35 m";
    EXPECT_THAT(refused.text, HasSubstr("tool_length"));
}

} // namespace
} // namespace two_robots
