// Opening one real device: where the binding says it stands, for what its driver's map says.
#pragma once

#include "drivers/can/safe_sender.hpp"
#include "drivers/can/socket_can.hpp"
#include "drivers/gpio/line_map.hpp"
#include "drivers/gpio/lines.hpp"
#include "drivers/hardware/devices.hpp"
#include "drivers/modbus/libmodbus_transport.hpp"
#include "drivers/modbus/register_map.hpp"
#include "drivers/udp/socket.hpp"
#include "kernel/machine/table/binding.hpp"
#include "kernel/machine/table/board.hpp"
#include "kernel/machine/table/components.hpp"
#include "kernel/os/thread.hpp"

#include <array>
#include <expected>

namespace tappet {

/// The lines of one chip as they are requested; they stay where they are while the chip is open.
using PlacedLines = std::array<gpio::Line, gpio::most_lines>;

/// What a driver's row is bound to; `device` is null for what is reached by an address. The check of the
/// table has found all of it.
struct BoundTo {
    const ComponentRow& row;
    const BoundDevice& bound;
    const BoardDevice* device;
    DeviceUse use{}; ///< without a name: nothing is proven of it
    [[nodiscard]] std::string_view address() const noexcept {
        return device != nullptr ? device->address : bound.at;
    }
};

/// Not real-time. An error says what is wrong and how to cure it, not which device it is.
std::expected<void, Sentence> open_device(can::SocketCan& bus, const BoundTo& to);
std::expected<void, Sentence> open_device(gpio::Lines& chip, PlacedLines& lines, const BoundTo& to);
std::expected<void, Sentence> open_device(modbus::LibmodbusTransport& server, const BoundTo& to);
std::expected<void, Sentence> open_device(udp::Socket& socket, const BoundTo& to);

/// Sends the frames of all buses until all are confirmed, for so long at most; how many are not.
std::size_t send_safe_frames(std::span<can::SafeSender> buses, Duration within) noexcept;
void rehearse(std::span<can::SafeSender> buses) noexcept;

/// A Modbus server and what makes it safe.
struct SafeServer {
    modbus::LibmodbusTransport* server = nullptr;
    modbus::SafeWrites writes{};
    std::string_view at{}; ///< servers at the same address share a line: a serial port, a gateway
    bool is_safe = false;  ///< each of them was confirmed

    struct Attempt {
        std::size_t next = 0, confirmed = 0;
        Duration took{};         ///< the last answer
        std::size_t answers = 0; ///< on this connection
        bool is_connected = false;
    } attempt{};
};
/// Whoever asks the servers of one address. It stays where it is while they are asked.
struct SafeLine {
    std::span<SafeServer> servers{}; ///< of all lines
    std::string_view at{};
    Time end{};
    os::ThreadPlan plan{};
    os::Thread thread{};
};
/// Asks each server until it is safe, for so long at most. Servers that are not. All lines at the same time:
/// a dead server takes nobody's time but that of its own line. There, servers that are still to be tried have
/// equal shares of the time that is left in each round, wherever they stand. The first round of several over
/// Ethernet is a quick one: it takes half of the time at most, and one that does not answer holds up the
/// others by twice `quick_answer_within`. `lines`: as many as servers. `meanwhile` is called every 50 ms.
std::size_t write_safe_registers(std::span<SafeServer> servers, std::span<SafeLine> lines, Duration within,
                                 const Meanwhile& meanwhile) noexcept;
inline constexpr Duration quick_answer_within = 50ms;

} // namespace tappet
