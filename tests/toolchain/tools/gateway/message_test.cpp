// Clients' messages: what is understood, and the sentence for what is not.
#include "toolchain/tools/gateway/bounds.hpp"
#include "toolchain/tools/gateway/message.hpp"

#include <gmock/gmock.h>

#include <array>

namespace tappet::network {
namespace {

TEST(Message, is_read_with_its_fields) {
    const auto watch =
        parse_message(R"({"id": 7, "do": "watch", "names": ["saw.line.speed"], "rate_hz": 20})");
    ASSERT_TRUE(watch) << watch.error().sentence;
    EXPECT_EQ(watch->id, 7u);
    EXPECT_EQ(watch->what, Do::watch);
    EXPECT_THAT(watch->names, testing::ElementsAre("saw.line.speed"));
    EXPECT_EQ(watch->rate_hz, 20);
    EXPECT_EQ(parse_message(R"({"do": "request", "id": 1, "machine": "saw", "line": "get \"a\""})")->line,
              "get \"a\"");
}

TEST(Message, is_refused_with_the_cure) {
    struct Case {
        std::string_view text;
        std::uint32_t id;
        std::string_view sentence;
    };
    const std::array cases{
        Case{"", 0, "a message is a JSON object"},
        Case{"[1]", 0, "a message is a JSON object"},
        Case{R"({"do": "machines"})", 0, "\"id\" is not a whole number"},
        Case{R"({"id": 0, "do": "machines"})", 0, "\"id\" is not a whole number"},
        Case{R"({"id": 2147483648, "do": "machines"})", 0, "\"id\" is not a whole number"},
        Case{R"({"id": 1.5, "do": "machines"})", 0, "\"id\" is not a whole number"},
        Case{R"({"id": 3})", 3, "\"do\" is missing"},
        Case{R"({"id": 3, "do": "wach"})", 3, "did you mean \"watch\"?"},
        Case{R"({"id": 3, "do": "watch"})", 3, "the field \"names\" is missing"},
        Case{R"({"id": 3, "do": "watch", "names": "a"})", 3, "\"names\" is not a list"},
        Case{R"({"id": 3, "do": "watch", "names": [1]})", 3, "\"names\" is not a list of texts"},
        Case{R"({"id": 3, "do": "watch", "names": [], "rate_h": 1})", 3, "did you mean \"rate_hz\"?"},
        Case{R"({"id": 3, "do": "watch", "names": [], "rate_hz": -1})", 3,
             "\"rate_hz\" is not a number above 0"},
        Case{R"({"id": 3, "do": "machines", "x": [[[[[1]]]]]})", 0, "4 levels of brackets"}};
    for (const Case& each : cases) {
        const auto read = parse_message(each.text);
        ASSERT_FALSE(read) << each.text;
        EXPECT_EQ(read.error().id, each.id) << each.text;
        EXPECT_THAT(read.error().sentence, testing::HasSubstr(std::string{each.sentence}));
    }
}

TEST(Message, of_any_depth_or_length_costs_little) {
    EXPECT_FALSE(parse_message(std::string(60'000, '[')));
    EXPECT_FALSE(parse_message(std::string(bounds.message_bytes + 1, ' ')));
    std::string names = R"({"id": 1, "do": "watch", "names": [)";
    for (std::size_t i = 0; i <= bounds.names; ++i) names += (i == 0 ? "" : ",") + std::string{"\"a\""};
    EXPECT_THAT(parse_message(names + "]}").error().sentence, testing::HasSubstr("at most 256 texts"));
}

} // namespace
} // namespace tappet::network
