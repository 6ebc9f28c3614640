// SPDX-License-Identifier: Apache-2.0
// A raw socket that hears nothing but the confirmations of its own frames.
#include "drivers/can/safe_sender.hpp"

#include "drivers/can/link.hpp"
#include "drivers/can/wire.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <utility>

#include <linux/can/raw.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::can {

std::expected<void, Sentence> SafeSender::open(std::string_view interface, std::span<const Frame> frames) {
    close();
    frames_ = frames;
    if (frames.empty()) return {};
    const auto refused = [&](std::string_view why) {
        close();
        return std::unexpected(
            Sentence{"CAN interface \"", interface, "\": the guardian cannot send there: ", why});
    };
    if (frames.size() > 64)
        return refused("its map has more than 64 frames with safe values; use a second bus");
    const auto link = find_link(interface);
    if (!link) return std::unexpected{link.error()};
    fd_ = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    can_filter filters[64];
    for (std::size_t i = 0; i < frames.size(); ++i)
        filters[i] = wire::exactly({frames[i].id, frames[i].extended});
    const bool sends_fd = std::ranges::any_of(frames, &Frame::fd);
    if (sends_fd)
        if (auto good = fit_for_fd(*link, interface); !good) {
            close();
            return good;
        }
    const int yes = 1;
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = link->index;
    const bool good =
        fd_ >= 0 &&
        ::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FILTER, filters,
                     static_cast<socklen_t>(frames.size() * sizeof filters[0])) == 0 &&
        ::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &yes, sizeof yes) == 0 &&
        (!sends_fd || ::setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &yes, sizeof yes) == 0) &&
        ::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    if (!good) return refused(strerrordesc_np(errno));
    return {};
}

void SafeSender::close() noexcept {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
    confirmed_ = 0;
    in_flight_ = of_before_ = 0;
}

void SafeSender::begin() noexcept {
    static_cast<void>(left()); // what waits at the socket is of before
    confirmed_ = 0;
    of_before_ = in_flight_;
}

void SafeSender::send(Purpose purpose) noexcept {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        if ((confirmed_ >> i & 1u) != 0) continue;
        canfd_frame raw;
        wire::encode(frames_[i], raw);
        // The kernel takes no more now. The rest waits for the next repetition: frames keep their order.
        if (purpose == Purpose::rehearsal) {
            static_cast<void>(::write(fd_, &raw, 0));
            continue;
        }
        if (::write(fd_, &raw, wire::bytes_of(frames_[i])) < 0) return;
        ++in_flight_;
    }
}

std::size_t SafeSender::left() noexcept {
    // Frames of the machine come first, as many as the socket's buffer holds; an interface that was down in
    // between is told once.
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
        if ((message.msg_flags & MSG_CONFIRM) == 0) continue; // of the machine, while it lived
        in_flight_ -= std::min<std::size_t>(in_flight_, 1);
        if (of_before_ > 0) {
            --of_before_;
            continue;
        }
        Frame sent;
        if (!wire::decode(raw, static_cast<std::size_t>(got), State::active, sent)) continue;
        for (std::size_t i = 0; i < frames_.size(); ++i)
            if (sent.id == frames_[i].id && sent.extended == frames_[i].extended)
                confirmed_ |= std::uint64_t{1} << i;
    }
    return frames_.size() - static_cast<std::size_t>(std::popcount(confirmed_));
}

} // namespace tappet::can
