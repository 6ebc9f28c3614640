// SPDX-License-Identifier: Apache-2.0
// Four calls of the watchdog interface of Linux.
#include "kernel/os/watchdog.hpp"

#include "kernel/os/clock.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <linux/watchdog.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace tappet::os {

std::expected<void, Sentence> Watchdog::open(const char* path, Duration within) noexcept {
    close();
    if (!outputs_.may_kick(Clock::monotonic()))
        return std::unexpected(
            Sentence{"the watchdog \"", path,
                     "\" is not opened: the outputs may not be safe, and it resets the box; "
                     "repair what keeps the guardian from making them safe"});
    descriptor_ = ::open(path, O_WRONLY | O_CLOEXEC); // dog.open
    if (descriptor_ < 0)
        return std::unexpected(
            Sentence{"the watchdog \"", path, "\" cannot be opened (", std::strerror(errno),
                     "); load its module, end the process that uses it, or correct the board"});
    const auto refused = [&](const Sentence& why) {
        stand_down();
        return std::unexpected(Sentence{"the watchdog \"", path, "\" ", why});
    };
    watchdog_info facts{};
    constexpr std::uint32_t needed = WDIOF_KEEPALIVEPING | WDIOF_MAGICCLOSE;
    if (ioctl(descriptor_, WDIOC_GETSUPPORT, &facts) != 0 || (facts.options & needed) != needed)
        return refused(Sentence{"stops when whoever kicks it dies; use another, or none on this board"});
    int seconds = static_cast<int>(std::max<std::int64_t>(within / 1s, 1));
    static_cast<void>(ioctl(descriptor_, WDIOC_SETTIMEOUT, &seconds)); // some have a time of their own
    if (ioctl(descriptor_, WDIOC_GETTIMEOUT, &seconds) != 0 || seconds * 1s > within)
        return refused(
            Sentence{"waits ", seconds, " s, and the board says ", within / 1s, "; correct the board"});
    every_ = seconds * 1s / 8;
    next_ = Time::min();
    kick(Clock::monotonic());
    return {};
}

void Watchdog::kick(Time now) noexcept {
    if (descriptor_ < 0 || now < next_ || !outputs_.may_kick(now)) return;
    next_ = now + every_;
    keep_alive(); // dog.kick
}

void Watchdog::hand_over() noexcept {
    if (descriptor_ < 0) return;
    if (outputs_.may_kick(Clock::monotonic())) keep_alive(); // dog.hand_over
    close();
}

void Watchdog::stand_down() noexcept {
    if (descriptor_ < 0) return;
    if (outputs_.is_safe()) {
        [[maybe_unused]] const auto n = write(descriptor_, "V", 1); // dog.stand_down
    }
    close();
}

// A failed kick causes a reset, which shows it.
void Watchdog::keep_alive() const noexcept {
    static_cast<void>(ioctl(descriptor_, WDIOC_KEEPALIVE, nullptr));
}

void Watchdog::close() noexcept {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
}

} // namespace tappet::os
