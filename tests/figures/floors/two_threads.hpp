// Floors between two threads: a cache line from core to core, and the wake of a sleeper.
#pragma once

#include "tests/figures/measure/candidates.hpp"

namespace tappet::figures {

/// Adds the figures floors.line and floors.wake, as far as options.only selects them. On a machine with one
/// processor a note names the omissions.
void measure_two_threads(const Options& options, Result& result);

} // namespace tappet::figures
