// The plant's end of the CAN bus: a raw SocketCAN socket that never blocks the loop.
#pragma once

#include "apps/carpet_loom/plant/plant.hpp"

#include <expected>
#include <string>

namespace tappet::loom {

class CanWire {
public:
    [[nodiscard]] static std::expected<CanWire, std::string> open(const std::string& interface);
    CanWire(CanWire&& other) noexcept;
    CanWire& operator=(CanWire&&) = delete;
    ~CanWire();

    /// Gives the plant what arrived and sends what it wants to send.
    void exchange(Plant& plant, Time now);
    /// Tells every listener of error frames that the bus is off.
    void announce_bus_off();
    [[nodiscard]] std::uint64_t unsent() const { return unsent_; }

private:
    explicit CanWire(int socket) : socket_(socket) {}
    void send(const CanFrame& frame);

    int socket_;
    std::uint64_t unsent_ = 0; // the queue was full
};

} // namespace tappet::loom
