// A signal map as a DBC file, for tools that look at the bus beside us. On the host.
#pragma once

#include "drivers/can/signal_map.hpp"

#include <string>

namespace tappet::can::dbc {

/// The machine is the node of that name, everybody else on the bus the node "others". Texts are of code page
/// 1252: a character that it has not becomes a question mark. What no name of a DBC file may hold becomes
/// '_'.
std::string to_dbc(std::string_view machine, std::span<const FrameRow> frames,
                   std::span<const Signal> signals);

} // namespace tappet::can::dbc
