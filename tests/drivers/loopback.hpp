// Sockets at free ports of this box.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet {

struct Loopback {
    int socket;
    std::uint16_t port;
};
/// Binds a socket of this type, SOCK_STREAM or SOCK_DGRAM.
inline Loopback bound_to_loopback(int type) {
    const int socket = ::socket(AF_INET, type | SOCK_CLOEXEC, 0);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    auto* const address = reinterpret_cast<sockaddr*>(&at);
    if (::bind(socket, address, size) != 0 || ::getsockname(socket, address, &size) != 0) std::abort();
    return {socket, ntohs(at.sin_port)};
}
/// A port that is free at this moment.
inline std::uint16_t free_port(int type) {
    const auto [socket, port] = bound_to_loopback(type);
    ::close(socket);
    return port;
}

} // namespace tappet
