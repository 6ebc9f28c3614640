// The written grammar equals the compiler's: each rule has an example, and each example compiles (thesis
// 5.1.4, 5.2.4).
#include "tests/kernel/script/fixture.hpp"

#include "kernel/script/token.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <set>
#include <sstream>

namespace {

using namespace script_test;

struct Grammar {
    std::set<std::string> rules;
    std::string written; ///< all rules
    struct Example {
        std::string rules;
        std::string text;
    };
    std::vector<Example> examples;
};

Grammar read_grammar() {
    Grammar grammar;
    std::ifstream file{SCRIPT_GRAMMAR};
    std::string line, fence;
    while (std::getline(file, line)) {
        if (line.starts_with("```")) {
            fence = line.substr(3);
            if (fence.starts_with("osd ")) grammar.examples.push_back({fence.substr(4), {}});
        } else if (fence == "ebnf") {
            grammar.written += line + "\n";
            const auto sign = line.find(" = ");
            if (!line.starts_with(' ') && sign != std::string::npos) {
                std::string rule = line.substr(0, sign);
                rule.erase(rule.find_last_not_of(' ') + 1);
                grammar.rules.insert(rule);
            }
        } else if (fence.starts_with("osd ")) {
            grammar.examples.back().text += line + "\n";
        }
    }
    return grammar;
}

TEST(The_grammar, has_an_example_for_each_rule) {
    const Grammar grammar = read_grammar();
    EXPECT_GT(grammar.rules.size(), 40u);
    for (const std::string& rule : grammar.rules) {
        bool shown = false;
        for (const Grammar::Example& each : grammar.examples)
            shown = shown || (" " + each.rules + " ").find(" " + rule + " ") != std::string::npos;
        EXPECT_TRUE(shown) << "no example names the rule \"" << rule << "\"";
    }
}

TEST(The_grammar, has_only_examples_that_compile) {
    for (const Grammar::Example& each : read_grammar().examples)
        EXPECT_EQ(fault_of(each.text), "") << each.rules;
}

TEST(The_grammar, names_every_word_of_the_language) {
    const Grammar grammar = read_grammar();
    for (const script_detail::Keyword& each : script_detail::keywords)
        EXPECT_THAT(grammar.written, testing::HasSubstr("\"" + std::string{each.spelled} + "\""));
}

TEST(The_grammar, defines_every_rule_that_it_names) {
    // Words of a rule outside quotes and comments are names of rules, or letters and digits.
    const Grammar grammar = read_grammar();
    std::string plain;
    char quote = 0;
    for (std::size_t i = 0; i < grammar.written.size(); ++i) {
        const char c = grammar.written[i];
        if (quote == 0 && grammar.written.compare(i, 2, "(*") == 0)
            i = grammar.written.find("*)", i) + 1;
        else if (quote != 0)
            quote = c == quote ? char{0} : quote;
        else if (c == '"' || c == '\'')
            quote = c, plain += ',';
        else
            plain += c;
    }
    std::stringstream pieces{plain};
    for (std::string piece; std::getline(pieces, piece, ';');) {
        const auto sign = piece.find('=');
        if (sign == std::string::npos) continue;
        for (char& c : piece)
            if (std::string_view{"|[]{}(),="}.find(c) != std::string_view::npos) c = '\n';
        std::stringstream words{piece};
        for (std::string word; std::getline(words, word);) {
            word.erase(0, word.find_first_not_of(" \t"));
            word.erase(word.find_last_not_of(" \t") + 1);
            const std::set<std::string> letters{"",          "letter",   "digit",
                                                "character", "anything", "rest of line"};
            EXPECT_TRUE(letters.contains(word) || grammar.rules.contains(word)) << "\"" << word << "\"";
        }
    }
}

} // namespace
