// Lines, also those damaged on a serial line, become what a viewer sees: stops, messages, the picture.
#include "apps/carpet_loom/demo/view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::demo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

std::string line(int time_ms, const char* state, int speed_rpm, int picks, int stops, const char* cause,
                 int error_ddeg = 0, int angle_deg = 57) {
    return "loom t=" + std::to_string(time_ms) + "ms state=" + state + " speed=" + std::to_string(speed_rpm) +
           "rpm angle=" + std::to_string(angle_deg) + "deg picks=" + std::to_string(picks) +
           " tension=301N oil=250cbar stops=" + std::to_string(stops) + " cause=" + cause +
           " stop_error=" + std::to_string(error_ddeg) + "ddeg bus=active frames_lost=0 waits_for=nothing";
}

Story story_of(std::initializer_list<std::string> lines) {
    Story story;
    for (const std::string& each : lines) story.take(each);
    return story;
}

TEST(Story, sees_a_stop_at_the_stop_angle_with_its_error) {
    const Story story =
        story_of({line(1000, "weave", 600, 8, 0, "none"), line(1250, "stopped", 0, 9, 1, "weft", 60, 316),
                  line(1500, "stopped", 0, 9, 1, "weft", 60, 316)});
    EXPECT_THAT(story.stops(), ElementsAre(Pair("stop after pick 9, weft", "at 316.0 deg, error +6.0 deg")));
}

TEST(Story, shows_the_angle_of_an_emergency_stop_without_an_error) {
    const Story story = story_of({line(1000, "weave", 600, 8, 1, "none", 60),
                                  line(1250, "emergency", 200, 9, 1, "emergency", 60),
                                  line(1500, "emergency", 0, 9, 1, "emergency", 60, 42)});
    EXPECT_THAT(story.stops(), ElementsAre(Pair("stop after pick 9, emergency", "at 42.0 deg")));
}

TEST(Story, sees_a_stop_that_was_over_before_the_next_line) {
    EXPECT_EQ(story_of({line(1000, "weave", 600, 8, 0, "none"), line(1250, "run-up", 100, 9, 1, "none", 30)})
                  .stops()
                  .size(),
              1U);
}

TEST(Story, counts_a_stop_once_although_the_shaft_stood_before_the_report) {
    const Story story =
        story_of({line(1000, "weave", 600, 8, 0, "none"), line(1250, "stopping", 0, 9, 0, "weft", 0, 314),
                  line(1500, "stopped", 0, 9, 1, "weft", 35, 314)});
    EXPECT_EQ(story.stops().size(), 1U);
}

TEST(Story, counts_no_stop_when_the_shaft_moves_a_little_at_brake_release) {
    EXPECT_THAT(
        story_of({line(1000, "preparing", 3, 9, 1, "none"), line(1250, "ready", 0, 9, 1, "none")}).stops(),
        IsEmpty());
}

TEST(Story, counts_no_stop_while_the_shaft_stands_from_the_beginning) {
    EXPECT_THAT(story_of({line(0, "preparing", 0, 0, 0, "none"), line(250, "ready", 0, 0, 0, "none"),
                          line(500, "run-up", 90, 0, 0, "none")})
                    .stops(),
                IsEmpty());
}

TEST(Story, keeps_the_last_messages_as_they_came) {
    Story story = story_of({"carpet-loom: cannot open \"can0\"", "", "loom t=cut"});
    EXPECT_THAT(story.messages(), ElementsAre("carpet-loom: cannot open \"can0\"", "loom t=cut"));
    EXPECT_THAT(story.status(), IsEmpty());
    for (int i = 0; i < 1000; ++i) story.take("message " + std::to_string(i));
    EXPECT_LE(story.messages().size(), 200U);
    EXPECT_EQ(story.messages().back(), "message 999");
}

TEST(Story, knows_how_long_nothing_was_woven) {
    Story story = story_of({line(1000, "preparing", 0, 0, 0, "none"), line(3000, "weave", 600, 1, 0, "none"),
                            line(9000, "weave", 600, 1, 0, "none")});
    EXPECT_EQ(story.idle_ms(), 6000);
    EXPECT_EQ(Story{}.idle_ms(), 0);
}

TEST(Story, keeps_the_activity_nearest_to_its_deadline) {
    EXPECT_EQ(story_of({"timing can=100/500us motion=150/1000us io=90/300us misses=2"}).timing(),
              "io=90/300us misses=2");
}

TEST(Words, are_empty_for_a_damaged_line) {
    const std::string whole = line(4784, "stopped", -1, 9, 1, "weft", -60);
    const auto words = [](const std::string& each) { return words_of(each, "loom", "waits_for"); };
    ASSERT_EQ(words(whole).size(), 13u);
    EXPECT_EQ(number_of(text_of(words(whole), "speed")), -1);
    EXPECT_EQ(text_of(words(whole), "humidity"), "");
    for (std::size_t at = 1; at < whole.size(); ++at) {
        if (at <= whole.rfind('=')) {
            EXPECT_THAT(words(whole.substr(0, at)), IsEmpty()) << at;
        }
        EXPECT_THAT(words(whole.substr(at)), IsEmpty()) << at;
        EXPECT_THAT(words(whole.substr(0, at) + whole), IsEmpty()) << at;
    }
    for (const char* other : {"", "loom", "loom ", "loom  ", "looms waits_for=1", "=", "loom =",
                              "arm: 13 checks made, 1 warning", "\x1d\xff\xfe", "timing can=1/2us misses=0"})
        EXPECT_THAT(words(other), IsEmpty()) << other;
}

TEST(Picture, has_a_row_for_each_word_the_timing_and_the_last_stops) {
    Story story = story_of({line(0, "weave", 599, 0, 0, "none"), "timing can=100/500us misses=0"});
    EXPECT_EQ(picture_of(story, 200, 1.0).rows[1].value, "weave");
    EXPECT_EQ(picture_of(story, 200, 1.0).rows[2], (browser::WatchRow{"speed", "599", "rpm"}));
    for (int i = 1; i <= 40; ++i) story.take(line(1000 * i, "stopped", 0, i, i, "weft", i));
    story.take("a word of the plant");
    const browser::WatchPicture picture = picture_of(story, 200, 1.0);
    EXPECT_THAT(picture.title, HasSubstr("pick 40 of 200"));
    EXPECT_EQ(picture.status, "a word of the plant");
    EXPECT_LE(draw(picture, {}, false).size(), 24u);
    EXPECT_EQ(picture.rows.back().name, "stop after pick 40, weft");
}

TEST(Picture, says_that_the_box_is_booting_before_the_first_line) {
    EXPECT_THAT(picture_of(Story{}, 10, 1.0).status, HasSubstr("booting"));
}

std::vector<std::string> lines_of(std::initializer_list<std::string_view> pieces) {
    Lines lines;
    std::vector<std::string> found;
    for (const std::string_view piece : pieces)
        lines.add(piece, [&](std::string_view each) { found.emplace_back(each); });
    return found;
}

TEST(Lines, are_complete_however_the_bytes_are_split) {
    EXPECT_THAT(lines_of({"one\ntwo\n"}), ElementsAre("one", "two"));
    EXPECT_THAT(lines_of({"o", "n", "e", "\n", "two\nth", "ree"}), ElementsAre("one", "two"));
    EXPECT_THAT(lines_of({"\n\r\n", "one\r\n"}), ElementsAre("", "", "one"));
}

TEST(Lines, do_not_grow_without_bound) {
    const std::string endless(100'000, 'x');
    const auto lines = lines_of({endless, endless, "\nnext\n"});
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_LE(lines[0].size(), 4096U);
    EXPECT_EQ(lines[1], "next");
}

} // namespace
} // namespace tappet::demo
