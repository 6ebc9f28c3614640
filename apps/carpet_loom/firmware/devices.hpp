// The real devices of the carpet loom, opened where the board says they are.
#pragma once

#include "apps/carpet_loom/maps.hpp"
#include "drivers/can/socket_can.hpp"
#include "drivers/gpio/lines.hpp"
#include "drivers/modbus/libmodbus_transport.hpp"
#include "kernel/machine/table/board.hpp"

#include <array>
#include <expected>

namespace tappet::carpet {

/// Not real-time.
class Devices {
public:
    /// Opens all of them. An error names the device, what the board says of it, and the cure.
    std::expected<void, Sentence> open(const Board& board);
    /// For MachineInstance::configure.
    [[nodiscard]] std::span<const ProvidedDevice> provided() const noexcept { return provided_; }

    [[nodiscard]] const can::SocketCan& can() const noexcept { return can_; }
    [[nodiscard]] const gpio::Lines& lines() const noexcept { return lines_; }

private:
    std::expected<void, Sentence> open_can(const BoardDevice& device);
    std::expected<void, Sentence> open_lines(const BoardDevice& device);
    std::expected<void, Sentence> open_utility(const BoardDevice& device);

    can::SocketCan can_{};
    gpio::Lines lines_{};
    modbus::LibmodbusTransport utility_{};
    std::array<gpio::Line, io_lines.rows.size()> placed_lines_{};
    std::array<ProvidedDevice, 3> provided_{};
};

} // namespace tappet::carpet
