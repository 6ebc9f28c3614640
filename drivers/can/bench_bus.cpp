// Transfers frames between a plant and SocketCAN.
#include "drivers/can/bench_bus.hpp"

#include "drivers/can/signal_map.hpp"
#include "drivers/can/wire.hpp"

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::can {

BenchBus::~BenchBus() {
    if (socket_ >= 0) ::close(socket_);
}

std::expected<void, Sentence> BenchBus::open(const DevicePlace& place) {
    const std::string_view interface = place.address;
    const auto& machine = *static_cast<const Identifiers*>(place.map);
    const unsigned index = if_nametoindex(std::string{interface}.c_str());
    if (index == 0)
        return std::unexpected(Sentence{"CAN interface \"", interface,
                                        "\" does not exist on this bench; create it: --can ", interface});
    socket_ = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (socket_ < 0)
        return std::unexpected(
            Sentence{"CAN sockets: ", std::string_view{std::strerror(errno)}, "; load the module can-raw"});
    std::vector<can_filter> filters;
    for (const Identifier& each : machine.transmit) filters.push_back(wire::exactly(each));
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(index);
    const int takes_fd = machine.has_fd ? 1 : 0;
    if (setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                   static_cast<socklen_t>(filters.size() * sizeof(can_filter))) != 0 ||
        setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &takes_fd, sizeof takes_fd) != 0 ||
        ::bind(socket_, static_cast<const sockaddr*>(static_cast<const void*>(&address)), sizeof address) !=
            0)
        return std::unexpected(Sentence{"CAN interface \"", interface,
                                        "\": ", std::string_view{std::strerror(errno)}, "; is it up?"});
    return {};
}

Receive BenchBus::receive(Frame& frame) noexcept TAPPET_REALTIME {
    canfd_frame raw{};
    ssize_t got = 0;
    TAPPET_ESCAPE("a plant is not real-time", got = ::read(socket_, &raw, sizeof raw));
    frame = {};
    if (got <= 0 || !wire::decode(raw, static_cast<std::size_t>(got), State::active, frame)) return {};
    ++count_.received;
    return {Received::frame, 0};
}

Send BenchBus::send(const Frame& frame, Keep) noexcept TAPPET_REALTIME {
    canfd_frame raw;
    wire::encode(frame, raw);
    const std::size_t bytes = wire::bytes_of(frame);
    ssize_t sent = 0;
    TAPPET_ESCAPE("a plant is not real-time", sent = ::write(socket_, &raw, bytes));
    const bool whole = sent == static_cast<ssize_t>(bytes);
    whole ? ++count_.sent : ++count_.refused;
    return whole ? Send::queued : Send::refused_full;
}

void BenchBus::announce_bus_off() {
    can_frame raw{};
    raw.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
    raw.len = CAN_ERR_DLC;
    if (::write(socket_, &raw, sizeof raw) != sizeof raw) ++count_.refused;
}

} // namespace tappet::can
