// SPDX-License-Identifier: Apache-2.0
// A raw socket that receives only the confirmations of its own frames.
#include "drivers/can/safe_sender.hpp"

#include "drivers/can/link.hpp"
#include "drivers/can/wire.hpp"
#include "kernel/os/clock.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <utility>

#include <linux/can/raw.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::can {

namespace {

/// Returns the socket, or -1 with errno.
int socket_for(int interface, std::span<const Frame> frames) noexcept {
    can_filter filters[SafeSender::most_frames];
    for (std::size_t i = 0; i < frames.size(); ++i)
        filters[i] = wire::exactly({frames[i].id, frames[i].extended});
    const bool sends_fd = std::ranges::any_of(frames, &Frame::fd);
    const int yes = 1;
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = interface;
    const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    const bool good =
        fd >= 0 &&
        ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters,
                     static_cast<socklen_t>(frames.size() * sizeof filters[0])) == 0 &&
        ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &yes, sizeof yes) == 0 &&
        (!sends_fd || ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &yes, sizeof yes) == 0) &&
        ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    if (good || fd < 0) return fd;
    const int why = errno;
    ::close(fd);
    errno = why;
    return -1;
}

/// Returns whether frames of this socket are in the interface's queue; not those in the controller.
bool waits_in_queue(int fd) noexcept {
    std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
    socklen_t size = sizeof memory;
    return ::getsockopt(fd, SOL_SOCKET, SO_MEMINFO, memory.data(), &size) == 0 &&
           memory[SK_MEMINFO_WMEM_ALLOC] != 0;
}

} // namespace

std::expected<void, Sentence> SafeSender::open(std::string_view interface, std::span<const Frame> frames) {
    close();
    frames_ = frames;
    if (frames.empty()) return {};
    const auto refused = [&](std::string_view why) {
        return std::unexpected(
            Sentence{"CAN interface \"", interface, "\": the guardian cannot send there: ", why});
    };
    if (frames.size() > most_frames)
        return refused("its map has more than 64 frames with safe values; use a second bus");
    const auto link = find_link(interface);
    if (!link) return std::unexpected{link.error()};
    if (std::ranges::any_of(frames, &Frame::fd))
        if (auto good = fit_for_fd(*link, interface); !good) return good;
    interface_ = link->index;
    fd_ = socket_for(interface_, frames_);
    if (fd_ < 0) return refused(strerrordesc_np(errno));
    return {};
}

void SafeSender::close() noexcept {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
    confirmed_ = accepted_ = 0;
    tells_ = true;
}

void SafeSender::begin() noexcept {
    confirmed_ = accepted_ = 0;
    if (fd_ < 0) return;
    const int fresh = socket_for(interface_, frames_);
    tells_ = fresh >= 0;
    if (tells_) ::close(std::exchange(fd_, fresh));
}

bool SafeSender::are_lost() const noexcept {
    return std::cmp_equal(std::popcount(confirmed_ | accepted_), frames_.size()) &&
           os::Clock::monotonic() - progress_ >= repeat_after && !waits_in_queue(fd_);
}

void SafeSender::send(Purpose purpose) noexcept {
    if (purpose == Purpose::earnest && are_lost()) accepted_ = 0;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        const std::uint64_t bit = std::uint64_t{1} << i;
        if (((confirmed_ | accepted_) & bit) != 0) continue;
        canfd_frame raw;
        wire::encode(frames_[i], raw);
        if (purpose == Purpose::rehearsal) {
            static_cast<void>(::write(fd_, &raw, 0));
            continue;
        }
        // The kernel's queue is full. The rest waits for the next call: frames keep their order.
        if (::write(fd_, &raw, wire::bytes_of(frames_[i])) < 0) return;
        accepted_ |= bit;
        progress_ = os::Clock::monotonic();
    }
}

std::size_t SafeSender::left() noexcept {
    // The machine's frames come first, as many as the socket's buffer holds. An interface that was down in
    // between reports this once.
    bool was_down = false;
    for (int n = 0; n < 65536; ++n) {
        canfd_frame raw{};
        iovec part{&raw, sizeof raw};
        msghdr message{};
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        const ssize_t got = ::recvmsg(fd_, &message, MSG_DONTWAIT);
        if (got < 0 && errno == ENETDOWN && !std::exchange(was_down, true)) continue;
        if (got != CAN_MTU && got != CANFD_MTU) break;
        if ((message.msg_flags & MSG_CONFIRM) == 0 || !tells_) continue; // of the machine, or from before
        Frame sent;
        if (!wire::decode(raw, static_cast<std::size_t>(got), State::active, sent)) continue;
        for (std::size_t i = 0; i < frames_.size(); ++i)
            if (sent.id == frames_[i].id && sent.extended == frames_[i].extended)
                confirmed_ |= std::uint64_t{1} << i;
        progress_ = os::Clock::monotonic();
    }
    return frames_.size() - static_cast<std::size_t>(std::popcount(confirmed_));
}

} // namespace tappet::can
