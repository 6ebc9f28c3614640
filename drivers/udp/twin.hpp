// The stand-in of a socket in the host world: datagrams of a plant.
#pragma once

#include "drivers/twin/ring.hpp"
#include "drivers/udp/device.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace tappet::udp {

/// The machine's end is a Device; the plant's end sends. One thread each.
class Wires {
public:
    Wires() = default;
    Wires(const Wires&) = delete;
    Wires& operator=(const Wires&) = delete;
    virtual ~Wires() = default;
    /// False: it did not go out.
    virtual bool send(std::span<const std::byte> datagram) noexcept = 0;
};

class Twin final : public Device, public Wires {
public:
    std::size_t receive(std::span<std::byte> into) noexcept TAPPET_REALTIME override {
        Datagram next;
        if (!ring_.pop(next)) return 0;
        std::memcpy(into.data(), next.bytes.data(), std::min(next.size, into.size()));
        return next.size;
    }
    /// As a socket drops what nobody takes, so does this.
    bool send(std::span<const std::byte> datagram) noexcept override {
        Datagram next;
        if (datagram.size() > next.bytes.size()) return false;
        next.size = datagram.size();
        std::memcpy(next.bytes.data(), datagram.data(), datagram.size());
        return ring_.push(next);
    }

private:
    struct Datagram {
        std::size_t size = 0;
        std::array<std::byte, most_bytes> bytes{};
    };
    twin::Ring<Datagram, 32> ring_;
};

} // namespace tappet::udp
