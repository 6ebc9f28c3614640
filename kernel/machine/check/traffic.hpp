// Checks by the drivers' own analyses whether the traffic on each device of the board arrives in time.
#pragma once

#include "kernel/machine/check/board.hpp"
#include "kernel/machine/check/time.hpp"

namespace tappet::checks {

/// Returns how the component uses its device. An empty device name: the device is reached by an address, or
/// its driver has no deadline. `worst_ns`: the response of each activity.
constexpr DeviceUse use_of_device(const MachineView& m, const Board& board, const Binding& binding,
                                  const TableIndexView& r, std::span<const std::int64_t> worst_ns,
                                  std::size_t component) {
    const ComponentRow& row = m.components[component];
    const std::size_t activity = r.activity[component];
    if (row.type->device_traffic.rows == 0 || !m.activities[activity].real_time) return {};
    const BoundDevice* bound = find_named(binding.devices, row.device);
    const BoardDevice* device = bound == nullptr ? nullptr : find_named(board.devices, bound->at);
    if (device == nullptr) return {};
    return {device->name, device->facts, Duration{worst_ns[activity]}};
}

/// Checks the traffic; needs the worst responses of the activities.
constexpr Sentence check_traffic(const MachineView& m, const Board& board, const Binding& binding,
                                 const TableIndexView& r) {
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        const DeviceUse use = use_of_device(m, board, binding, r, r.worst_response_ns, c);
        if (use.device.empty()) continue;
        if (Sentence fault = m.components[c].type->device_traffic.analyse(use, {}); !fault.empty())
            return of_component(m.components[c].name, ": board \"", board.name, "\", device \"", use.device,
                                "\": ", fault);
    }
    return {};
}

} // namespace tappet::checks
