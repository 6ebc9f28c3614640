// Converts an IPv4 address and a port to the system's form.
#pragma once

#include "kernel/base/realtime.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace tappet::udp {

/// Returns false when it is not an address.
inline bool read_address(std::string_view numbers, std::uint16_t port, sockaddr_in& into) noexcept {
    std::array<char, INET_ADDRSTRLEN> text{}; // NUL-terminated
    if (numbers.size() >= text.size()) return false;
    std::ranges::copy(numbers, text.begin());
    into = {};
    into.sin_family = AF_INET;
    into.sin_port = htons(port);
    return ::inet_pton(AF_INET, text.data(), &into.sin_addr) == 1;
}
inline const sockaddr* as_socket_address(const sockaddr_in& address) noexcept TAPPET_REALTIME {
    return static_cast<const sockaddr*>(static_cast<const void*>(&address));
}
inline sockaddr* as_socket_address(sockaddr_in& address) noexcept TAPPET_REALTIME {
    return static_cast<sockaddr*>(static_cast<void*>(&address));
}

} // namespace tappet::udp
