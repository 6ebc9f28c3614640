// The alternate screen of xterm-like terminals, drawn from the top left corner (ECMA-48, xterm's control
// sequences).
#include "toolchain/tools/browser/screen.hpp"

#include <array>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace tappet::browser {

namespace {

void put(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(STDOUT_FILENO, text.data(), text.size());
        if (written <= 0) return; // the terminal is gone; the next key read reports it
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

} // namespace

bool Screen::possible() {
    const char* const kind = std::getenv("TERM");
    return ::isatty(STDIN_FILENO) != 0 && ::isatty(STDOUT_FILENO) != 0 && kind != nullptr &&
           std::strcmp(kind, "dumb") != 0;
}

Screen::Screen() {
    ::tcgetattr(STDIN_FILENO, &before_);
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_cc[VMIN] = 1;
    raw.c_cc[VTIME] = 0;
    ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    put("\x1b[?1049h\x1b[?25l\x1b[?7l\x1b[2J");
}

Screen::~Screen() {
    put("\x1b[?7h\x1b[?25h\x1b[?1049l");
    ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

Size Screen::size() const {
    winsize seen{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &seen) != 0 || seen.ws_col == 0 || seen.ws_row == 0) return {};
    return {seen.ws_col, seen.ws_row};
}

void Screen::show(const std::vector<std::string>& lines) const {
    std::string picture = "\x1b[H";
    for (std::size_t i = 0; i < lines.size(); ++i) {
        picture += lines[i] + "\x1b[K";
        if (i + 1 < lines.size()) picture += "\r\n";
    }
    put(picture + "\x1b[J");
}

std::optional<Key> Screen::key(std::chrono::milliseconds patience) const {
    pollfd look{STDIN_FILENO, POLLIN, 0};
    if (::poll(&look, 1, static_cast<int>(patience.count())) <= 0) return std::nullopt;
    std::array<char, 16> characters{};
    const ssize_t count = ::read(STDIN_FILENO, characters.data(), characters.size());
    if (count <= 0) return Key::quit;
    const std::string_view typed{characters.data(), static_cast<std::size_t>(count)};
    if (typed == "q" || typed == "Q" || typed == "\x1b" || typed == "\x04") return Key::quit;
    if (typed == "\x1b[A" || typed == "\x1bOA" || typed == "k") return Key::up;
    if (typed == "\x1b[B" || typed == "\x1bOB" || typed == "j") return Key::down;
    if (typed == "\x1b[5~") return Key::page_up;
    if (typed == "\x1b[6~" || typed == " ") return Key::page_down;
    return Key::other;
}

} // namespace tappet::browser
