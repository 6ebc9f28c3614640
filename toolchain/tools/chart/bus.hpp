// Draws the frames of a bus and the time that each may take.
#pragma once

#include "kernel/machine/firmware.hpp"

#include <string>

namespace tappet::chart {

/// Draws the bus of a component whose driver proves response times (its type's device_traffic), at the given
/// bit rate and with a board's default errors. Returns an SVG: the frames in the order of arbitration, each
/// with its time on the wire, its longest response and its deadline.
std::string draw_bus(const AcceptedMachine& machine, std::size_t component, std::uint32_t bit_rate,
                     std::uint32_t data_bit_rate);

} // namespace tappet::chart
