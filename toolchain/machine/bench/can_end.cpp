// Frames between a plant and SocketCAN.
#include "toolchain/machine/bench/can_end.hpp"

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

namespace tappet {

CanEnd::~CanEnd() {
    if (socket_ >= 0) ::close(socket_);
}

std::expected<void, Sentence> CanEnd::open(std::string_view interface, const can::Identifiers& machine) {
    const unsigned index = if_nametoindex(std::string{interface}.c_str());
    if (index == 0)
        return std::unexpected(Sentence{"CAN interface \"", interface,
                                        "\" does not exist on this bench; create it: --can ", interface});
    socket_ = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (socket_ < 0)
        return std::unexpected(
            Sentence{"CAN sockets: ", std::string_view{std::strerror(errno)}, "; load the module can-raw"});
    std::vector<can_filter> filters;
    for (const can::Identifier& each : machine.transmit) filters.push_back(can::wire::exactly(each));
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

can::Receive CanEnd::receive(can::Frame& frame) noexcept TAPPET_REALTIME {
    canfd_frame raw{};
    ssize_t got = 0;
    TAPPET_ESCAPE("a plant is not real-time", got = ::read(socket_, &raw, sizeof raw));
    frame = {};
    if (got <= 0 || !can::wire::decode(raw, static_cast<std::size_t>(got), can::State::active, frame))
        return {};
    ++count_.received;
    return {can::Received::frame, 0};
}

can::Send CanEnd::send(const can::Frame& frame, can::Keep) noexcept TAPPET_REALTIME {
    canfd_frame raw;
    can::wire::encode(frame, raw);
    const std::size_t bytes = can::wire::bytes_of(frame);
    ssize_t sent = 0;
    TAPPET_ESCAPE("a plant is not real-time", sent = ::write(socket_, &raw, bytes));
    const bool whole = sent == static_cast<ssize_t>(bytes);
    whole ? ++count_.sent : ++count_.refused;
    return whole ? can::Send::queued : can::Send::refused_full;
}

void CanEnd::announce_bus_off() {
    can_frame raw{};
    raw.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
    raw.len = CAN_ERR_DLC;
    if (::write(socket_, &raw, sizeof raw) != sizeof raw) ++count_.refused;
}

} // namespace tappet
