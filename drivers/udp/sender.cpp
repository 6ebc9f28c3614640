// Sends at once to the listener; before the machine runs there is none.
#include "drivers/udp/sender.hpp"

#include "drivers/udp/address.hpp"

#include <cerrno>
#include <cstring>

#include <sys/socket.h>
#include <unistd.h>

namespace tappet::udp {

Sender::~Sender() {
    if (socket_ >= 0) ::close(socket_);
}

std::expected<void, Sentence> Sender::open(std::string_view address, std::uint16_t port) {
    sockaddr_in to;
    const std::string_view numbers = address == "0.0.0.0" ? "127.0.0.1" : address;
    if (!read_address(numbers, port, to))
        return std::unexpected(Sentence{"\"", address, "\" is not an IPv4 address; write it as 127.0.0.1"});
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket_ < 0 || ::connect(socket_, as_socket_address(to), sizeof to) != 0)
        return std::unexpected(Sentence{"no way to ", numbers, ": ", std::string_view{std::strerror(errno)},
                                        "; is the loopback interface up?"});
    return {};
}

bool Sender::tell(std::span<const std::byte> datagram) noexcept {
    return ::send(socket_, datagram.data(), datagram.size(), 0) == static_cast<ssize_t>(datagram.size());
}

} // namespace tappet::udp
