// The pages that the code generates: nothing is left out, and an entry without a text is an error.
#include "toolchain/tools/pages/pages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::pages {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

const fs::path tree{TAPPET_TREE};

TEST(Words, are_functions_and_constants_with_the_comment_above) {
    const auto found =
        words("a.hpp", "struct Deadline {};\n"
                       "/// From the release\n/// to the end.\n"
                       "constexpr Deadline deadline(Duration after) noexcept { return {after}; }\n"
                       "/// A row.\n"
                       "template <class... Options>\n"
                       "constexpr Row row(std::string_view name,\n"
                       "                  const Options&... options) {\n"
                       "/// Marks it.\n"
                       "inline constexpr Mark mark{};\n"
                       "namespace detail {\nconstexpr int hidden(int a) { return a; }\n"
                       "} // namespace detail\n"
                       "inline constexpr std::size_t room = 16;\n");
    ASSERT_TRUE(found) << found.error();
    EXPECT_THAT(*found, ElementsAre(Field(&Word::spelled, "deadline(Duration after)"),
                                    Field(&Word::spelled, "row(string_view name, const Options&... options)"),
                                    Field(&Word::spelled, "mark")));
    EXPECT_EQ((*found)[0].text, "From the release to the end.");
}

TEST(Words, are_refused_by_name_when_they_have_no_text) {
    const auto found = words("a.hpp", "/// Of a struct, not of the word.\nstruct Age {};\n"
                                      "constexpr Age age(int years) { return {years}; }\n"
                                      "inline constexpr Age young{};\n");
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error(), "a.hpp has no text of age, young; say above each, after ///, what it is");
}

TEST(Words, share_a_text_when_they_share_a_name) {
    const auto found = words("a.hpp", "/// A value.\nconstexpr A a(int i) { return {i}; }\n"
                                      "template <class T> constexpr A a(T t) { return {t}; }\n"
                                      "constexpr bool is_one(A a) { return a == 1; }\n");
    ASSERT_TRUE(found) << found.error();
    EXPECT_EQ(found->back().text, "as above");
}

TEST(Text, is_the_comment_above_a_type) {
    EXPECT_EQ(text_of("/// Not this.\nint a;\n/// One\n/// two.\ntemplate <class T> struct Box {\n", "Box"),
              "One two.");
    EXPECT_EQ(text_of("struct Box;\nstruct Box {\n", "Box"), "");
    EXPECT_EQ(text_of("/// Of a larger one.\nstruct BoxOfBoxes {\n", "Box"), "");
}

TEST(Cells, escape_pipes_and_angle_brackets) {
    EXPECT_EQ(cell("a|b <c> `<d|e>`"), "a\\|b \\<c> `<d\\|e>`");
    EXPECT_EQ(code("set_it|not"), "`set_it\\|not`");
}

TEST(Reference, holds_every_component_of_the_library_and_the_drivers) {
    const auto page = reference_page(tree);
    ASSERT_TRUE(page) << page.error();
    std::size_t seen = 0;
    for (const char* floor : {"kernel/pieces", "kernel/services", "kernel/limits", "drivers"})
        for (const auto& entry : fs::recursive_directory_iterator{tree / floor}) {
            if (entry.path().extension() != ".hpp" ||
                !contents_of(entry.path()).contains("\n    static constexpr auto interface()"))
                continue;
            ++seen;
            const std::string header = fs::relative(entry.path(), tree).string();
            EXPECT_TRUE(page->contains("#include \"" + header + "\""))
                << header << ": add its component to toolchain/tools/pages/reference.cpp";
        }
    EXPECT_GE(seen, 10u);
    for (const char* part : {"| `in_frame.measure` | output | double | mm |",
                             "`at_most(int64_t n, Duration per)`", "| `set PROPERTY VALUE"})
        EXPECT_THAT(*page, HasSubstr(part));
}

TEST(Reference, is_refused_for_a_missing_tree) {
    EXPECT_THAT(reference_page("/nowhere").error(), HasSubstr("has no text"));
}

TEST(Refusals, each_have_a_name_and_a_cure) {
    const auto page = refusals_page(tree);
    ASSERT_TRUE(page) << page.error();
    EXPECT_GT(refusals(tree).size(), 200u);
    for (const Refusal& each : refusals(tree)) EXPECT_NE(each.name, "") << each.sentence;
    EXPECT_THAT(*page, HasSubstr("| `frame \"f\" is there twice` | `rename one of them` |"))
        << "over one line";
    EXPECT_THAT(*page,
                HasSubstr("is a second initial state in \"working\" beside \"run_up\"` | `keep one` |"))
        << "of two literals";
    EXPECT_THAT(*page, HasSubstr("| `loom: component \"horn\": its interface has a facet without a name` | "
                                 "`name it in Unnamed` |"));
}

} // namespace
} // namespace tappet::pages
