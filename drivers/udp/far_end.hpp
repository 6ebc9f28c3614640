// The other end of datagrams for a plant: the instrument that sends them, or the box that is asked.
#pragma once

#include "drivers/twin/far_end.hpp"
#include "drivers/udp/twin.hpp"

#include <cstdint>

namespace tappet::udp {

///     udp::FarEnd camera{ends, "camera-link"};
///     camera.send(packet);
class FarEnd final : public tappet::FarEnd {
public:
    FarEnd(FarEnds& of, std::string_view device) : tappet::FarEnd{of, device, "udp"} {}

    /// Sends at once. Counts datagrams that could not be sent.
    void send(std::span<const std::byte> datagram) {
        if (wires_ == nullptr || !wires_->tell(datagram)) ++refused_;
    }
    /// Takes the machine's next datagram; returns 0 when there is none. On the bench, where machines reach
    /// each other directly, it always returns 0.
    std::size_t receive(std::span<std::byte> into) { return wires_ == nullptr ? 0 : wires_->hear(into); }
    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

protected:
    bool take_wire(const ProvidedDevice& wire) noexcept override {
        wires_ = wire.as<Wires>();
        return wires_ != nullptr;
    }

private:
    Wires* wires_ = nullptr;
    std::uint64_t refused_ = 0;
};

} // namespace tappet::udp
