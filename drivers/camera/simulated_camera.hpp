// A camera of the host.
#pragma once

#include "drivers/camera/twin.hpp"
#include "drivers/twin/simulated_device.hpp"

namespace tappet::camera {

class SimulatedCamera : public SimulatedDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;
    static constexpr bool is_judged = false; // it has no outputs

    SimulatedCamera(std::string_view of, std::uint64_t seed) : SimulatedDevice{of}, twin{seed} {}

    std::expected<void, Sentence> open(const void* device_map) {
        twin.open(*static_cast<const Size*>(device_map));
        return {};
    }
    [[nodiscard]] ProvidedDevice machine_end() noexcept {
        return {type_id<Device>, name, static_cast<Device*>(&twin)};
    }
    [[nodiscard]] ProvidedDevice plant_end() noexcept {
        return {type_id<Wires>, name, static_cast<Wires*>(&twin)};
    }

    void count(WireCounters& into) const noexcept { twin.counters().tell(into); }
    void bring_to_machine(Time) { twin.deliver(); }

    Twin twin;
};

} // namespace tappet::camera
