// The repository as the rules of the house see it: every text file with its lines, and of C++ files also what
// is code and what is comment on each line.
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
        code; ///< of C and C++: the same lines, comments and what literals contain left out
    std::vector<std::string> comments; ///< of C and C++: what the comments of each line say, with their marks

    [[nodiscard]] bool is_cpp() const; ///< C++ or C
    [[nodiscard]] bool is_cmake() const;
    [[nodiscard]] std::string name() const;   ///< without its folder
    [[nodiscard]] std::string folder() const; ///< without the last slash; empty at the root
    /// Stands in this folder or in one below it.
    [[nodiscard]] bool is_under(std::string_view folder) const;
};

/// A file from its text; the self-tests of the rules make theirs with it.
File file(std::string path, std::string_view text);

using Tree = std::vector<File>;

/// The whole repository, read once.
const Tree& tree();

/// What #include "..." and #include <...> name, with their lines.
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

/// Fails the running test when something was found, with one line for each: "path:line: fault; cure".
void expect_none(const Findings& findings);

/// Whether `word` stands in `text` from `from` on as a word of its own; npos when not.
std::size_t find_word(std::string_view text, std::string_view word, std::size_t from = 0);

} // namespace tappet::house
