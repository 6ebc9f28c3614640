// The real-time annotations: every escape from clang's proof states a reason, the whole list is printed, and
// there is no second way out.
#include "tests/house/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>

namespace tappet::house {
namespace {

/// The only file that spells the attribute, the pragma and the sanitizer.
constexpr std::string_view hatch = "kernel/base/realtime.hpp";

struct Escape {
    std::string path;
    std::size_t line;
    std::string reason; ///< empty when the call does not begin with a literal
};

/// The literals that follow position `at`, joined; an escape's first argument may be laid out over two lines.
std::string literal_after(const File& file, std::size_t line, std::size_t at) {
    std::string text = file.lines[line].substr(at);
    for (std::size_t next = line + 1; next < std::min(line + 3, file.lines.size()); ++next)
        text += " " + file.lines[next];
    std::string joined;
    std::size_t begin = text.find_first_not_of(' ');
    while (begin != text.npos && text[begin] == '"') {
        const std::size_t end = text.find('"', begin + 1);
        if (end == text.npos) break;
        joined += text.substr(begin + 1, end - begin - 1);
        begin = text.find_first_not_of(' ', end + 1);
    }
    return joined;
}

std::vector<Escape> escapes(const Tree& files) {
    static constexpr std::string_view call = "TAPPET_ESCAPE(";
    std::vector<Escape> found;
    for (const File& file : files) {
        if (!file.is_cpp() || file.path == hatch) continue;
        for (std::size_t i = 0; i < file.code.size(); ++i)
            if (file.code[i].contains(call)) {
                const std::size_t at = file.lines[i].find(call) + call.size();
                found.push_back({file.path, i + 1, literal_after(file, i, at)});
            }
    }
    return found;
}

Findings without_reason(const Tree& files) {
    Findings found;
    for (const Escape& escape : escapes(files))
        if (std::ranges::count(escape.reason, ' ') < 2)
            found.push_back({escape.path, escape.line,
                             "the escape's reason \"" + escape.reason + "\" says nothing by itself",
                             "begin TAPPET_ESCAPE with a literal of three words or more"});
    return found;
}

Findings other_ways_out(const Tree& files) {
    // In two pieces, so that this file passes its own rule.
    static constexpr std::array words{"clang::non"
                                      "blocking",
                                      "clang::non"
                                      "allocating",
                                      "clang::block"
                                      "ing",
                                      "clang::allo"
                                      "cating",
                                      "__rt"
                                      "san",
                                      "no_sani"
                                      "tize",
                                      "diagnostic ig"
                                      "nored",
                                      "Wno-function-"
                                      "effects",
                                      "Wno-error=function-"
                                      "effects",
                                      "TAPPET_PRA"
                                      "GMA",
                                      "TAPPET_SANITIZER_"
                                      "PAUSE"};
    Findings found;
    for (const File& file : files) {
        if (file.path == hatch || !(file.is_cpp() || file.is_cmake())) continue;
        for (std::size_t i = 0; i < file.lines.size(); ++i)
            for (const std::string_view word : words)
                if (file.lines[i].contains(word))
                    found.push_back({file.path, i + 1,
                                     "\"" + std::string(word) + "\" switches the real-time proof",
                                     "write TAPPET_REALTIME, or TAPPET_ESCAPE with its reason"});
    }
    return found;
}

TEST(Escapes, each_have_a_reason) {
    expect_none(without_reason(tree()));
    const auto all = escapes(tree());
    std::size_t shipped = 0;
    for (const Escape& escape : all) {
        if (escape.path.starts_with("tests/")) continue;
        ++shipped;
        std::cout << escape.path << ":" << escape.line << ": " << escape.reason << "\n";
    }
    std::cout << shipped << " escapes from the real-time proof, and " << all.size() - shipped
              << " in tests\n";
    EXPECT_GT(shipped, 0u) << "the rule does not see the tree";
}

TEST(Escapes, are_the_only_way_out_of_the_proof) { expect_none(other_ways_out(tree())); }

TEST(EscapesRule, refuses_an_escape_without_a_literal_or_with_an_empty_phrase) {
    EXPECT_EQ(without_reason({file("kernel/a.cpp", "TAPPET_ESCAPE(reason, f());\n")}).size(), 1u);
    EXPECT_EQ(without_reason({file("kernel/a.cpp", "TAPPET_ESCAPE(\"as above\", f());\n")}).size(), 1u);
    EXPECT_TRUE(
        without_reason({file("kernel/a.cpp", "TAPPET_ESCAPE(\"the driver's own read\", f());\n")}).empty());
    EXPECT_TRUE(without_reason({file("kernel/a.cpp",
                                     "TAPPET_ESCAPE(\n    \"the driver's own \"\n    \"read\", f());\n")})
                    .empty());
}

TEST(EscapesRule, refuses_a_suppression_beside_the_hatch) {
    EXPECT_EQ(other_ways_out({file("kernel/a.cpp", "#pragma clang diagnostic ig"
                                                   "nored \"-Wx\"\n")})
                  .size(),
              1u);
    EXPECT_EQ(other_ways_out({file("kernel/CMakeLists.txt", "-Wno-function-"
                                                            "effects\n")})
                  .size(),
              1u);
}

} // namespace
} // namespace tappet::house
