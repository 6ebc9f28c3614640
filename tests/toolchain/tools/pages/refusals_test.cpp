// Every sentence with which the table's check refuses appears in a test of tests/diagnostics, and so in the
// index of refusals.
#include "toolchain/tools/pages/pages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

namespace tappet::pages {
namespace {

using testing::IsEmpty;
namespace fs = std::filesystem;

/// The literal pieces of a statement that makes a sentence, in order; one of two alternatives is omitted.
using Pieces = std::vector<std::string>;

std::vector<Pieces> sentences_in(const std::string& source) {
    static const std::regex token{
        R"(//[^\n]*|#include[^\n]*|"((?:\\.|[^"\\])*)\"|'(?:\\.|[^'])'|\breturn\b|;|[^\s"])"};
    static const std::regex sentence{R"(Sentence[{(\w]|\bof_\w+\(|\.add\(|add_suggestion\()"};
    std::vector<Pieces> found;
    Pieces pieces;
    std::string code; // of the statement, without its literals
    const auto end_statement = [&] {
        std::size_t length = 0;
        for (const std::string& piece : pieces) length += piece.size();
        if (std::regex_search(code, sentence) && length > 12) found.push_back(pieces);
        pieces.clear();
        code.clear();
    };
    bool joins = false; // adjacent literals are one
    for (std::sregex_iterator at(source.begin(), source.end(), token), end; at != end; ++at) {
        const std::string word = at->str();
        if (word.starts_with("//") || word.starts_with("#include")) continue;
        if (word == ";" || word == "return") {
            end_statement();
            joins = false;
        } else if ((*at)[1].matched && word.starts_with('"')) {
            static const std::regex escape{R"(\\(.))"};
            const std::string text = std::regex_replace((*at)[1].str(), escape, "$1");
            const bool is_alternative = code.ends_with('?') || (code.ends_with(':') && !code.ends_with("::"));
            if (joins)
                pieces.back() += text;
            else if (!is_alternative)
                pieces.push_back(text);
            joins = !is_alternative || joins;
        } else {
            code += word;
            joins = false;
        }
    }
    return found;
}

bool says(const std::string& sentence, const Pieces& pieces) {
    std::size_t at = 0;
    for (const std::string& piece : pieces) {
        at = sentence.find(piece, at);
        if (at == sentence.npos) return false;
        at += piece.size();
    }
    return true;
}

/// Sentences without a row: a script's compiler refuses earlier, or the machine would be too large for a row.
constexpr std::string_view unsaid[] = {
    ": events(...): \" .. \" has  ..  bytes of arguments, more than the  ..  that a state "
    "machine keeps; read its component's ports instead",
    "its  ..  bytes of arguments exceed the  ..  that a state machine keeps; send them through a port",
    ": script \" .. \" hears more than  ..  events; split it",
    ": script \" .. \" names facet  ..  of \" .. \", which has fewer; compile the script again",
    ": script \" .. \" uses \" .. . .. \" ( .. ) of activity \" .. \"; send it a command, or declare the "
    "operation any_thread if it is safe there",
    " exceeds the  ..  buffer rows that a port may have; merge some",
    ": component \" .. \" may block, and activity \" .. \" runs functions of \" .. \" too; ",
    "the table has more than  ..  activities; merge those of equal period",
    "inputs from other activities",
    "calls answered by several chains",
    "inputs written by several chains",
};

TEST(Refusals, of_the_table_each_have_a_test) {
    const fs::path tree{TAPPET_TREE};
    std::vector<fs::path> sources{tree / "kernel/machine/table/names.hpp",
                                  tree / "kernel/machine/firmware.hpp"};
    for (const auto& entry : fs::directory_iterator{tree / "kernel/machine/check"})
        sources.push_back(entry.path());
    for (const auto& entry : fs::directory_iterator{tree / "kernel/control"})
        if (entry.path().extension() == ".hpp") sources.push_back(entry.path());
    const std::vector<Refusal> golden = refusals(tree);
    std::vector<std::string> silent;
    std::size_t all = 0;
    for (const fs::path& source : sources)
        for (const Pieces& pieces : sentences_in(contents_of(source))) {
            ++all;
            std::string spelled;
            for (const std::string& piece : pieces) spelled += (spelled.empty() ? "" : " .. ") + piece;
            const bool is_said =
                std::ranges::any_of(golden, [&](const Refusal& each) { return says(each.sentence, pieces); });
            const bool is_excused = std::ranges::find(unsaid, spelled) != std::end(unsaid);
            EXPECT_FALSE(is_said && is_excused) << "strike it off the list of the unsaid: " << spelled;
            if (!is_said && !is_excused) silent.push_back(source.filename().string() + ": " + spelled);
        }
    EXPECT_GT(all, 150u) << "the rule does not see the sentences";
    std::ranges::sort(silent);
    EXPECT_THAT(silent, IsEmpty()) << "add a row to tests/diagnostics/rows for each";
}

TEST(RefusalsRule, finds_what_a_statement_spells_out) {
    EXPECT_THAT(
        sentences_in("return of_row(name, \": it is \", two ? \"one\" : \"other\", \" thing\"\n\" long\");"),
        testing::ElementsAre(Pieces{": it is ", " thing long"}));
    EXPECT_THAT(
        sentences_in("// Sentence{\"a comment is none\"}\nif (kind == \"a kind of device\") return {};"),
        IsEmpty());
    EXPECT_THAT(sentences_in("return Sentence{\"a \\\"quoted\\\" word\"};"),
                testing::ElementsAre(Pieces{"a \"quoted\" word"}));
}

TEST(RefusalsRule, wants_the_pieces_in_their_order) {
    EXPECT_TRUE(says("loom: a one b two", {"one", "two"}));
    EXPECT_FALSE(says("loom: a two b one", {"one", "two"}));
}

} // namespace
} // namespace tappet::pages
