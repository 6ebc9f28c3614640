// The table itself as a graph: who runs where and how often, what flows between them, what acts on what.
#pragma once

#include "kernel/machine/firmware.hpp"

#include <string>

namespace tappet::chart {

/// In the language of the tool dot: components in boxes of their activities, with rates, deadlines and the
/// priorities of the machine's plan; solid arrows for data, dashed ones for what makes something happen;
/// devices at the edge. Both are in the order of the table.
std::string to_dot(const AcceptedMachine& machine);

} // namespace tappet::chart
