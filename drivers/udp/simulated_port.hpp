// A port for datagrams of the host.
#pragma once

#include "drivers/twin/simulated_device.hpp"
#include "drivers/udp/twin.hpp"

namespace tappet::udp {

class SimulatedPort : public SimulatedDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;
    static constexpr bool is_judged = false; // a datagram's component defines its format

    SimulatedPort(std::string_view of, std::uint64_t) : SimulatedDevice{of} {}

    std::expected<void, Sentence> open(const void*) { return {}; }
    [[nodiscard]] ProvidedDevice machine_end() noexcept { return provide<Device>(name, twin_); }
    [[nodiscard]] ProvidedDevice plant_end() noexcept { return provide<Wires>(name, twin_); }

private:
    Twin twin_{};
};

} // namespace tappet::udp
