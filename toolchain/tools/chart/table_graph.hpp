// The table as a graph: which activity runs a component and how often, the data flow, and the reactions.
#pragma once

#include "kernel/machine/firmware.hpp"

#include <string>

namespace tappet::chart {

/// Writes the language of the tool dot: components in boxes of their activities, with rates, deadlines and
/// the priorities of the machine's plan; solid arrows for data, dashed ones for reactions; devices at the
/// edge. All in the order of the table.
std::string to_dot(const AcceptedMachine& machine);

} // namespace tappet::chart
