// Frames between a plant and SocketCAN.
#include "toolchain/machine/bench/can_end.hpp"

#include <algorithm>
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

std::expected<void, Sentence> CanEnd::open(std::string_view interface,
                                           std::span<const can::Identifier> received) {
    const unsigned index = if_nametoindex(std::string{interface}.c_str());
    if (index == 0)
        return std::unexpected(Sentence{"CAN interface \"", interface,
                                        "\" does not exist on this bench; create it: --can ", interface});
    socket_ = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (socket_ < 0)
        return std::unexpected(
            Sentence{"CAN sockets: ", std::string_view{std::strerror(errno)}, "; load the module can-raw"});
    std::vector<can_filter> filters;
    for (const can::Identifier& each : received)
        filters.push_back(each.extended
                              ? can_filter{each.id | CAN_EFF_FLAG, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_EFF_MASK}
                              : can_filter{each.id, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK});
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(index);
    if (setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                   static_cast<socklen_t>(filters.size() * sizeof(can_filter))) != 0 ||
        ::bind(socket_, static_cast<const sockaddr*>(static_cast<const void*>(&address)), sizeof address) !=
            0)
        return std::unexpected(Sentence{"CAN interface \"", interface,
                                        "\": ", std::string_view{std::strerror(errno)}, "; is it up?"});
    return {};
}

can::Receive CanEnd::receive(can::Frame& frame) noexcept TAPPET_REALTIME {
    can_frame raw{};
    bool got = false;
    TAPPET_ESCAPE("a plant is not real-time", got = ::read(socket_, &raw, sizeof raw) == sizeof raw);
    if (!got) return {};
    frame = {};
    frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame.length = std::min<std::uint8_t>(raw.len, 8);
    std::copy(raw.data, raw.data + 8, frame.data.begin());
    ++count_.received;
    return {can::Received::frame, 0};
}

can::Send CanEnd::send(const can::Frame& frame, can::Keep) noexcept TAPPET_REALTIME {
    can_frame raw{};
    raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0u);
    raw.len = frame.length;
    std::copy(frame.data.begin(), frame.data.end(), raw.data);
    bool sent = false;
    TAPPET_ESCAPE("a plant is not real-time", sent = ::write(socket_, &raw, sizeof raw) == sizeof raw);
    sent ? ++count_.sent : ++count_.refused;
    return sent ? can::Send::queued : can::Send::refused_full;
}

void CanEnd::announce_bus_off() {
    can_frame raw{};
    raw.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
    raw.len = CAN_ERR_DLC;
    if (::write(socket_, &raw, sizeof raw) != sizeof raw) ++count_.refused;
}

} // namespace tappet
