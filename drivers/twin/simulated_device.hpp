// What a host has in place of a device of the box: a twin at the machine's end, and the plant's end of its
// wires.
#pragma once

#include "kernel/component/device_kind.hpp"
#include "kernel/component/setup.hpp"
#include "kernel/component/wire_counters.hpp"

#include <cstdint>
#include <expected>

namespace tappet {

/// A driver's own class derives from it for its kind. It has
///     static constexpr const DeviceKind& kind
///     explicit ..(std::string_view name, std::uint64_t seed)         `seed` decides what its faults strike
///     std::expected<void, Sentence> open(const void* device_map)
///     ProvidedDevice machine_end(), plant_end()
/// and hides those of the following that its kind has something to do in. Not real-time; one thread, the
/// plant's.
class SimulatedDevice {
public:
    explicit SimulatedDevice(std::string_view of) noexcept : name{of} {}
    SimulatedDevice(const SimulatedDevice&) = delete;
    SimulatedDevice& operator=(const SimulatedDevice&) = delete;

    const std::string_view name;

    /// The machine's end anew, as a new process has it.
    std::expected<void, Sentence> open_again() { return {}; }
    void count(WireCounters&) const noexcept {}

    // ---- time: what comes to the plant before it moves, and to the machine behind that
    void bring_to_plant(Time) {}
    void bring_to_machine(Time) {}
    /// When something that is on its way arrives by itself.
    [[nodiscard]] Time next() const noexcept { return never; }
    /// Whether the machine has done something at its end since bring_to_machine(), or the twin holds
    /// something back.
    [[nodiscard]] bool is_driven() const noexcept { return false; }
    /// Whether nothing is on its way.
    [[nodiscard]] bool is_still() const noexcept { return true; }

    // ---- what the guardian of a machine does whose process is gone
    void write_safe_lines() noexcept {}
    void send_safe_frames(Time) noexcept {}
    void write_safe_registers() noexcept {}
};

} // namespace tappet
