// The other end of datagrams for a plant: the instrument that sends them, or the box that is asked.
#pragma once

#include "drivers/twin/far_end.hpp"
#include "drivers/udp/twin.hpp"

#include <cstdint>

namespace tappet::udp {

///     udp::FarEnd camera{ends, "camera-link"};
///     camera.send(packet);
class FarEnd final : public FarEndOf<Wires> {
public:
    FarEnd(FarEnds& of, std::string_view device) : FarEndOf{of, device, "udp"} {}

    /// Sends at once. Counts datagrams that could not be sent.
    void send(std::span<const std::byte> datagram) {
        if (wire_ == nullptr || !wire_->tell(datagram)) ++refused_;
    }
    /// Takes the machine's next datagram; returns 0 when there is none. On the bench, where machines reach
    /// each other directly, it always returns 0.
    std::size_t receive(std::span<std::byte> into) { return wire_ == nullptr ? 0 : wire_->hear(into); }
};

} // namespace tappet::udp
