// The devices of one machine, whatever world they are of: opened together, given to its drivers, counted.
#pragma once

#include "drivers/can/device.hpp"
#include "drivers/gpio/device.hpp"
#include "kernel/machine/firmware.hpp"
#include "kernel/os/arming.hpp"

#include <cstdint>
#include <expected>
#include <span>

namespace tappet {

/// What was lost on the wires, and what came and was not as it must be; over all devices.
struct WireCounters {
    std::uint64_t can_frames_lost = 0;
    std::uint64_t can_faults = 0;
    std::uint64_t can_restarts = 0;
    std::uint64_t can_impostors = 0;
    std::uint64_t can_malformed = 0;
    std::uint64_t gpio_edges_lost = 0;

    void add(const can::Counters& seen) noexcept {
        can_frames_lost += seen.lost_in_kernel;
        can_faults += seen.faults;
        can_restarts += seen.restarts;
        can_impostors += seen.impostors;
        can_malformed += seen.malformed;
    }
    void add(const gpio::Counters& seen) noexcept { gpio_edges_lost += seen.missed; }
};

/// Not real-time but for the devices themselves.
class Devices {
public:
    Devices() = default;
    Devices(const Devices&) = delete;
    Devices& operator=(const Devices&) = delete;
    virtual ~Devices() = default;

    /// Opens all that the machine's drivers name. An error names the device, where it stands, and the cure.
    virtual std::expected<void, Sentence> open(const AcceptedMachine& machine) = 0;
    /// For MachineInstance::configure.
    [[nodiscard]] virtual std::span<const ProvidedDevice> provided() const noexcept = 0;
    /// What open() found and who answers, for the report of arming. It may take each server's time-out.
    virtual void report(os::ArmingReport& report) = 0;
    [[nodiscard]] virtual WireCounters counters() const noexcept = 0;
};

/// How many devices of each kind the drivers of a machine name.
struct DeviceCounts {
    std::size_t can = 0, gpio = 0, modbus = 0;
    [[nodiscard]] constexpr std::size_t all() const noexcept { return can + gpio + modbus; }
};

/// Whether a row's driver has a map of what stands on its device, by which that can be opened. A component
/// that shares the device of another has none, nor has a driver of the machine's own kind.
constexpr bool drives(const ComponentRow& row, std::string_view kind) noexcept {
    return row.type->device_kind == kind && row.type->device_map != nullptr;
}

constexpr DeviceCounts count_devices(const MachineView& m) noexcept {
    DeviceCounts counts;
    for (const ComponentRow& row : m.components) {
        counts.can += drives(row, "can") ? 1u : 0u;
        counts.gpio += drives(row, "gpio") ? 1u : 0u;
        counts.modbus += drives(row, "modbus") ? 1u : 0u;
    }
    return counts;
}

} // namespace tappet
