// Reads the models' comments and labels, and runs spin, the compiler and the search that spin wrote.
#include "tests/models/model.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <sys/wait.h>

namespace tappet::models {

namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream{text};
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// The words after "Source:" or "Twins:".
std::vector<std::string> listed(const std::string& text, const std::string& heading) {
    std::vector<std::string> words;
    for (const std::string& line : lines_of(text)) {
        const std::size_t at = line.find(heading);
        if (at == line.npos) continue;
        std::istringstream rest{line.substr(at + heading.size())};
        for (std::string word; rest >> word;) words.push_back(word);
        break;
    }
    return words;
}

Labels labels_of_model(const std::string& text) {
    static const std::regex label{"^\\s*([a-z]+_[a-z_]+):\\s*$"};
    Labels found;
    const auto lines = lines_of(text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::smatch match;
        if (std::regex_match(lines[i], match, label)) found.emplace(match[1], i + 1);
    }
    return found;
}

/// Runs a command and returns its output; -1 when it did not end by itself.
int run(const std::string& command, std::string& said) {
    std::FILE* const pipe =
        popen((command + " 2>&1").c_str(), "r"); // NOLINT: the command is made of the tree's own names
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

} // namespace

std::string read(const std::string& path) {
    std::ifstream file{path};
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

const std::vector<Model>& all_models() {
    static const std::vector<Model> all = [] {
        std::vector<Model> found;
        for (const auto& entry : std::filesystem::directory_iterator{TAPPET_TREE "/tests/models"}) {
            if (entry.path().extension() != ".pml") continue;
            Model model;
            model.name = entry.path().stem();
            model.path = entry.path();
            model.text = read(model.path);
            model.sources = listed(model.text, "Source:");
            model.twins = listed(model.text, "Twins:");
            model.labels = labels_of_model(model.text);
            found.push_back(std::move(model));
        }
        std::ranges::sort(found, {}, &Model::name);
        return found;
    }();
    return all;
}

Labels labels_of_source(const std::string& text) {
    static const std::regex label{"// ([a-z]+)\\.([a-z_]+)$"};
    Labels found;
    const auto lines = lines_of(text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::smatch match;
        if (std::regex_search(lines[i], match, label))
            found.emplace(match[1].str() + "_" + match[2].str(), i + 1);
    }
    return found;
}

std::vector<std::string> unlabelled_accesses(const std::string& text) {
    static const std::regex access{
        "\\b((?:load|store)(?:_pair)?|exchange|compare_exchange_\\w+|fetch_\\w+)\\("};
    static const std::regex excused{"// ([a-z]+\\.[a-z_]+|no step: \\S+ \\S+ .*)$"};
    // A value of several words is written and read by Words, whose own accesses bear the labels;
    // std::exchange stays in one thread.
    static const std::regex composed{
        "\\bvalue\\.(load|store)\\(|(?:void|Pair) (?:load|store)(?:_pair)?\\(|std::exchange\\("};
    std::vector<std::string> found;
    for (const std::string& line : lines_of(text)) {
        const std::string code = line.substr(0, line.find("//"));
        if (!std::regex_search(code, access) || std::regex_search(code, composed)) continue;
        if (!std::regex_search(line, excused)) found.push_back(line);
    }
    return found;
}

Search search(const Model& model, const std::string& twin) {
    Search result;
    std::string pattern = std::filesystem::temp_directory_path() / "tappet-model-XXXXXX";
    const char* const made = mkdtemp(pattern.data());
    if (made == nullptr) return result;
    const std::string place = made;
    const std::string define = twin.empty() ? "" : " -DTWIN_" + twin;
    const int status = run("cd '" + place + "' && cp '" + model.path + "' model.pml && spin -a" + define +
                               " model.pml && cc " + std::string(twin.empty() ? "-O1" : "-O0") +
                               " -w -DSAFETY -o search pan.c && ./search -m100000 -w22",
                           result.output);
    std::error_code ignored;
    std::filesystem::remove_all(place, ignored);
    result.ran = status == 0;
    const std::string errors = found_in(result.output, "errors: ([0-9]+)");
    if (!errors.empty()) result.errors = std::stol(errors);
    const std::string states = found_in(result.output, "([0-9.e+]+) states, stored");
    if (!states.empty()) result.states = std::stod(states);
    result.error = found_in(result.output, "pan:[0-9]+: (.*)\n");
    result.complete = !result.output.contains("max search depth too small") &&
                      !result.output.contains("Search not completed") &&
                      !result.output.contains("out of memory");
    static const std::regex line{"\tmodel\\.pml:([0-9]+), state"};
    for (std::sregex_iterator each{result.output.begin(), result.output.end(), line}, end; each != end;
         ++each)
        result.unreached.push_back(std::stoul((*each)[1]));
    return result;
}

} // namespace tappet::models
