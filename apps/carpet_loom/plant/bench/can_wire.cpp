// Frames between the plant and SocketCAN.
#include "apps/carpet_loom/plant/bench/can_wire.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::loom {

std::expected<CanWire, std::string> CanWire::open(const std::string& interface) {
    const unsigned index = if_nametoindex(interface.c_str());
    if (index == 0)
        return std::unexpected("CAN interface '" + interface +
                               "' does not exist; create it or name another by --can");
    const int handle = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (handle < 0)
        return std::unexpected(std::string("CAN sockets: ") + std::strerror(errno) +
                               "; load the module can-raw");
    CanWire wire(handle);
    constexpr canid_t exact = CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK;
    const can_filter filters[] = {{wires::cob::nmt, exact},
                                  {wires::cob::main_drive_command, exact},
                                  {wires::cob::let_off_drive_command, exact},
                                  {wires::cob::feeder_command, exact},
                                  {wires::cob::dobby_command, exact}};
    if (setsockopt(handle, SOL_CAN_RAW, CAN_RAW_FILTER, filters, sizeof filters) != 0)
        return std::unexpected(std::string("CAN filters: ") + std::strerror(errno));
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(index);
    if (bind(handle, static_cast<const sockaddr*>(static_cast<const void*>(&address)), sizeof address) != 0)
        return std::unexpected("binding to '" + interface + "': " + std::strerror(errno) +
                               "; is the interface up?");
    return wire;
}

CanWire::CanWire(CanWire&& other) noexcept : socket_(other.socket_), unsent_(other.unsent_) {
    other.socket_ = -1;
}

CanWire::~CanWire() {
    if (socket_ >= 0) close(socket_);
}

void CanWire::send(const CanFrame& frame) {
    can_frame raw{};
    raw.can_id = frame.id;
    raw.len = frame.length;
    std::copy(frame.data.begin(), frame.data.end(), raw.data);
    if (write(socket_, &raw, sizeof raw) != sizeof raw) ++unsent_;
}

void CanWire::announce_bus_off() {
    can_frame raw{};
    raw.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
    raw.len = CAN_ERR_DLC;
    if (write(socket_, &raw, sizeof raw) != sizeof raw) ++unsent_;
}

void CanWire::exchange(Plant& plant, Time now) {
    can_frame raw{};
    while (read(socket_, &raw, sizeof raw) == sizeof raw) {
        CanFrame frame;
        frame.id = raw.can_id & CAN_SFF_MASK;
        frame.length = std::min<std::uint8_t>(raw.len, 8);
        std::copy(raw.data, raw.data + 8, frame.data.begin());
        plant.receive(frame, now);
    }
    plant.advance(now);
    CanFrame frame;
    CanFrame encoder;
    bool sampled = false;
    Time due;
    while (plant.transmit(frame, due)) {
        if (frame.id != wires::cob::encoder_position) {
            send(frame);
            continue;
        }
        // A late loop leaves samples out, which the counter shows, rather than sending several of the past.
        encoder = frame;
        sampled = true;
    }
    if (!sampled) return;
    const std::uint16_t code = plant.encoder_code();
    encoder.data[0] = static_cast<std::uint8_t>(code & 0xFF);
    encoder.data[1] = static_cast<std::uint8_t>(code >> 8);
    send(encoder);
}

} // namespace tappet::loom
