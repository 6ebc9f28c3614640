// The machines of the tree that tappet-chart draws and verifies. A machine of your own is one more row.
#pragma once

#include "apps/chart/model.hpp"
#include "kernel/machine/machine.hpp"

#include <span>

namespace tappet::chart {

struct KnownMachine {
    MachineView machine{};
    std::span<const ModelRow> model{};
};

std::span<const KnownMachine> known_machines();

} // namespace tappet::chart
