// Floors between two threads: a cache line from core to core, and a sleeper woken.
#pragma once

#include "tests/figures/measure/candidates.hpp"

namespace tappet::figures {

/// Adds the figures floors.line and floors.wake, as far as options.only wants them. On a machine of one
/// processor a note says what is left out.
void measure_two_threads(const Options& options, Result& result);

} // namespace tappet::figures
