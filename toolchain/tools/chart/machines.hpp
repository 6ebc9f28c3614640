// The machines of the tree that tappet-chart draws and verifies. A machine of your own is one more row.
#pragma once

#include "toolchain/tools/chart/promela.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace tappet::chart {

struct KnownMachine {
    MachineView machine{};
    std::span<const ModelRow> model{};
    const ScriptUnit* script = nullptr; ///< instead of a whole machine: one script
    std::string_view component{};       ///< that it drives

    [[nodiscard]] std::vector<Chart> charts() const {
        return script != nullptr ? charts_of(*script, component) : charts_of(machine);
    }
};

std::span<const KnownMachine> known_machines();

} // namespace tappet::chart
