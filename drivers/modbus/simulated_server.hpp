// A Modbus server of the host.
#pragma once

#include "drivers/modbus/register_map.hpp"
#include "drivers/modbus/twin.hpp"
#include "drivers/twin/simulated_device.hpp"
#include "drivers/twin/simulated_outputs.hpp"
#include "kernel/base/random.hpp"

namespace tappet::modbus {

class SimulatedServer : public SimulatedDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;
    static constexpr bool is_judged = true;

    SimulatedServer(std::string_view of, std::uint64_t) : SimulatedDevice{of} {}

    std::expected<void, Sentence> open(const void* device_map) {
        safe_ = static_cast<const SafeWrites*>(device_map);
        return {};
    }
    [[nodiscard]] ProvidedDevice machine_end() noexcept { return provide<Transport>(name, twin); }
    [[nodiscard]] ProvidedDevice plant_end() noexcept { return provide<ServerTables>(name, twin); }

    void bring_to_machine(Time) { seen_ = twin.changes(); }
    [[nodiscard]] bool is_driven() const noexcept { return twin.changes() != seen_; }
    void write_safe_registers() noexcept {
        static_cast<void>(twin.connect());
        for (const SafeWrite& each : safe_->requests)
            static_cast<void>(twin.write(each.run.table, static_cast<std::uint16_t>(each.run.address),
                                         safe_->words.subspan(each.first, each.run.count)));
        twin.disconnect();
    }

    [[nodiscard]] std::vector<WireOutput> outputs() const;
    [[nodiscard]] TwinFault strike(Random& random, Time now, bool with_any_values);

    Twin twin{ServerFacts{}.answer_within};

private:
    [[nodiscard]] TwinFault say_anything(Random& random);

    const SafeWrites* safe_ = nullptr;
    std::uint32_t seen_ = 0;
};

} // namespace tappet::modbus
