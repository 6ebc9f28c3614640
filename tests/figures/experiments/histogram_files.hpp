// The histograms of all tasks as files that gnuplot reads: one for each real-time task, application and
// setting, as the thesis kept them (A.2.2).
#pragma once

#include "tests/figures/experiments/findings.hpp"

#include <string>

namespace tappet::experiments {

/// "concurrent-data-high.txt" and so on: a block for each thing that was measured, two empty lines between
/// them, each line the lower end of a bin and how many executions fell into it. Empty: written; else why not.
std::string write_histograms(const Findings& findings, const std::string& directory);

} // namespace tappet::experiments
