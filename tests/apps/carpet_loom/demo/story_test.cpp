// From lines to what a viewer sees: stops, messages, the plain lines and the screen.
#include "apps/carpet_loom/demo/story.hpp"
#include "apps/carpet_loom/demo/view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace tappet::demo {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string line(int time_ms, const char* state, int speed_rpm, int picks, int stops, const char* cause,
                 int error_ddeg = 0, int angle_deg = 57) {
    return "loom t=" + std::to_string(time_ms) + "ms state=" + state + " speed=" + std::to_string(speed_rpm) +
           "rpm angle=" + std::to_string(angle_deg) + "deg picks=" + std::to_string(picks) +
           " tension=301N oil=250cbar stops=" + std::to_string(stops) + " cause=" + cause +
           " stop_error=" + std::to_string(error_ddeg) + "ddeg bus=0 frames_lost=0 edges_lost=0 outages=0";
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
    EXPECT_THAT(
        story.stops(),
        ElementsAre(SeenStop{
            .after_pick = 9, .cause = "weft", .angle_deg = 316.0, .at_stop_angle = true, .error_deg = 6.0}));
}

TEST(Story, sees_an_emergency_stop_where_the_shaft_came_to_stand_without_an_error) {
    const Story story = story_of({line(1000, "weave", 600, 8, 1, "none", 60),
                                  line(1250, "emergency", 200, 9, 1, "emergency", 60),
                                  line(1500, "emergency", 0, 9, 1, "emergency", 60, 42)});
    EXPECT_THAT(story.stops(), ElementsAre(SeenStop{.after_pick = 9,
                                                    .cause = "emergency",
                                                    .angle_deg = 42.0,
                                                    .at_stop_angle = false,
                                                    .error_deg = 0.0}));
}

TEST(Story, sees_a_stop_that_was_over_before_the_next_line) {
    EXPECT_EQ(story_of({line(1000, "weave", 600, 8, 0, "none"), line(1250, "run-up", 100, 9, 1, "none", 30)})
                  .stops()
                  .size(),
              1U);
}

TEST(Story, counts_a_stop_once_although_the_shaft_stood_before_the_machine_said_so) {
    const Story story =
        story_of({line(1000, "weave", 600, 8, 0, "none"), line(1250, "stopping", 0, 9, 0, "weft", 0, 314),
                  line(1500, "stopped", 0, 9, 1, "weft", 35, 314)});
    EXPECT_EQ(story.stops().size(), 1U);
}

TEST(Story, takes_a_shaft_that_moved_a_little_when_the_brake_opened_for_no_stop) {
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
    EXPECT_FALSE(story.begun());
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

TEST(Plain, line_says_state_picks_tension_wires_and_the_activity_nearest_to_its_deadline) {
    const Story story = story_of({line(2000, "weave", 599, 12, 0, "none"),
                                  "timing can=100/500us motion=150/1000us io=90/300us misses=0"});
    const std::string text = plain_line(story, {.picks_wanted = 30, .wall_s = 5.0});
    EXPECT_THAT(text,
                AllOf(HasSubstr("2.0 s"), HasSubstr("weave"), HasSubstr("599 rpm"), HasSubstr("picks 12/30"),
                      HasSubstr("301 N"), HasSubstr("CAN active"), HasSubstr("io 90/300 us")));
    EXPECT_TRUE(std::ranges::all_of(text, [](char character) {
        return character >= ' ' && character <= '~';
    })) << "neither colours nor line ends";
}

TEST(Plain, stop_names_cause_angle_and_error_where_there_is_one) {
    EXPECT_THAT(plain_stop({9, "weft", 316.0, true, 6.0}),
                AllOf(HasSubstr("pick 9"), HasSubstr("weft"), HasSubstr("316.0"), HasSubstr("+6.0")));
    EXPECT_THAT(plain_stop({9, "emergency", 42.0, false, 0.0}),
                AllOf(HasSubstr("42.0"), Not(HasSubstr("error"))));
}

TEST(Screen, stays_low_enough_for_a_terminal_whatever_happened) {
    Story story = story_of({line(0, "weave", 600, 0, 0, "none"), "timing can=100/500us misses=0"});
    for (int i = 1; i <= 40; ++i) {
        story.take(line(1000 * i, "stopped", 0, i, i, "weft", i));
        story.take("message " + std::to_string(i));
    }
    const auto lines = screen(story, {.picks_wanted = 200, .wall_s = 1.0});
    EXPECT_LE(lines.size(), 16U);
    EXPECT_THAT(lines, Each(Not(HasSubstr("\n"))));
}

TEST(Screen, draws_what_no_loom_should_say_without_harm) {
    const Story story =
        story_of({"loom t=-1ms state=? speed=-99999rpm angle=99999deg picks=-5 tension=-9999N oil=-1cbar "
                  "stops=-1 cause=? stop_error=0ddeg bus=77 frames_lost=-1 edges_lost=9 outages=0"});
    ASSERT_TRUE(story.begun());
    EXPECT_FALSE(screen(story, {.picks_wanted = 0, .wall_s = 0.0}).empty());
    EXPECT_THAT(plain_line(story, {}), HasSubstr("CAN unknown"));
}

TEST(Screen, shows_that_the_box_is_booting_before_the_first_line) {
    const auto lines = screen(Story{}, {.picks_wanted = 10, .wall_s = 1.0});
    EXPECT_THAT(lines.back(), HasSubstr("booting"));
}

} // namespace
} // namespace tappet::demo
