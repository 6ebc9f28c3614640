// A GPIO chip of the host: its twin has the lines in the order of the map.
#pragma once

#include "drivers/gpio/line_map.hpp"
#include "drivers/gpio/twin.hpp"
#include "drivers/twin/simulated_device.hpp"
#include "drivers/twin/simulated_outputs.hpp"

namespace tappet::gpio {

class SimulatedChip : public SimulatedDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;
    static constexpr bool is_judged = true;

    SimulatedChip(std::string_view of, std::uint64_t seed) : SimulatedDevice{of}, twin{seed} {}

    std::expected<void, Sentence> open(const void* device_map) {
        map_ = *static_cast<const std::span<const LineRow>*>(device_map);
        place(map_, [next = 0u](std::string_view) mutable { return next++; }, lines_); // a twin has no board
        return twin.open({name, std::span{lines_}.first(map_.size())});
    }
    [[nodiscard]] ProvidedDevice machine_end() noexcept { return provide<Device>(name, twin); }
    [[nodiscard]] ProvidedDevice plant_end() noexcept { return provide<Wires>(name, twin); }

    void count(WireCounters& into) const noexcept { twin.counters().tell(into); }
    void bring_to_plant(Time) { seen_ = twin.outputs(); }
    void bring_to_machine(Time now) { twin.deliver_until(now); }
    [[nodiscard]] bool is_driven() const noexcept { return !twin.is_still() || twin.outputs() != seen_; }
    [[nodiscard]] bool is_still() const noexcept { return twin.is_still(); }
    void write_safe_lines() noexcept { static_cast<void>(twin.make_safe()); }

    [[nodiscard]] std::vector<WireOutput> outputs() const;
    [[nodiscard]] TwinFault strike(Random& random, Time now, bool with_any_values);

    Twin twin;

private:
    [[nodiscard]] TwinFault strike_line(Random& random, Time now, std::uint64_t what, std::size_t line);

    std::span<const LineRow> map_{};
    PlacedLines lines_{};
    Mask seen_ = 0;
};

} // namespace tappet::gpio
