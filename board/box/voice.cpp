// SPDX-License-Identifier: Apache-2.0
// Writes text to consoles.
#include "board/box/voice.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <utility>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::box {

namespace {

constexpr off_t most_kept_bytes = 64 * 1024; // limit of each of two files: the previous one is kept
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

namespace {

/// Runs in the writer until the other end is closed. A full disk loses the rest.
[[noreturn]] void write_down(int from, int disk) {
    constexpr int in = 0, out = 1;
    ::dup2(from, in);
    ::dup2(disk, out);
    ::close_range(out + 1, ~0U, 0); // closes everything else that init has open
    ::prctl(PR_SET_NAME, "log");
    std::array<char, 4096> piece{};
    for (ssize_t count = 0; (count = ::read(in, piece.data(), piece.size())) > 0;) {
        [[maybe_unused]] const auto written = ::write(out, piece.data(), static_cast<std::size_t>(count));
    }
    ::_exit(0);
}

} // namespace

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
    // A writer whose disk does not respond loses the line, so that the machine is not delayed.
    if (file_ >= 0) [[maybe_unused]]
        const auto sent = ::send(file_, line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

init::Done Voice::keep_in(const std::string& file) {
    struct stat facts{};
    if (::stat(file.c_str(), &facts) == 0 && facts.st_size > most_kept_bytes)
        ::rename(file.c_str(), (file + ".before").c_str());
    // Synchronous, because the last line before a reset is the important one.
    const int disk = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_DSYNC | O_CLOEXEC, 0644);
    if (disk < 0) return init::failed("open " + file);
    int ends[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0) writer_ = ::fork();
    if (writer_ == 0) write_down(ends[0], disk);
    ::close(disk);
    if (ends[0] >= 0) ::close(ends[0]);
    if (writer_ < 0) {
        if (ends[1] >= 0) ::close(ends[1]);
        return init::failed("begin to write " + file);
    }
    file_ = ends[1];
    keep(std::exchange(said_before_, {}));
    return {};
}

void Voice::let_go() {
    if (file_ < 0) return;
    ::close(file_);
    file_ = -1;
    for (const double given_up_s = uptime_s() + 1.0;
         ::waitpid(writer_, nullptr, WNOHANG) == 0 && uptime_s() < given_up_s;)
        init::pause_for(std::chrono::milliseconds{1});
}

void Voice::pass_on(std::string_view text) const {
    for (const int console : consoles_) {
        [[maybe_unused]] const auto written = ::write(console, text.data(), text.size());
    }
}

} // namespace tappet::box
