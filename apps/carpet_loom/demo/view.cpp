// Draws a row for each word of the console and the last stops below; without a terminal, one line a second.
#include "apps/carpet_loom/demo/view.hpp"

#include <algorithm>
#include <cstdio>
#include <span>

namespace tappet::demo {

namespace {

void put(const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
}

} // namespace

browser::WatchPicture picture_of(const Story& story, std::int64_t picks_wanted, double wall_s) {
    browser::WatchPicture picture;
    picture.title = "carpet loom on the bench  pick " + std::to_string(story.number("picks")) + " of " +
                    std::to_string(picks_wanted) + "  " + std::to_string(static_cast<int>(wall_s)) +
                    " s of wall time";
    picture.status = !story.messages().empty() ? story.messages().back()
                     : story.status().empty()  ? "booting the emulated box"
                                               : "^C ends";
    for (const auto& [name, value] : story.status()) {
        const std::size_t digits = value.find_first_not_of("-0123456789");
        const std::size_t end = digits == 0 ? value.size() : std::min(digits, value.size());
        picture.rows.push_back({.name = name, .value = value.substr(0, end), .unit = value.substr(end)});
    }
    if (!story.timing().empty()) picture.rows.push_back({.name = "worst response", .value = story.timing()});
    constexpr std::size_t shown = 5; // a terminal of 24 lines has room for them
    for (const auto& [stop, where] : std::span{story.stops()}.last(std::min(shown, story.stops().size())))
        picture.rows.push_back({.name = stop, .value = where});
    return picture;
}

View::View(bool plain, std::int64_t picks_wanted) : picks_wanted_{picks_wanted} {
    if (!plain && browser::Screen::possible())
        screen_ = browser::own_screen();
    else
        put("booting the emulated box");
}

void View::tick(const Story& story) {
    const auto now = Steady::now();
    if (!screen_ || now - drawn_at_ < std::chrono::milliseconds{100}) return;
    drawn_at_ = now;
    const double wall_s = std::chrono::duration<double>(now - begun_).count();
    screen_->show(draw(picture_of(story, picks_wanted_, wall_s), screen_->size(), true));
}

void View::show(const Story& story, Story::Kind news) {
    if (screen_) return tick(story);
    if (news == Story::Kind::message && !story.messages().empty()) put("  " + story.messages().back());
    for (; stops_told_ < story.stops().size(); ++stops_told_)
        put("  " + story.stops()[stops_told_].first + ", " + story.stops()[stops_told_].second);
    if (news != Story::Kind::status || story.number("t") < next_plain_ms_) return;
    next_plain_ms_ = story.number("t") + 1000;
    std::string line;
    for (const auto& [name, value] : story.status()) line += name + "=" + value + " ";
    put(line + story.timing());
}

} // namespace tappet::demo
