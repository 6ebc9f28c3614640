// Datagrams of the network for this box.
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

    /// Listens at that address of this box; 0.0.0.0: at every address. Not real-time.
    std::expected<void, Sentence> open(std::string_view address, std::uint16_t port);
    /// Asks at that address of another box, and receives only its answers. Not real-time.
    std::expected<void, Sentence> ask(std::string_view address, std::uint16_t port);
    std::size_t receive(std::span<std::byte> into) noexcept TAPPET_REALTIME override;
    bool send(std::span<const std::byte> datagram) noexcept TAPPET_REALTIME override;

private:
    void make_anew();

    int socket_ = -1;
    sockaddr_in to_{}; ///< family 0: no receiver yet
};

} // namespace tappet::udp
