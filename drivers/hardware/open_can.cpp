// A CAN interface, opened for the identifiers of its driver's signal map.
#include "drivers/can/signal_map.hpp"
#include "drivers/hardware/open.hpp"

namespace tappet {

std::expected<void, Sentence> open_device(can::SocketCan& bus, const BoundTo& to) {
    const auto& map = *static_cast<const can::Identifiers*>(to.row.type->device_map);
    can::Settings settings;
    settings.interface = to.address();
    settings.bit_rate = to.device->bit_rate.bits_per_second;
    settings.receive = map.receive;
    settings.transmit = map.transmit;
    return bus.open(settings);
}

} // namespace tappet
