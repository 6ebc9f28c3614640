// The watch view fits a terminal of 80 columns and 24 rows, and smaller ones (thesis 4.8).
#include "toolchain/tools/browser/watch_view.hpp"

#include <gmock/gmock.h>

namespace tappet::browser {
namespace {

using testing::HasSubstr;
using testing::Not;

WatchPicture picture(std::size_t rows) {
    WatchPicture all;
    all.title = "loom  engineer";
    all.status = "q ends";
    for (std::size_t i = 0; i < rows; ++i)
        all.rows.push_back(
            {"shaft.value_" + std::to_string(i), std::to_string(i) + ".5", "deg", "", false, false});
    return all;
}

/// Removes the sequences that take no space.
std::string visible(const std::string& line) {
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] != '\x1b') {
            text += line[i];
            continue;
        }
        while (i < line.size() && line[i] != 'm') ++i;
    }
    return text;
}

TEST(WatchView, shows_name_value_and_unit) {
    const auto lines = draw(picture(2), {}, false);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_THAT(lines[0], HasSubstr("loom"));
    EXPECT_THAT(lines[1], HasSubstr("shaft.value_0"));
    EXPECT_THAT(lines[1], HasSubstr("0.5 deg"));
    EXPECT_THAT(lines[3], HasSubstr("q ends"));
}

TEST(WatchView, never_is_larger_than_the_terminal) {
    WatchPicture all = picture(100);
    all.rows[0].name = std::string(200, 'n');
    all.rows[1].value = std::string(200, '9');
    all.rows[2].marks = "FORCED, and more than there is room for";
    all.title = std::string(300, 't');
    for (const bool colour : {false, true})
        for (const Size size : {Size{80, 24}, Size{40, 10}, Size{20, 3}, Size{1, 1}, Size{200, 60}}) {
            const auto lines = draw(all, size, colour);
            EXPECT_LE(lines.size(), size.rows);
            if (size.columns < 40) continue; // narrower ones are cut by the terminal itself
            for (const std::string& line : lines) EXPECT_LE(visible(line).size(), size.columns) << line;
        }
}

TEST(WatchView, says_which_part_of_many_it_shows) {
    WatchPicture all = picture(100);
    all.first = 50;
    const auto lines = draw(all, {80, 24}, false);
    EXPECT_THAT(lines[1], HasSubstr("shaft.value_50"));
    EXPECT_THAT(lines.back(), HasSubstr("51-72 of 100"));
}

TEST(WatchView, marks_a_forced_value_in_words_and_in_colour) {
    WatchPicture all = picture(2);
    all.rows[1].forced = true;
    all.rows[1].marks = "FORCED";
    const auto plain = draw(all, {}, false);
    EXPECT_THAT(plain[2], HasSubstr("FORCED"));
    EXPECT_THAT(plain[1], Not(HasSubstr("FORCED")));
    EXPECT_THAT(plain[2], Not(HasSubstr("\x1b")));
    EXPECT_THAT(draw(all, {}, true)[2], HasSubstr("\x1b[7;31mFORCED"));
}

} // namespace
} // namespace tappet::browser
