// The alternate screen of xterm-like terminals, drawn from the top left corner (ECMA-48, xterm's control
// sequences).
#include "toolchain/tools/browser/screen.hpp"

#include <array>
#include <cstdlib>
#include <cstring>
#include <ostream>

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace tappet::browser {

namespace {

constexpr std::string_view screen_begins = "\x1b[?1049h\x1b[?25l\x1b[?7l\x1b[2J";

class OwnScreen final : public Screen {
public:
    OwnScreen() {
        ::tcgetattr(STDIN_FILENO, &before_);
        termios raw = before_;
        raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
        raw.c_cc[VMIN] = 1;
        raw.c_cc[VTIME] = 0;
        ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
        OwnScreen::put(screen_begins);
    }
    ~OwnScreen() override {
        OwnScreen::put(screen_ends);
        ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    }
    OwnScreen(const OwnScreen&) = delete;
    OwnScreen& operator=(const OwnScreen&) = delete;

    [[nodiscard]] Size size() const override {
        winsize seen{};
        if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &seen) != 0 || seen.ws_col == 0 || seen.ws_row == 0) return {};
        return {seen.ws_col, seen.ws_row};
    }
    [[nodiscard]] std::optional<Key> key(std::chrono::milliseconds patience) const override;

private:
    void put(std::string_view text) const override {
        while (!text.empty()) {
            const ssize_t written = ::write(STDOUT_FILENO, text.data(), text.size());
            if (written <= 0) return; // the terminal is gone; the next key read reports it
            text.remove_prefix(static_cast<std::size_t>(written));
        }
    }

    termios before_{};
};

std::optional<Key> OwnScreen::key(std::chrono::milliseconds patience) const {
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

class FarScreen final : public Screen {
public:
    FarScreen(std::ostream& out, Size size, std::function<void(std::chrono::milliseconds)> pause)
        : out_{out}, size_{size}, pause_{std::move(pause)} {
        FarScreen::put(screen_begins);
    }
    ~FarScreen() override { FarScreen::put(screen_ends); }
    FarScreen(const FarScreen&) = delete;
    FarScreen& operator=(const FarScreen&) = delete;

    [[nodiscard]] Size size() const override { return size_; }
    [[nodiscard]] std::optional<Key> key(std::chrono::milliseconds patience) const override {
        pause_(patience);
        return std::nullopt;
    }

private:
    void put(std::string_view text) const override { out_ << text << std::flush; }

    std::ostream& out_;
    Size size_;
    std::function<void(std::chrono::milliseconds)> pause_;
};

} // namespace

bool Screen::possible() {
    const char* const kind = std::getenv("TERM");
    return ::isatty(STDIN_FILENO) != 0 && ::isatty(STDOUT_FILENO) != 0 && kind != nullptr &&
           std::strcmp(kind, "dumb") != 0;
}

void Screen::show(const std::vector<std::string>& lines) const {
    std::string picture = "\x1b[H";
    for (std::size_t i = 0; i < lines.size(); ++i) {
        picture += lines[i] + "\x1b[K";
        if (i + 1 < lines.size()) picture += "\r\n";
    }
    put(picture + "\x1b[J");
}

std::unique_ptr<const Screen> own_screen() { return std::make_unique<OwnScreen>(); }

std::unique_ptr<const Screen> far_screen(std::ostream& out, Size size,
                                         std::function<void(std::chrono::milliseconds)> pause) {
    return std::make_unique<FarScreen>(out, size, std::move(pause));
}

} // namespace tappet::browser
