// The devices of one machine, whatever world they are of: opened together, given to its drivers, counted.
#pragma once

#include "drivers/can/device.hpp"
#include "drivers/gpio/device.hpp"
#include "kernel/machine/plan/places.hpp"
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

/// Called between the steps of what may take long.
struct Meanwhile {
    void* context = nullptr;
    void (*call)(void* context) noexcept = nullptr;
    void operator()() const noexcept {
        if (call != nullptr) call(context);
    }
};

/// Devices whose wires lead to a machine of steel: what makes them safe when the machine's process is no
/// more. All of it is the guardian's, whose process is a copy of the machine's from before it armed. Not
/// real-time.
class GuardedDevices : public Devices {
public:
    /// Descriptors that the guardian needs of those that were opened.
    [[nodiscard]] virtual Bounded<int, 16> kept_by_guardian() const noexcept = 0;
    /// Opens what the guardian needs for itself, and rehearses: nothing has moved, and every line has its
    /// safe value. No frame and no request leaves. The error names the device and the cure.
    virtual std::expected<void, Sentence> prepare_safe_ending() = 0;
    /// Writes the safe values of all output lines. Chips that did not take them.
    virtual std::size_t write_safe_lines() noexcept = 0;
    /// Sends the safe frames of all buses until each is confirmed, for so long at most. Frames that are not.
    virtual std::size_t send_safe_frames(Duration within) noexcept = 0;
    /// Each server gets its safe values over a connection of its own, all at the same time, for so long at
    /// most. Servers that did not confirm them.
    virtual std::size_t write_safe_registers(Duration within, const Meanwhile& meanwhile) noexcept = 0;
};

/// How many devices of each kind the drivers of a machine name.
struct DeviceCounts {
    std::size_t can = 0, gpio = 0, modbus = 0, udp = 0;
    [[nodiscard]] constexpr std::size_t all() const noexcept { return can + gpio + modbus + udp; }
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
        counts.udp += drives(row, "udp") ? 1u : 0u;
    }
    return counts;
}

} // namespace tappet
