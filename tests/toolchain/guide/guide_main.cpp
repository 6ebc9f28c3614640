// Takes the guide's pages apart, writes their code as cases of tests/diagnostics, and becomes the program
// that compiles them:
//     guide --pages DIR --templates DIR --to DIR --scripts FILE --front PROGRAM --browser PROGRAM -- JUDGE...
// The help of its program knows each command that a page shows.
#include "tests/toolchain/guide/page.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <regex>

#include <unistd.h>

namespace tappet::guide {
namespace {

namespace fs = std::filesystem;

std::string output_of(const std::string& command) {
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return text;
    std::array<char, 4096> block{};
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe))
        text.append(block.data(), n);
    pclose(pipe);
    return text;
}

/// Returns whether that word is a command of that program, for "tappet build" and "tappet-browse list warp".
bool is_known(const std::string& command, const std::string& of_front, const std::string& of_browser) {
    static const std::regex used{"\\s*(tappet browse|tappet-browse|tappet)\\s+([a-z]+).*"};
    std::smatch words;
    if (!std::regex_match(command, words, used)) return true;
    const bool front = words[1] == "tappet";
    const std::regex row{std::string{front ? "  tappet " : "\n  "} + words[2].str() + "\\b"};
    return std::regex_search(front ? of_front : of_browser, row);
}

int write_all(std::map<std::string, std::string>& options) {
    const fs::path to{options["--to"]};
    fs::remove_all(to);
    fs::create_directories(to);
    const std::string of_front = output_of("'" + options["--front"] + "' --help");
    const std::string of_browser = output_of("'" + options["--browser"] + "' help");
    std::size_t faults = 0;
    const auto fail = [&faults](const std::string& what) { std::cout << what << '\n', ++faults; };
    for (const auto& entry : fs::directory_iterator{options["--pages"]}) {
        if (entry.path().extension() != ".md") continue;
        std::ifstream file{entry.path()};
        const std::string text{std::istreambuf_iterator<char>{file}, {}};
        const auto page = read_page(text, options["--templates"]);
        if (!page) {
            fail(entry.path().string() + ":" + page.error());
            continue;
        }
        for (const std::string& command : page->commands)
            if (!is_known(command, of_front, of_browser))
                fail(entry.path().string() + ": \"" + command + "\" names no command of its program");
        for (const Unit& unit : page->units) {
            const std::string name =
                entry.path().stem().string() + (unit.refusal.empty() ? "" : "-" + std::to_string(unit.line));
            write_unit(unit, to, name, entry.path().filename().string());
            for (const auto& [path, script] : unit.project.files) {
                const std::string from = (to / name / path).string();
                if (path.ends_with(".osd") &&
                    std::system(("cmake '-DFROM=" + from + "' '-DTO=" + from + ".hpp' '-DPLACE=" + path +
                                 "' '-DCONSTANT=scripts::" + fs::path{path}.stem().string() + "' -P '" +
                                 options["--scripts"] + "'")
                                    .c_str()) != 0)
                    fail(from + ": no constant could be made of it");
            }
        }
    }
    return faults == 0 ? 0 : 1;
}

int main(int count, char** words) {
    std::map<std::string, std::string> options;
    int at = 1;
    for (; at + 1 < count && std::string_view{words[at]} != "--"; at += 2) options[words[at]] = words[at + 1];
    if (at + 1 >= count || options.size() != 6) {
        std::cerr << "usage: guide --pages DIR --templates DIR --to DIR --scripts FILE --front PROGRAM "
                     "--browser PROGRAM -- JUDGE...\n";
        return 2;
    }
    if (const int status = write_all(options); status != 0) return status;
    ::execv(words[at + 1], words + at + 1);
    std::perror(words[at + 1]);
    return 2;
}

} // namespace
} // namespace tappet::guide

int main(int count, char** words) { return tappet::guide::main(count, words); }
