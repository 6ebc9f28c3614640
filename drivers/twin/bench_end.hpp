// A bench's end of a device's wires on the plant's side. On a bench the machine runs in a process of its own,
// with the real driver.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/component/real_device.hpp"

#include <cstdint>
#include <expected>

namespace tappet {

/// Base of a driver's own class for its kind, which must have
///     static constexpr const DeviceKind& kind
/// Not real-time; only the plant's thread.
class BenchEnd {
public:
    BenchEnd() = default;
    BenchEnd(const BenchEnd&) = delete;
    BenchEnd& operator=(const BenchEnd&) = delete;
    virtual ~BenchEnd() = default;

    /// Opens the other end of the device that the machine's driver opens at that place. The error states
    /// cause and cure, without the device's name.
    virtual std::expected<void, Sentence> open(const DevicePlace& place) = 0;
    /// Returns the interface for the plant's FarEnd.
    [[nodiscard]] virtual ProvidedDevice provided(std::string_view name) noexcept = 0;
    /// Lets the machine connect, after the plant set its first values. Errors as in open().
    virtual std::expected<void, Sentence> listen() { return {}; }
    /// Reads what the machine has done by `now`, for devices without notification.
    virtual void look(Time /*now*/) {}

    // ---- faults of the wires
    /// Puts a bus into bus-off.
    virtual void announce_bus_off() {}
    /// Switches a server on or off.
    virtual void set_power(bool /*on*/) {}

    // ---- counted errors
    [[nodiscard]] virtual std::uint64_t unsent() const noexcept { return 0; }
    [[nodiscard]] virtual std::uint64_t failures() const noexcept { return 0; }
};

} // namespace tappet
