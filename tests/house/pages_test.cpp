// Pages describe the tree as it is: every file and function that a page names exists, and every floor and
// room has a page that names its folders.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <regex>
#include <set>

namespace tappet::house {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> floors{"apps",   "board", "ci",       "drivers",
                                                 "kernel", "tests", "toolchain"};
/// Its commands explain themselves.
constexpr std::string_view without_page = "ci";

using Exists = std::function<bool(const std::string& path)>;

bool is_there(const std::string& path) { return fs::exists(fs::path{TAPPET_TREE} / path); }

/// A page without its fenced examples, in one line, since sentences may continue in the next line.
struct Prose {
    std::string text;
    std::vector<std::size_t> starts; ///< of each line of the page
    [[nodiscard]] std::size_t line_at(std::size_t at) const {
        return static_cast<std::size_t>(std::ranges::upper_bound(starts, at) - starts.begin());
    }
};

Prose prose(const File& page) {
    Prose found;
    for (const std::string& line : page.prose) {
        found.starts.push_back(found.text.size());
        found.text += line + ' ';
    }
    return found;
}

struct Match {
    std::vector<std::string> groups;
    std::size_t line;
};

std::vector<Match> matches(const File& page, const std::regex& pattern) {
    const Prose said = prose(page);
    std::vector<Match> found;
    for (std::sregex_iterator at(said.text.begin(), said.text.end(), pattern), end; at != end; ++at) {
        Match match{{}, said.line_at(static_cast<std::size_t>(at->position()))};
        for (std::size_t g = 1; g < at->size(); ++g) match.groups.push_back(at->str(g));
        found.push_back(match);
    }
    return found;
}

bool ends_like_a_file(std::string_view word) {
    static constexpr std::array ends{".hpp", ".cpp", ".md", ".cmake", ".txt", ".osd",
                                     ".pml", ".py",  ".ld", ".dict",  "/"};
    return std::ranges::any_of(ends, [&](std::string_view end) { return word.ends_with(end); });
}

/// Returns the file or folder that the words between two backticks name; empty: they name none. A command
/// counts by its first word.
std::string file_in(const std::string& code) {
    static constexpr std::string_view characters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-";
    const std::string word = code.substr(0, code.find(' '));
    if (word.empty() || word.find_first_not_of(characters) != word.npos || word.starts_with('/')) return {};
    const bool is_of_a_floor = std::ranges::any_of(
        floors, [&](std::string_view floor) { return word.starts_with(std::string{floor} + "/"); });
    return is_of_a_floor || (word == code && word.size() > 1 && ends_like_a_file(word)) ? word : "";
}

/// Looks from the page's folder and from the root; in the guide also for a file of the project that the front
/// door writes.
bool leads_somewhere(const File& page, const std::string& name, const Exists& exists) {
    const auto tidy = [](const fs::path& path) { return path.lexically_normal().generic_string(); };
    return exists(tidy(fs::path{page.folder()} / name)) || exists(tidy(name)) ||
           (page.is_under("toolchain/guide") &&
            exists(tidy("toolchain/tools/front/template/" + name + ".in")));
}

Findings missing_files(const Tree& files, const Exists& exists) {
    static const std::regex code("`([^`]+)`");
    static const std::regex link("\\]\\(([^)#\\s]+)[^)]*\\)");
    Findings found;
    for (const File& page : files) {
        if (!page.is_page()) continue;
        for (const Match& each : matches(page, code))
            if (const std::string name = file_in(each.groups[0]);
                !name.empty() && !leads_somewhere(page, name, exists))
                found.push_back({page.path, each.line, "names `" + name + "`, which is not there",
                                 "write its path from the page's folder or from the root"});
        for (const Match& each : matches(page, link)) {
            const std::string& to = each.groups[0];
            const fs::path path = (fs::path{page.folder()} / to).lexically_normal();
            if (!to.contains("://") && !exists(path.generic_string()))
                found.push_back({page.path, each.line, "links to " + to + ", which is not there",
                                 "write the path from the page's folder"});
        }
    }
    return found;
}

bool says(const File& file, std::string_view word) {
    return std::ranges::any_of(file.code,
                               [&](const std::string& line) { return find_word(line, word) != line.npos; });
}

/// "`Class::function` in `file`": each part of the name is a word of the file's code.
struct Hop {
    std::string function;
    std::string file;
    std::size_t line;
};

std::vector<Hop> hops(const File& page) {
    static const std::regex hop("`([A-Za-z_]\\w*(?:::\\w+)*)(?:\\(\\))?` in `([^` ]+\\.[hc](?:pp)?)`");
    std::vector<Hop> found;
    for (const Match& each : matches(page, hop)) found.push_back({each.groups[0], each.groups[1], each.line});
    return found;
}

Findings missing_functions(const Tree& files) {
    static const std::regex part("\\w+");
    Findings found;
    for (const File& page : files) {
        if (!page.is_page()) continue;
        for (const Hop& hop : hops(page)) {
            const auto beside = (fs::path{page.folder()} / hop.file).lexically_normal().generic_string();
            const auto file = std::ranges::find_if(
                files, [&](const File& f) { return f.path == hop.file || f.path == beside; });
            if (file == files.end()) continue; // missing_files reports it
            for (std::sregex_iterator at(hop.function.begin(), hop.function.end(), part), end; at != end;
                 ++at)
                if (!says(*file, at->str()))
                    found.push_back(
                        {page.path, hop.line,
                         "`" + hop.function + "`: " + hop.file + " has no word \"" + at->str() + "\"",
                         "name the function and the file as they are now"});
        }
    }
    return found;
}

/// Returns the folders directly inside another one that hold a file, at any depth; "" is the root.
std::set<std::string> folders_in(const Tree& files, const std::string& folder) {
    const std::string above = folder.empty() ? "" : folder + "/";
    std::set<std::string> found;
    for (const File& file : files) {
        if (!file.path.starts_with(above)) continue;
        const std::size_t slash = file.path.find('/', above.size());
        if (slash != file.path.npos) found.insert(file.path.substr(above.size(), slash - above.size()));
    }
    return found;
}

Findings missing_pages(const Tree& files) {
    std::vector<std::string> rooms{""};
    for (const std::string_view floor : floors)
        if (floor != without_page) rooms.emplace_back(floor);
    for (const std::string& room : folders_in(files, "kernel")) rooms.push_back("kernel/" + room);
    Findings found;
    for (const std::string& room : rooms) {
        const std::string path = room.empty() ? "README.md" : room + "/README.md";
        const auto page = std::ranges::find(files, path, &File::path);
        if (page == files.end()) {
            found.push_back({path, 1, "the room has no page",
                             "say what lies here, what comes in, what goes out and where to add what"});
            continue;
        }
        const Prose said = prose(*page);
        for (const std::string& inner : folders_in(files, room))
            if (find_word(said.text, inner) == said.text.npos)
                found.push_back({path, 1, "does not name the folder " + inner, "say in a line what it is"});
    }
    return found;
}

/// The numbers of lines in a page's tables, and those in names of tests below `folder`, as line_NN.
std::set<std::string> numbers_in(const Tree& files, std::string_view folder, const std::regex& form) {
    std::set<std::string> found;
    for (const File& each : files) {
        if (!each.is_under(folder)) continue;
        for (const std::string& line : each.lines)
            if (std::smatch number; std::regex_search(line, number, form))
                found.insert(number[1].length() == 1 ? "0" + number[1].str() : number[1].str());
    }
    return found;
}

TEST(Pages, list_exactly_the_tests_of_the_order_of_state_machines) {
    const auto lines = numbers_in(tree(), "kernel/statechart", std::regex("^\\| ([0-9]+) \\|"));
    const auto tests = numbers_in(tree(), "tests/kernel/statechart", std::regex("^TEST.* line_([0-9]+)_"));
    EXPECT_GT(lines.size(), 30u);
    EXPECT_EQ(lines, tests);
}

TEST(Pages, name_files_that_are_there) { expect_none(missing_files(tree(), is_there)); }
TEST(Pages, name_functions_that_are_there) {
    expect_none(missing_functions(tree()));
    const auto way = std::ranges::find(tree(), "kernel/from-frame-to-valve.md", &File::path);
    ASSERT_NE(way, tree().end());
    EXPECT_GT(hops(*way).size(), 20u) << "the rule does not see the page's hops";
}
TEST(Pages, exist_at_the_head_of_every_room) { expect_none(missing_pages(tree())); }

TEST(PagesRule, finds_files_and_links_that_lead_nowhere) {
    const Exists exists = [](const std::string& path) {
        return path == "kernel/os/a.hpp" || path == "kernel/os" || path == "ci/x";
    };
    const auto faults = [&](std::string_view text) {
        return missing_files({file("kernel/os/README.md", text)}, exists).size();
    };
    for (const auto* good : {"`a.hpp`", "`kernel/os/a.hpp`", "[a](a.hpp)", "[up](../os/a.hpp#part)",
                             "[far](https://example.org/a)", "`ci/x --long`", "`int a`", "`/dev/a.hpp`",
                             "`*.cpp`", "`a/b`", "`build/a.hpp.gz`", "```\n`b.hpp`\n```"})
        EXPECT_EQ(faults(good), 0u) << good;
    for (const auto* bad :
         {"`b.hpp`", "`kernel/os/b.hpp`", "`kernel/attic`", "`attic/`", "[b](b.hpp)", "`ci/y --long`"})
        EXPECT_EQ(faults(bad), 1u) << bad;
}

TEST(PagesRule, finds_functions_that_are_not_in_their_file) {
    const File source = file("kernel/os/a.cpp", "// A word.\nvoid Clock::tick() {}\n");
    const auto faults = [&](std::string_view text) {
        return missing_functions({source, file("kernel/os/README.md", text)}).size();
    };
    EXPECT_EQ(faults("`Clock::tick` in `a.cpp`, `tick()` in\n`kernel/os/a.cpp`\n"), 0u);
    EXPECT_EQ(faults("`Clock::tock` in `a.cpp`\n"), 1u);
    EXPECT_EQ(faults("one line\n`word` in\n`kernel/os/a.cpp`\n"), 1u) << "a comment is no code";
}

TEST(PagesRule, reports_the_line) {
    const Findings found = missing_files({file("a.md", "one\n```\n`b.hpp`\n```\nsee `b.hpp`\n")},
                                         [](const std::string&) { return false; });
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].line, 5u);
}

TEST(PagesRule, finds_rooms_without_a_page_and_unnamed_folders) {
    Tree files{file("README.md", "apps board ci drivers kernel tests toolchain\n"),
               file("kernel/os/a.hpp", "// A.\n")};
    for (const std::string_view floor : floors)
        if (floor != without_page) files.push_back(file(std::string{floor} + "/README.md", "os\n"));
    EXPECT_EQ(missing_pages(files).size(), 1u) << "of kernel/os";
    files.push_back(file("kernel/os/README.md", "a\n"));
    EXPECT_TRUE(missing_pages(files).empty());
    files.push_back(file("kernel/os/attic/a.hpp", "// A.\n"));
    EXPECT_EQ(missing_pages(files).size(), 1u) << "kernel/os/README.md does not name attic";
}

} // namespace
} // namespace tappet::house
