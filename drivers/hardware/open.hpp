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

/// A Modbus server and what makes it safe. It stays where it is while it is asked.
struct SafeServer {
    modbus::LibmodbusTransport* server = nullptr;
    modbus::SafeWrites writes{};
    bool is_safe = false; ///< each of them was confirmed
    Time end{};
    os::ThreadPlan plan{};
    os::Thread thread{};
};
/// Asks all servers at the same time, each until it is safe or so long has passed. Servers that are not. A
/// dead one takes nobody's time, but where the box refuses a thread: such servers share the time between
/// them. `meanwhile` is called at least every 50 ms, without a thread between two requests.
std::size_t write_safe_registers(std::span<SafeServer> servers, Duration within,
                                 const Meanwhile& meanwhile) noexcept;

} // namespace tappet
