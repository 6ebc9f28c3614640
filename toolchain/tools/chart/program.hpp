// The program that draws one machine: what toolchain/machine/chart_main.cpp is made of.
#pragma once

#include "toolchain/tools/chart/model.hpp"
#include "toolchain/tools/chart/table_graph.hpp"

#include <span>

namespace tappet::chart {

/// Does what its command line says, see options.hpp. `model`: what spin knows beside the table. The exit
/// code: 0 well, 1 something could not be drawn, written or proved, 2 a wrong option.
[[nodiscard]] int run_chart(const AcceptedMachine& machine, std::span<const ModelRow> model, int count,
                            char** words);

} // namespace tappet::chart
