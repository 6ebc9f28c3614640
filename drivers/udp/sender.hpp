// Sends datagrams to a listening port, for plants whose machines run in processes of their own.
#pragma once

#include "drivers/udp/twin.hpp"
#include "kernel/base/text.hpp"

#include <cstdint>
#include <expected>
#include <string_view>

namespace tappet::udp {

/// Not real-time.
class Sender final : public Wires {
public:
    Sender() = default;
    ~Sender() override;
    /// A machine that listens at every address of its box is reached at this box's own.
    std::expected<void, Sentence> open(std::string_view address, std::uint16_t port);
    bool tell(std::span<const std::byte> datagram) noexcept override;
    std::size_t hear(std::span<std::byte>) noexcept override { return 0; }

private:
    int socket_ = -1;
};

} // namespace tappet::udp
