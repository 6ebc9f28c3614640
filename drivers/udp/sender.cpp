// Sent at once, to whoever listens; nobody does before the machine is there.
#include "drivers/udp/sender.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::udp {

Sender::~Sender() {
    if (socket_ >= 0) ::close(socket_);
}

std::expected<void, Sentence> Sender::open(std::string_view address, std::uint16_t port) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    const std::string numbers{address == "0.0.0.0" ? "127.0.0.1" : address};
    if (::inet_pton(AF_INET, numbers.c_str(), &to.sin_addr) != 1)
        return std::unexpected(Sentence{"\"", address, "\" is no IPv4 address; write it as 127.0.0.1"});
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket_ < 0 ||
        ::connect(socket_, static_cast<const sockaddr*>(static_cast<const void*>(&to)), sizeof to) != 0)
        return std::unexpected(Sentence{"no way to ", numbers, ": ", std::string_view{std::strerror(errno)},
                                        "; is the loopback interface up?"});
    return {};
}

bool Sender::send(std::span<const std::byte> datagram) noexcept {
    return ::send(socket_, datagram.data(), datagram.size(), 0) == static_cast<ssize_t>(datagram.size());
}

} // namespace tappet::udp
