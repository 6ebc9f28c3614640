// The repository as the rules of the house see it: every text file with its lines, and for C++ files also the
// code and the comments of each line.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::house {

struct File {
    std::string path; ///< from the repository's root
    std::vector<std::string> lines;
    std::vector<std::string>
        code; ///< for C and C++: the same lines without comments and without the contents of literals
    std::vector<std::string> comments; ///< for C and C++: the comments of each line, with their marks

    std::vector<std::string> prose; ///< of pages: the same lines, fenced examples left out

    [[nodiscard]] bool is_cpp() const;  ///< C++ or C
    [[nodiscard]] bool is_page() const; ///< Markdown
    [[nodiscard]] bool is_cmake() const;
    [[nodiscard]] std::string name() const;   ///< without its folder
    [[nodiscard]] std::string folder() const; ///< without the last slash; empty at the root
    /// Returns whether the file is in this folder or below it.
    [[nodiscard]] bool is_under(std::string_view folder) const;
};

/// Makes a file from its text; the self-tests of the rules use it.
File file(std::string path, std::string_view text);

using Tree = std::vector<File>;

/// The whole repository, read once.
const Tree& tree();

/// The names in #include "..." and #include <...>, with their lines.
struct Include {
    std::string name;
    std::size_t line;
    bool quoted;
};
std::vector<Include> includes(const File& file);

struct Finding {
    std::string path;
    std::size_t line;
    std::string fault;
    std::string cure;
};
using Findings = std::vector<Finding>;

/// Fails the running test when there are findings, with one line for each: "path:line: fault; cure".
void expect_none(const Findings& findings);

/// Finds `word` in `text` from `from` on as a word of its own; npos: not found.
std::size_t find_word(std::string_view text, std::string_view word, std::size_t from = 0);

} // namespace tappet::house
