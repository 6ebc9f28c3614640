// Reading a command line: options anywhere, values never taken for options (thesis 4.8).
#include "toolchain/tools/browser/options.hpp"

#include <gmock/gmock.h>

namespace tappet::browser {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

std::expected<Line, std::string> parsed(std::vector<std::string> words) { return parse_line(words); }

TEST(Options, stand_anywhere_in_the_line) {
    const auto line = parsed({"--json", "watch", "shaft.angle", "--every", "1.5s", "--count", "3"});
    ASSERT_TRUE(line.has_value()) << line.error();
    EXPECT_THAT(line->words, ElementsAre("watch", "shaft.angle"));
    EXPECT_TRUE(line->json);
    EXPECT_EQ(line->every, 1500ms);
    EXPECT_EQ(line->count, 3);
}

TEST(Options, negative_numbers_are_values) {
    EXPECT_THAT(parsed({"set", "a.b", "-5"})->words, ElementsAre("set", "a.b", "-5"));
    EXPECT_THAT(parsed({"set", "a.b", "-.5"})->words, ElementsAre("set", "a.b", "-.5"));
}

TEST(Options, after_two_dashes_everything_is_a_word) {
    EXPECT_THAT(parsed({"set", "a.b", "--", "--json"})->words, ElementsAre("set", "a.b", "--json"));
}

TEST(Options, a_wrong_one_is_refused_with_its_cure) {
    EXPECT_THAT(parsed({"get", "--jason"}).error(), HasSubstr("did you mean --json?"));
    EXPECT_THAT(parsed({"watch", "a", "--every"}).error(), HasSubstr("needs a value"));
    EXPECT_THAT(parsed({"watch", "a", "--every", "soon"}).error(), HasSubstr("write 200ms"));
    EXPECT_THAT(parsed({"watch", "a", "--every", "nan"}).error(), HasSubstr("write 200ms"));
    EXPECT_THAT(parsed({"watch", "a", "--count", "0"}).error(), HasSubstr("from 1"));
    EXPECT_THAT(parsed({"watch", "a", "--count", "3x"}).error(), HasSubstr("from 1"));
}

TEST(TypedLines, keep_quotes_and_brackets_together) {
    EXPECT_THAT(*split_line("set a.b [1, 2]  c.d \"two words\""),
                ElementsAre("set", "a.b", "[1, 2]", "c.d", "\"two words\""));
    EXPECT_THAT(split_line("set a.b [1, 2").error(), HasSubstr("not closed"));
    EXPECT_TRUE(split_line("   ")->empty());
}

} // namespace
} // namespace tappet::browser
