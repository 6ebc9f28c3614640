// Drawing over the last picture: up by its lines, each line written and cleared behind. Long lines are not
// wrapped.
#include "apps/carpet_loom/demo/terminal.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <sys/ioctl.h>
#include <unistd.h>

namespace tappet::demo {

namespace {

constexpr unsigned short least_rows = 18; // the screen with its stops and messages

bool can_draw() {
    const char* const kind = std::getenv("TERM");
    if (::isatty(STDOUT_FILENO) == 0 || kind == nullptr || std::strcmp(kind, "dumb") == 0) return false;
    winsize size{};
    return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row >= least_rows;
}

void put(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
}

} // namespace

Terminal::Terminal(bool plain) : draws_(!plain && can_draw()) {
    if (draws_) put("\x1b[?25l\x1b[?7l"); // no cursor, no wrapping
}

Terminal::~Terminal() { finish(); }

void Terminal::finish() {
    if (draws_) put("\x1b[?7h\x1b[?25h");
    draws_ = false;
}

void Terminal::show(const Story& story, const Frame& frame, Story::Kind news) {
    if (draws_)
        draw(story, frame);
    else
        print_news(story, frame, news);
}

void Terminal::tick(const Story& story, const Frame& frame) {
    if (draws_ && std::chrono::steady_clock::now() - drawn_at_ >= std::chrono::milliseconds(100))
        draw(story, frame);
}

void Terminal::draw(const Story& story, const Frame& frame) {
    std::string picture = drawn_lines_ == 0 ? std::string{} : "\x1b[" + std::to_string(drawn_lines_) + "A";
    const std::vector<std::string> lines = screen(story, frame);
    for (const std::string& line : lines) picture += "\r" + line + "\x1b[K\n";
    put(picture + "\x1b[J"); // a shorter picture leaves nothing of the longer one
    drawn_lines_ = lines.size();
    drawn_at_ = std::chrono::steady_clock::now();
}

void Terminal::print_news(const Story& story, const Frame& frame, Story::Kind news) {
    if (news == Story::Kind::message) put("          " + story.messages().back() + "\n");
    for (; stops_told_ < story.stops().size(); ++stops_told_)
        put(plain_stop(story.stops()[stops_told_]) + "\n");
    if (news != Story::Kind::status || story.status().time_ms < next_plain_ms_) return;
    put(plain_line(story, frame) + "\n");
    next_plain_ms_ = story.status().time_ms + 1000;
}

} // namespace tappet::demo
