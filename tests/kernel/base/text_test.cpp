// Sentence and Text: messages and names without a heap.
#include "kernel/base/text.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

namespace {

using namespace tappet;

static_assert(Sentence{"row ", 3, ": ", std::size_t{7}, " of ", 8u}.view() == "row 3: 7 of 8");

template <text Name> struct Named {};
static_assert(std::is_same_v<Named<"loom">, Named<text<4>{std::string_view{"loom"}}>>,
              "equal texts are one argument");
static_assert(!std::is_same_v<Named<"loom">, Named<"loop">>);

TEST(Sentence, is_empty_at_first) {
    EXPECT_TRUE(Sentence{}.empty());
    EXPECT_EQ(Sentence{}.size(), 0u);
}

TEST(Sentence, grows_piece_by_piece) {
    Sentence sentence;
    sentence.add("connection ").add(2).add(Sentence{": ", std::string_view{"unknown"}});
    EXPECT_EQ(sentence.view(), "connection 2: unknown");
    EXPECT_STREQ(sentence.data(), "connection 2: unknown");
}

TEST(Sentence, writes_every_whole_number) {
    EXPECT_EQ(Sentence{0}.view(), "0");
    EXPECT_EQ(Sentence{-1}.view(), "-1");
    EXPECT_EQ(Sentence{std::numeric_limits<std::int64_t>::max()}.view(), "9223372036854775807");
    EXPECT_EQ(Sentence{std::numeric_limits<std::int64_t>::min()}.view(), "-9223372036854775808");
    EXPECT_EQ(Sentence{std::size_t{1} << 63}.view(), "9223372036854775808");
    EXPECT_EQ(Sentence{std::numeric_limits<std::size_t>::max()}.view(), "18446744073709551615");
    EXPECT_EQ(Sentence{std::numeric_limits<unsigned>::max()}.view(), "4294967295");
}

TEST(Sentence, marks_text_that_it_had_to_cut) {
    Sentence sentence{std::string_view{std::string(Sentence::capacity, 'x')}};
    EXPECT_EQ(sentence.view().back(), 'x') << "what fits exactly is whole";
    sentence.add("y");
    EXPECT_EQ(sentence.size(), Sentence::capacity);
    EXPECT_EQ(sentence.view().substr(Sentence::capacity - 4), "x...");
    EXPECT_EQ(sentence.data()[Sentence::capacity], '\0');
}

TEST(Text, stores_its_characters_without_a_terminating_zero) {
    constexpr text name{"shaft"};
    EXPECT_EQ(name.view(), "shaft");
    EXPECT_EQ(name.view().size(), 5u);
    EXPECT_EQ(text<0>{}.view(), "");
}

} // namespace
