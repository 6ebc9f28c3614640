// No dead file: a CMakeLists.txt names each source, and an include names each header.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

namespace tappet::house {
namespace {

/// The words of a CMakeLists.txt that name sources, as patterns from the root: a variable matches anything,
/// since foreach builds names from it.
std::vector<std::regex> sources_of(const File& cmake) {
    static const std::regex word("[^\\s()\"]+\\.(cpp|c)(?=[\\s()\"]|$)");
    static const std::regex root("^\\$\\{(CMAKE|PROJECT)_SOURCE_DIR\\}/");
    static const std::regex variable("\\$\\{[^}]*\\}");
    std::vector<std::regex> found;
    for (const std::string& line : cmake.lines) {
        const std::string said = line.substr(0, line.find('#'));
        for (std::sregex_iterator at(said.begin(), said.end(), word), end; at != end; ++at) {
            std::string name = at->str();
            if (std::regex_search(name, root))
                name = std::regex_replace(name, root, "");
            else if (!cmake.folder().empty())
                name = cmake.folder() + "/" + name;
            name = std::regex_replace(name, std::regex("\\."), "\\.");
            found.emplace_back(std::regex_replace(name, variable, ".*"));
        }
    }
    return found;
}

/// The program of tests/diagnostics finds its cases in their folder; the machines of the guide's pages
/// include its context.
bool has_no_target(const File& file) {
    return file.is_under("tests/diagnostics/cases") || file.is_under("board/bench/left_out") ||
           file.is_under("toolchain/libmodbus") || file.is_under("toolchain/aarch64") ||
           file.path == "tests/toolchain/guide/context.hpp";
}

Findings dead(const Tree& files) {
    std::vector<std::regex> sources;
    std::set<std::string> headers;
    std::string cmake_text;
    std::set<std::string> given_to_mains;
    static const std::regex given(
        "(TABLE|BINDINGS|PLANT|HOOKS|BOARDS)(?:\\s+[a-z0-9_-]+)*\\s+([^\\s()]+\\.hpp)");
    for (const File& file : files) {
        if (file.is_cmake()) {
            std::ranges::move(sources_of(file), std::back_inserter(sources));
            for (const std::string& line : file.lines) {
                cmake_text += line + "\n";
                for (std::sregex_iterator at(line.begin(), line.end(), given), end; at != end; ++at)
                    given_to_mains.insert(file.folder() + "/" + (*at)[2].str());
            }
        }
        for (const Include& include : includes(file)) headers.insert(include.name);
    }
    Findings found;
    for (const File& file : files) {
        if (!file.is_cpp() || has_no_target(file)) continue;
        if (file.path.ends_with(".hpp")) {
            // The build names a board's header and picks the board. tappet_machine(..) hands the headers of
            // its folder to the mains.
            const bool by_build = (file.name() == "board.hpp" &&
                                   cmake_text.contains(file.folder().substr(file.folder().rfind('/') + 1))) ||
                                  given_to_mains.contains(file.path);
            if (!headers.contains(file.path) && !by_build)
                found.push_back(
                    {file.path, 1, "no file includes it", "remove it, or include it where it is needed"});
        } else if (std::ranges::none_of(
                       sources, [&](const std::regex& s) { return std::regex_match(file.path, s); })) {
            found.push_back({file.path, 1, "no CMakeLists.txt names it", "remove it, or add it to a target"});
        }
    }
    return found;
}

TEST(Reach, no_file_is_dead) { expect_none(dead(tree())); }

TEST(ReachRule, finds_a_source_without_a_target_and_a_header_without_an_include) {
    EXPECT_EQ(dead({file("kernel/os/a.cpp", "// A.\n")}).size(), 1u);
    EXPECT_EQ(dead({file("kernel/os/a.hpp", "// A.\n")}).size(), 1u);
    EXPECT_EQ(
        dead({file("kernel/os/a.cpp", "// A.\n"), file("kernel/CMakeLists.txt", "# os/a.cpp\n")}).size(), 1u);
}

TEST(ReachRule, knows_every_way_to_name_a_source) {
    const File source = file("kernel/os/a_main.cpp", "// A.\n#include \"kernel/os/a.hpp\"\n");
    const File header = file("kernel/os/a.hpp", "// A.\n");
    for (const auto* line :
         {"add_library(a a_main.cpp)", "add_library(a \"${CMAKE_SOURCE_DIR}/kernel/os/a_main.cpp\")",
          "add_library(a ${name}_main.cpp)"})
        EXPECT_TRUE(dead({source, header, file("kernel/os/CMakeLists.txt", line)}).empty()) << line;
    EXPECT_TRUE(
        dead({source, header, file("kernel/CMakeLists.txt", "add_library(a os/a_main.cpp)")}).empty());
}

TEST(ReachRule, knows_the_headers_that_a_machine_hands_to_its_mains) {
    const auto* const line = "tappet_machine(saw TABLE saw.hpp BOARDS bench boards/box.hpp)";
    EXPECT_TRUE(dead({file("apps/saw/saw.hpp", "// S.\n"), file("apps/saw/boards/box.hpp", "// B.\n"),
                      file("apps/saw/CMakeLists.txt", line)})
                    .empty());
    EXPECT_EQ(dead({file("apps/saw/other.hpp", "// O.\n"), file("apps/saw/CMakeLists.txt", line)}).size(),
              1u);
}

} // namespace
} // namespace tappet::house
