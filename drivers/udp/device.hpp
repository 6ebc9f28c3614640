// Datagrams as a driver sees them: Ethernet instruments that send measurements unasked, and machines that
// query each other.
#pragma once

#include "drivers/udp/kind.hpp"
#include "kernel/base/realtime.hpp"

#include <cstddef>
#include <span>

namespace tappet::udp {

inline constexpr std::size_t most_bytes = 512; ///< of a datagram; each driver states its own maximum

/// All real-time, from one activity. Datagrams dropped by the system show as gaps in the sender's numbers.
class Device {
public:
    virtual ~Device() = default;
    /// Takes the next datagram; returns 0 when there is none. When it is longer than `into`, copies the
    /// beginning and returns the whole size.
    virtual std::size_t receive(std::span<std::byte> into) noexcept TAPPET_REALTIME = 0;
    /// Sends to the address it asks, or else to the sender of the last received datagram. Returns false when
    /// it was not sent.
    virtual bool send(std::span<const std::byte> datagram) noexcept TAPPET_REALTIME = 0;

protected:
    Device() = default;
    Device(const Device&) = default;
    Device& operator=(const Device&) = default;
};

/// Contents of a driver's `device_map`: its longest datagram, and whether it asks. If it asks, the binding
/// states the address to ask, else the address where this box listens.
struct Longest {
    std::size_t bytes;
    bool asks = false;
};

} // namespace tappet::udp
