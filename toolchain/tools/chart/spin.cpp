// Runs spin, the C compiler and the search, one after the other.
#include "toolchain/tools/chart/spin.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <sys/wait.h>

namespace tappet::chart {

namespace {

int run(const std::string& command, std::string& said) {
    std::FILE* const pipe =
        popen((command + " 2>&1").c_str(), "r"); // NOLINT: the command is made of this file's own words
    if (pipe == nullptr) return -1;
    std::array<char, 4096> part{};
    while (std::fgets(part.data(), part.size(), pipe) != nullptr) said += part.data();
    const int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string found_in(const std::string& text, const char* pattern) {
    std::smatch match;
    return std::regex_search(text, match, std::regex{pattern}) ? match[1].str() : std::string{};
}

/// Returns the words between the comment signs of a line; empty for an empty line.
std::string mark_of(const std::vector<std::string>& lines, std::size_t number) {
    if (number == 0 || number > lines.size()) return {};
    const std::string& line = lines[number - 1];
    const std::size_t from = line.find("/* ");
    const std::size_t to = line.rfind(" */");
    return from == std::string::npos || to == std::string::npos ? std::string{}
                                                                : line.substr(from + 3, to - from - 3);
}

} // namespace

bool has_spin() {
    std::string said;
    return run("command -v spin", said) == 0;
}

SpinSearch search(const std::string& model, const std::vector<std::string>& defines) {
    SpinSearch result;
    std::string place = (std::filesystem::temp_directory_path() / "tappet-chart-XXXXXX").string();
    if (mkdtemp(place.data()) == nullptr) return result;
    std::ofstream{place + "/model.pml"} << model;
    std::string options;
    for (const std::string& each : defines) options += " -D" + each;
    // Without merged statements, each line is reported by itself.
    const int status =
        run("cd '" + place + "' && spin -a -o3" + options +
                " model.pml && cc -O0 -w -DSAFETY -DVECTORSZ=4096 -o search pan.c && ./search -m2000000 -w22",
            result.output);
    result.ran = status == 0;
    std::vector<std::string> lines;
    std::istringstream stream{model};
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    const std::string errors = found_in(result.output, "errors: ([0-9]+)");
    if (!errors.empty()) result.errors = std::stol(errors);
    const std::string states = found_in(result.output, "([0-9.e+]+) states, stored");
    if (!states.empty()) result.states = std::stod(states);
    const std::string seconds = found_in(result.output, "elapsed time ([0-9.e+]+) seconds");
    if (!seconds.empty()) result.seconds = std::stod(seconds);
    result.error = found_in(result.output, "pan:[0-9]+: (.*)\n");
    result.complete = !result.output.contains("max search depth too small") &&
                      !result.output.contains("Search not completed") &&
                      !result.output.contains("out of memory");
    static const std::regex line_number{"model\\.pml:([0-9]+)"};
    std::vector<std::string> reached_nowhere;
    for (std::sregex_iterator each{result.output.begin(), result.output.end(), line_number}, end; each != end;
         ++each)
        if (std::string mark = mark_of(lines, std::stoul((*each)[1])); !mark.empty())
            reached_nowhere.push_back(std::move(mark));
    for (const std::string& each : reached_nowhere)
        if (std::ranges::find(result.unreached, each) == result.unreached.end())
            result.unreached.push_back(each);
    if (result.errors > 0) {
        // The first error trail may be a long one: a shallow search often finds a short one.
        std::string said;
        static_cast<void>(
            run("cd '" + place +
                    "' && for depth in 100 300 1000 4000; do ./search -m$depth -w22 | grep -q 'errors: 1' && "
                    "break; done",
                said));
        said.clear();
        static_cast<void>(run("cd '" + place + "' && spin -t -p" + options + " model.pml", said));
        for (std::sregex_iterator each{said.begin(), said.end(), line_number}, end; each != end; ++each) {
            std::string mark = mark_of(lines, std::stoul((*each)[1]));
            if (!mark.empty() && !mark.starts_with("state ") &&
                (result.trail.empty() || result.trail.back() != mark))
                result.trail.push_back(std::move(mark));
        }
        result.unreached.clear(); // the search ended early
    }
    std::error_code ignored;
    std::filesystem::remove_all(place, ignored);
    return result;
}

} // namespace tappet::chart
