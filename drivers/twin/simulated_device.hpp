// The host's replacement for a device of the box: a twin at the machine's end, and the plant's end of its
// wires.
#pragma once

#include "drivers/twin/simulated_outputs.hpp"
#include "kernel/component/device_kind.hpp"
#include "kernel/component/setup.hpp"
#include "kernel/component/wire_counters.hpp"

#include <cstdint>
#include <expected>

namespace tappet {

/// Base of a driver's own class for its kind, which must have
///     static constexpr const DeviceKind& kind
///     explicit ..(std::string_view name, std::uint64_t seed)         `seed` selects what its faults strike
///     std::expected<void, Sentence> open(const void* device_map)
///     ProvidedDevice machine_end(), plant_end()
///     static constexpr bool is_judged                                a swarm disturbs it and judges its
///     outputs
/// and, if it is judged,
///     std::vector<WireOutput> outputs() const
///     TwinFault strike(Random&, Time now, bool with_any_values)      with values that no plant would send
/// and hides those of the following members that its kind needs. Not real-time; only the plant's thread.
class SimulatedDevice {
public:
    explicit SimulatedDevice(std::string_view of) noexcept : name{of} {}
    SimulatedDevice(const SimulatedDevice&) = delete;
    SimulatedDevice& operator=(const SimulatedDevice&) = delete;

    const std::string_view name;

    /// Opens the machine's end again, as for a new process.
    std::expected<void, Sentence> open_again() { return {}; }
    void count(WireCounters&) const noexcept {}

    // ---- time: arrivals at the plant before its move(), and at the machine after it
    void bring_to_plant(Time) {}
    void bring_to_machine(Time) {}
    /// Returns when something pending arrives by itself.
    [[nodiscard]] Time next() const noexcept { return never; }
    /// Returns whether the machine used its end since bring_to_machine(), or the twin holds something back.
    [[nodiscard]] bool is_driven() const noexcept { return false; }
    /// Returns whether nothing is pending.
    [[nodiscard]] bool is_still() const noexcept { return true; }

    // ---- the guardian's work for a machine whose process has ended
    void write_safe_lines() noexcept {}
    void send_safe_frames(Time) noexcept {}
    void write_safe_registers() noexcept {}

    // ---- for a swarm
    /// Returns what was wrong with something that the machine has sent; empty: nothing.
    [[nodiscard]] Sentence broken() const { return {}; }
    /// Returns whether it works for nobody until it is repaired or its driver restarts it.
    [[nodiscard]] bool is_off() const noexcept { return false; }
    /// Repairs it, as a person at the box does.
    void repair() {}
};

} // namespace tappet
