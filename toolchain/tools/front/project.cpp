// Writing projects from templates.
#include "toolchain/tools/front/project.hpp"

#include "kernel/base/nearest.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

namespace tappet::front {

namespace fs = std::filesystem;

namespace {

/// A name that C++, CMake and a file system take.
bool is_name(const std::string& name) {
    static const std::regex good{"[a-z][a-z0-9]*(_[a-z0-9]+)*"};
    return std::regex_match(name, good);
}

void replace_all(std::string& text, std::string_view what, const std::string& by) {
    for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

std::string contents_of(const fs::path& path) {
    std::ifstream file{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
}

} // namespace

std::string filled(std::string_view text, const Choice& choice) {
    struct Tag {
        std::string_view word;
        bool stays;
    };
    const Tag tags[] = {{"@can ", choice.can},
                        {"@nocan ", !choice.can},
                        {"@modbus ", choice.modbus},
                        {"@nomodbus ", !choice.modbus}};
    std::string result;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end);
        bool stays = true;
        for (const Tag& tag : tags)
            if (line.starts_with(tag.word)) {
                stays = tag.stays;
                line.remove_prefix(tag.word.size());
                break;
            }
        if (stays) result += line;
    }
    std::string title = choice.name;
    std::ranges::replace(title, '_', '-');
    replace_all(result, "@NAME@", choice.name);
    replace_all(result, "@TITLE@", title);
    return result;
}

std::string write_project(const fs::path& templates, const Choice& choice) {
    if (choice.name.empty()) return "the machine needs a name: tappet new bottle_filler";
    if (!is_name(choice.name))
        return "\"" + choice.name +
               "\" is no name for C++ and CMake; write small letters, digits and single underscores, as in "
               "bottle_filler";
    if (choice.name == "tappet") return "\"tappet\" is the framework's own name; take another";
    if (fs::exists(choice.name))
        return "\"" + choice.name + "\" is there already; take another name, or remove it";
    if (!fs::is_directory(templates))
        return "the templates are not at " + templates.string() + "; install Tappet anew";
    std::error_code error;
    for (const auto& entry : fs::recursive_directory_iterator{templates}) {
        if (entry.path().extension() != ".in") continue;
        const fs::path to = fs::path{choice.name} / fs::relative(entry.path(), templates).replace_extension();
        fs::create_directories(to.parent_path(), error);
        std::ofstream file{to, std::ios::binary};
        file << filled(contents_of(entry.path()), choice);
        if (!file.flush()) return "cannot write " + to.string() + "; check the folder's rights and the disk";
    }
    return {};
}

std::expected<std::string, std::string> machine_of(const fs::path& cmake) {
    const std::string text = contents_of(cmake);
    if (text.empty())
        return std::unexpected(
            "there is no CMakeLists.txt here; go to a machine's folder, or begin with tappet new NAME");
    static const std::regex machine{"(^|\n)\\s*tappet_machine\\(\\s*([A-Za-z0-9_-]+)"};
    std::smatch found;
    if (!std::regex_search(text, found, machine))
        return std::unexpected("CMakeLists.txt here names no tappet_machine(..); go to a machine's folder");
    return found[2].str();
}

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
    Nearest nearest{word};
    for (const std::string& name : names) nearest.consider(name);
    return nearest.best().empty() ? "" : "; did you mean " + std::string{nearest.best()} + "?";
}

} // namespace tappet::front
