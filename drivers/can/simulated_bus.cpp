// Opens both controllers by the machine's map, the plant's with sent and received frames exchanged.
#include "drivers/can/simulated_bus.hpp"

#include <utility>

namespace tappet::can {

std::expected<void, Sentence> SimulatedBus::open(const void* device_map) {
    const auto& map = *static_cast<const Identifiers*>(device_map);
    settings.interface = name;
    if (map.restarts_allowed != 0) settings.restarts_allowed = map.restarts_allowed;
    settings.receive = map.receive;
    settings.transmit = map.transmit;
    settings.takes_fd = map.has_fd;
    safe_ = map.safe;
    if (auto opened = machine.open(settings); !opened) return opened;
    Settings others = settings;
    std::swap(others.receive, others.transmit);
    others.restarts_allowed = ~0u; // nodes retry without limit
    if (auto opened = plant.open(others); !opened) return opened;
    if (!wire.attach(machine) || !wire.attach(plant))
        return std::unexpected(Sentence{"twin bus: no room for two ends"});
    return {};
}

void SimulatedBus::bring_to_plant(Time now) {
    wire.deliver_until(now);
    if (faulted(plant.state())) static_cast<void>(plant.restart());
}

void SimulatedBus::send_safe_frames(Time now) noexcept {
    static_cast<void>(open_again());
    for (Frame frame : safe_) {
        frame.stamp = now;
        static_cast<void>(machine.send(frame, Keep::last));
    }
    machine.finish(now);
}

} // namespace tappet::can
