// The devices of one machine in any world: opened together, provided to its drivers, counted.
#pragma once

#include "kernel/component/real_device.hpp"
#include "kernel/machine/plan/places.hpp"
#include "kernel/os/arming.hpp"

#include <expected>
#include <span>

namespace tappet {

/// Not real-time, except the devices themselves.
class Devices {
public:
    Devices() = default;
    Devices(const Devices&) = delete;
    Devices& operator=(const Devices&) = delete;
    virtual ~Devices() = default;

    /// Opens all devices that the machine's drivers name. An error names the device, its place and the cure.
    virtual std::expected<void, Sentence> open(const AcceptedMachine& machine) = 0;
    /// Returns the devices for MachineInstance::configure.
    [[nodiscard]] virtual std::span<const ProvidedDevice> provided() const noexcept = 0;
    /// Adds the results of open() and of a test request to the arming report. May take a time-out per server.
    virtual void report(os::ArmingReport& report) = 0;
    [[nodiscard]] virtual WireCounters counters() const noexcept = 0;
};

/// Devices with real wires, made safe by the guardian when the machine's process has ended. Only the
/// guardian makes these calls: its process was forked from the machine's before arming. Not real-time.
class GuardedDevices : public Devices {
public:
    /// Returns the descriptors of opened devices that the guardian needs.
    [[nodiscard]] virtual Bounded<int, 16> kept_by_guardian() const noexcept = 0;
    /// Opens the guardian's own connections and tries the safe ending without effect: nothing moves yet,
    /// and every line has its safe value. Sends no frame and no request. The error names device and cure.
    virtual std::expected<void, Sentence> prepare_safe_ending() = 0;
    /// Writes the safe values of all output lines. Returns the number of chips that refused.
    virtual std::size_t write_safe_lines() noexcept = 0;
    /// Sends the safe frames of all buses until each is confirmed, for at most `within`. Returns the number
    /// of unconfirmed frames.
    virtual std::size_t send_safe_frames(Duration within) noexcept = 0;
    /// Writes each server's safe values over a connection of its own, to all at the same time, for at most
    /// `within`. Returns the number of servers that did not confirm.
    virtual std::size_t write_safe_registers(Duration within, const Meanwhile& meanwhile) noexcept = 0;
};

/// Returns whether a row's driver has a map by which its device is opened. A component that shares another
/// one's device has no map; nor has a driver that opens its device itself.
constexpr bool drives(const ComponentRow& row, std::string_view kind) noexcept {
    return row.type->device_kind != nullptr && row.type->device_kind->name == kind &&
           row.type->device_map != nullptr;
}

/// Returns the refusal of a device that start-up should open and does not know; `list`: where it looked.
Sentence unknown_kind(const ComponentRow& row, std::string_view list);

} // namespace tappet
