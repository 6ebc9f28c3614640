// Reading what the firmware prints: its own console's line, its timing, and everything a serial line may turn
// them into.
#include "apps/carpet_loom/demo/status.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::demo {
namespace {

using testing::ElementsAre;

const std::string status_line = "loom t=4784ms state=stopped speed=-1rpm angle=316deg picks=9 tension=289N "
                                "oil=237cbar stops=1 cause=weft "
                                "stop_error=-60ddeg bus=4 frames_lost=2 edges_lost=3 outages=5";
const std::string timing_line = "timing can=107/500us io=8/300us misses=2";

TEST(StatusLine, is_read_whole) {
    const Status expected{.time_ms = 4784,
                          .state = "stopped",
                          .speed_rpm = -1,
                          .angle_deg = 316,
                          .picks = 9,
                          .tension_n = 289,
                          .oil_bar = 2.37,
                          .stops = 1,
                          .cause = "weft",
                          .stop_error_deg = -6.0,
                          .bus_state = 4,
                          .frames_lost = 2,
                          .edges_lost = 3,
                          .outages = 5};
    EXPECT_EQ(parse_status(status_line), expected);
}

TEST(StatusLine, may_have_words_that_are_not_known_yet) {
    EXPECT_EQ(parse_status(status_line + " humidity=55%"), parse_status(status_line));
}

TEST(StatusLine, is_refused_when_it_is_cut_anywhere_before_its_last_value) {
    const std::size_t last_value = status_line.rfind('=') + 1;
    for (std::size_t length = 0; length <= last_value; ++length)
        EXPECT_FALSE(parse_status(status_line.substr(0, length))) << length;
}

TEST(StatusLine, is_refused_when_its_beginning_is_lost) {
    for (std::size_t lost = 1; lost < status_line.size(); ++lost)
        EXPECT_FALSE(parse_status(status_line.substr(lost))) << lost;
}

TEST(StatusLine, is_refused_when_two_lines_ran_into_each_other) {
    for (std::size_t at = 1; at < status_line.size(); ++at)
        EXPECT_FALSE(parse_status(status_line.substr(0, at) + status_line)) << at;
}

TEST(StatusLine, is_refused_when_a_number_is_none) {
    for (const auto& [good, bad] : {std::pair{"picks=9", "picks=nine"},
                                    {"picks=9", "picks="},
                                    {"picks=9", "picks=9.5"},
                                    {"picks=9", "picks=99999999999999999999"},
                                    {"289N", "289"},
                                    {"289N", "289kN"},
                                    {"289N", "N"}}) {
        std::string line = status_line;
        line.replace(line.find(good), std::string{good}.size(), bad);
        EXPECT_FALSE(parse_status(line)) << line;
    }
}

TEST(StatusLine, is_none_of_the_other_lines) {
    for (const char* line : {"", "loom", "loom ", "loom  ", "looms t=1ms", "=", "loom =",
                             "arm: 13 checks made, 1 warning", "\x1d\xff\xfe", "loom t=4784ms  state=weave"})
        EXPECT_FALSE(parse_status(line)) << line;
    EXPECT_FALSE(parse_status(timing_line));
}

TEST(TimingLine, is_read_whole) {
    const Timing expected{.responses = {{"can", 107, 500}, {"io", 8, 300}}, .misses = 2};
    EXPECT_EQ(parse_timing(timing_line), expected);
}

TEST(TimingLine, is_refused_when_it_is_cut_anywhere_before_its_last_value) {
    for (std::size_t length = 0; length < timing_line.size(); ++length)
        EXPECT_FALSE(parse_timing(timing_line.substr(0, length))) << length;
}

TEST(TimingLine, is_refused_when_a_value_is_wrong) {
    for (const char* line : {"timing misses=0", "timing can=107us misses=0", "timing can=107/500 misses=0",
                             "timing can=/us misses=0", "timing can=1/0us misses=0",
                             "timing can=1/2us misses=x", "timing can=1/2us can=1/2us misses=0"})
        EXPECT_FALSE(parse_timing(line)) << line;
    EXPECT_FALSE(parse_timing(status_line));
}

std::vector<std::string> lines_of(std::initializer_list<std::string_view> pieces) {
    Lines lines;
    std::vector<std::string> found;
    for (const std::string_view piece : pieces)
        lines.add(piece, [&](std::string_view line) { found.emplace_back(line); });
    return found;
}

TEST(Lines, come_whole_however_the_bytes_come_in_pieces) {
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
