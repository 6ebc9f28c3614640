// Makes a channel of each row of data flow.
#include "tests/figures/experiments/wiring.hpp"

#include "kernel/machine/table/names.hpp"

namespace tappet::experiments {

namespace {

struct PortName {
    std::string_view component, port;
    explicit PortName(std::string_view whole)
        : component{whole.substr(0, whole.find('.'))}, port{whole.substr(whole.find('.') + 1)} {}
};

Duration period_of(const MachineView& machine, std::string_view component) {
    return machine.activities[activity_of(machine, component)].period;
}

} // namespace

Wiring::Wiring(const MachineView& machine) : assignments_(machine.components.size()) {
    for (const ConnectionRow& row : machine.connections) {
        const PortName from{row.from}, to{row.to};
        Assignment& writer = assignments_[find_component(machine, from.component)];
        Assignment& reader = assignments_[find_component(machine, to.component)];
        ++channels_;
        if (row.buffered) {
            writer.ports.fill = reader.ports.drain = &buffers_.emplace_back(row.capacity);
            const bool writer_is_slower =
                period_of(machine, from.component) > period_of(machine, to.component);
            writer.fill_at_most = writer_is_slower ? row.capacity : 1;
            reader.drain_at_most = writer_is_slower ? 1 : row.capacity;
            continue;
        }
        auto*& channel = from.port == "to_higher" ? writer.ports.to_higher : writer.ports.to_lower;
        if (channel == nullptr) channel = &data_.emplace_back();
        (to.port == "from_higher" ? reader.ports.from_higher : reader.ports.from_lower) = channel;
    }
}

} // namespace tappet::experiments
