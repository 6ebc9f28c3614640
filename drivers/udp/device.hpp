// Datagrams, as a driver sees them: instruments on Ethernet that tell their measurements unasked, and
// machines that ask each other.
#pragma once

#include "drivers/udp/kind.hpp"
#include "kernel/base/realtime.hpp"

#include <cstddef>
#include <span>

namespace tappet::udp {

inline constexpr std::size_t most_bytes = 512; ///< of a datagram; a driver states the most of its own

/// All real-time, from one activity. What the system dropped is missing from the sender's numbers.
class Device {
public:
    virtual ~Device() = default;
    /// The next one; nothing: none is there. Of what is longer than `into` the beginning is given, and its
    /// whole size.
    virtual std::size_t receive(std::span<std::byte> into) noexcept TAPPET_REALTIME = 0;
    /// To whom it asks, else to whoever sent the last one that was received. False: it did not go out.
    virtual bool send(std::span<const std::byte> datagram) noexcept TAPPET_REALTIME = 0;

protected:
    Device() = default;
    Device(const Device&) = default;
    Device& operator=(const Device&) = default;
};

/// What a driver's `device_map` says: the longest datagram that it takes; and whether it asks: then its
/// binding says whom, else where this box listens.
struct Longest {
    std::size_t bytes;
    bool asks = false;
};

} // namespace tappet::udp
