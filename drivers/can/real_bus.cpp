// The settings of a bus: from its board, its map and its timing proof.
#include "drivers/can/real_bus.hpp"

#include "drivers/can/transmitter.hpp"

#include <algorithm>
#include <array>

namespace tappet::can {

std::expected<void, Sentence> RealBus::open(const DevicePlace& place) {
    const auto& map = *static_cast<const Identifiers*>(place.map);
    address_ = place.address;
    safe_frames_ = map.safe;
    const BusFacts facts = bus_facts(place.of_board);
    Settings settings;
    settings.interface = place.address;
    settings.bit_rate = facts.bit_rate;
    settings.data_bit_rate = facts.data_bit_rate;
    settings.takes_fd = map.has_fd;
    if (map.restarts_allowed != 0) settings.restarts_allowed = map.restarts_allowed;
    settings.receive = map.receive;
    settings.transmit = map.transmit;
    std::array<TrafficRow, most_traffic_rows> rows{};
    Duration shortest_sent = Duration::max();
    if (!place.use.device.empty()) static_cast<void>(place.traffic.analyse(place.use, rows)); // accepted
    for (const TrafficRow& row : rows)
        if (row.sent) shortest_sent = std::min(shortest_sent, row.wire_time);
    if (shortest_sent != Duration::max())
        settings.in_flight = frames_in_flight(place.use.response, shortest_sent);
    return bus_.open(settings);
}

void RealBus::report(os::ArmingReport& report, std::string_view) { report.passed("can-bus", bus_.found()); }

std::expected<void, Sentence> RealBus::prepare_safe_ending() {
    if (auto opened = safe_.open(address_, safe_frames_); !opened) return opened;
    safe_.send(SafeSender::Purpose::rehearsal);
    static_cast<void>(safe_.left());
    return {};
}

} // namespace tappet::can
