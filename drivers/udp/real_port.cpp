// Listens at the binding's address, or asks there.
#include "drivers/udp/real_port.hpp"

#include "kernel/base/address.hpp"

namespace tappet::udp {

std::expected<void, Sentence> RealPort::open(const DevicePlace& place) {
    const auto* longest = static_cast<const Longest*>(place.map);
    const std::string_view host = host_of(place.address);
    const auto port = static_cast<std::uint16_t>(port_of(place.address));
    return longest != nullptr && longest->asks ? socket_.ask(host, port) : socket_.open(host, port);
}

} // namespace tappet::udp
