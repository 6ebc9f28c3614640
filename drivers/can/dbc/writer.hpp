// Writes a signal map as a DBC file, for tools that observe the bus next to the machine. On the host.
#pragma once

#include "drivers/can/signal_map.hpp"

#include <string>

namespace tappet::can::dbc {

/// Returns the file. The machine is the node `machine`, all other nodes are the node "others". Texts are in
/// code page 1252; a missing character becomes a question mark. Characters not allowed in a DBC name become
/// '_'.
std::string to_dbc(std::string_view machine, std::span<const FrameRow> frames,
                   std::span<const Signal> signals);

} // namespace tappet::can::dbc
