// Words that no file may contain: notes to oneself, places outside the repository, code that is switched off;
// and sentences that begin with their object.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <regex>

namespace tappet::house {
namespace {

struct Banned {
    std::string_view word;
    bool as_word; ///< else anywhere in the text
    std::string_view cure;
};

// In two pieces, so that this file passes its own rule.
// clang-format off
constexpr std::array banned{
    Banned{"TO" "DO",           true,  "do it, or leave it out visibly"},
    Banned{"FIX" "ME",          true,  "repair it"},
    Banned{"X" "XX",            true,  "repair it"},
    Banned{"HA" "CK",           true,  "write it properly, or say why it must be so"},
    Banned{"for n" "ow",        true,  "say what holds, not what will"},
    Banned{"/wo" "rk/",         false, "name no path outside the repository"},
    Banned{"is" "sue #",        false, "say the reason itself"},
};
// clang-format on

Findings banned_words(const Tree& files) {
    Findings found;
    for (const File& file : files)
        for (std::size_t i = 0; i < file.lines.size(); ++i)
            for (const Banned& row : banned) {
                const std::string& line = file.lines[i];
                if (row.as_word ? find_word(line, row.word) != line.npos : line.contains(row.word))
                    found.push_back(
                        {file.path, i + 1, "says \"" + std::string(row.word) + "\"", std::string(row.cure)});
            }
    return found;
}

/// A comment that reads like a statement. An example in a comment is indented by four spaces or more and
/// passes.
bool is_code(std::string_view comment) {
    static const std::regex statement(
        "(return\\b.*;|#\\s*(include|if|define|endif).*|\\}.*|[\\w:<>,.*&\\[\\] "
        "-]+(\\(.*\\)|\\s*[-+|&]?=\\s*[^=].*);"
        "|(if|for|while|switch) ?\\(.*\\).*[;{]|.*\\) ?(const )?(noexcept )?\\{)");
    if (!comment.starts_with("//")) return false;
    comment.remove_prefix(std::min(comment.find_first_not_of("/<"), comment.size()));
    const std::size_t indent = comment.find_first_not_of(' ');
    if (indent == comment.npos || indent >= 4) return false;
    comment.remove_prefix(indent);
    return std::regex_match(comment.begin(), comment.end(), statement);
}

Findings code_in_comments(const Tree& files) {
    Findings found;
    for (const File& file : files)
        for (std::size_t i = 0; i < file.comments.size(); ++i)
            if (is_code(file.comments[i]))
                found.push_back({file.path, i + 1, "a comment that is code",
                                 "remove it; an example is indented by four spaces"});
    return found;
}

/// Returns the text of a line that people read as sentences: a comment without its marks, or a line of a page
/// outside of its examples and headings.
std::string prose_of(const File& file, std::size_t at) {
    if (file.is_page()) {
        const std::string& line = file.prose[at];
        return line.starts_with('#') || line.starts_with("    ") ? "" : line;
    }
    const std::string& comment = file.is_cpp() ? file.comments[at] : file.lines[at];
    const std::size_t mark = comment.find_first_not_of(file.is_cpp() ? "/<!*" : " ");
    if (mark == comment.npos || (!file.is_cpp() && comment[mark] != '#')) return {};
    return comment.substr(mark + (file.is_cpp() ? 0 : 1));
}

/// A sentence that begins with its object, or with a clause about whoever does it, is read twice. Questions
/// may.
Findings sentences_turned_round(const Tree& files) {
    static const std::regex opening("(?:^[ >|*0-9.-]*|[.;:|] |[*][*])"
                                    "(What|Who|Whose|Whoever|Whom|Of|Likewise|Beside)\\b[^.?]*[.?]?");
    Findings found;
    for (const File& file : files) {
        if (file.is_under("tests/fuzz/corpus")) continue;
        for (std::size_t i = 0; i < file.lines.size(); ++i) {
            const std::string prose = prose_of(file, i);
            for (std::sregex_iterator at(prose.begin(), prose.end(), opening), end; at != end; ++at)
                if (!at->str().ends_with('?'))
                    found.push_back({file.path, i + 1, "a sentence begins with \"" + at->str(1) + "\"",
                                     "begin with the subject: say who does what"});
        }
    }
    return found;
}

/// The texts before the diffs of planted faults, as pages.
Tree headers_of_planted() {
    Tree headers;
    for (const auto& entry : std::filesystem::directory_iterator{TAPPET_TREE "/tests/planted"}) {
        if (entry.path().extension() != ".patch") continue;
        std::ifstream patch{entry.path()};
        std::string header;
        for (std::string line; std::getline(patch, line) && !line.starts_with("diff ");)
            header += line + "\n";
        headers.push_back(file("tests/planted/" + entry.path().filename().string() + ".md", header));
    }
    return headers;
}

TEST(Words, begin_no_sentence_with_its_object) {
    expect_none(sentences_turned_round(tree()));
    expect_none(sentences_turned_round(headers_of_planted()));
}
TEST(Words, hold_no_note_to_oneself_and_no_place_outside) { expect_none(banned_words(tree())); }
TEST(Words, of_comments_are_not_code) { expect_none(code_in_comments(tree())); }

TEST(WordsRule, finds_each_banned_word_and_no_part_of_another) {
    for (const Banned& row : banned)
        EXPECT_EQ(banned_words({file("a.md", "see " + std::string(row.word) + " there\n")}).size(), 1u)
            << row.word;
    EXPECT_TRUE(banned_words({file("a.md", "MA"
                                           "STODON and for n"
                                           "owhere\n")})
                    .empty());
}

TEST(WordsRule, finds_sentences_that_begin_with_their_object) {
    for (const auto* wrong :
         {"// What wakes it says its row.", "/// Late. Who asks is told.", "int x; ///< Of its thread"})
        EXPECT_EQ(sentences_turned_round({file("a.hpp", wrong)}).size(), 1u) << wrong;
    for (const auto* right : {"// What is a tappet?", "// Says what wakes it, of its thread.",
                              "int What = 1;", "const char* x = \"Who asks is told.\";", "// Whatever"})
        EXPECT_TRUE(sentences_turned_round({file("a.hpp", right)}).empty()) << right;
    EXPECT_EQ(sentences_turned_round({file("ci/run", "# Beside it lies a log.\necho What it is.\n")}).size(),
              1u);
    EXPECT_EQ(sentences_turned_round(
                  {file("a.md", "# What holds\n- Of both.\n```\nWho\n```\n    Who\n| a | Whose |\n")})
                  .size(),
              2u);
}

TEST(WordsRule, tells_code_from_prose) {
    for (const auto* code : {"// return x;", "// count = 3;", "// wake(now);", "// #include <array>", "// }",
                             "// if (late) {", "// const int a = b;", "/// list.push_back(x);"})
        EXPECT_TRUE(is_code(code)) << code;
    for (const auto* prose :
         {"// The frame is late;", "// what follows: a list of rows,", "//     wake(now);",
          "// clang-format off", "// see f(x), which wakes it; the rest sleeps", "// a == b holds", ""})
        EXPECT_FALSE(is_code(prose)) << prose;
}

} // namespace
} // namespace tappet::house
