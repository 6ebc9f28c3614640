// The shape of files: one idea, stated in the first line, a size that can be read at once, and a place where
// a reader looks for it.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace tappet::house {
namespace {

constexpr std::size_t most_lines = 500;
constexpr std::size_t most_lines_of_a_function = 70;
constexpr std::size_t most_columns =
    140; // clang-format keeps code within 110; this catches the parts that it may not touch

Findings too_long(const Tree& files) {
    Findings found;
    for (const File& file : files)
        if (file.lines.size() > most_lines)
            found.push_back({file.path, file.lines.size(),
                             "has more than " + std::to_string(most_lines) + " lines",
                             "a file is one idea: part it"});
    return found;
}

/// A function's body follows a head with parameters; other braces follow a keyword, or a head without
/// parameters.
bool opens_function(std::string_view head) {
    if (find_word(head, "namespace") != head.npos) return false; // behind a macro, too
    for (const std::string_view word : {"class", "struct", "enum", "union"})
        if (find_word(head, word) < head.find('(')) return false;
    return head.contains(')');
}

Findings too_long_functions(const Tree& files) {
    struct Open {
        std::size_t begins;
        bool is_function;
    };
    Findings found;
    for (const File& file : files) {
        if (!file.is_cpp()) continue;
        std::vector<Open> open;
        std::string head;
        std::size_t begins = 0;
        for (std::size_t i = 0; i < file.code.size(); ++i)
            for (const char each : file.code[i].starts_with('#') ? std::string{} : file.code[i] + '\n') {
                if (each == '{') open.push_back({begins, opens_function(head)});
                if (each == '}' && !open.empty()) {
                    const std::size_t lines = i + 1 - open.back().begins;
                    if (open.back().is_function && lines > most_lines_of_a_function)
                        found.push_back({file.path, open.back().begins + 1,
                                         "a function of " + std::to_string(lines) + " lines",
                                         "part it: at most " + std::to_string(most_lines_of_a_function)});
                    open.pop_back();
                }
                if (each == '{' || each == '}' || each == ';') {
                    head.clear();
                } else if (!head.empty() || (each != ' ' && each != '\n')) {
                    if (head.empty()) begins = i;
                    head += each;
                }
            }
    }
    return found;
}

/// Unbroken words and tables with clang-format off may exceed the limit, up to this width.
Findings too_wide(const Tree& files) {
    Findings found;
    for (const File& file : files) {
        // The golden sentence of a case is one line, as the compiler prints it.
        if (!file.is_cpp() || file.is_under("tests/diagnostics/cases")) continue;
        bool is_table = false;
        for (std::size_t i = 0; i < file.lines.size(); ++i) {
            if (file.comments[i].contains("clang-format off")) is_table = true;
            if (file.comments[i].contains("clang-format on")) is_table = false;
            // Literals are left out: a raw literal cannot be broken.
            const std::size_t columns = file.code[i].size() + file.comments[i].size();
            if (!is_table && columns > most_columns)
                found.push_back({file.path, i + 1, std::to_string(columns) + " columns beside literals",
                                 "lay it out: the limit is 110"});
        }
    }
    return found;
}

Findings without_idea(const Tree& files) {
    Findings found;
    for (const File& file : files) {
        if (file.lines.empty()) {
            found.push_back({file.path, 1, "the file is empty", "remove it"});
        } else if (file.is_cpp() && !file.is_under("tests/diagnostics/cases")) {
            const std::string& first = file.lines[0];
            if (!first.starts_with("// ") && !first.starts_with("/* "))
                found.push_back({file.path, 1, "does not begin with its idea",
                                 "say in one or two comment lines what it holds"});
        } else if (file.is_cmake() || file.lines[0].starts_with("#!")) {
            const std::size_t line = file.lines[0].starts_with("#!") ? 1 : 0;
            if (file.lines.size() <= line || file.lines[line] != "# SPDX-License-Identifier: Apache-2.0")
                found.push_back({file.path, line + 1, "does not state its license",
                                 "begin with # SPDX-License-Identifier: Apache-2.0"});
        }
    }
    return found;
}

Findings untidy_ends(const Tree& files) {
    Findings found;
    for (const File& file : files) {
        if (file.is_under("tests/fuzz/corpus")) continue; // a fuzzer wrote them
        for (std::size_t i = 0; i < file.lines.size(); ++i)
            if (file.lines[i].starts_with('\t') && (file.is_cpp() || file.is_cmake()))
                found.push_back({file.path, i + 1, "a tab", "indent with spaces"});
            else if (file.lines[i].ends_with(' ') || file.lines[i].ends_with('\r'))
                found.push_back({file.path, i + 1, "white space at the end of the line", "remove it"});
    }
    return found;
}

Findings unguarded(const Tree& files) {
    Findings found;
    for (const File& file : files)
        if (file.path.ends_with(".hpp") && std::ranges::find(file.lines, "#pragma once") == file.lines.end())
            found.push_back(
                {file.path, 1, "the header can be included twice", "write #pragma once below its idea"});
    return found;
}

/// Folders of tests that mirror no folder of the tree.
constexpr std::array own_folders{
    std::string_view{"tests/house"},        // holds for the whole tree
    std::string_view{"tests/diagnostics"},  // machines that must not compile
    std::string_view{"tests/bench"},        // need a booted kernel
    std::string_view{"tests/stack"},        // the stack depth of a firmware
    std::string_view{"tests/waitfree"},     // the object code of exchange between activities
    std::string_view{"tests/adversary"},    // a machine with every way to an output, for the swarm
    std::string_view{"tests/fuzz"},         // any bytes for every reader, and their corpus
    std::string_view{"tests/models"},       // the algorithms as Promela, and their labels in the source
    std::string_view{"tests/differential"}, // scripts, compiled and loaded, against a second interpreter
    std::string_view{"tests/figures"},      // measurements, side by side
    std::string_view{"tests/drivers/components"}, // the drivers' components inside machines
};

Findings unmirrored(const Tree& files) {
    std::set<std::string> folders;
    for (const File& file : files)
        for (std::string folder = file.folder(); !folder.empty();
             folder.resize(folder.contains('/') ? folder.rfind('/') : 0))
            folders.insert(folder);
    Findings found;
    for (const File& file : files) {
        if (!file.is_under("tests") || !file.is_cpp()) continue;
        const bool own = std::ranges::any_of(own_folders, [&](auto folder) { return file.is_under(folder); });
        const std::string mirrored =
            file.folder() == "tests" ? "" : file.folder().substr(std::string_view{"tests/"}.size());
        if (!own && !folders.contains(mirrored))
            found.push_back({file.path, 1, "mirrors no folder of the tree",
                             "move it to tests/<the folder that it tests>"});
    }
    return found;
}

TEST(Shape, no_file_is_too_long) { expect_none(too_long(tree())); }
TEST(Shape, no_function_is_too_long) { expect_none(too_long_functions(tree())); }
TEST(Shape, no_line_is_too_wide) { expect_none(too_wide(tree())); }
TEST(Shape, every_file_begins_with_its_idea) { expect_none(without_idea(tree())); }
TEST(Shape, lines_contain_no_tabs_and_no_trailing_spaces) { expect_none(untidy_ends(tree())); }
TEST(Shape, headers_are_included_once) { expect_none(unguarded(tree())); }
TEST(Shape, tests_mirror_the_tree) { expect_none(unmirrored(tree())); }

TEST(ShapeRule, finds_what_is_too_long_or_too_wide) {
    std::string many;
    for (std::size_t i = 0; i <= most_lines; ++i) many += "\n";
    EXPECT_EQ(too_long({file("a.cpp", many)}).size(), 1u);
    const std::string wide(most_columns + 1, 'x');
    EXPECT_EQ(too_wide({file("a.cpp", wide)}).size(), 1u);
    EXPECT_TRUE(too_wide({file("a.cpp", "// clang-format off\n" + wide + "\n// clang-format on\n")}).empty());
    EXPECT_EQ(too_wide({file("a.cpp", "// clang-format off\n// clang-format on\n" + wide)}).size(), 1u);
}

TEST(ShapeRule, finds_a_function_that_is_too_long) {
    const auto of = [](const std::string& head, std::size_t lines) {
        std::string text = head + "\n";
        for (std::size_t i = 2; i < lines; ++i) text += "    go();\n";
        return too_long_functions({file("a.cpp", "int before;\n" + text + "}\n")}).size();
    };
    EXPECT_EQ(of("void f() {", most_lines_of_a_function), 0u);
    EXPECT_EQ(of("void f() {", most_lines_of_a_function + 1), 1u);
    EXPECT_EQ(of("void f(int a,\n    int b) noexcept {", most_lines_of_a_function), 1u) << "its head counts";
    EXPECT_EQ(of("struct alignas(64) S {", most_lines_of_a_function + 1), 0u);
    EXPECT_EQ(of("constexpr int rows[] = {", most_lines_of_a_function + 1), 0u);
}

TEST(ShapeRule, finds_files_that_do_not_say_their_idea) {
    EXPECT_EQ(without_idea({file("a.cpp", "#include <array>\n")}).size(), 1u);
    EXPECT_EQ(without_idea({file("a.cpp", "")}).size(), 1u);
    EXPECT_EQ(without_idea({file("CMakeLists.txt", "project(x)\n")}).size(), 1u);
    EXPECT_EQ(without_idea({file("ci/x", "#!/bin/sh\nexit 0\n")}).size(), 1u);
    EXPECT_TRUE(without_idea({file("ci/x", "#!/bin/sh\n# SPDX-License-Identifier: Apache-2.0\n")}).empty());
}

TEST(ShapeRule, finds_tabs_trailing_spaces_and_unguarded_headers) {
    EXPECT_EQ(untidy_ends({file("a.cpp", "\tint a;\n")}).size(), 1u);
    EXPECT_EQ(untidy_ends({file("a.cpp", "int a; \n")}).size(), 1u);
    EXPECT_EQ(unguarded({file("a.hpp", "// A.\n")}).size(), 1u);
}

TEST(ShapeRule, finds_a_test_without_a_matching_folder) {
    EXPECT_EQ(unmirrored({file("tests/kernel/attic/a_test.cpp", "// A.\n")}).size(), 1u);
    EXPECT_TRUE(
        unmirrored({file("kernel/os/sub/a.hpp", "// A.\n"), file("tests/kernel/os/a_test.cpp", "// A.\n")})
            .empty());
}

} // namespace
} // namespace tappet::house
