// ci/test --all runs each command of ci/, and each that a page shows, at least in a short form.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

namespace tappet::house {
namespace {

/// The rest of the file name that begins with `ci/` there.
std::string command_at(std::string_view line, std::size_t at) {
    std::string name{"ci/"};
    for (at += 3;
         at < line.size() && (std::islower(line[at]) != 0 || std::isdigit(line[at]) != 0 || line[at] == '_');
         ++at)
        name += line[at];
    return name;
}

/// The commands in the table of ci/test, with ci/setup, which it runs, and ci/test itself.
std::vector<std::string> tried(const Tree& files) {
    std::vector<std::string> names{"ci/setup", "ci/test"};
    for (const File& file : files)
        if (file.path == "ci/test")
            for (const std::string& line : file.lines)
                if (line.starts_with("    \"ci/")) names.push_back(command_at(line, 5));
    return names;
}

Findings untried(const Tree& files) {
    const std::vector<std::string> known = tried(files);
    Findings found;
    const auto look = [&](const File& file, std::size_t line, const std::string& name) {
        if (std::ranges::find(known, name) == known.end())
            found.push_back({file.path, line, name + " is run by no test",
                             "write a short form of it into ci/test's commands"});
    };
    for (const File& file : files) {
        if (file.folder() == "ci") look(file, 1, file.path);
        if (!file.path.ends_with(".md")) continue;
        for (std::size_t i = 0; i < file.lines.size(); ++i)
            for (const std::string_view before : {"`ci/", "    ci/"})
                if (const auto at = file.lines[i].find(before); at != std::string::npos)
                    if (const std::string name = command_at(file.lines[i], at + before.size() - 3);
                        name != "ci/")
                        look(file, i + 1, name);
    }
    return found;
}

/// Programs that answer --help, but not --version.
Findings without_version(const Tree& files) {
    Findings found;
    for (const File& file : files) {
        if (!file.is_cpp() || file.is_under("tests")) continue;
        const auto says = [&](std::string_view text) {
            return std::ranges::find_if(file.lines,
                                        [&](const std::string& line) { return line.contains(text); });
        };
        auto help = says("has(\"--help\")) {");
        if (help == file.lines.end()) help = says("== \"--help\"");
        if (help != file.lines.end() && says("prints_version(") == file.lines.end())
            found.push_back({file.path, static_cast<std::size_t>(help - file.lines.begin()) + 1,
                             "a program without --version",
                             "call prints_version of toolchain/version.hpp first"});
    }
    return found;
}

TEST(Commands, are_tried_when_people_are_told_to_type_them) { expect_none(untried(tree())); }

TEST(Commands, print_their_version) { expect_none(without_version(tree())); }

TEST(CommandsRule, finds_printed_or_existing_commands_that_are_never_run) {
    const File test = file("ci/test", "commands=(\n    \"ci/demo --plain\"\n)\n");
    EXPECT_TRUE(untried({test, file("ci/demo", "true\n"),
                         file("a.md", "Type `ci/demo`, after `ci/setup`.\n    ci/test\n")})
                    .empty());
    EXPECT_EQ(untried({test, file("ci/lost", "true\n")}).size(), 1u);
    EXPECT_EQ(untried({test, file("a.md", "Type `ci/demos --fast`.\n")}).size(), 1u);
    EXPECT_EQ(untried({test, file("b/README.md", "    ci/own --keep\n")}).size(), 1u);
    EXPECT_TRUE(untried({test, file("a.md", "The folder `ci/` holds them.\n")}).empty());
}

TEST(CommandsRule, finds_programs_that_do_not_print_their_version) {
    const std::string help = "if (word == \"--help\") return usage();\n";
    EXPECT_EQ(without_version({file("toolchain/a.cpp", help)}).size(), 1u);
    EXPECT_EQ(without_version({file("apps/a.cpp", "\nif (line->has(\"--help\")) {\n")})[0].line, 2u);
    EXPECT_TRUE(
        without_version({file("a.cpp", help + "if (prints_version(count, words, \"a\")) return 0;\n")})
            .empty());
}

} // namespace
} // namespace tappet::house
