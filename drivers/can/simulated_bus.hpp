// A CAN bus of the host: the machine's controller and the plant's, with the wire between them.
#pragma once

#include "drivers/can/signal_map.hpp"
#include "drivers/can/simulated_frames.hpp"
#include "drivers/can/twin.hpp"
#include "drivers/can/twin_bus.hpp"
#include "drivers/twin/simulated_device.hpp"

namespace tappet::can {

class SimulatedBus : public SimulatedDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;
    static constexpr bool is_judged = true;

    SimulatedBus(std::string_view of, std::uint64_t seed) : SimulatedDevice{of}, wire{seed} {}

    std::expected<void, Sentence> open(const void* device_map);
    [[nodiscard]] ProvidedDevice machine_end() noexcept { return provide<Device>(name, machine); }
    [[nodiscard]] ProvidedDevice plant_end() noexcept { return provide<Device>(name, plant); }

    std::expected<void, Sentence> open_again() { return machine.open(settings); }
    void count(WireCounters& into) const noexcept { machine.counters().tell(into); }
    void bring_to_plant(Time now);
    void bring_to_machine(Time now) { wire.deliver_until(now); }
    [[nodiscard]] Time next() noexcept { return wire.next(); }
    [[nodiscard]] bool is_driven() const noexcept { return !wire.is_silent() || plant.has_arrivals(); }
    [[nodiscard]] bool is_still() const noexcept { return wire.is_still(); }
    void send_safe_frames(Time now) noexcept;

    [[nodiscard]] std::vector<WireOutput> outputs() const { return sent.outputs(); }
    [[nodiscard]] Sentence broken() const { return sent.fault(); }
    [[nodiscard]] TwinFault strike(Random& random, Time now, bool with_any_values);
    [[nodiscard]] bool is_off() const noexcept { return faulted(machine.state()); }
    void repair() { static_cast<void>(machine.restart()); }

    TwinBus wire;
    Settings settings{}; ///< of the machine's controller
    Twin machine{}, plant{};
    SentFrames sent{}; ///< by the machine, if somebody lets it hear them

private:
    [[nodiscard]] TwinFault say_anything(Random& random, Time now);
    [[nodiscard]] TwinFault disturb_frames(Random& random, std::size_t what);

    const Identifiers* map_ = nullptr;
    std::span<const Frame> safe_{};
};

} // namespace tappet::can
