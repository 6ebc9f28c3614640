// Ignores packets that are not the answer: only the kernel's, complete, and with the request's number counts.
#include "drivers/can/netlink.hpp"

#include <cerrno>
#include <cstring>
#include <ctime>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::can {

namespace {

constexpr int packets_at_most = 64; // most packets ignored before the answer

} // namespace

NetlinkAnswer judge(std::span<const std::byte> packet, std::uint32_t sender, bool cut,
                    std::uint32_t sequence) noexcept {
    nlmsghdr header{};
    if (sender != 0 || packet.size() < sizeof header) return {};
    std::memcpy(&header, packet.data(), sizeof header);
    if (header.nlmsg_seq != sequence) return {};
    if (cut) return {true, EMSGSIZE};
    if (header.nlmsg_len < sizeof header || header.nlmsg_len > packet.size()) return {true, EPROTO};
    if (header.nlmsg_type != NLMSG_ERROR) return {true, 0};
    nlmsgerr error{};
    if (packet.size() < sizeof header + sizeof error) return {true, EPROTO};
    std::memcpy(&error, packet.data() + sizeof header, sizeof error);
    return {true, -error.error};
}

Netlink::Netlink() noexcept : fd_{::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE)} {
    const timeval patience{2, 0};
    if (fd_ >= 0) ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
}

Netlink::~Netlink() {
    if (fd_ >= 0) ::close(fd_);
}

int Netlink::ask(const ifinfomsg& what, std::uint16_t type, std::uint16_t flags) noexcept {
    length_ = 0;
    if (fd_ < 0) return EBADF;
    struct {
        nlmsghdr header;
        ifinfomsg info;
    } request{};
    request.header.nlmsg_len = sizeof request;
    request.header.nlmsg_type = type;
    request.header.nlmsg_flags = static_cast<std::uint16_t>(NLM_F_REQUEST | flags);
    request.header.nlmsg_seq = ++sequence_;
    request.info = what;
    sockaddr_nl kernel{};
    kernel.nl_family = AF_NETLINK;
    if (::sendto(fd_, &request, sizeof request, 0, reinterpret_cast<const sockaddr*>(&kernel),
                 sizeof kernel) < 0)
        return errno;
    for (int i = 0; i < packets_at_most; ++i) {
        sockaddr_nl sender{};
        socklen_t size = sizeof sender;
        const ssize_t n = ::recvfrom(fd_, buffer_.data(), buffer_.size(), MSG_TRUNC,
                                     reinterpret_cast<sockaddr*>(&sender), &size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return errno == EAGAIN ? ETIMEDOUT : errno;
        const auto there = static_cast<std::size_t>(n); // with MSG_TRUNC: the packet's full length
        const bool cut = there > buffer_.size();
        length_ = cut ? buffer_.size() : there;
        if (const NetlinkAnswer answer = judge(data(), sender.nl_pid, cut, sequence_); answer.ours)
            return answer.error;
    }
    return ETIMEDOUT;
}

} // namespace tappet::can
