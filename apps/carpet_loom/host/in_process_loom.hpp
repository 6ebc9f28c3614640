// The host world's other end of the wires: the plant in the machine's own process, behind the twins of its
// devices.
#pragma once

#include "apps/carpet_loom/maps.hpp"
#include "apps/carpet_loom/plant/plant.hpp"
#include "drivers/can/twin.hpp"
#include "drivers/can/twin_bus.hpp"
#include "drivers/gpio/twin.hpp"
#include "drivers/modbus/twin.hpp"
#include "kernel/component/setup.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"

#include <array>
#include <cstdint>

namespace tappet::carpet {

/// Twins and plant. The plant meets the machine at frames, lines and registers only.
class InProcessLoom {
public:
    InProcessLoom(const loom::Settings& settings, std::uint64_t seed);

    /// Opens the twins as a board would open the devices. An error names what and the cure.
    std::expected<void, Sentence> open();
    /// For MachineInstance::configure.
    [[nodiscard]] std::span<const ProvidedDevice> devices() const noexcept { return provided_; }

    /// Before the first advance(): the plant's time begins here. The epoch unless told.
    void begin_at(Time origin) noexcept { origin_ = origin.time_since_epoch(); }
    /// Moves plant and wires to `now`. One thread, the plant's; the machine's may be others.
    void advance(Time now);
    /// When advance() has something to do: the plant's next event.
    [[nodiscard]] Time next() const noexcept { return plant_.next_event() + origin_; }

    [[nodiscard]] loom::Plant& plant() noexcept { return plant_; }
    [[nodiscard]] can::TwinBus& bus() noexcept { return bus_; }
    [[nodiscard]] can::Twin& machine_can() noexcept { return machine_can_; }
    [[nodiscard]] gpio::Twin& lines() noexcept { return lines_; }
    [[nodiscard]] modbus::Twin& utility() noexcept { return utility_; }
    [[nodiscard]] const can::Twin& machine_can() const noexcept { return machine_can_; }

private:
    void frames_to_plant(Time now);
    void frames_to_machine(Time now);
    void lines_to_plant(Time now);
    void lines_to_machine(Time now);
    void registers();

    loom::Plant plant_;
    can::TwinBus bus_;
    can::Twin machine_can_{};
    can::Twin plant_can_{};
    gpio::Twin lines_;
    modbus::Twin utility_{};
    std::array<gpio::Line, io_lines.rows.size()> line_settings_{};
    std::array<ProvidedDevice, 3> provided_{};
    gpio::Mask seen_outputs_ = 0;
    Duration origin_{};
};

} // namespace tappet::carpet
