// Reads the comments above the declarations of headers.
#include "toolchain/tools/pages/pages.hpp"

#include <algorithm>
#include <regex>
#include <sstream>

namespace tappet::pages {

namespace {

/// Joins "/// a" and "/// b" to "a b"; an indented line is an example and starts a new line.
void add_comment(std::string& text, std::string_view line) {
    line.remove_prefix(std::min<std::size_t>(line.size(), 3));
    const std::size_t first = line.find_first_not_of(' ');
    if (first == line.npos) return;
    const std::string words{line.substr(first)};
    text += (text.empty() ? "" : " ") + (first > 1 ? "`" + words + "`" : words);
}

/// The words of rows are in `tappet` or in a driver's namespace; their implementation is one level deeper.
bool is_detail(std::string_view line) {
    return line.starts_with("namespace ") &&
           (line.contains("detail") || !line.starts_with("namespace tappet"));
}

} // namespace

std::string text_of(std::string_view header, std::string_view type) {
    const std::regex head{"^(template <.*> )?(struct|class) " + std::string{type} + "\\b.*\\{"};
    std::istringstream lines{std::string{header}};
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        if (std::regex_search(line, head)) return text;
        if (line == "///")
            text += "\n\n"; // a paragraph of its own
        else if (line.starts_with("///"))
            add_comment(text, line);
        else if (!line.starts_with("template") && !line.starts_with("// clang-format"))
            text.clear();
    }
    return {};
}

std::expected<std::vector<Word>, std::string> words(const std::string& header, std::string_view text) {
    // Functions that return a number or nothing are not part of a row.
    static const std::regex function{
        R"(^constexpr (?!bool|void|unsigned|std::size_t)[\w:<>, ]+? (\w+\([^{]*\))(?: noexcept)?(?: \{.*)?$)"};
    static const std::regex constant{R"(^inline constexpr (?!std::size_t|unsigned)[\w:]+ (\w+)\b.*;)"};
    std::vector<Word> found;
    std::istringstream lines{std::string{text}};
    std::string comment, name_before, silent;
    bool inside_detail = false;
    for (std::string line; std::getline(lines, line);) {
        if (is_detail(line)) inside_detail = true;
        if (line.starts_with("} // namespace")) inside_detail = false;
        if (line.starts_with("///")) {
            add_comment(comment, line);
            continue;
        }
        static const std::regex parameters{"^template <.*> (?=constexpr )"};
        line = std::regex_replace(line, parameters, "");
        if (inside_detail || line.starts_with("template")) continue;
        std::string joined = line; // a declaration may continue on the next line
        while (line.starts_with("constexpr ") && !joined.ends_with('{') && !joined.ends_with('}') &&
               std::getline(lines, line))
            joined += ' ' + line.substr(std::min(line.find_first_not_of(' '), line.size()));
        std::smatch word;
        if (!std::regex_search(joined, word, function) && !std::regex_search(joined, word, constant)) {
            comment.clear();
            continue;
        }
        const std::string spelled =
            std::regex_replace(word[1].str(), std::regex{"std::(string_view|)"}, "$1");
        const std::string name = spelled.substr(0, spelled.find('('));
        if (comment.empty() && name != name_before) silent += (silent.empty() ? "" : ", ") + name;
        found.push_back({spelled, comment.empty() ? "as above" : comment});
        comment.clear();
        name_before = name;
    }
    if (silent.empty()) return found;
    return std::unexpected(header + " has no text of " + silent + "; say above each, after ///, what it is");
}

} // namespace tappet::pages
