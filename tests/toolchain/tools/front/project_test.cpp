// Projects from templates: an unchosen part is absent, invalid names are refused, and existing files are
// never overwritten.
#include "toolchain/tools/front/project.hpp"

#include "tests/toolchain/folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace tappet::front {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
namespace fs = std::filesystem;

struct Folder : testing::Test {
    fs::path before = fs::current_path();
    test::Folder folder;
    Folder() { fs::current_path(folder); }
    ~Folder() override { fs::current_path(before); }
};

struct Line {
    fs::path path;
    std::string text;
    /// Returns whether the line is neither blank nor only a comment.
    [[nodiscard]] bool says_something() const {
        const std::size_t first = text.find_first_not_of(' ');
        return first != text.npos && !std::string_view{text}.substr(first).starts_with("//");
    }
};
std::vector<Line> lines_of(const fs::path& folder) {
    std::vector<Line> lines;
    for (const auto& entry : fs::recursive_directory_iterator{folder}) {
        std::ifstream file{entry.path()};
        for (std::string line; std::getline(file, line);) lines.push_back({entry.path(), line});
    }
    return lines;
}

TEST(Template, keeps_the_lines_of_a_choice_and_fills_its_names_in) {
    constexpr std::string_view text = "@can bus @NAME@\n@nocan no bus\n@modbus server\nalways \"@TITLE@\"\n";
    EXPECT_EQ(filled(text, {"bottle_filler", true, false}), "bus bottle_filler\nalways \"bottle-filler\"\n");
    EXPECT_EQ(filled(text, {"press", false, true}), "no bus\nserver\nalways \"press\"\n");
}

TEST(Template, keeps_a_line_when_all_its_choices_were_made) {
    constexpr std::string_view text = "@can @cam both\n@can @nocam drive\n@bus wire\n@nobus none\n@map map\n";
    EXPECT_EQ(filled(text, {.name = "a", .can = true, .cam = true}), "both\nwire\nmap\n");
    EXPECT_EQ(filled(text, {.name = "a", .can = true}), "drive\nwire\nmap\n");
    EXPECT_EQ(filled(text, {.name = "a", .cam = true}), "wire\nmap\n") << "a shaft's encoder is on the bus";
    EXPECT_EQ(filled(text, {.name = "a", .modbus = true}), "none\nmap\n");
    EXPECT_EQ(filled(text, {.name = "a"}), "none\n");
}

TEST_F(Folder, gets_a_readable_project_without_leftover_tags) {
    ASSERT_THAT(write_project(TAPPET_TEMPLATE, {"press", true, true, true}), IsEmpty());
    for (const auto& [path, line] : lines_of("press")) {
        EXPECT_THAT(line, Not(HasSubstr("@"))) << path;
        EXPECT_LE(line.size(), 140u) << path;
    }
    EXPECT_EQ(machines_of("press/CMakeLists.txt"), std::vector<std::string>{"press"});
}

TEST_F(Folder, gets_a_whole_machine_in_few_lines) {
    const struct {
        Choice choice;
        std::ptrdiff_t lines;
    } projects[] = {{{"lines"}, 130},
                    {{"on_can", true}, 155},
                    {{"on_modbus", true, true}, 171},
                    {{"with_all", true, true, true}, 193}};
    for (const auto& [choice, lines] : projects) {
        ASSERT_THAT(write_project(TAPPET_TEMPLATE, choice), IsEmpty());
        const auto written = lines_of(choice.name);
        EXPECT_EQ(std::ranges::count_if(written, &Line::says_something), lines) << choice.name;
    }
}

TEST_F(Folder, is_not_overwritten_when_it_exists) {
    fs::create_directory("press");
    EXPECT_THAT(write_project(TAPPET_TEMPLATE, {"press"}), HasSubstr("\"press\" exists already"));
}

TEST_F(Folder, gets_no_project_with_an_invalid_name) {
    for (const char* name : {"", "9lives", "Press", "a b", "a-b", "_a", "a__b", "../x", "tappet"})
        EXPECT_THAT(write_project(TAPPET_TEMPLATE, {name}), Not(IsEmpty())) << name;
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(Folder, names_the_cure_when_it_holds_no_machine) {
    EXPECT_THAT(machines_of("CMakeLists.txt").error(), HasSubstr("tappet new NAME"));
    std::ofstream{"CMakeLists.txt"} << "project(x)\n";
    EXPECT_THAT(machines_of("CMakeLists.txt").error(), HasSubstr("names no tappet_machine(..)"));
}

TEST_F(Folder, knows_only_the_options_that_its_sources_name) {
    fs::create_directories("build");
    std::ofstream{"build/CMakeCache.txt"} << "\n";
    std::ofstream{"build/old.hpp"} << "\"--runs\"";
    std::ofstream{"plant.hpp"} << "if (option != \"--pieces\") return false;";
    EXPECT_TRUE(has_option(".", "--pieces"));
    EXPECT_FALSE(has_option(".", "--piece"));
    EXPECT_FALSE(has_option(".", "--runs")) << "what was built says nothing";
}

} // namespace
} // namespace tappet::front
