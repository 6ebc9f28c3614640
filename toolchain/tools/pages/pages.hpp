// The pages that nobody writes: every refusal, from its tests; every component, row and command, from what
// the code says of itself. As Markdown.
#pragma once

#include <expected>
#include <filesystem>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::pages {

/// A sentence by which the compiler refuses a machine, as a test has it.
struct Refusal {
    std::string topic;    ///< the file of its row, or what the test is about
    std::string name;     ///< of its row, case or test: "activity_runs_nothing"
    std::string sentence; ///< # stands for any number
};
/// Of all rows and cases of tests/diagnostics, and of the tests of state machines, limits and maps, by topic;
/// those that only clang sees are functions' names, and left out.
std::vector<Refusal> refusals(const std::filesystem::path& tree);

/// What may stand in a table's row or in a map: a function or a constant of a header, with its comment.
struct Word {
    std::string spelled; ///< "at_most(std::int64_t n, Duration per)"
    std::string text;
};
/// In the header's order. An error names those that have no text.
std::expected<std::vector<Word>, std::string> words(const std::string& header, std::string_view text);
/// The comment above a struct or a class of the header.
std::string text_of(std::string_view header, std::string_view type);

/// The files that could not be read, or what has no text, are the error.
std::expected<std::string, std::string> refusals_page(const std::filesystem::path& tree);
std::expected<std::string, std::string> reference_page(const std::filesystem::path& tree);

std::string contents_of(const std::filesystem::path& file);
// As one cell of a table: words, and what is spelled so.
std::string cell(std::string_view text);
std::string code(std::string_view text);

} // namespace tappet::pages
