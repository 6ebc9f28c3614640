// A CANopen network as one constexpr table: its nodes, their identity and their configuration.
//
//     inline constexpr auto press_network = canopen::network(press_signals,
//         canopen::manager(127).sync(10ms),
//         canopen::node(1, "drive", canopen::dictionary<files::servo_eds>)
//             .heartbeat(100ms)
//             .pdo("drive", canopen::on_event(5ms), {0x6041, 0x606C})   a frame of the signal map
//             .pdo("drive_command", {0x6040, 0x60FF})
//             .write(0x6060, 3));
#pragma once

#include "drivers/canopen/eds.hpp"
#include "drivers/canopen/network_steps.hpp"

namespace tappet::canopen {

/// `signals` is the bus's map. The component has the static_assert(map.fault.empty(), map.fault).
template <std::size_t F, std::size_t S, class... Nodes>
constexpr NetworkMap<sizeof...(Nodes)> network(const can::SignalMap<F, S>& signals, ManagerRow manager,
                                               const Nodes&... nodes) noexcept {
    NetworkMap<sizeof...(Nodes)> map;
    map.manager = manager;
    map.nodes = {nodes...};
    map.fault = signals.fault;
    if (map.fault.empty()) map.fault = detail::network_fault(signals, map);
    if (map.fault.empty()) detail::add_steps(signals, map);
    return map;
}

} // namespace tappet::canopen
