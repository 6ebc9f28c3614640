// What a bus carries and how long each frame may take, as a picture.
#pragma once

#include "kernel/machine/firmware.hpp"

#include <string>

namespace tappet::chart {

/// Of a component whose driver proves response times (its type's device_traffic), at that bit rate and with
/// the errors that a board expects without saying so. An SVG: the frames in the order in which they win the
/// bus, each with its time on the wire, its longest response and its deadline.
std::string draw_bus(const AcceptedMachine& machine, std::size_t component, std::uint32_t bit_rate,
                     std::uint32_t data_bit_rate);

} // namespace tappet::chart
