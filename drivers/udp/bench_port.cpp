// The binding's address is the machine's.
#include "drivers/udp/bench_port.hpp"

#include "kernel/base/address.hpp"

namespace tappet::udp {

std::expected<void, Sentence> BenchPort::open(const DevicePlace& place) {
    return sender_.open(host_of(place.address), static_cast<std::uint16_t>(port_of(place.address)));
}

} // namespace tappet::udp
