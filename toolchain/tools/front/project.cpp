// Writes projects from templates.
#include "toolchain/tools/front/project.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace tappet::front {

namespace fs = std::filesystem;

namespace {

/// Returns true for a name that is valid in C++, CMake and a file system.
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
    const bool bus = choice.can || choice.cam; // the shaft's encoder is on CAN
    const Tag tags[] = {
        {"@bus ", bus},           {"@nobus ", !bus},           {"@can ", choice.can},
        {"@nocan ", !choice.can}, {"@modbus ", choice.modbus}, {"@nomodbus ", !choice.modbus},
        {"@cam ", choice.cam},    {"@nocam ", !choice.cam},    {"@map ", bus || choice.modbus}};
    std::string result;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end);
        bool stays = true;
        for (bool more = true; more;) {
            more = false;
            for (const Tag& tag : tags)
                if (line.starts_with(tag.word)) {
                    stays &= tag.stays;
                    line.remove_prefix(tag.word.size());
                    more = true;
                }
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
               "\" is not a name for C++ and CMake; write small letters, digits and single underscores, as "
               "in "
               "bottle_filler";
    if (choice.name == "tappet") return "\"tappet\" is the framework's own name; choose another";
    if (fs::exists(choice.name))
        return "\"" + choice.name + "\" exists already; choose another name, or remove it";
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

std::expected<std::vector<std::string>, std::string> machines_of(const fs::path& cmake) {
    const std::string text = contents_of(cmake);
    if (text.empty())
        return std::unexpected(
            "there is no CMakeLists.txt here; go to a machine's folder, or begin with tappet new NAME");
    static const std::regex machine{"(^|\n)\\s*tappet_machine\\(\\s*([A-Za-z0-9_-]+)"};
    std::vector<std::string> names;
    for (std::sregex_iterator at(text.begin(), text.end(), machine), end; at != end; ++at)
        names.push_back((*at)[2].str());
    if (names.empty())
        return std::unexpected("CMakeLists.txt here names no tappet_machine(..); go to a machine's folder");
    return names;
}

std::vector<std::string> boards_of(const fs::path& cmake, std::string_view machine) {
    const std::string text = contents_of(cmake);
    const std::regex call{"tappet_machine\\(\\s*" + std::string{machine} + "\\b([^)]*)\\)"};
    std::smatch arguments;
    std::vector<std::string> boards;
    if (!std::regex_search(text, arguments, call)) return boards;
    static const std::regex keyword{"[A-Z_]+"};
    std::istringstream words{arguments[1].str()};
    bool is_board = false;
    for (std::string word; words >> word;)
        if (std::regex_match(word, keyword))
            is_board = word == "BOARDS";
        else if (is_board)
            boards.push_back(fs::path{word}.extension() == ".hpp" ? fs::path{word}.stem().string() : word);
    return boards;
}

bool has_option(const fs::path& folder, std::string_view option) {
    constexpr std::string_view of_a_name = "abcdefghijklmnopqrstuvwxyz0123456789-_";
    std::error_code error;
    for (fs::recursive_directory_iterator at{folder, error}, end; !error && at != end; at.increment(error)) {
        if (at->is_directory() && fs::exists(at->path() / "CMakeCache.txt")) at.disable_recursion_pending();
        const std::string extension = at->path().extension().string();
        if (extension != ".hpp" && extension != ".cpp" && extension != ".h") continue;
        const std::string text = contents_of(at->path());
        for (std::size_t found = text.find(option); found != text.npos;
             found = text.find(option, found + 1)) {
            const std::size_t after = found + option.size();
            if (after == text.size() || of_a_name.find(text[after]) == of_a_name.npos) return true;
        }
    }
    return false;
}

} // namespace tappet::front
