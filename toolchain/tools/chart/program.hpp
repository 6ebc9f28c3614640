// The program that draws one machine: the body of toolchain/machine/chart_main.cpp.
#pragma once

#include "toolchain/tools/chart/model.hpp"
#include "toolchain/tools/chart/table_graph.hpp"

#include <span>

namespace tappet::chart {

/// Runs the command line, see options.hpp. `model`: the rows for spin beside the table. Exit code: 0 well, 1
/// something could not be drawn, written or proved, 2 a wrong option.
[[nodiscard]] int run_chart(const AcceptedMachine& machine, std::span<const ModelRow> model, int count,
                            char** words);

} // namespace tappet::chart
