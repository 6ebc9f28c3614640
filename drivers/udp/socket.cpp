// A socket that is asked and never waits.
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

std::expected<void, Sentence> Socket::open(std::string_view address, std::uint16_t port) {
    sockaddr_in at;
    if (!read_address(address, port, at))
        return std::unexpected(Sentence{"\"", address, "\" is no IPv4 address; write it as 192.168.7.1"});
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket_ < 0 || ::bind(socket_, as_socket_address(at), sizeof at) != 0)
        return std::unexpected(Sentence{std::string_view{std::strerror(errno)},
                                        "; it must be an address of this box, and its port be free"});
    return {};
}

std::size_t Socket::receive(std::span<std::byte> into) noexcept TAPPET_REALTIME {
    ssize_t size = -1;
    TAPPET_ESCAPE("the driver's own input, which does not wait",
                  size = ::recv(socket_, into.data(), into.size(), MSG_DONTWAIT | MSG_TRUNC));
    return size > 0 ? static_cast<std::size_t>(size) : 0;
}

} // namespace tappet::udp
