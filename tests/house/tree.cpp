// Reads the repository and separates C++ text into code and comments: a scanner of comments, literals and raw
// literals.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ranges>

namespace tappet::house {
namespace {

namespace fs = std::filesystem;

bool is_word_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::vector<std::string> split(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(end == text.npos ? text.size() : end + 1);
    }
    return lines;
}

/// Scans the text once and assigns each part to its line.
class Scanner {
public:
    Scanner(std::string_view text, File& into) : text_(text), into_(into) {
        into_.code.resize(into_.lines.size() + 1);
        into_.comments.resize(into_.lines.size() + 1);
    }

    void scan() {
        while (at_ < text_.size()) {
            if (text_.substr(at_).starts_with("//"))
                comment("\n", 0);
            else if (text_.substr(at_).starts_with("/*"))
                comment("*/", 2);
            else if (is_raw_literal())
                raw_literal();
            else if (text_[at_] == '"' || is_character())
                literal(text_[at_]);
            else
                take(into_.code);
        }
        into_.code.resize(into_.lines.size());
        into_.comments.resize(into_.lines.size());
    }

private:
    void take(std::vector<std::string>& kind) {
        if (text_[at_] == '\n')
            ++line_;
        else
            kind[line_].push_back(text_[at_]);
        ++at_;
    }
    void skip() {
        if (text_[at_] == '\n') ++line_;
        ++at_;
    }
    void comment(std::string_view end, std::size_t closing) {
        const std::size_t last = std::min(text_.find(end, at_ + 2), text_.size() - closing) + closing;
        while (at_ < last) take(into_.comments);
    }
    [[nodiscard]] bool is_raw_literal() const {
        return text_.substr(at_).starts_with("R\"") && (at_ == 0 || !is_word_character(text_[at_ - 1]));
    }
    /// Tells a character literal from the mark between digits.
    [[nodiscard]] bool is_character() const {
        return text_[at_] == '\'' && (at_ == 0 || !is_word_character(text_[at_ - 1]));
    }
    void raw_literal() {
        const std::size_t open = std::min(text_.find('(', at_), text_.size());
        const std::string end = ")" + std::string(text_.substr(at_ + 2, open - at_ - 2)) + "\"";
        const std::size_t last = std::min(text_.find(end, open), text_.size() - end.size()) + end.size();
        into_.code[line_] += "\"\"";
        while (at_ < last && at_ < text_.size()) skip();
    }
    void literal(char quote) {
        take(into_.code);
        while (at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n') {
            if (text_[at_] == '\\' && at_ + 1 < text_.size()) skip();
            skip();
        }
        if (at_ < text_.size()) take(into_.code);
    }

    std::string_view text_;
    File& into_;
    std::size_t at_ = 0;
    std::size_t line_ = 0;
};

/// Returns whether the rules apply to a file. They ignore all others, such as pictures.
bool is_text(const fs::path& path) {
    static constexpr std::array extensions{".hpp", ".cpp", ".h", ".c", ".cmake", ".txt", ".md", ".json", ""};
    return std::ranges::find(extensions, path.extension().string()) != extensions.end();
}

Tree read(const fs::path& root) {
    Tree files;
    for (auto entry = fs::recursive_directory_iterator(root); entry != fs::recursive_directory_iterator();
         ++entry) {
        const std::string path = fs::relative(entry->path(), root).generic_string();
        if (entry->is_directory()) {
            if (path.starts_with('.') || path == "build") entry.disable_recursion_pending();
            continue;
        }
        if (!entry->is_regular_file() || !is_text(entry->path()) || path == "LICENSE" || path == ".git")
            continue;
        std::ifstream stream(entry->path(), std::ios::binary);
        files.push_back(file(path, std::string(std::istreambuf_iterator<char>(stream), {})));
    }
    std::ranges::sort(files, {}, &File::path);
    return files;
}

std::vector<std::string> without_examples(const std::vector<std::string>& lines) {
    std::vector<std::string> prose;
    bool is_fenced = false;
    for (const std::string& line : lines) {
        const bool is_fence = line.starts_with("```");
        prose.push_back(is_fenced || is_fence ? "" : line);
        is_fenced ^= is_fence;
    }
    return prose;
}

} // namespace

bool File::is_cpp() const {
    static constexpr std::array extensions{".hpp", ".cpp", ".h", ".c"};
    return std::ranges::any_of(extensions, [&](std::string_view end) { return path.ends_with(end); });
}
bool File::is_page() const { return path.ends_with(".md"); }
bool File::is_cmake() const { return path.ends_with(".cmake") || path.ends_with("CMakeLists.txt"); }
std::string File::name() const { return path.substr(path.rfind('/') + 1); }
std::string File::folder() const {
    const std::size_t slash = path.rfind('/');
    return slash == path.npos ? "" : path.substr(0, slash);
}
bool File::is_under(std::string_view folder) const {
    return path.starts_with(folder) && path.size() > folder.size() && path[folder.size()] == '/';
}

File file(std::string path, std::string_view text) {
    File made{.path = std::move(path), .lines = split(text), .code = {}, .comments = {}, .prose = {}};
    if (made.is_cpp()) Scanner(text, made).scan();
    if (made.is_page()) made.prose = without_examples(made.lines);
    return made;
}

const Tree& tree() {
    static const Tree files = read(TAPPET_TREE);
    return files;
}

std::vector<Include> includes(const File& file) {
    std::vector<Include> found;
    for (std::size_t i = 0; i < file.code.size(); ++i) {
        if (!file.code[i].starts_with("#include")) continue;
        const std::string& line = file.lines[i];
        const std::size_t open = line.find_first_of("\"<");
        if (open == line.npos) continue;
        const std::size_t close = line.find_first_of("\">", open + 1);
        found.push_back({line.substr(open + 1, close - open - 1), i + 1, line[open] == '"'});
    }
    return found;
}

void expect_none(const Findings& findings) {
    std::string text;
    for (const Finding& f : findings)
        text += f.path + ":" + std::to_string(f.line) + ": " + f.fault + "; " + f.cure + "\n";
    if (!findings.empty()) ADD_FAILURE() << findings.size() << " against the rules of the house:\n" << text;
}

std::size_t find_word(std::string_view text, std::string_view word, std::size_t from) {
    for (std::size_t at = text.find(word, from); at != text.npos; at = text.find(word, at + 1)) {
        const bool begins = at == 0 || !is_word_character(word.front()) || !is_word_character(text[at - 1]);
        const std::size_t end = at + word.size();
        const bool ends =
            end == text.size() || !is_word_character(word.back()) || !is_word_character(text[end]);
        if (begins && ends) return at;
    }
    return text.npos;
}

} // namespace tappet::house
