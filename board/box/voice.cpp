// SPDX-License-Identifier: Apache-2.0
// Text to consoles.
#include "board/box/voice.hpp"

#include <array>
#include <cstdio>
#include <ctime>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tappet::box {

namespace {

constexpr off_t most_kept_bytes = 64 * 1024; // twice that: the file before this one stays
}

std::string text_of_seconds(double seconds) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3f s", seconds);
    return text.data();
}

double uptime_s() {
    timespec now{};
    ::clock_gettime(CLOCK_BOOTTIME, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

void Voice::open(const std::string& console) {
    const std::string path = "/dev/" + console.substr(0, console.find(','));
    if (const int descriptor = ::open(path.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
        descriptor >= 0)
        consoles_.push_back(descriptor);
}

void Voice::say(std::string_view sentence) const {
    std::array<char, 32> time{};
    std::snprintf(time.data(), time.size(), "init: [%6.3f s] ", uptime_s());
    const std::string line = std::string{time.data()} + std::string{sentence} + "\n";
    pass_on(line);
    keep(line);
}

void Voice::keep(std::string_view line) const {
    if (file_ < 0 && said_before_.size() < most_kept_bytes) said_before_ += line;
    // A disk that is full keeps no more of it, and the machine goes on.
    if (file_ >= 0) [[maybe_unused]]
        const auto written = ::write(file_, line.data(), line.size());
}

init::Done Voice::keep_in(const std::string& file) {
    struct stat facts{};
    if (::stat(file.c_str(), &facts) == 0 && facts.st_size > most_kept_bytes)
        ::rename(file.c_str(), (file + ".before").c_str());
    // Through to the disk: the last line before a reset is the one that tells.
    file_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_DSYNC | O_CLOEXEC, 0644);
    if (file_ < 0) return init::failed("open " + file);
    keep(std::exchange(said_before_, {}));
    return {};
}

void Voice::let_go() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
}

void Voice::pass_on(std::string_view text) const {
    for (const int console : consoles_) {
        [[maybe_unused]] const auto written = ::write(console, text.data(), text.size());
    }
}

} // namespace tappet::box
