// Datagrams of the network that are addressed to this box.
#pragma once

#include "drivers/udp/device.hpp"
#include "kernel/base/text.hpp"

#include <cstdint>
#include <expected>
#include <string_view>

#include <netinet/in.h>

namespace tappet::udp {

/// IPv4.
class Socket final : public Device {
public:
    Socket() = default;
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    ~Socket() override;

    /// Listens at that address of this box; 0.0.0.0: at each of them. Not real-time.
    std::expected<void, Sentence> open(std::string_view address, std::uint16_t port);
    /// Asks at that address of another box, and hears its answers only. Not real-time.
    std::expected<void, Sentence> ask(std::string_view address, std::uint16_t port);
    std::size_t receive(std::span<std::byte> into) noexcept TAPPET_REALTIME override;
    bool send(std::span<const std::byte> datagram) noexcept TAPPET_REALTIME override;

private:
    void make_anew();

    int socket_ = -1;
    sockaddr_in to_{}; ///< of no family: to nobody yet
};

} // namespace tappet::udp
