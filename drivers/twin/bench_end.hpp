// What a bench has at the plant's end of a device's wires. The machine runs in a process of its own there, on
// the real driver.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/component/real_device.hpp"

#include <cstdint>
#include <expected>

namespace tappet {

/// A driver's own class derives from it for its kind, and has
///     static constexpr const DeviceKind& kind
/// Not real-time; one thread, the plant's.
class BenchEnd {
public:
    BenchEnd() = default;
    BenchEnd(const BenchEnd&) = delete;
    BenchEnd& operator=(const BenchEnd&) = delete;
    virtual ~BenchEnd() = default;

    /// The other end of what the machine's driver opens at that place. The error says what is wrong and how
    /// to cure it, not which device it is.
    virtual std::expected<void, Sentence> open(const DevicePlace& place) = 0;
    /// For the plant's FarEnd.
    [[nodiscard]] virtual ProvidedDevice provided(std::string_view name) noexcept = 0;
    /// Lets the machine come: the plant has set what it can read. The error as of open().
    virtual std::expected<void, Sentence> listen() { return {}; }
    /// Takes in what the machine has done by `now`, where nothing tells of it.
    virtual void look(Time /*now*/) {}

    // ---- what goes wrong with the wires
    /// Of a bus: it is off.
    virtual void announce_bus_off() {}
    /// Of a server: it is there.
    virtual void set_power(bool /*on*/) {}

    // ---- what went wrong by itself
    [[nodiscard]] virtual std::uint64_t unsent() const noexcept { return 0; }
    [[nodiscard]] virtual std::uint64_t failures() const noexcept { return 0; }
};

} // namespace tappet
