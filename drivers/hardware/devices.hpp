// The devices of one machine, whatever world they are of: opened together, given to its drivers, counted.
#pragma once

#include "kernel/component/real_device.hpp"
#include "kernel/machine/plan/places.hpp"
#include "kernel/os/arming.hpp"

#include <expected>
#include <span>

namespace tappet {

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

/// Whether a row's driver has a map of what stands on its device, by which that can be opened. A component
/// that shares the device of another has none, nor has a driver of the machine's own kind.
constexpr bool drives(const ComponentRow& row, std::string_view kind) noexcept {
    return row.type->device_kind != nullptr && row.type->device_kind->name == kind &&
           row.type->device_map != nullptr;
}

} // namespace tappet
