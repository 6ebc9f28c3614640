// The output of a program goes through a small pipe into a file; while it is held, the pipe fills.
#pragma once

#include <array>
#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace tappet::bench {

class HeldOutput {
public:
    static constexpr int pipe_bytes = 4096;

    HeldOutput() {
        if (::pipe2(ends_.data(), O_CLOEXEC) == 0) ::fcntl(ends_[1], F_SETPIPE_SZ, pipe_bytes);
    }
    HeldOutput(const HeldOutput&) = delete;
    HeldOutput& operator=(const HeldOutput&) = delete;
    ~HeldOutput() {
        ends_here_ = true;
        if (pump_.joinable()) pump_.join();
        for (const int end : ends_) ::close(end);
        ::close(file_);
    }
    /// The writing end, for the program.
    [[nodiscard]] int entry() const { return ends_[1]; }
    void flow_into(const std::string& path) {
        file_ = ::open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0600);
        pump_ = std::thread{[this] { pump(); }};
    }
    void hold(bool on) { held_ = on; }
    [[nodiscard]] int unread() const {
        int bytes = 0;
        ::ioctl(ends_[0], FIONREAD, &bytes);
        return bytes;
    }
    /// Waits until everything written so far stands in the file.
    void settle() {
        for (;; std::this_thread::sleep_for(std::chrono::milliseconds{1})) {
            const std::scoped_lock all{passing_};
            if (held_ || unread() == 0) return;
        }
    }

private:
    void pump() {
        std::array<char, pipe_bytes> part;
        while (!ends_here_) {
            pollfd polled{ends_[0], POLLIN, 0};
            if (held_ || ::poll(&polled, 1, 10) <= 0) {
                std::this_thread::sleep_for(std::chrono::milliseconds{1});
                continue;
            }
            const std::scoped_lock all{passing_};
            const ssize_t got = ::read(ends_[0], part.data(), part.size());
            // A box without memory cannot write its files either.
            if (got > 0 && ::write(file_, part.data(), static_cast<std::size_t>(got)) != got) continue;
        }
    }

    std::array<int, 2> ends_{-1, -1};
    int file_ = -1;
    std::atomic<bool> held_{false}, ends_here_{false};
    std::mutex passing_;
    std::thread pump_;
};

} // namespace tappet::bench
