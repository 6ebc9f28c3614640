// Replaces a socket in the host world: datagrams of a plant.
#pragma once

#include "drivers/twin/ring.hpp"
#include "drivers/udp/device.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace tappet::udp {

/// The machine's end is a Device; this is the plant's end. One thread each.
class Wires {
public:
    Wires() = default;
    Wires(const Wires&) = delete;
    Wires& operator=(const Wires&) = delete;
    virtual ~Wires() = default;
    /// Sends to the machine. Returns false when it was not sent.
    virtual bool tell(std::span<const std::byte> datagram) noexcept = 0;
    /// Takes the machine's next datagram, as Device::receive does.
    virtual std::size_t hear(std::span<std::byte> into) noexcept = 0;
};

class Twin final : public Device, public Wires {
public:
    std::size_t receive(std::span<std::byte> into) noexcept TAPPET_REALTIME override {
        return take(to_machine_, into);
    }
    bool send(std::span<const std::byte> datagram) noexcept TAPPET_REALTIME override {
        return put(to_plant_, datagram);
    }
    bool tell(std::span<const std::byte> datagram) noexcept override { return put(to_machine_, datagram); }
    std::size_t hear(std::span<std::byte> into) noexcept override { return take(to_plant_, into); }

private:
    struct Datagram {
        std::size_t size = 0;
        std::array<std::byte, most_bytes> bytes{};
    };
    template <std::size_t N>
    static std::size_t take(twin::Ring<Datagram, N>& ring, std::span<std::byte> into) noexcept
        TAPPET_REALTIME {
        Datagram next;
        if (!ring.pop(next)) return 0;
        std::memcpy(into.data(), next.bytes.data(), std::min(next.size, into.size()));
        return next.size;
    }
    /// Drops datagrams that nobody takes, as a socket does.
    template <std::size_t N>
    static bool put(twin::Ring<Datagram, N>& ring, std::span<const std::byte> datagram) noexcept
        TAPPET_REALTIME {
        Datagram next;
        if (datagram.size() > next.bytes.size()) return false;
        next.size = datagram.size();
        std::memcpy(next.bytes.data(), datagram.data(), datagram.size());
        return ring.push(next);
    }

    twin::Ring<Datagram, 32> to_machine_;
    twin::Ring<Datagram, 8> to_plant_;
};

} // namespace tappet::udp
