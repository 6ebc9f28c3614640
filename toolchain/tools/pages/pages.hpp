// The generated pages, as Markdown: every refusal, from its tests; every component, row and command, from the
// comments in the code.
#pragma once

#include <expected>
#include <filesystem>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::pages {

/// A sentence by which the compiler refuses a machine, as in a test.
struct Refusal {
    std::string topic;    ///< the file of its row, or the topic of the test
    std::string name;     ///< of its row, case or test: "activity_runs_nothing"
    std::string sentence; ///< # stands for any number
};
/// Returns the refusals of all rows and cases of tests/diagnostics, and of the tests of state machines,
/// limits and maps, by topic. Leaves out refusals that only clang sees: they are names of functions.
std::vector<Refusal> refusals(const std::filesystem::path& tree);

/// A word of a table's row or of a map: a function or a constant of a header, with its comment.
struct Word {
    std::string spelled; ///< "at_most(std::int64_t n, Duration per)"
    std::string text;
};
/// Returns the words in the header's order. The error names those without a comment.
std::expected<std::vector<Word>, std::string> words(const std::string& header, std::string_view text);
/// Returns the comment above a struct or a class of the header.
std::string text_of(std::string_view header, std::string_view type);

/// The error names unreadable files, or words without a comment.
std::expected<std::string, std::string> refusals_page(const std::filesystem::path& tree);
std::expected<std::string, std::string> reference_page(const std::filesystem::path& tree);

std::string contents_of(const std::filesystem::path& file);
// Formats one cell of a table: words, and code.
std::string cell(std::string_view text);
std::string code(std::string_view text);

} // namespace tappet::pages
