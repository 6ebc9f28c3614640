// A CAN interface, opened for the identifiers of its driver's signal map.
#include "drivers/can/signal_map.hpp"
#include "drivers/can/transmitter.hpp"
#include "drivers/hardware/open.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/sleep.hpp"

namespace tappet {

std::expected<void, Sentence> open_device(can::SocketCan& bus, const BoundTo& to) {
    const auto& map = *static_cast<const can::Identifiers*>(to.row.type->device_map);
    can::Settings settings;
    settings.interface = to.address();
    settings.bit_rate = to.device->bit_rate.bits_per_second;
    settings.data_bit_rate = to.device->bit_rate.in_data_phase;
    settings.takes_fd = map.has_fd;
    if (map.restarts_allowed != 0) settings.restarts_allowed = map.restarts_allowed;
    settings.receive = map.receive;
    settings.transmit = map.transmit;
    std::array<TrafficRow, most_traffic_rows> rows{};
    Duration shortest_sent = Duration::max();
    if (!to.use.device.empty())
        static_cast<void>(to.row.type->device_traffic.analyse(to.use, rows)); // accepted
    for (const TrafficRow& row : rows)
        if (row.sent) shortest_sent = std::min(shortest_sent, row.wire_time);
    if (shortest_sent != Duration::max())
        settings.in_flight = can::frames_in_flight(to.use.response, shortest_sent);
    return bus.open(settings);
}

void rehearse(std::span<can::SafeSender> buses) noexcept {
    for (can::SafeSender& bus : buses) {
        bus.send(can::SafeSender::Purpose::rehearsal);
        static_cast<void>(bus.left());
    }
}

std::size_t send_safe_frames(std::span<can::SafeSender> buses, Duration within) noexcept {
    for (can::SafeSender& bus : buses) bus.begin();
    for (const Time end = os::Clock::monotonic() + within;;) {
        for (can::SafeSender& bus : buses) bus.send(can::SafeSender::Purpose::earnest);
        os::sleep_for(can::SafeSender::look_every);
        std::size_t left = 0;
        for (can::SafeSender& bus : buses) left += bus.left();
        if (left == 0 || os::Clock::monotonic() >= end) return left;
    }
}

} // namespace tappet
