// The loom's CANopen network: its nodes, the contents of their frames, and their configuration.
#pragma once

#include "apps/carpet_loom/maps.hpp"
#include "apps/carpet_loom/nodes/dobby.eds.hpp"
#include "apps/carpet_loom/nodes/drive.eds.hpp"
#include "apps/carpet_loom/nodes/encoder.eds.hpp"
#include "apps/carpet_loom/nodes/feeder.eds.hpp"
#include "apps/carpet_loom/nodes/load_cell.eds.hpp"
#include "drivers/canopen/frames.hpp"
#include "drivers/canopen/network.hpp"

namespace tappet::carpet {

// clang-format off
inline constexpr auto loom_network = canopen::network(can_signals,
    canopen::manager(wires::node::machine), // no heartbeat of its own: the drives stop when its commands cease
    canopen::node(wires::node::main_drive, "main", canopen::dictionary<files::drive_eds>).heartbeat(wires::heartbeat_period)
        .pdo("main_drive", canopen::on_event(wires::drive_status_period), {0x6041, 0x606C})
        .pdo("main_drive_command", {0x6040, 0x60FF})
        .write(0x6060, 3), // profile velocity
    canopen::node(wires::node::let_off_drive, "let_off", canopen::dictionary<files::drive_eds>).heartbeat(wires::heartbeat_period)
        .pdo("let_off", canopen::on_event(wires::drive_status_period), {0x6041, 0x606C})
        .pdo("let_off_command", {0x6040, 0x60FF})
        .write(0x6060, 3),
    canopen::node(wires::node::encoder, "encoder", canopen::dictionary<files::encoder_eds>).heartbeat(wires::heartbeat_period)
        .pdo("encoder", canopen::on_event(wires::encoder_period), {0x2100, 0x2101}),
    canopen::node(wires::node::load_cell, "load_cell", canopen::dictionary<files::load_cell_eds>).heartbeat(wires::heartbeat_period)
        .pdo("load_cell", canopen::on_event(wires::load_cell_period), {{0x7130, 1}, {0x6150, 1}}),
    canopen::node(wires::node::feeder, "feeder", canopen::dictionary<files::feeder_eds>).heartbeat(wires::heartbeat_period)
        .pdo("feeder", canopen::on_event(wires::feeder_status_period), {0x2200, 0x2201})
        .pdo("feeder_command", {0x2210, 0x2211}),
    canopen::node(wires::node::dobby, "dobby", canopen::dictionary<files::dobby_eds>).heartbeat(wires::heartbeat_period)
        .pdo("dobby", {0x2300, 0x2301})
        .pdo("dobby_command", {0x2310, 0x2311}));
// clang-format on

} // namespace tappet::carpet
