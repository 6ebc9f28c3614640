// A non-blocking socket.
#include "drivers/udp/socket.hpp"

#include "drivers/udp/address.hpp"

#include <cerrno>
#include <cstring>

#include <sys/socket.h>
#include <unistd.h>

namespace tappet::udp {

Socket::~Socket() {
    if (socket_ >= 0) ::close(socket_);
}

void Socket::make_anew() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

std::expected<void, Sentence> Socket::open(std::string_view address, std::uint16_t port) {
    sockaddr_in at;
    if (!read_address(address, port, at))
        return std::unexpected(Sentence{"\"", address, "\" is not an IPv4 address; write it as 192.168.7.1"});
    make_anew();
    if (socket_ < 0 || ::bind(socket_, as_socket_address(at), sizeof at) != 0)
        return std::unexpected(Sentence{std::string_view{std::strerror(errno)},
                                        "; it must be an address of this box, and its port be free"});
    return {};
}

std::expected<void, Sentence> Socket::ask(std::string_view address, std::uint16_t port) {
    if (!read_address(address, port, to_))
        return std::unexpected(Sentence{"\"", address, "\" is not an IPv4 address; write it as 192.168.7.1"});
    make_anew();
    if (socket_ < 0 || ::connect(socket_, as_socket_address(to_), sizeof to_) != 0)
        return std::unexpected(Sentence{"no way to ", address, ": ", std::string_view{std::strerror(errno)},
                                        "; is the network up?"});
    return {};
}

std::size_t Socket::receive(std::span<std::byte> into) noexcept TAPPET_REALTIME {
    ssize_t size = -1;
    sockaddr_in from{};
    socklen_t bytes = sizeof from;
    TAPPET_ESCAPE("the driver's own input, which does not wait",
                  size = ::recvfrom(socket_, into.data(), into.size(), MSG_DONTWAIT | MSG_TRUNC,
                                    as_socket_address(from), &bytes));
    if (size <= 0) return 0;
    to_ = from;
    return static_cast<std::size_t>(size);
}

bool Socket::send(std::span<const std::byte> datagram) noexcept TAPPET_REALTIME {
    if (to_.sin_family != AF_INET) return false;
    ssize_t size = -1;
    TAPPET_ESCAPE("the driver's own output, which does not wait",
                  size = ::sendto(socket_, datagram.data(), datagram.size(), MSG_DONTWAIT,
                                  as_socket_address(to_), sizeof to_));
    return size == static_cast<ssize_t>(datagram.size());
}

} // namespace tappet::udp
