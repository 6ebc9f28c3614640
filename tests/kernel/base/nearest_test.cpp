// The nearest name to a misspelt one, by its edit distance.
#include "kernel/base/nearest.hpp"

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace tappet;

constexpr std::string_view nearest(std::string_view written,
                                   std::initializer_list<std::string_view> candidates) {
    Nearest search{written};
    for (const std::string_view candidate : candidates) search.consider(candidate);
    return search.best();
}

static_assert(edit_distance("", "") == 0);
static_assert(edit_distance("kitten", "sitting") == 3);
static_assert(nearest("shfat", {"encoder", "shaft", "panel"}) == "shaft", "in a constant expression");

TEST(EditDistance, counts_swapped_neighbours_as_one_edit) {
    EXPECT_EQ(edit_distance("shfat", "shaft"), 1u);
    EXPECT_EQ(edit_distance("ab", "ba"), 1u);
    EXPECT_EQ(edit_distance("ca", "abc"), 3u) << "no character is edited twice";
}

TEST(EditDistance, distinguishes_case_unless_asked_to_ignore_it) {
    EXPECT_EQ(edit_distance("Shaft", "shaft"), 1u);
    EXPECT_EQ(edit_distance("SHAFT", "shaft", 64, LetterCase::ignored), 0u);
}

TEST(EditDistance, compares_names_of_up_to_64_characters) {
    const std::string longest(64, 'x');
    EXPECT_EQ(edit_distance(longest, longest), 0u);
    EXPECT_EQ(edit_distance(longest + "x", longest + "x", 5), 6u);
}

// The textbook recursion, with a table of the whole.
std::size_t textbook_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            d[i][j] = std::min(
                {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
            }
        }
    }
    return d[a.size()][b.size()];
}

TEST(EditDistance, agrees_with_the_textbook_algorithm_under_every_limit) {
    Random random{11};
    const auto word = [&random] {
        std::string text(random.below(9), ' ');
        for (char& character : text) character = static_cast<char>('a' + random.below(3));
        return text;
    };
    for (int round = 0; round < 3000; ++round) {
        const std::string a = word();
        const std::string b = word();
        const std::size_t limit = random.below(9);
        ASSERT_EQ(edit_distance(a, b, limit), std::min(textbook_distance(a, b), limit + 1)) << a << " " << b;
        ASSERT_EQ(edit_distance(a, b), edit_distance(b, a));
    }
}

TEST(Nearest, finds_the_misspelt_name) {
    EXPECT_EQ(nearest("encodr", {"shaft", "encoder", "tension"}), "encoder");
    EXPECT_EQ(nearest("tensoin.feed_forwrd", {"tension.feed_forward", "tension.feed"}),
              "tension.feed_forward");
}

TEST(Nearest, suggests_no_distant_name) {
    EXPECT_EQ(nearest("panel", {"shaft", "encoder"}), "");
    EXPECT_EQ(nearest("panel", {}), "");
    EXPECT_EQ(nearest("abcdefghi", {"abcdefxyz"}), "abcdefxyz") << "three of nine is a third";
    EXPECT_EQ(nearest("abcdefgh", {"abcdexyz"}), "") << "three of eight is more";
    EXPECT_EQ(nearest("abcd", {"abxy"}), "abxy") << "two are always near";
}

TEST(Nearest, suggests_no_name_without_a_letter_in_common) {
    EXPECT_EQ(nearest("ab", {"xy"}), "");
    EXPECT_EQ(nearest("a", {"b", "a1"}), "a1");
    EXPECT_EQ(nearest("", {"a"}), "");
}

TEST(Nearest, prefers_fewer_edits_in_any_order_of_candidates) {
    EXPECT_EQ(nearest("weft", {"west", "wefts_", "weft1"}), "west");
    EXPECT_EQ(nearest("weftx", {"wefty1", "weft"}), "weft");
}

TEST(Nearest, breaks_a_tie_by_preferring_differences_in_case) {
    EXPECT_EQ(nearest("shaft", {"shift", "Shaft"}), "Shaft");
    EXPECT_EQ(nearest("shaft", {"Shaft", "shift"}), "Shaft");
}

TEST(Nearest, breaks_remaining_ties_by_order) { EXPECT_EQ(nearest("shaft", {"shift", "shaft1"}), "shift"); }

TEST(Nearest, recognises_a_long_name_in_another_case) {
    EXPECT_EQ(nearest("OPERATORPANEL", {"OPERATORPAN", "operatorpanel"}), "operatorpanel");
    EXPECT_EQ(nearest("AB", {"ab"}), "ab");
}

TEST(Nearest, recognises_a_name_that_continues_after_a_dot) {
    EXPECT_EQ(nearest("start", {"stop.rises", "start.rises", "start.falls"}), "start.rises");
    EXPECT_EQ(nearest("start", {"starts.rises"}), "");
    EXPECT_EQ(nearest("start", {"start.rises", "Start"}), "Start") << "one letter's case is nearer";
}

TEST(Nearest, compares_no_names_of_more_than_64_characters) {
    const std::string long_name(65, 'x');
    Nearest search{long_name};
    search.consider(long_name);
    EXPECT_EQ(search.best(), "");
}

} // namespace
